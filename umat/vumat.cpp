// The explicit entry point, by the Abaqus/Explicit convention (conventions page, "VUMAT meaning of the arrays").
#include "vumat.hpp"

extern "C" LODE_API void vumat_(const int* nblock, const int* ndir, const int* nshr, const int* nstatev,
                                const int* nfieldv, const int* nprops, const int* /*lanneal*/, const double* step_time,
                                const double* total_time, const double* dt, const char* cmname,
                                const double* /*coord_mp*/, const double* char_length, const double* props,
                                const double* density, double* strain_inc, const double* /*rel_spin_inc*/,
                                const double* temp_old, const double* /*stretch_old*/, const double* /*defgrad_old*/,
                                const double* field_old, const double* stress_old, const double* state_old,
                                const double* ener_intern_old, const double* ener_inelas_old, const double* temp_new,
                                const double* stretch_new, const double* /*defgrad_new*/, const double* field_new,
                                double* stress_new, double* state_new, double* ener_intern_new,
                                double* ener_inelas_new) {
    const lode::VumatHeader header{cmname, props, *nprops, *ndir, *nshr, *step_time == 0.0 && *total_time == 0.0};
    const lode::VumatArguments arguments{.nblock = *nblock,
                                         .nstatev = *nstatev,
                                         .nfieldv = *nfieldv,
                                         .stride = *nblock,
                                         .time_increment = *dt,
                                         .time_end = *total_time,
                                         .density = density,
                                         .temp_old = temp_old,
                                         .temp_new = temp_new,
                                         .field_old = field_old,
                                         .field_new = field_new,
                                         .stretch_new = stretch_new,
                                         .char_length = char_length,
                                         .strain_increment = strain_inc,
                                         .stress_old = stress_old,
                                         .state_old = state_old,
                                         .internal_energy_old = ener_intern_old,
                                         .inelastic_energy_old = ener_inelas_old,
                                         .stress_new = stress_new,
                                         .state_new = state_new,
                                         .internal_energy_new = ener_intern_new,
                                         .inelastic_energy_new = ener_inelas_new};
    lode::run_vumat(header, arguments, 0);
}

extern "C" [[gnu::alias("vumat_"), gnu::visibility("default")]] decltype(vumat_) VUMAT;
