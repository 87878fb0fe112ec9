// The explicit entry point for single-precision arrays. The arithmetic stays in double precision: increments of an
// explicit analysis are too small against the totals for anything else. Blocks are converted in chunks that stay in the
// first-level cache.
#include <algorithm>
#include <exception>
#include <vector>

#include "errors.hpp"
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

}  // namespace

extern "C" LODE_API void vumat_(const int* nblock, const int* ndir, const int* nshr, const int* nstatev,
                                const int* nfieldv, const int* nprops, const int* /*lanneal*/, const float* step_time,
                                const float* total_time, const float* dt, const char* cmname, const float* /*coord_mp*/,
                                const float* char_length, const float* props, const float* density, float* strain_inc,
                                const float* /*rel_spin_inc*/, const float* temp_old, const float* /*stretch_old*/,
                                const float* /*defgrad_old*/, const float* field_old, const float* stress_old,
                                const float* state_old, const float* ener_intern_old, const float* ener_inelas_old,
                                const float* temp_new, const float* stretch_new, const float* /*defgrad_new*/,
                                const float* field_new, float* stress_new, float* state_new, float* ener_intern_new,
                                float* ener_inelas_new) try {
    const int n = *ndir + *nshr;
    const int constants = std::max(*nprops, 0);
    const int total_columns = 3 * n + 2 * *nstatev + 2 * *nfieldv + n + 10;
    const int props_columns = constants / static_cast<int>(chunk) + 1;
    for (int first = 0; first < *nblock; first += static_cast<int>(chunk)) {
        const int count = std::min(static_cast<int>(chunk), *nblock - first);
        Workspace work(total_columns + props_columns);
        double* const constants_in_double = work.take(props_columns);
        std::copy_n(props, constants, constants_in_double);
        const auto in = [&](const float* source, int columns) {
            return work.take(source, columns, *nblock, first, count);
        };
        VumatArguments a{};
        a.nblock = count;
        a.nstatev = *nstatev;
        a.nfieldv = *nfieldv;
        a.stride = chunk;
        a.time_increment = static_cast<double>(*dt);
        a.time_end = static_cast<double>(*total_time);
        a.density = in(density, 1);
        a.temp_old = in(temp_old, 1);
        a.temp_new = in(temp_new, 1);
        a.field_old = in(field_old, *nfieldv);
        a.field_new = in(field_new, *nfieldv);
        a.stretch_new = in(stretch_new, n);
        a.char_length = in(char_length, 1);
        a.strain_increment = in(strain_inc, n);
        a.stress_old = in(stress_old, n);
        a.state_old = in(state_old, *nstatev);
        a.internal_energy_old = in(ener_intern_old, 1);
        a.inelastic_energy_old = in(ener_inelas_old, 1);
        a.stress_new = work.take(n);
        a.state_new = work.take(*nstatev);
        a.internal_energy_new = work.take(1);
        a.inelastic_energy_new = work.take(1);
        const VumatHeader header{
            cmname, constants_in_double, constants, *ndir, *nshr, *step_time == 0.0f && *total_time == 0.0f};
        if (!run_vumat(header, a, first)) return;
        give(a.stress_new, stress_new, n, *nblock, first, count);
        give(a.state_new, state_new, *nstatev, *nblock, first, count);
        give(a.internal_energy_new, ener_intern_new, 1, *nblock, first, count);
        give(a.inelastic_energy_new, ener_inelas_new, 1, *nblock, first, count);
        give(a.strain_increment, strain_inc, n, *nblock, first, count);
    }
} catch (const std::exception& problem) {
    lode::report_error_and_stop(lode::HostProgram::explicit_, problem.what());
}

extern "C" [[gnu::alias("vumat_"), gnu::visibility("default")]] decltype(vumat_) VUMAT;
