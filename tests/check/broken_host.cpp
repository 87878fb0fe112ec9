// A host that makes the mistake that its argument names: six increments of a shear that turns, one element, through the
// library that it is linked to.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <string_view>

#include "lode/entry_points.h"
#include "replay/kinematics.hpp"

namespace {

using namespace lode::host;

constexpr int increments = 6;
const char* const name = "ISO_ELASTIC-HOST                                                                ";
const double props[] = {210000.0, 0.3};

Matrix3 gradient_at(double t) {
    Matrix3 U = Matrix3::Identity();
    U(0, 0) += 0.02 * t;
    U(0, 1) = U(1, 0) = 0.03 * t;
    U(1, 2) = U(2, 1) = 0.01 * t;
    return rotation_about({0.2, 0.3, 1}, 0.4 * t) * U;
}

void implicit(std::string_view mistake) {
    const Layout layout(Kind::solid);
    Components stress = Components::Zero(6), stran = Components::Zero(6);
    std::array<double, 4> statev{};
    double sse = 0, spd = 0, scd = 0, total = 0;
    const int ndi = 3, nshr = 3, nstatv = 4, nprops = 2, one = 1;
    const int ntens = mistake == "ntens" ? 5 : 6;
    const std::array<int, 4> jstep{1, 1, 1, 0};
    const double zero = 0, coords[3] = {}, celent = mistake == "celent" ? 0 : 1;
    for (int k = 1; k <= increments; ++k) {
        const double dtime_true = 1.0 / increments, dtime = mistake == "dtime" ? -dtime_true : dtime_true;
        Matrix3 F0 = gradient_at((k - 1.0) / increments), F1 = gradient_at(static_cast<double>(k) / increments);
        const MotionIncrement motion = motion_increment(F0, F1);
        Matrix3 drot = motion.rotation;
        Components dstran = layout.strain_components(motion.strain);
        if (mistake != "stress_not_rotated")
            stress = layout.stress_components(drot * layout.stress_tensor(stress) * drot.transpose());
        if (mistake == "stress_twice" && k > 1) stress *= 1.5;
        stran = layout.strain_components(drot * layout.strain_tensor(stran) * drot.transpose());
        const Components turned_strain = stran;
        if (mistake == "stran_at_end") stran += dstran;
        if (mistake == "stran_zero") stran.setZero();
        if (mistake == "tensor_shear") dstran.tail(3) *= 0.5;
        if (mistake == "dstran") dstran[0] += 0.5 * dstran.cwiseAbs().maxCoeff();
        if (mistake == "transposed") {
            F0.transposeInPlace();
            F1.transposeInPlace();
        }
        if (mistake == "dfgrd0") F0.setIdentity();
        if (mistake == "drot") drot = motion.rotation + motion.spin;
        if (mistake == "not_finite" && k == 3) dstran[2] = std::numeric_limits<double>::quiet_NaN();
        if (mistake == "state" && k == 4) statev[1] = 5;
        double ddsdde[36], rpl = 0, ddsddt[6], drplde[6], drpldt = 0, pnewdt = mistake == "pnewdt" ? 0.5 : 1;
        const double time[2] = {total, total};
        umat_(stress.data(), statev.data(), ddsdde, &sse, &spd, &scd, &rpl, ddsddt, drplde, &drpldt, stran.data(),
              dstran.data(), time, &dtime, &zero, &zero, &zero, &zero, name, &ndi, &nshr, &ntens, &nstatv, props,
              &nprops, coords, drot.data(), &pnewdt, &celent, F0.data(), F1.data(), &one, &one, &one, &one,
              jstep.data(), &k, LODE_CMNAME_LENGTH);
        stran = turned_strain + layout.strain_components(motion.strain);
        total += dtime_true;
    }
}

// Two equal points, no rotation of the axes.
void explicit_host(std::string_view mistake) {
    const int nblock = 2, ndir = 3, nshr = 3, nstatev = 4, nfieldv = 0, nprops = 2, lanneal = 0;
    std::array<double, 12> stress{}, stress_new{};
    std::array<double, 8> state{}, state_new{};
    std::array<double, 2> intern{}, intern_new{}, inelas{}, inelas_new{}, zero{};
    std::array<double, 2> length{1, 1}, density{1, 1};
    if (mistake == "vumat_density") density[1] = 0;
    if (mistake == "celent") length[0] = -1;
    const std::array<double, 6> coordinates{}, spin{};
    constexpr std::array<std::pair<int, int>, 9> places{
        {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}, {1, 0}, {2, 1}, {0, 2}}};
    for (int k = 1; k <= increments; ++k) {
        const double dt = (mistake == "dtime" ? -1.0 : 1.0) / increments, time = static_cast<double>(k) / increments;
        const Matrix3 F[2] = {gradient_at((k - 1.0) / increments), gradient_at(time)};
        std::array<double, 12> stretch[2];
        std::array<double, 18> gradient[2];
        Matrix3 U[2];
        for (const int end : {0, 1}) {
            U[end] = polar(F[end]).right_stretch;
            for (std::size_t c = 0; c < 9; ++c)
                for (std::size_t p = 0; p < 2; ++p) {
                    const auto [i, j] = places[c];
                    gradient[end][2 * c + p] = F[end](i, j);
                    if (c < 6) stretch[end][2 * c + p] = (mistake == "vumat_stretch" ? F[end] : U[end])(i, j);
                }
        }
        const Matrix3 rate = (U[1] - U[0]) * (0.5 * (U[0] + U[1])).inverse();
        std::array<double, 12> strain;
        for (std::size_t c = 0; c < 6; ++c)
            for (std::size_t p = 0; p < 2; ++p) {
                const auto [i, j] = places[c];
                strain[2 * c + p] = 0.5 * (rate(i, j) + rate(j, i));
                if (mistake == "vumat_engineering" && c >= 3) strain[2 * c + p] *= 2;
            }
        vumat_(&nblock, &ndir, &nshr, &nstatev, &nfieldv, &nprops, &lanneal, &time, &time, &dt, name,
               coordinates.data(), length.data(), props, density.data(), strain.data(), spin.data(), zero.data(),
               stretch[0].data(), gradient[0].data(), zero.data(), stress.data(), state.data(), intern.data(),
               inelas.data(), zero.data(), stretch[1].data(), gradient[1].data(), zero.data(), stress_new.data(),
               state_new.data(), intern_new.data(), inelas_new.data(), LODE_CMNAME_LENGTH);
        stress = stress_new;
        state = state_new;
        intern = intern_new;
        inelas = inelas_new;
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    if (std::strcmp(argv[1], "umat") == 0) implicit(argv[2]);
    else explicit_host(argv[2]);
}
