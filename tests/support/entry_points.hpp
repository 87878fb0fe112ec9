// The entry points of the library under test, as a Fortran host declares them.
#pragma once

extern "C" {
void umat_(double* stress, double* statev, double* ddsdde, double* sse, double* spd, double* scd, double* rpl,
           double* ddsddt, double* drplde, double* drpldt, const double* stran, const double* dstran,
           const double* time, const double* dtime, const double* temp, const double* dtemp, const double* predef,
           const double* dpred, const char* cmname, const int* ndi, const int* nshr, const int* ntens,
           const int* nstatv, const double* props, const int* nprops, const double* coords, const double* drot,
           double* pnewdt, const double* celent, const double* dfgrd0, const double* dfgrd1, const int* noel,
           const int* npt, const int* layer, const int* kspt, const int* kstep, const int* kinc);

void vumat_(const int* nblock, const int* ndir, const int* nshr, const int* nstatev, const int* nfieldv,
            const int* nprops, const int* lanneal, const double* step_time, const double* total_time, const double* dt,
            const char* cmname, const double* coord_mp, const double* char_length, const double* props,
            const double* density, double* strain_inc, const double* rel_spin_inc, const double* temp_old,
            const double* stretch_old, const double* defgrad_old, const double* field_old, const double* stress_old,
            const double* state_old, const double* ener_intern_old, const double* ener_inelas_old,
            const double* temp_new, const double* stretch_new, const double* defgrad_new, const double* field_new,
            double* stress_new, double* state_new, double* ener_intern_new, double* ener_inelas_new);

decltype(umat_) UMAT;
decltype(vumat_) VUMAT;
}

namespace lode::test {

using UmatFunction = decltype(&umat_);
// `Real` is the type of the host's arrays.
template <class Real>
using VumatFunctionOf = void (*)(const int*, const int*, const int*, const int*, const int*, const int*, const int*,
                                 const Real*, const Real*, const Real*, const char*, const Real*, const Real*,
                                 const Real*, const Real*, Real*, const Real*, const Real*, const Real*, const Real*,
                                 const Real*, const Real*, const Real*, const Real*, const Real*, const Real*,
                                 const Real*, const Real*, const Real*, Real*, Real*, Real*, Real*);

}  // namespace lode::test
