// What the tests of the two liquids share.
#pragma once

#include <cmath>

#include "finite_strain.hpp"
#include "vumat_block.hpp"

namespace lode::test {

inline constexpr double liquid_K0 = 2200.0;

// One increment to F with the given strain increment.
inline Answer liquid_at(const std::string& name, const Numbers& props, const Load& load,
                        AnalysisKind kind = AnalysisKind::solid) {
    return UmatPoint(name, kind, props).advance(load);
}

// (J+ sigma+ - J- sigma-)/(2 h J) with DSTRAN perturbed together with F, for stress; DRPLDE and DDSDDT as well.
inline void expect_liquid_tangent(const UmatPoint& point, const Load& load) {
    const double h = 1e-6;
    const Answer a = point.evaluate(load);
    ASSERT_TRUE(a.done()) << a.first_error();
    const Matrix3d f = *load.dfgrd1;
    const double scale = a.tangent.cwiseAbs().maxCoeff();
    for (int k = 0; k < point.size(); ++k) {
        const auto column = static_cast<std::size_t>(k);
        Numbers unit(static_cast<std::size_t>(point.size()), 0.0);
        unit[column] = 1.0;
        const Matrix3d d = strain_tensor(unit, point.kind());
        Load ahead = load, back = load;
        ahead.dfgrd1 = (Matrix3d::Identity() + h * d) * f;
        ahead.dstran[column] += h;
        back.dfgrd1 = (Matrix3d::Identity() - h * d) * f;
        back.dstran[column] -= h;
        const Answer up = point.evaluate(ahead), down = point.evaluate(back);
        for (int i = 0; i < point.size(); ++i) {
            const auto row = static_cast<std::size_t>(i);
            const double slope =
                (ahead.dfgrd1->determinant() * up.stress[row] - back.dfgrd1->determinant() * down.stress[row]) /
                (2 * h * f.determinant());
            EXPECT_NEAR(a.tangent(i, k), slope, 2e-8 * scale) << i << k;
        }
        EXPECT_NEAR(a.drplde[column], (up.rpl - down.rpl) / (2 * h), 2e-8 * (std::abs(a.drplde[column]) + scale));
    }
    Load hot = load, cold = load;
    hot.dtemp += 0.01;
    cold.dtemp -= 0.01;
    const Answer up = point.evaluate(hot), down = point.evaluate(cold);
    for (std::size_t i = 0; i < a.stress.size(); ++i)
        EXPECT_NEAR(a.ddsddt[i], (up.stress[i] - down.stress[i]) / 0.02, 1e-8 * scale);
}

// Tests that do not depend on the pressure law; `form` is the constant that tells the laws apart.
inline void expect_liquid_viscosity(const std::string& name, double form) {
    const Matrix3d one = Matrix3d::Identity();
    const Numbers constant = {liquid_K0, 0.5};
    const Answer sheared = liquid_at(name, constant, {.dstran = {0, 0, 0, 0.1, 0, 0}, .dtime = 0.01, .dfgrd1 = one});
    expect_close({0, 0, 0, 5, 0, 0}, sheared.stress, 1e-14);
    EXPECT_NEAR(sheared.state[1], 10.0, 1e-13);
    // viscous work 2 eta D:D dt = eta gdot^2 dt
    EXPECT_NEAR(sheared.scd, 0.5, 1e-14);
    EXPECT_NEAR(sheared.rpl, 50.0, 1e-12);
    // no time, no rate
    EXPECT_EQ(largest(liquid_at(name, constant, {.dstran = {0, 0, 0, 0.1, 0, 0}, .dtime = 0, .dfgrd1 = one}).stress),
              0.0);

    const Numbers table = {liquid_K0, 7.0, form, 0, 0, 0, 3, 0, 2, 1, 1.2, 3, 0.1};
    const auto shear = [&](double dstran) {
        return liquid_at(name, table, {.dstran = {0, 0, 0, dstran, 0, 0}, .dtime = 0.01, .dfgrd1 = one});
    };
    EXPECT_NEAR(shear(0.05).stress[3], 7.2041199826559, 1e-13 * 7);
    EXPECT_NEAR(shear(0.05).state[1], 5.0, 1e-13);
    EXPECT_NEAR(shear(0.5).stress[3], 40.778324880759, 1e-13 * 40);
    EXPECT_NEAR(shear(1e-4).stress[3], 2 * 0.01, 1e-15);    // below the table
    EXPECT_NEAR(shear(100.0).stress[3], 0.1 * 1e4, 1e-10);  // above
    EXPECT_NEAR(shear(0.1).stress[3], 1.2 * 10, 1e-13);     // at a pair
    EXPECT_EQ(largest(shear(0.0).stress), 0.0);
    EXPECT_NEAR(shear(0.0).tangent(3, 3), 2 / 0.01, 1e-12);  // eta_1
}

inline void expect_liquid_tangents(const std::string& name, double form) {
    Matrix3d f = diagonal_gradient(0.93, 1.02, 0.99);
    f(0, 1) = 0.1;
    const Numbers table = {-1, 2, 0, 1.2, 2, 0.3};
    for (const AnalysisKind kind : {AnalysisKind::solid, AnalysisKind::plane_strain})
        for (const double pairs : {0.0, 3.0})
            for (const double dtime : {1e-3, 0.02, 10.0}) {
                Numbers props = {liquid_K0, 0.5, form, 7e-5, 1e-3, 5.0, pairs};
                props.insert(props.end(), table.begin(), table.end());
                const UmatPoint point(name, kind, props);
                Numbers dstran = {-0.07, 0.02, -0.01, 0.1};
                if (kind == AnalysisKind::solid) dstran = {-0.07, 0.02, -0.01, 0.1, 0.03, -0.02};
                expect_liquid_tangent(point,
                                      {.dstran = dstran, .dtime = dtime, .dtemp = 20.0, .dpred = {0.5}, .dfgrd1 = f});
            }
    const Numbers inviscid = {liquid_K0, 0.0, form};
    expect_liquid_tangent(UmatPoint(name, AnalysisKind::solid, inviscid),
                          {.dstran = {-0.07, 0, 0, 0, 0, 0}, .dfgrd1 = f});
}

struct Liquid {
    std::string name;
    Numbers props;
};

// Work of the stress against stored and dissipated energy, along a path of the volume through the explicit entry point.
template <class Volume>
void expect_liquid_balance(const Liquid& liquid, int first_steps, const Volume& volume) {
    const bool viscous = liquid.props[1] > 0.0;
    double errors[3];
    for (int k = 0; k < 3; ++k) {
        const int steps = first_steps << (2 * k);
        VumatBlock block(liquid.name, AnalysisKind::solid, liquid.props);
        block.points.push_back(block.fresh_point());
        block.dtime = 1.0 / steps;
        double work = 0.0, old_stress = 0.0;
        for (int i = 1; i <= steps; ++i) {
            VumatPoint& p = block.points.front();
            const double before = volume(static_cast<double>(i - 1) / steps),
                         now = volume(static_cast<double>(i) / steps);
            p.stretch = diagonal_gradient(now, 1, 1);
            p.strain_increment = {std::log(now / before), 0, 0, 0, 0, 0};
            p.density = 2.0 / now;
            ASSERT_EQ(block.run().stops, 0);
            work += 0.5 * (old_stress + p.stress[0]) * (now - before);
            old_stress = p.stress[0];
        }
        const VumatPoint& end = block.points.front();
        if (viscous) EXPECT_GT(end.inelastic_energy, 0.1);
        else EXPECT_EQ(end.inelastic_energy, 0.0);
        errors[k] = std::abs(work - 2.0 * end.internal_energy);
    }
    const double order = viscous ? 1.0 : 2.0;  // steps by 4
    EXPECT_GE(std::log2(errors[0] / errors[1]), 2 * order - 0.2);
    EXPECT_GE(std::log2(errors[1] / errors[2]), 2 * order - 0.2);
}

// d(U)/dJ = -p: the energy by central differences, and the balance of a viscous cycle through the explicit entry point.
inline void expect_liquid_energies(const std::string& name, double form) {
    const Numbers props = {liquid_K0, 0.0, form, 7e-5, 0, 5.0};
    for (const double J : {0.6, 0.95, 1.0, 1.05}) {
        const auto energy = [&](double volume) {
            return volume * liquid_at(name, props, {.dtemp = 20.0, .dfgrd1 = diagonal_gradient(volume, 1, 1)}).sse;
        };
        const Answer a = liquid_at(name, props, {.dtemp = 20.0, .dfgrd1 = diagonal_gradient(J, 1, 1)});
        const double h = 1e-5;
        EXPECT_NEAR((energy(J + h) - energy(J - h)) / (2 * h), a.stress[0],
                    1e-8 * std::max(liquid_K0, a.tangent(0, 0)));
    }
    // second order in tiny strains, without cancellation
    const Answer tiny = liquid_at(name, {liquid_K0, 0, form}, {.dfgrd1 = diagonal_gradient(1 + 1e-7, 1, 1)});
    const double e = (1 + 1e-7) - 1;
    EXPECT_NEAR(tiny.sse, 0.5 * liquid_K0 * e * e, 2e-6 * 0.5 * liquid_K0 * e * e);

    // work = stored + dissipated, with and without viscosity. The trapezoid rule is of second order, the mean rate of
    // first
    const auto cycle = [](double t) { return 1.0 - 0.1 * std::pow(std::sin(M_PI * t), 2) - 0.05 * t; };
    const auto tube = [](double t) { return shock_tube(t, 0.8, 1.01); };
    for (const double viscosity : {0.0, 20.0}) {
        const Liquid liquid = {name, {liquid_K0, viscosity, form}};
        expect_liquid_balance(liquid, 50, cycle);
        expect_liquid_balance(liquid, viscosity > 0.0 ? 2000 : 200, tube);  // the front takes a tenth of them
    }
}

inline void expect_liquid_failures(const std::string& name, double form) {
    const UmatPoint point(name, AnalysisKind::solid, {liquid_K0, 1e-3, form});
    for (const double J : {0.0, -1.0, std::nan("")}) {
        const Answer a = point.evaluate({.dfgrd1 = diagonal_gradient(J, 1, 1)});
        EXPECT_TRUE(a.cut);
        EXPECT_EQ(a.pnewdt, 0.25);
    }
    EXPECT_TRUE(point.evaluate({.dfgrd1 = diagonal_gradient(1e-3, 1, 1)}).done());
    VumatBlock block(name, AnalysisKind::solid, {liquid_K0, 1e-3, form});
    block.points.assign(3, block.fresh_point());
    block.points[1].stretch = diagonal_gradient(-0.1, 1, 1);
    EXPECT_EQ(block.run().stops, 1);

    expect_refused(name, {0.0, 1.0}, {name, "PROPS(1)", "K0"});
    expect_refused(name, {liquid_K0, -1.0}, {"PROPS(2)", "ETA"});
    expect_refused(name, {liquid_K0, 0, 0}, {"PROPS(3)"});
    expect_refused(name, {liquid_K0, 0, form, 0, 0, 0, 51}, {"PROPS(7)", "NV"});
    expect_refused(name, {liquid_K0, 0, form, 0, 0, 0, 2, 0, 1, 1}, {"NV = 2", "NPROPS >= 11", "NPROPS = 10"});
    expect_refused(name, {liquid_K0, 0, form, 0, 0, 0, 2, 0, 1, 0, 1}, {"PROPS(10)", "increase"});
    expect_refused(name, {liquid_K0, 0, form, 0, 0, 0, 2, 0, 1, 1, -1}, {"PROPS(11)"});
    expect_refused(name, {liquid_K0, 0, form, 0, 0, 0, 2, 0, 1, 1, 0.0999}, {"PROPS(11)", "viscous stress"});
    EXPECT_EQ(refusal(name, {liquid_K0, 0, form, 0, 0, 0, 2, 0, 1, 1, 0.1001}), "");
    for (const AnalysisKind kind : {AnalysisKind::plane_stress, AnalysisKind::uniaxial, AnalysisKind::cohesive_2d})
        expect_refused(name, {liquid_K0, 0}, {name, "not served"}, kind);

    // stress that falls with the rate on the way from one pair to the next
    const UmatPoint thinning(name.substr(0, name.find('-')) + "-THINNING", AnalysisKind::solid,
                             {liquid_K0, 0, form, 0, 0, 0, 2, 1, 1.2, 3, 0.1});
    const Answer first = thinning.evaluate({});
    ASSERT_EQ(first.messages.warnings.size(), 1u);
    EXPECT_NE(first.messages.warnings[0].find("viscous stress decreases"), std::string::npos);
}

}  // namespace lode::test
