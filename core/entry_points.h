/* The entry points, as C and C++ see what Fortran declares: arguments by reference, arrays in Fortran order, and the
 * length of the CHARACTER argument by value at the end (80; Lode itself does not read it, libraries that were compiled
 * from Fortran may). Meanings: the Abaqus manuals, "UMAT" and "VUMAT". */
#ifndef LODE_ENTRY_POINTS_H
#define LODE_ENTRY_POINTS_H

#include <stddef.h>

#include "lode/lode.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { LODE_CMNAME_LENGTH = 80 }; /* CMNAME is padded with blanks */

#define LODE_UMAT_ARGUMENTS                                                                                            \
    double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd, double *rpl,                \
        double *ddsddt, double *drplde, double *drpldt, const double *stran, const double *dstran, const double *time, \
        const double *dtime, const double *temp, const double *dtemp, const double *predef, const double *dpred,       \
        const char *cmname, const int *ndi, const int *nshr, const int *ntens, const int *nstatv, const double *props, \
        const int *nprops, const double *coords, const double *drot, double *pnewdt, const double *celent,             \
        const double *dfgrd0, const double *dfgrd1, const int *noel, const int *npt, const int *layer,                 \
        const int *kspt, const int *kstep, const int *kinc, size_t cmname_length
typedef void lode_umat_function(LODE_UMAT_ARGUMENTS);
/* umat_ by the same way, which also says what the solution took. Such calls are not recorded. */
typedef void lode_umat_observed_function(lode_observation* observation, LODE_UMAT_ARGUMENTS);
#undef LODE_UMAT_ARGUMENTS

#define LODE_VUMAT_ARGUMENTS(real)                                                                                  \
    const int *nblock, const int *ndir, const int *nshr, const int *nstatev, const int *nfieldv, const int *nprops, \
        const int *lanneal, const real *step_time, const real *total_time, const real *dt, const char *cmname,      \
        const real *coord_mp, const real *char_length, const real *props, const real *density, real *strain_inc,    \
        const real *rel_spin_inc, const real *temp_old, const real *stretch_old, const real *defgrad_old,           \
        const real *field_old, const real *stress_old, const real *state_old, const real *ener_intern_old,          \
        const real *ener_inelas_old, const real *temp_new, const real *stretch_new, const real *defgrad_new,        \
        const real *field_new, real *stress_new, real *state_new, real *ener_intern_new, real *ener_inelas_new,     \
        size_t cmname_length
typedef void lode_vumat_function(LODE_VUMAT_ARGUMENTS(double));
typedef void lode_vumat_sp_function(LODE_VUMAT_ARGUMENTS(float)); /* of a library for single-precision hosts */
#undef LODE_VUMAT_ARGUMENTS

lode_umat_function umat_;
lode_umat_observed_function lode_umat_observed;
lode_vumat_function vumat_;

#ifdef __cplusplus
}
#endif

#endif
