// What the tests of the two gases share.
#pragma once

#include <cmath>

#include "finite_strain.hpp"
#include "vumat_block.hpp"

namespace lode::test {

// Stress and STATEV (TREL, JM1, W, Q, S) of a gas that goes to F in one increment.
inline Answer gas_at(const std::string& name, const Numbers& props, const Matrix3d& f, double temperature,
                     double dtemp = 0.0) {
    UmatPoint point(name, AnalysisKind::solid, props);
    return point.temperature(temperature).advance({.dtemp = dtemp, .dfgrd1 = f});
}

// A path through the explicit entry point: volume ratio and temperature of the host as functions of t in [0, 1], in
// equal increments. The kinds of work are per initial volume.
struct GasPath {
    double stress_work = 0.0;  // of the stress that acts, by the trapezoid rule
    VumatPoint end;
};
template <class Volume, class Temperature>
GasPath follow(const std::string& name, const Numbers& props, int steps, const Volume& volume,
               const Temperature& temperature) {
    VumatBlock block(name, AnalysisKind::solid, props);
    block.points.push_back(block.fresh_point());
    block.dtime = 1.0 / steps;
    GasPath path;
    double old_volume = volume(0.0), old_stress = 0.0;
    for (int i = 0; i <= steps; ++i) {  // the first one leaves the volume
        const double t = static_cast<double>(i) / steps, now = volume(t);
        VumatPoint& p = block.points.front();
        p.stretch = diagonal_gradient(now, 1.0, 1.0);
        p.strain_increment = {std::log(now / old_volume), 0, 0, 0, 0, 0};
        p.temperature_old = temperature(std::max(0.0, static_cast<double>(i - 1) / steps));
        p.temperature_new = temperature(t);
        p.density = 2.0 / now;
        block.step_time = block.total_time = t + 1.0;
        EXPECT_EQ(block.run().stops, 0);
        if (i > 0) path.stress_work += 0.5 * (old_stress + p.stress[0]) * (now - old_volume);
        old_volume = now;
        old_stress = p.stress[0];
    }
    path.end = block.points.front();
    return path;
}

// Compression to less than half and expansion beyond the start, as between shock and rarefaction.
inline double shock_and_rarefaction(double t) {
    return t < 0.5 ? 1.0 - 0.6 * std::pow(std::sin(M_PI * t), 2) : 0.4 + 0.9 * std::pow(std::sin(M_PI * (t - 0.5)), 2);
}
inline double closed_cycle(double t) { return 1.0 - 0.5 * std::pow(std::sin(M_PI * t), 2); }

// (J+ sigma+ - J- sigma-)/(2 h J) for F <- (I +- h e e^T) F against DDSDDE, and DDSDDT, DRPLDE, DRPLDT.
inline void expect_gas_tangent(UmatPoint point, const Matrix3d& f) {
    const double h = 1e-6;
    const Load load{.dtime = 0.5, .dtemp = 2.0, .dfgrd1 = f};
    const Answer a = point.evaluate(load);
    ASSERT_TRUE(a.done()) << a.first_error();
    const double J = f.determinant(), scale = std::max(largest(a.stress), a.tangent.cwiseAbs().maxCoeff());
    for (int k = 0; k < point.size(); ++k) {
        Numbers unit(static_cast<std::size_t>(point.size()), 0.0);
        unit[static_cast<std::size_t>(k)] = 1.0;
        const Matrix3d d = strain_tensor(unit, point.kind());
        Load ahead = load, back = load;
        ahead.dfgrd1 = (Matrix3d::Identity() + h * d) * f;
        back.dfgrd1 = (Matrix3d::Identity() - h * d) * f;
        const Answer up = point.evaluate(ahead), down = point.evaluate(back);
        for (int i = 0; i < point.size(); ++i) {
            const auto at = static_cast<std::size_t>(i);
            const double slope =
                (ahead.dfgrd1->determinant() * up.stress[at] - back.dfgrd1->determinant() * down.stress[at]) /
                (2 * h * J);
            EXPECT_NEAR(a.tangent(i, k), slope, 1e-8 * scale);
        }
        EXPECT_NEAR(a.drplde[static_cast<std::size_t>(k)], (up.rpl - down.rpl) / (2 * h), 1e-7 * scale);
    }
    Load hot = load, cold = load;
    const double dT = 1e-3;
    hot.dtemp += dT;
    cold.dtemp -= dT;
    const Answer up = point.evaluate(hot), down = point.evaluate(cold);
    for (std::size_t i = 0; i < a.stress.size(); ++i)
        EXPECT_NEAR(a.ddsddt[i], (up.stress[i] - down.stress[i]) / (2 * dT), 1e-8 * scale);
    EXPECT_NEAR(a.drpldt, (up.rpl - down.rpl) / (2 * dT), 1e-8 * scale);
}

}  // namespace lode::test
