// A host with nothing but the calls: no XIT, no message routines. Started by the tests as a process of its own.
//     bare_host sweep                     every sample of every model in every kind, stresses on standard output
//     bare_host refuse umat|vumat         a material that does not exist
//     bare_host turned PNEWDT             the stress of a stretched and turned body, with PNEWDT on entry
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "entry_points.hpp"
#include "lode/material/kind.hpp"

namespace {

using lode::AnalysisKind;

std::string padded(std::string name) {
    name.resize(80, ' ');
    return name;
}

struct Point {
    std::vector<double> stress, statev, props;
    double f[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    double pnewdt = 1.0;
    std::vector<double> tangent;

    void call(const std::string& name, int ndi, int nshr, const std::vector<double>& dstran) {
        const int ntens = ndi + nshr, nstatv = static_cast<int>(statev.size()), nprops = static_cast<int>(props.size());
        const auto n = static_cast<std::size_t>(ntens);
        tangent.resize(n * n);
        std::vector<double> ddsddt(n), drplde(n), stran(n);
        double sse = 0, spd = 0, scd = 0, rpl = 0, drpldt = 0;
        const double time[2] = {0, 0}, dtime = 1, temp = 20, dtemp = 0, predef = 0, dpred = 0, coords[3] = {},
                     celent = 1;
        const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
        const int one = 1;
        const std::string cmname = padded(name);
        umat_(stress.data(), statev.data(), tangent.data(), &sse, &spd, &scd, &rpl, ddsddt.data(), drplde.data(),
              &drpldt, stran.data(), dstran.data(), time, &dtime, &temp, &dtemp, &predef, &dpred, cmname.data(), &ndi,
              &nshr, &ntens, &nstatv, props.data(), &nprops, coords, identity, &pnewdt, &celent, identity, f, &one,
              &one, &one, &one, &one, &one, LODE_CMNAME_LENGTH);
    }
};

void call_vumat(const std::string& name, int points, int ndir, int nshr, int nstatv, std::vector<double> props,
                std::vector<double>& strain, std::vector<double>& stress_new) {
    const auto block = static_cast<std::size_t>(points), columns = static_cast<std::size_t>(ndir + nshr);
    const std::vector<double> zeros(9 * block + static_cast<std::size_t>(nstatv) * block, 0.0), ones(block, 1.0);
    std::vector<double> stretch(6 * block, 0.0), state_new(static_cast<std::size_t>(nstatv) * block + 1), intern(block),
        inelas(block);
    for (std::size_t i = 0; i < 3 * block; ++i) stretch[i] = 1.0;
    if (ndir == 3)
        for (std::size_t i = 0; i < columns * block; ++i) stretch[i] += strain[i];
    stress_new.assign(columns * block, 0.0);
    const std::vector<double> temperature(block, 20.0);
    const std::string cmname = padded(name);
    const int nfield = 1, nprops = static_cast<int>(props.size()), lanneal = 0;
    const double time = 1.0;
    vumat_(&points, &ndir, &nshr, &nstatv, &nfield, &nprops, &lanneal, &time, &time, &time, cmname.data(), zeros.data(),
           ones.data(), props.data(), ones.data(), strain.data(), zeros.data(), temperature.data(), stretch.data(),
           stretch.data(), zeros.data(), zeros.data(), zeros.data(), zeros.data(), zeros.data(), temperature.data(),
           stretch.data(), stretch.data(), zeros.data(), stress_new.data(), state_new.data(), intern.data(),
           inelas.data(), LODE_CMNAME_LENGTH);
}

// One line a number: what it is, the scale its rounding errors have, and the number.
void print(const std::string& what, double scale, const std::vector<double>& values) {
    for (const double x : values) std::printf("%s %.17g %.17g\n", what.c_str(), scale, x);
}

void sweep_sample(const lode_model& model, const lode_sample& sample, AnalysisKind kind) {
    const int ndi = lode::normal_components(kind), nshr = lode::shear_components(kind);
    const auto n = static_cast<std::size_t>(ndi + nshr);
    const std::string name = std::string(model.keyword) + "-" + sample.label;
    Point point;
    point.props.assign(sample.constants, sample.constants + sample.constant_count);
    const int nstatv =
        lode_required_state(name.c_str(), sample.constants, sample.constant_count, ndi, nshr, nullptr, 0);
    point.statev.assign(static_cast<std::size_t>(nstatv), 0.0);
    for (std::size_t i = 0; i < point.statev.size() && static_cast<int>(i) < model.state_count; ++i)
        point.statev[i] = model.state[i].initial;
    const std::vector<double> initial_state = point.statev;
    point.stress.assign(n, 0.0);
    point.call(name, ndi, nshr, std::vector<double>(n, 0.0));
    double stiffness = 0.0;
    for (const double c : point.tangent) stiffness = std::fmax(stiffness, std::abs(c));
    const std::string what = name + "/" + std::to_string(static_cast<int>(kind));

    std::vector<double> strain(n);
    for (int step = 0; step < 8; ++step) {
        for (std::size_t i = 0; i < n; ++i)
            strain[i] = 0.3 * sample.strain_scale * std::cos(1.0 + 0.4 * step + 1.7 * static_cast<double>(i));
        if (!lode::is_cohesive(kind)) {
            for (int i = 0; i < ndi; ++i) point.f[4 * i] *= 1.0 + strain[static_cast<std::size_t>(i)];
            if (nshr > 0) point.f[3] += strain[static_cast<std::size_t>(ndi)];
        }
        point.call(name, ndi, nshr, strain);
        print(what, stiffness * (sample.strain_scale + 1.0), point.stress);
        print(what, stiffness, point.tangent);
    }

    const int points = 13;
    if (kind == AnalysisKind::plane_stress) return;
    std::vector<double> block(n * points), stress;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t p = 0; p < points; ++p)
            block[i * points + p] =
                sample.strain_scale * std::sin(1.0 + 0.9 * static_cast<double>(p) + static_cast<double>(i));
    call_vumat(name, points, ndi, nshr, nstatv, point.props, block, stress);
    print(what + "/vumat", stiffness * (sample.strain_scale + 1.0), stress);
}

int sweep() {
    for (int m = 0; m < lode_model_count(); ++m) {
        const lode_model& model = *lode_model_at(m);
        for (int s = 0; s < model.sample_count; ++s)
            for (int k = 0; k < lode::kind_count; ++k)
                if ((model.kinds & model.samples[s].kinds & lode::kind_bit(static_cast<AnalysisKind>(k))) != 0)
                    sweep_sample(model, model.samples[s], static_cast<AnalysisKind>(k));
    }
    std::printf("# instruction set %s\n", lode_instruction_set());
    return 0;
}

int refuse(bool implicit) {
    if (implicit) {
        Point point;
        point.stress.assign(6, 0.0);
        point.call("NO_SUCH_MODEL-HERE", 3, 3, std::vector<double>(6, 0.0));
    } else {
        std::vector<double> strain(6, 0.0), stress;
        call_vumat("NO_SUCH_MODEL-HERE", 1, 3, 3, 0, {1.0}, strain, stress);
    }
    return 0;
}

// 10 % stretch along 1, then a quarter turn: the stress is along 2, or along 1 in the unrotated frame.
int turned(double pnewdt) {
    Point point;
    point.props = {1000.0, 0.25, 0.0, 0.0, 1.0};
    point.stress.assign(6, 0.0);
    point.statev.assign(4, 0.0);
    const double f[9] = {0, 1.1, 0, -1, 0, 0, 0, 0, 1};
    std::memcpy(point.f, f, sizeof f);
    point.pnewdt = pnewdt;
    point.call("ISO_ELASTIC-TURNED", 3, 3, std::vector<double>(6, 0.0));
    std::printf("%.6f %.6f %.6f\n", point.stress[0], point.stress[1], point.pnewdt);
    return 0;
}

}  // namespace

int main(int count, char** arguments) {
    const std::string_view mode = count > 1 ? arguments[1] : "";
    if (mode == "sweep") return sweep();
    if (mode == "refuse" && count > 2) return refuse(std::string_view(arguments[2]) == "umat");
    if (mode == "turned" && count > 2) return turned(std::atof(arguments[2]));
    return 2;
}
