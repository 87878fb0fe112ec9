// The way of a call through the recorder: its inputs are copied, it runs, the frame is written.
#pragma once

#include <cstddef>

namespace lode::record {

// Arguments of UMAT and VUMAT as the host passes them.
struct UmatCall {
    double *stress, *statev, *ddsdde, *sse, *spd, *scd, *rpl, *ddsddt, *drplde, *drpldt;
    const double *stran, *dstran, *time, *dtime, *temp, *dtemp, *predef, *dpred;
    const char* cmname;
    const int *ndi, *nshr, *ntens, *nstatv;
    const double* props;
    const int* nprops;
    const double *coords, *drot;
    double* pnewdt;
    const double *celent, *dfgrd0, *dfgrd1;
    const int *noel, *npt, *layer, *kspt, *kstep, *kinc;
};
template <class Real>
struct VumatCall {
    const int *nblock, *ndir, *nshr, *nstatev, *nfieldv, *nprops, *lanneal;
    const Real *step_time, *total_time, *dt;
    const char* cmname;
    const Real *coord_mp, *char_length, *props, *density;
    Real* strain_inc;
    const Real *rel_spin_inc, *temp_old, *stretch_old, *defgrad_old, *field_old, *stress_old, *state_old,
        *ener_intern_old, *ener_inelas_old, *temp_new, *stretch_new, *defgrad_new, *field_new;
    Real *stress_new, *state_new, *ener_intern_new, *ener_inelas_new;
};

// Whether LODE_RECORD asks for a recording; decided when the library is loaded.
extern const bool active;

// What is recorded, for the session frame. Defined by each library that has a recorder.
struct Recorded {
    const char *library, *version, *instruction_set;
};
Recorded recorded_library();

void record(const UmatCall& call, void (*run)(const UmatCall&));
void record(const VumatCall<double>& call, void (*run)(const VumatCall<double>&));
void record(const VumatCall<float>& call, void (*run)(const VumatCall<float>&));

template <class Real>
inline void run_or_record(const VumatCall<Real>& call, void (*run)(const VumatCall<Real>&)) {
    if (active) [[unlikely]]
        record(call, run);
    else run(call);
}

// The call that this thread is in will not come back: stores it, and what a ring holds.
void ending();

}  // namespace lode::record
