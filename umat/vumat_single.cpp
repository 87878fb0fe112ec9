// The explicit entry point for single-precision arrays. The arithmetic stays in double precision: increments of an
// explicit analysis are too small against the totals for anything else. Blocks are converted in chunks that stay in the
// first-level cache.
#include <algorithm>
#include <exception>
#include <vector>

#include "errors.hpp"
#include "record/recorder.hpp"
#include "vumat.hpp"

namespace {

using namespace lode;

constexpr std::ptrdiff_t chunk = 64;

// Columns of doubles for one chunk, filled from and written back to columns of floats.
class Workspace {
  public:
    explicit Workspace(int columns) : memory_(thread_memory()) {
        const auto needed = static_cast<std::size_t>(columns * chunk);
        if (memory_.size() < needed) memory_.resize(needed);
    }
    double* take(int columns) {
        double* column = memory_.data() + used_;
        used_ += static_cast<std::size_t>(columns * chunk);
        return column;
    }
    double* take(const float* source, int columns, int nblock, int first, int count) {
        double* target = take(columns);
        for (int c = 0; c < columns; ++c) {
            const float* from = source + static_cast<std::ptrdiff_t>(c) * nblock + first;
            double* to = target + c * chunk;
            for (int i = 0; i < count; ++i) to[i] = static_cast<double>(from[i]);
        }
        return target;
    }

  private:
    static std::vector<double>& thread_memory() {
        thread_local std::vector<double> memory;
        return memory;
    }
    std::vector<double>& memory_;
    std::size_t used_ = 0;
};

void give(const double* source, float* target, int columns, int nblock, int first, int count) {
    for (int c = 0; c < columns; ++c) {
        const double* from = source + c * chunk;
        float* to = target + static_cast<std::ptrdiff_t>(c) * nblock + first;
        for (int i = 0; i < count; ++i) to[i] = static_cast<float>(from[i]);
    }
}

void run(const record::VumatCall<float>& c) try {
    const int n = *c.ndir + *c.nshr;
    const int constants = std::max(*c.nprops, 0);
    const int total_columns = 3 * n + 2 * *c.nstatev + 2 * *c.nfieldv + n + 10;
    const int props_columns = constants / static_cast<int>(chunk) + 1;
    for (int first = 0; first < *c.nblock; first += static_cast<int>(chunk)) {
        const int count = std::min(static_cast<int>(chunk), *c.nblock - first);
        Workspace work(total_columns + props_columns);
        double* const constants_in_double = work.take(props_columns);
        std::copy_n(c.props, constants, constants_in_double);
        const auto in = [&](const float* source, int columns) {
            return work.take(source, columns, *c.nblock, first, count);
        };
        VumatArguments a{};
        a.nblock = count;
        a.nstatev = *c.nstatev;
        a.nfieldv = *c.nfieldv;
        a.stride = chunk;
        a.time_increment = static_cast<double>(*c.dt);
        a.time_end = static_cast<double>(*c.total_time);
        a.density = in(c.density, 1);
        a.temp_old = in(c.temp_old, 1);
        a.temp_new = in(c.temp_new, 1);
        a.field_old = in(c.field_old, *c.nfieldv);
        a.field_new = in(c.field_new, *c.nfieldv);
        a.stretch_new = in(c.stretch_new, n);
        a.char_length = in(c.char_length, 1);
        a.strain_increment = in(c.strain_inc, n);
        a.stress_old = in(c.stress_old, n);
        a.state_old = in(c.state_old, *c.nstatev);
        a.internal_energy_old = in(c.ener_intern_old, 1);
        a.inelastic_energy_old = in(c.ener_inelas_old, 1);
        a.stress_new = work.take(n);
        a.state_new = work.take(*c.nstatev);
        a.internal_energy_new = work.take(1);
        a.inelastic_energy_new = work.take(1);
        const VumatHeader header{
            c.cmname, constants_in_double, constants, *c.ndir, *c.nshr, *c.step_time == 0.0f && *c.total_time == 0.0f};
        if (!run_vumat(header, a, first)) return;
        give(a.stress_new, c.stress_new, n, *c.nblock, first, count);
        give(a.state_new, c.state_new, *c.nstatev, *c.nblock, first, count);
        give(a.internal_energy_new, c.ener_intern_new, 1, *c.nblock, first, count);
        give(a.inelastic_energy_new, c.ener_inelas_new, 1, *c.nblock, first, count);
        give(a.strain_increment, c.strain_inc, n, *c.nblock, first, count);
    }
} catch (const std::exception& problem) {
    report_error_and_stop(HostProgram::explicit_, problem.what());
}

}  // namespace

extern "C" LODE_API void vumat_(const int* nblock, const int* ndir, const int* nshr, const int* nstatev,
                                const int* nfieldv, const int* nprops, const int* lanneal, const float* step_time,
                                const float* total_time, const float* dt, const char* cmname, const float* coord_mp,
                                const float* char_length, const float* props, const float* density, float* strain_inc,
                                const float* rel_spin_inc, const float* temp_old, const float* stretch_old,
                                const float* defgrad_old, const float* field_old, const float* stress_old,
                                const float* state_old, const float* ener_intern_old, const float* ener_inelas_old,
                                const float* temp_new, const float* stretch_new, const float* defgrad_new,
                                const float* field_new, float* stress_new, float* state_new, float* ener_intern_new,
                                float* ener_inelas_new, std::size_t) {
    record::run_or_record<float>(
        {nblock,          ndir,     nshr,        nstatev,     nfieldv,     nprops,     lanneal,   step_time,
         total_time,      dt,       cmname,      coord_mp,    char_length, props,      density,   strain_inc,
         rel_spin_inc,    temp_old, stretch_old, defgrad_old, field_old,   stress_old, state_old, ener_intern_old,
         ener_inelas_old, temp_new, stretch_new, defgrad_new, field_new,   stress_new, state_new, ener_intern_new,
         ener_inelas_new},
        &run);
}

extern "C" [[gnu::alias("vumat_"), gnu::visibility("default")]] decltype(vumat_) VUMAT;
