#include "umat_call.hpp"

#include <cmath>
#include <cstring>

#include "../guard.hpp"

namespace lode::host {
namespace {

using record::UmatInput;

bool same_bits(const double* a, const double* b, std::size_t count) {
    return count == 0 || std::memcmp(a, b, count * sizeof(double)) == 0;
}

template <class Matrix>
bool same_bits(const Matrix& a, const Matrix& b) {
    return a.size() == b.size() && same_bits(a.data(), b.data(), static_cast<std::size_t>(a.size()));
}

}  // namespace

UmatCall call_of(const RecordedCall& recorded) {
    const record::UmatHeader& h = recorded.umat();
    UmatCall call;
    call.name = padded_material_name(recorded.material->name);
    call.props = recorded.material->constants;
    call.ndi = h.ndi;
    call.nshr = h.nshr;
    const auto scalar = [&](UmatInput i, double& target) {
        if (!recorded.input(i).empty()) target = recorded.input(i)[0];
    };
    const auto components = [&](UmatInput i) -> Components {
        const Numbers& values = recorded.input(i);
        Components result = Components::Zero(call.size());
        for (int k = 0; k < call.size() && k < static_cast<int>(values.size()); ++k)
            result[k] = values[static_cast<std::size_t>(k)];
        return result;
    };
    const auto matrix = [&](UmatInput i, Matrix3& target) {
        if (recorded.input(i).size() == 9) target = Eigen::Map<const Matrix3>(recorded.input(i).data());
    };
    call.stress = components(UmatInput::stress);
    call.stran = components(UmatInput::stran);
    call.dstran = components(UmatInput::dstran);
    call.statev = recorded.input(UmatInput::statev);
    scalar(UmatInput::sse, call.sse);
    scalar(UmatInput::spd, call.spd);
    scalar(UmatInput::scd, call.scd);
    scalar(UmatInput::pnewdt, call.pnewdt);
    if (recorded.input(UmatInput::time).size() == 2)
        std::copy_n(recorded.input(UmatInput::time).begin(), 2, call.time.begin());
    scalar(UmatInput::dtime, call.dtime);
    scalar(UmatInput::temp, call.temp);
    scalar(UmatInput::dtemp, call.dtemp);
    if (!recorded.input(UmatInput::predef).empty()) call.predef = recorded.input(UmatInput::predef);
    if (!recorded.input(UmatInput::dpred).empty()) call.dpred = recorded.input(UmatInput::dpred);
    if (recorded.input(UmatInput::coords).size() == 3)
        std::copy_n(recorded.input(UmatInput::coords).begin(), 3, call.coords.begin());
    matrix(UmatInput::drot, call.drot);
    matrix(UmatInput::dfgrd0, call.dfgrd0);
    matrix(UmatInput::dfgrd1, call.dfgrd1);
    scalar(UmatInput::celent, call.celent);
    call.noel = h.noel;
    call.npt = h.npt;
    call.layer = h.layer;
    call.kspt = h.kspt;
    call.kstep = h.kstep;
    call.kinc = h.kinc;
    return call;
}

bool UmatAnswer::finite() const {
    double sum = 0;
    for (const double x : statev) sum += 0 * x;
    return stress.allFinite() && sum == 0;
}

std::string first_difference(const UmatAnswer& a, const UmatAnswer& b) {
    if (a.returned != b.returned) return "the end of the analysis";
    if (!a.returned) return {};
    if (!same_bits(a.stress, b.stress)) return "STRESS";
    if (a.statev.size() != b.statev.size() || !same_bits(a.statev.data(), b.statev.data(), a.statev.size()))
        return "STATEV";
    if (!same_bits(a.tangent, b.tangent)) return "DDSDDE";
    if (!same_bits(&a.sse, &b.sse, 1)) return "SSE";
    if (!same_bits(&a.spd, &b.spd, 1)) return "SPD";
    if (!same_bits(&a.scd, &b.scd, 1)) return "SCD";
    if (!same_bits(&a.rpl, &b.rpl, 1)) return "RPL";
    if (!same_bits(a.ddsddt, b.ddsddt)) return "DDSDDT";
    if (!same_bits(a.drplde, b.drplde)) return "DRPLDE";
    if (!same_bits(&a.drpldt, &b.drpldt, 1)) return "DRPLDT";
    if (!same_bits(&a.pnewdt, &b.pnewdt, 1)) return "PNEWDT";
    return {};
}
bool identical(const UmatAnswer& a, const UmatAnswer& b) { return first_difference(a, b).empty(); }

UmatAnswer UmatCaller::operator()(const UmatCall& call, const Surroundings& around) {
    const auto n = static_cast<std::size_t>(call.size());
    numbers_.reset(call.statev.size() + n * n + 5 * n + call.predef.size() + call.dpred.size() + call.props.size() + 64,
                   32);
    integers_.reset(32, 16);
    letters_.reset(material_name_length, 1);
    const auto input = [&](const char* name, const double* values, std::size_t count) {
        return numbers_.input(name, values, count, around.zone_of(name));
    };
    const auto inout = [&](const char* name, const double* values, std::size_t count) {
        return numbers_.inout(name, values, count, around.zone_of(name));
    };
    const auto output = [&](const char* name, std::size_t count) {
        return numbers_.output(name, count, around.outputs, around.zone_of(name));
    };
    const auto integer = [&](const char* name, int value) { return integers_.input(name, &value, 1, 0x5A5A5A5A); };
    double* const stress = inout("STRESS", call.stress.data(), n);
    double* const statev = inout("STATEV", call.statev.data(), call.statev.size());
    double* const ddsdde = output("DDSDDE", n * n);
    double* const sse = inout("SSE", &call.sse, 1);
    double* const spd = inout("SPD", &call.spd, 1);
    double* const scd = inout("SCD", &call.scd, 1);
    double* const rpl = output("RPL", 1);
    double* const ddsddt = output("DDSDDT", n);
    double* const drplde = output("DRPLDE", n);
    double* const drpldt = output("DRPLDT", 1);
    double* const pnewdt = inout("PNEWDT", &call.pnewdt, 1);
    const double* const stran = input("STRAN", call.stran.data(), n);
    const double* const dstran = input("DSTRAN", call.dstran.data(), n);
    const double* const time = input("TIME", call.time.data(), 2);
    const double* const dtime = input("DTIME", &call.dtime, 1);
    const double* const temp = input("TEMP", &call.temp, 1);
    const double* const dtemp = input("DTEMP", &call.dtemp, 1);
    const double* const predef = input("PREDEF", call.predef.data(), call.predef.size());
    const double* const dpred = input("DPRED", call.dpred.data(), call.dpred.size());
    const double* const props = input("PROPS", call.props.data(), call.props.size());
    const double* const coords = input("COORDS", call.coords.data(), 3);
    const double* const drot = input("DROT", call.drot.data(), 9);
    const double* const celent = input("CELENT", &call.celent, 1);
    const double* const dfgrd0 = input("DFGRD0", call.dfgrd0.data(), 9);
    const double* const dfgrd1 = input("DFGRD1", call.dfgrd1.data(), 9);
    const char* const cmname = letters_.input("CMNAME", call.name.data(), call.name.size(), ' ');
    const int* const ndi = integer("NDI", call.ndi);
    const int* const nshr = integer("NSHR", call.nshr);
    const int* const ntens = integer("NTENS", call.size());
    const int* const nstatv = integer("NSTATV", static_cast<int>(call.statev.size()));
    const int* const nprops = integer("NPROPS", static_cast<int>(call.props.size()));
    const int* const noel = integer("NOEL", call.noel);
    const int* const npt = integer("NPT", call.npt);
    const int* const layer = integer("LAYER", call.layer);
    const int* const kspt = integer("KSPT", call.kspt);
    const std::array<int, 4> step_numbers{call.kstep, 1, 1, 0};
    const int* const jstep = integers_.input("JSTEP", step_numbers.data(), step_numbers.size(), 0x5A5A5A5A);
    const int* const kinc = integer("KINC", call.kinc);

    UmatAnswer answer;
    answer.returned = guarded([&] {
        function_(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, temp,
                  dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, pnewdt, celent,
                  dfgrd0, dfgrd1, noel, npt, layer, kspt, jstep, kinc, material_name_length);
    });
    if (!answer.returned) answer.message = last_library_error();
    const auto size = static_cast<Eigen::Index>(n);
    answer.stress = Eigen::Map<const Components>(stress, size);
    answer.statev.assign(statev, statev + call.statev.size());
    answer.tangent = Eigen::Map<const Tangent>(ddsdde, size, size);
    answer.sse = *sse;
    answer.spd = *spd;
    answer.scd = *scd;
    answer.rpl = *rpl;
    answer.drpldt = *drpldt;
    answer.pnewdt = *pnewdt;
    answer.ddsddt = Eigen::Map<const Components>(ddsddt, size);
    answer.drplde = Eigen::Map<const Components>(drplde, size);
    numbers_.collect_damage(answer.damage);
    integers_.collect_damage(answer.damage);
    letters_.collect_damage(answer.damage);
    return answer;
}

}  // namespace lode::host
