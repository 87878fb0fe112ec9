// liblode-record.so: records the calls of any other library with umat_ or vumat_. The host loads this one; the one
// whose calls it passes on is named by LODE_RECORD_LIBRARY.
#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>

#include "lode/entry_points.h"
#include "recorder.hpp"

namespace {

using namespace lode::record;

// Without the library there is nothing to run.
[[noreturn]] void stop(const char* what, const char* detail) {
    std::fprintf(stderr, "Lode: ERROR: %s%s\n", what, detail);
    std::fflush(nullptr);
    std::_Exit(65);
}

void* wrapped(const char* symbol) {
    static void* const library = [] {
        const char* const path = std::getenv("LODE_RECORD_LIBRARY");
        if (path == nullptr) stop("LODE_RECORD_LIBRARY must name the library to record", "");
        void* const handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
        if (handle == nullptr) stop("LODE_RECORD_LIBRARY: ", dlerror());
        return handle;
    }();
    void* const function = dlsym(library, symbol);
    if (function == nullptr) stop("LODE_RECORD_LIBRARY: ", dlerror());
    return function;
}

void run(const UmatCall& c) {
    static const auto umat = reinterpret_cast<lode_umat_function*>(wrapped("umat_"));
    umat(c.stress, c.statev, c.ddsdde, c.sse, c.spd, c.scd, c.rpl, c.ddsddt, c.drplde, c.drpldt, c.stran, c.dstran,
         c.time, c.dtime, c.temp, c.dtemp, c.predef, c.dpred, c.cmname, c.ndi, c.nshr, c.ntens, c.nstatv, c.props,
         c.nprops, c.coords, c.drot, c.pnewdt, c.celent, c.dfgrd0, c.dfgrd1, c.noel, c.npt, c.layer, c.kspt, c.kstep,
         c.kinc, LODE_CMNAME_LENGTH);
}
void run(const VumatCall<double>& c) {
    static const auto vumat = reinterpret_cast<lode_vumat_function*>(wrapped("vumat_"));
    vumat(c.nblock, c.ndir, c.nshr, c.nstatev, c.nfieldv, c.nprops, c.lanneal, c.step_time, c.total_time, c.dt,
          c.cmname, c.coord_mp, c.char_length, c.props, c.density, c.strain_inc, c.rel_spin_inc, c.temp_old,
          c.stretch_old, c.defgrad_old, c.field_old, c.stress_old, c.state_old, c.ener_intern_old, c.ener_inelas_old,
          c.temp_new, c.stretch_new, c.defgrad_new, c.field_new, c.stress_new, c.state_new, c.ener_intern_new,
          c.ener_inelas_new, LODE_CMNAME_LENGTH);
}

}  // namespace

lode::record::Recorded lode::record::recorded_library() {
    const char* const path = std::getenv("LODE_RECORD_LIBRARY");
    return {path != nullptr ? path : "", "", ""};
}

extern "C" __attribute__((visibility("default"))) void umat_(
    double* stress, double* statev, double* ddsdde, double* sse, double* spd, double* scd, double* rpl, double* ddsddt,
    double* drplde, double* drpldt, const double* stran, const double* dstran, const double* time, const double* dtime,
    const double* temp, const double* dtemp, const double* predef, const double* dpred, const char* cmname,
    const int* ndi, const int* nshr, const int* ntens, const int* nstatv, const double* props, const int* nprops,
    const double* coords, const double* drot, double* pnewdt, const double* celent, const double* dfgrd0,
    const double* dfgrd1, const int* noel, const int* npt, const int* layer, const int* kspt, const int* kstep,
    const int* kinc, std::size_t) {
    const UmatCall call{stress, statev, ddsdde, sse,   spd,    scd,    rpl,    ddsddt, drplde, drpldt,
                        stran,  dstran, time,   dtime, temp,   dtemp,  predef, dpred,  cmname, ndi,
                        nshr,   ntens,  nstatv, props, nprops, coords, drot,   pnewdt, celent, dfgrd0,
                        dfgrd1, noel,   npt,    layer, kspt,   kstep,  kinc};
    if (active) record(call, &run);
    else run(call);
}

extern "C" __attribute__((visibility("default"))) void vumat_(
    const int* nblock, const int* ndir, const int* nshr, const int* nstatev, const int* nfieldv, const int* nprops,
    const int* lanneal, const double* step_time, const double* total_time, const double* dt, const char* cmname,
    const double* coord_mp, const double* char_length, const double* props, const double* density, double* strain_inc,
    const double* rel_spin_inc, const double* temp_old, const double* stretch_old, const double* defgrad_old,
    const double* field_old, const double* stress_old, const double* state_old, const double* ener_intern_old,
    const double* ener_inelas_old, const double* temp_new, const double* stretch_new, const double* defgrad_new,
    const double* field_new, double* stress_new, double* state_new, double* ener_intern_new, double* ener_inelas_new,
    std::size_t) {
    run_or_record<double>(
        {nblock,          ndir,     nshr,        nstatev,     nfieldv,     nprops,     lanneal,   step_time,
         total_time,      dt,       cmname,      coord_mp,    char_length, props,      density,   strain_inc,
         rel_spin_inc,    temp_old, stretch_old, defgrad_old, field_old,   stress_old, state_old, ener_intern_old,
         ener_inelas_old, temp_new, stretch_new, defgrad_new, field_new,   stress_new, state_new, ener_intern_new,
         ener_inelas_new},
        &run);
}
