// The implicit entry point, by the Abaqus/Standard convention (conventions page, "UMAT meaning of the arrays").
#include "call.hpp"
#include "host_profile.hpp"
#include "lode/entry_points.h"
#include "record/recorder.hpp"

namespace {

using namespace lode;

// PNEWDT is touched only when a smaller increment is wanted; hosts enter with 1, a huge number or (CalculiX) -1.
void ask_for_smaller_increment(double& pnewdt, double ratio) {
    if (pnewdt <= 0.0 || pnewdt > ratio) pnewdt = ratio;
}

[[gnu::always_inline]] inline void update_point(const char* cmname, const double* props, int nprops, int ndi, int nshr,
                                                double& pnewdt, UmatArguments arguments,
                                                lode_observation* observation = nullptr) {
    const Call call = prepare_call(HostProgram::standard, cmname, props, nprops, ndi, nshr, arguments.nstatv);
    if (call.material == nullptr) [[unlikely]]
        return;

    double stretch[9];
    if (host_profile(call.material->host, pnewdt) == HostProfile::calculix) [[unlikely]] {
        arguments.drot = nullptr;
        arguments.dfgrd1 = unrotated(arguments.dfgrd1, stretch);
        arguments.predef = arguments.dpred = no_fields;
        arguments.celent = &unknown_length;
    }
    CallStatus status;
    call.material->umat[static_cast<std::size_t>(call.kind)](call.material->object, arguments, status);
    if (observation != nullptr) *observation = status.solves;
    if (status.failure != nullptr) [[unlikely]] {
        if (status.refusal != nullptr)
            report_error_and_stop(HostProgram::standard, failure_text(*call.material, status));
        else ask_for_smaller_increment(pnewdt, status.time_step_ratio);
    }
    if (status.warning != nullptr) [[unlikely]]
        warn_once(HostProgram::standard, *call.material, status.warning);
}

void run(const record::UmatCall& c) {
    update_point(
        c.cmname, c.props, *c.nprops, *c.ndi, *c.nshr, *c.pnewdt,
        {c.stress, c.statev, c.ddsdde, c.sse,   c.spd,    c.scd,   c.rpl,  c.ddsddt, c.drplde, c.drpldt, c.dstran,
         c.time,   c.dtime,  c.temp,   c.dtemp, c.predef, c.dpred, c.drot, c.celent, c.dfgrd1, *c.nstatv});
}

}  // namespace

extern "C" LODE_API void umat_(double* stress, double* statev, double* ddsdde, double* sse, double* spd, double* scd,
                               double* rpl, double* ddsddt, double* drplde, double* drpldt, const double* stran,
                               const double* dstran, const double* time, const double* dtime, const double* temp,
                               const double* dtemp, const double* predef, const double* dpred, const char* cmname,
                               const int* ndi, const int* nshr, const int* ntens, const int* nstatv,
                               const double* props, const int* nprops, const double* coords, const double* drot,
                               double* pnewdt, const double* celent, const double* dfgrd0, const double* dfgrd1,
                               const int* noel, const int* npt, const int* layer, const int* kspt, const int* kstep,
                               const int* kinc, std::size_t) {
    if (record::active) [[unlikely]]
        return record::record(
            {stress, statev, ddsdde, sse,    spd,    scd,    rpl, ddsddt, drplde, drpldt, stran, dstran, time,
             dtime,  temp,   dtemp,  predef, dpred,  cmname, ndi, nshr,   ntens,  nstatv, props, nprops, coords,
             drot,   pnewdt, celent, dfgrd0, dfgrd1, noel,   npt, layer,  kspt,   kstep,  kinc},
            &run);
    update_point(cmname, props, *nprops, *ndi, *nshr, *pnewdt,
                 {stress, statev, ddsdde, sse,   spd,    scd,   rpl,  ddsddt, drplde, drpldt, dstran,
                  time,   dtime,  temp,   dtemp, predef, dpred, drot, celent, dfgrd1, *nstatv});
}

// `observation` stays zero where the call is refused.
extern "C" LODE_API void lode_umat_observed(lode_observation* observation, double* stress, double* statev,
                                            double* ddsdde, double* sse, double* spd, double* scd, double* rpl,
                                            double* ddsddt, double* drplde, double* drpldt, const double*,
                                            const double* dstran, const double* time, const double* dtime,
                                            const double* temp, const double* dtemp, const double* predef,
                                            const double* dpred, const char* cmname, const int* ndi, const int* nshr,
                                            const int*, const int* nstatv, const double* props, const int* nprops,
                                            const double*, const double* drot, double* pnewdt, const double* celent,
                                            const double*, const double* dfgrd1, const int*, const int*, const int*,
                                            const int*, const int*, const int*, std::size_t) {
    *observation = {};
    update_point(cmname, props, *nprops, *ndi, *nshr, *pnewdt,
                 {stress, statev, ddsdde, sse,   spd,    scd,   rpl,  ddsddt, drplde, drpldt, dstran,
                  time,   dtime,  temp,   dtemp, predef, dpred, drot, celent, dfgrd1, *nstatv},
                 observation);
}

// One host can only ask for upper-case symbols.
extern "C" [[gnu::alias("umat_"), gnu::visibility("default")]] decltype(umat_) UMAT;
