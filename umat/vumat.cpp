// The explicit entry point, by the Abaqus/Explicit convention (conventions page, "VUMAT meaning of the arrays").
#include "vumat.hpp"

#include "lode/entry_points.h"
#include "record/recorder.hpp"

namespace {

using namespace lode;

void run(const record::VumatCall<double>& c) {
    const VumatHeader header{c.cmname, c.props, *c.nprops,
                             *c.ndir,  *c.nshr, *c.step_time == 0.0 && *c.total_time == 0.0};
    const VumatArguments arguments{.nblock = *c.nblock,
                                   .nstatev = *c.nstatev,
                                   .nfieldv = *c.nfieldv,
                                   .stride = *c.nblock,
                                   .time_increment = *c.dt,
                                   .time_end = *c.total_time,
                                   .density = c.density,
                                   .temp_old = c.temp_old,
                                   .temp_new = c.temp_new,
                                   .field_old = c.field_old,
                                   .field_new = c.field_new,
                                   .stretch_new = c.stretch_new,
                                   .char_length = c.char_length,
                                   .strain_increment = c.strain_inc,
                                   .stress_old = c.stress_old,
                                   .state_old = c.state_old,
                                   .internal_energy_old = c.ener_intern_old,
                                   .inelastic_energy_old = c.ener_inelas_old,
                                   .stress_new = c.stress_new,
                                   .state_new = c.state_new,
                                   .internal_energy_new = c.ener_intern_new,
                                   .inelastic_energy_new = c.ener_inelas_new};
    run_vumat(header, arguments, 0);
}

}  // namespace

extern "C" LODE_API void vumat_(const int* nblock, const int* ndir, const int* nshr, const int* nstatev,
                                const int* nfieldv, const int* nprops, const int* lanneal, const double* step_time,
                                const double* total_time, const double* dt, const char* cmname, const double* coord_mp,
                                const double* char_length, const double* props, const double* density,
                                double* strain_inc, const double* rel_spin_inc, const double* temp_old,
                                const double* stretch_old, const double* defgrad_old, const double* field_old,
                                const double* stress_old, const double* state_old, const double* ener_intern_old,
                                const double* ener_inelas_old, const double* temp_new, const double* stretch_new,
                                const double* defgrad_new, const double* field_new, double* stress_new,
                                double* state_new, double* ener_intern_new, double* ener_inelas_new, std::size_t) {
    record::run_or_record<double>(
        {nblock,          ndir,     nshr,        nstatev,     nfieldv,     nprops,     lanneal,   step_time,
         total_time,      dt,       cmname,      coord_mp,    char_length, props,      density,   strain_inc,
         rel_spin_inc,    temp_old, stretch_old, defgrad_old, field_old,   stress_old, state_old, ener_intern_old,
         ener_inelas_old, temp_new, stretch_new, defgrad_new, field_new,   stress_new, state_new, ener_intern_new,
         ener_inelas_new},
        &run);
}

extern "C" [[gnu::alias("vumat_"), gnu::visibility("default")]] decltype(vumat_) VUMAT;
