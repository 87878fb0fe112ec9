// DRUCKER_PRAGER against page 20, section 4, and page 25, case T7: verification cases and failure modes.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "umat_point.hpp"
#include "vumat_block.hpp"

namespace lode::test::test_drucker_prager {
namespace {

constexpr auto solid = AnalysisKind::solid;
constexpr auto plane_strain = AnalysisKind::plane_strain;
constexpr auto plane_stress = AnalysisKind::plane_stress;
constexpr AnalysisKind kinds[] = {solid, plane_strain, plane_stress};

enum Slot { EQPS = 1, COHC, REGION, EPV, ASTOR = 7, PHI, HEATQ, ENTR, EP };

// E, NU, FIT = 0, eta, eta_bar, c0, xi: G = 400, K = 2000/3.
const Numbers direct = {1000.0, 0.25, 0, 0.4, 0.2, 2.0, 1.1};
const Numbers hardening = {1000.0, 0.25, 0, 0.4, 0.2, 2.0, 1.1, 1, 50.0};
Numbers softening(double slope = -40.0) {
    Numbers props = {1000.0, 0.25, 2, 20.0, 5.0, 2.0, 0.0, 1, slope, 0.5};
    props.resize(22, 0.0);
    props[21] = 10.0;
    return props;
}

// The page prints 12 significant digits.
void expect_printed(double value, double printed) { EXPECT_NEAR(value, printed, 1e-11 * std::fabs(printed) + 1e-12); }
void expect_printed(const Numbers& values, const Numbers& printed) {
    ASSERT_EQ(values.size(), printed.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        SCOPED_TRACE("component " + std::to_string(i));
        expect_printed(values[i], printed[i]);
    }
}
Numbers row(const Answer& answer, int i) {
    Numbers r;
    for (int j = 0; j < answer.tangent.cols(); ++j) r.push_back(answer.tangent(i, j));
    return r;
}
UmatPoint make_point(AnalysisKind kind, const Numbers& props) {
    UmatPoint point("DRUCKER_PRAGER-TEST", kind, props);
    point.nstatv(16);
    return point;
}

// The invariants of a stress in any kind: q = sqrt(J2) and p.
struct Invariants {
    double q, p;
};
Invariants invariants(const Numbers& stress, AnalysisKind kind) {
    const Matrix3d s = stress_tensor(stress, kind);
    const double p = -s.trace() / 3.0;
    return {(s + p * Matrix3d::Identity()).norm() / std::sqrt(2.0), p};
}

TEST(DruckerPrager, D1ShearOnTheCone) {
    UmatPoint point = make_point(solid, direct);
    const Answer answer = point.advance({.dstran = {0, 0, 0, 0.02, 0, 0}});
    expect_printed(point.stress(), {-1.70588235294, -1.70588235294, -1.70588235294, 2.88235294118, 0, 0});
    expect_printed(point.state(EQPS), 0.0140735294118);
    expect_printed(point.state(EPV), 0.00255882352941);
    expect_printed(point.spd(), 0.0325121107266);
    EXPECT_EQ(point.state(REGION), 1.0);
    EXPECT_EQ(point.state(COHC), 2.0);
    expect_printed(answer.tangent(0, 3), -117.647058824);
    expect_printed(answer.tangent(3, 0), -235.294117647);
    expect_printed(answer.tangent(3, 3), 47.0588235294);
    expect_printed(answer.tangent(4, 4), 144.117647059);
}

TEST(DruckerPrager, D2OuterConeAfterPressure) {
    UmatPoint point = make_point(solid, {1000.0, 0.25, 1, 30.0, 10.0, 2.0, 0.0, 1, 50.0});
    point.advance({.dstran = {-0.01, -0.01, -0.01, 0, 0, 0}});
    expect_printed(point.stress(), {-20, -20, -20, 0, 0, 0});
    const Answer answer = point.advance({.dstran = {-0.04, 0.03, 0.02, 0.04, -0.02, 0.01}});
    expect_printed(point.stress(),
                   {-37.5907079010, -7.95672387642, -12.1901501656, 8.46685257845, -4.23342628922, 2.11671314461});
    expect_printed(point.state(EQPS), 0.0500047239036);
    expect_printed(point.spd(), 0.609978184716);
    expect_printed(row(answer, 0),
                   {1160.22255301, 722.311922623, 724.393065689, -4.16228613177, 2.08114306589, -1.04057153294});
    expect_printed(row(answer, 3),
                   {-105.595907907, -171.526430283, -162.107784230, 192.834022354, 9.41864605374, -4.70932302687});
}

TEST(DruckerPrager, D3ApexWithHardening) {
    UmatPoint point = make_point(solid, hardening);
    point.advance({.dstran = {0.01, 0.01, 0.01, 0.002, 0, 0}});
    expect_printed(point.stress(), {13.2064421669, 13.2064421669, 13.2064421669, 0, 0, 0});
    expect_printed(point.state(EQPS), 0.0560468521230);
    expect_printed(point.state(EPV), 0.0101903367496);
    expect_printed(point.spd(), 0.134578092945);
    EXPECT_EQ(point.state(PHI), 0.0);  // sigma:dep - (c - c0) dalpha < 0 is clamped
    EXPECT_EQ(point.state(REGION), 2.0);
}

TEST(DruckerPrager, D4PerfectApexInPlaneStrain) {
    UmatPoint point = make_point(plane_strain, direct);
    const Answer answer = point.advance({.dstran = {0.01, 0.01, 0, 0}});
    expect_printed(point.stress(), {5.5, 5.5, 5.5, 0});
    expect_printed(point.state(EPV), 0.01175);
    expect_printed(point.state(EQPS), 0.064625);
    expect_printed({point.state(EP), point.state(EP + 1), point.state(EP + 2), point.state(EP + 3)},
                   {0.00725, 0.00725, -0.00275, 0});
    EXPECT_TRUE((answer.tangent.array() == 0.0).all());
}

TEST(DruckerPrager, D5PlaneStress) {
    UmatPoint point = make_point(plane_stress, hardening);
    point.advance({.dstran = {0.01, -0.002, 0.004}});
    expect_printed(point.stress(), {3.93031226378, 0.508523297401, 0.570298161064});
    expect_printed(point.state(EQPS), 0.0109847254251);
    const Answer answer = point.advance({.dstran = {-0.03, -0.01, 0.004}});
    expect_printed(point.stress(), {-17.0636945914, -12.2082659336, 0.837776362554});
    expect_printed(point.state(EQPS), 0.0496147699983);
    expect_printed(row(answer, 0), {352.280970087, 172.920758725, 22.3367180281});
    expect_printed(row(answer, 1), {126.427356877, 505.367236165, 12.0996088173});
    expect_printed(row(answer, 2), {14.3145482409, 4.07743903016, 152.641252297});
}

TEST(DruckerPrager, D6PlaneStrainPowerLaw) {
    UmatPoint point = make_point(plane_strain, {1000.0, 0.25, 3, 30.0, 0.0, 2.0, 0.0, 6, 3.0, 0.5});
    point.advance({.dstran = {-0.02, 0.004, 0, 0.006}});
    expect_printed(point.stress(), {-18.6705295544, -5.57329937450, -7.75617107114, 1.63715377248});
    expect_printed(point.state(EQPS), 0.00698386044447);
    point.advance({.dstran = {0.01, 0.01, 0, 0}});
    expect_printed(point.stress(), {1.85183336778, 3.85139621535, 2.29677041687, 0.249945355947});
    expect_printed(point.state(EQPS), 0.0194428983150);
}

TEST(DruckerPrager, D7Softening) {
    UmatPoint point = make_point(solid, softening());
    point.celent(5.0);
    point.advance({.dstran = {-0.01, 0.004, 0.004, 0, 0, 0}});
    expect_printed(point.stress(), {-4.82905397944, -0.564466414592, -0.564466414592, 0, 0, 0});
    expect_printed(point.state(EQPS), 0.00975032406737);
    point.advance({.dstran = {-0.05, 0.024, 0.024, 0, 0, 0}});
    expect_printed(point.stress(), {-12.8365606138, -6.64534445467, -6.64534445467, 0, 0, 0});
    expect_printed(point.state(EQPS), 0.0902695342596);
    EXPECT_EQ(point.state(COHC), 0.5);
}

TEST(DruckerPrager, D8VonMisesLimit) {
    UmatPoint point = make_point(solid, {200000.0, 0.3, 0, 0.0, 0.0, 200.0, 1.1547005383792517, 1, 1500.0});
    point.advance({.dstran = {0.004, -0.002, 0.001, 0.003, -0.001, 0.002}});
    expect_printed(point.stress(), {702.689258697, 297.310741303, 500, 101.344629348, -33.7815431161, 67.5630862322});
    expect_printed(point.state(EQPS), 2 * 0.00228961946521);
    EXPECT_EQ(point.state(EPV), 0.0);
}

// Page 25.
TEST(DruckerPrager, T7HostHeatsWithThermoelasticity) {
    UmatPoint point =
        make_point(solid, {1000.0, 0.25, 0, 0.4, 0.2, 2.0, 1.1, 1, 50.0, 0, 0, 0, 0, 1e-5, 0, 0, 2.0, 0, 1});
    point.temperature(300.0);
    const Answer answer = point.advance({.dstran = {-0.01, 0.002, 0.001, 0.012, 0, 0}, .dtime = 0.5, .dtemp = 3.0});
    expect_printed(point.stress(), {-9.60845438190, -3.21820559311, -3.75072632551, 3.19512439440, 0, 0});
    expect_printed(point.spd(), 0.0219826165072);
    expect_printed(point.state(PHI), 0.0198093577887);
    expect_printed(point.state(ASTOR), 0.0219826165072 - 0.0198093577887);
    expect_printed(answer.rpl, 0.124458715577);
    EXPECT_NEAR(answer.drpldt, 2.2005329051e-4, 1e-14);  // printed with 11 digits
    expect_printed(answer.drplde, {-14.7363091670, -7.51356214964, -8.11545773441, 3.61137350867, 0, 0});
    expect_printed(answer.ddsddt, {-0.0232511452199, -0.0149131612451, -0.0156079932430, 0.00416899198739, 0, 0});
}

// eta, eta_bar and xi of the three fits, from the yield stresses they give.
TEST(DruckerPrager, FitsOfTheFrictionAngle) {
    const double eta[] = {0.692820323028, 0.494871659305, 0.480384461415};
    const double xi[] = {1.2, 0.857142857143, 0.832050294338};
    const double eta_bar[] = {0.212830875466, 0.189540522152, 0.172782012866};
    for (int fit = 1; fit <= 3; ++fit) {
        SCOPED_TRACE("FIT " + std::to_string(fit));
        const auto k = static_cast<std::size_t>(fit - 1);
        const Numbers props = {1000.0, 0.25, static_cast<double>(fit), 30.0, 10.0, 2.0};
        UmatPoint shear = make_point(solid, props);
        shear.advance({.dstran = {0, 0, 0, 0.02, 0, 0}});
        const double lambda = (8.0 - xi[k] * 2.0) / (400.0 + eta[k] * eta_bar[k] * 2000.0 / 3.0);
        EXPECT_NEAR(shear.state(EQPS), xi[k] * lambda, 1e-11 * lambda);
        EXPECT_NEAR(shear.state(EPV), eta_bar[k] * lambda, 1e-11 * lambda);
        UmatPoint tension = make_point(solid, props);
        tension.advance({.dstran = {0.1, 0.1, 0.1, 0, 0, 0}});
        EXPECT_NEAR(tension.stress()[0], xi[k] * 2.0 / eta[k], 1e-11 * tension.stress()[0]);
    }
}

// Uniaxial tension yields at 3 xi c/(sqrt3 + eta), compression at 3 xi c/(sqrt3 - eta).
TEST(DruckerPrager, UniaxialStrengths) {
    for (const double sign : {1.0, -1.0}) {
        const double strength = 3 * 1.1 * 2.0 / (std::sqrt(3.0) + sign * 0.4);
        UmatPoint point = make_point(plane_stress, direct);
        const auto strain = [&](double stress) { return Numbers{stress / 1000.0, -0.25 * stress / 1000.0, 0}; };
        EXPECT_EQ(point.evaluate({.dstran = strain(sign * strength * (1 - 1e-9))}).state[REGION - 1], 0.0);
        EXPECT_EQ(point.evaluate({.dstran = strain(sign * strength * (1 + 1e-9))}).state[REGION - 1], 1.0);
    }
}

// The exact solution on the cone of section 6 for a constant strain rate and perfect plasticity. e = |dev de|,
// psi = angle(s, dev de), u = ln tan(psi/2): qJ(u) = qJ0 (cosh u/cosh u0)^kappa exp(w (u - u0)).
struct ExactCone {
    double q, psi;
};
ExactCone exact_on_cone(double q0, double psi0, double e, double ev, double G, double K, double eta, double eta_bar) {
    const double Dt = G + eta * eta_bar * K, kappa = 1 - G / Dt, w = eta * K * ev / (std::sqrt(2.0) * Dt * e);
    const double u0 = std::log(std::tan(psi0 / 2));
    const auto q_at = [&](double u) {
        return q0 * std::pow(std::cosh(u) / std::cosh(u0), kappa) * std::exp(w * (u - u0));
    };
    // The integral of qJ from u1 to u0 is sqrt2 G e: Runge-Kutta in the integral, du/da = -1/qJ(u).
    const int steps = 4000;
    const double h = std::sqrt(2.0) * G * e / steps;
    double u = u0;
    for (int i = 0; i < steps; ++i) {
        const double k1 = -1 / q_at(u), k2 = -1 / q_at(u + h / 2 * k1), k3 = -1 / q_at(u + h / 2 * k2),
                     k4 = -1 / q_at(u + h * k3);
        u += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    return {q_at(u), 2 * std::atan(std::exp(u))};
}

// Error of one step from the cone with sqrt2 G dev(de) = qJ0 (x n + y t), in percent of |sigma| (section 6), and of
// METHOD 2.
TEST(DruckerPrager, ErrorMap) {
    const double G = 400, K = 2000.0 / 3, xi = 1.1, c0 = 2, p0 = 3;
    const double x_grid[] = {0, 1, 2, 4, 6}, y_grid[] = {0.5, 1, 2, 3, 6};
    const double percent[2][5][5] = {{{0.865, 2.689, 1.823, 0.808, 0.421},
                                      {3.831, 4.935, 3.426, 1.570, 0.830},
                                      {8.067, 7.401, 5.526, 2.823, 1.564},
                                      {8.648, 7.822, 6.279, 3.625, 2.142},
                                      {6.284, 5.986, 5.433, 4.081, 2.914}},
                                     {{1.053, 3.776, 2.704, 1.191, 0.595},
                                      {4.918, 6.994, 5.076, 2.308, 1.169},
                                      {11.231, 10.659, 8.126, 4.097, 2.184},
                                      {12.333, 11.242, 9.080, 5.161, 2.949},
                                      {8.435, 8.011, 7.255, 5.404, 3.803}}};
    const int substeps[] = {1, 2, 4, 8, 16, 32};
    const double largest_of_substeps[] = {12.333, 7.49, 4.29, 2.32, 1.21, 0.62};
    double largest_error[6] = {};
    for (int flow = 0; flow < 2; ++flow) {
        const double eta = 0.4, eta_bar = flow == 0 ? 0.4 : 0.1;
        for (int iy = 0; iy < 5; ++iy)
            for (int ix = 0; ix < 5; ++ix) {
                const double x = x_grid[ix], y = y_grid[iy], q0 = eta * p0 + xi * c0;
                // n = diag(2, -1, -1)/sqrt 6, t = the 12 shear, both of unit norm.
                const double n1 = 2 / std::sqrt(6.0), t12 = 1 / std::sqrt(2.0), size = std::sqrt(2.0) * q0;
                const double along = q0 * x / (std::sqrt(2.0) * G), across = q0 * y / (std::sqrt(2.0) * G);
                const ExactCone exact =
                    exact_on_cone(q0, std::atan2(y, x), std::hypot(along, across), 0, G, K, eta, eta_bar);
                const double turned = std::atan2(y, x) - exact.psi, p = (exact.q - xi * c0) / eta;
                const double s1 = std::sqrt(2.0) * exact.q * std::cos(turned) * n1;
                const Numbers reference = {
                    s1 - p, -s1 / 2 - p, -s1 / 2 - p, std::sqrt(2.0) * exact.q * std::sin(turned) * t12, 0, 0};
                for (int k = 0; k < 6; ++k) {
                    if (k > 0 && flow == 0) continue;
                    Numbers props = {1000.0, 0.25, 0, eta, eta_bar, c0, xi};
                    props.resize(21, 0.0);
                    props[19] = k > 0 ? 2 : 0;
                    props[20] = substeps[k];
                    UmatPoint point = make_point(solid, props);
                    point.stress({size * n1 - p0, -size * n1 / 2 - p0, -size * n1 / 2 - p0, 0, 0, 0});
                    point.advance({.dstran = {along * n1, -along * n1 / 2, -along * n1 / 2, 2 * across * t12, 0, 0}});
                    Numbers difference = point.stress();
                    for (std::size_t i = 0; i < 6; ++i) difference[i] -= reference[i];
                    const double error =
                        100 * stress_tensor(difference, solid).norm() / stress_tensor(reference, solid).norm();
                    if (k == 0) {
                        EXPECT_NEAR(error, percent[flow][iy][ix], 0.0006) << eta_bar << " " << x << " " << y;
                    }
                    if (flow == 1) largest_error[k] = std::max(largest_error[k], error);
                }
            }
    }
    for (int k = 1; k < 6; ++k) EXPECT_NEAR(largest_error[k], largest_of_substeps[k], 0.006);
}

// What a random walk ends on satisfies the yield condition to 1e-10, whatever the law, kind and method.
TEST(DruckerPrager, StressesLieOnTheConeOrInside) {
    const Numbers laws[] = {{0}, {1, 50.0}, {2, 20.0, 0.4}, {6, 3.0, 0.5}, {8, 3.0, 30.0, 10.0}};
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    for (const auto kind : kinds)
        for (const Numbers& law : laws)
            for (const double eta : {0.0, 0.4, 0.9, 2.0})
                for (const double share : {0.0, 0.5, 1.0}) {
                    Numbers props = {1000.0, 0.25, 0, eta, share * eta, 2.0, 1.1};
                    props.insert(props.end(), law.begin(), law.end());
                    props.resize(21, 0.0);
                    props[19] = u(random) > 0.5 ? 2 : 0;
                    UmatPoint point = make_point(kind, props);
                    for (int i = 0; i < 200; ++i) {
                        Numbers strain(static_cast<std::size_t>(point.size()));
                        const double size = std::pow(10.0, -3.0 + 2.0 * u(random));
                        for (double& e : strain) e = size * u(random);
                        point.advance({.dstran = strain});
                        const auto [q, p] = invariants(point.stress(), kind);
                        const double cohesion = 1.1 * point.state(COHC);
                        const double largest_term = std::max({q, eta * std::fabs(p), cohesion});
                        const double phi = q - eta * p - cohesion;
                        ASSERT_LE(phi, 1e-10 * largest_term) << eta << " " << share << " law " << law[0];
                        if (point.state(REGION) > 0) {
                            ASSERT_GE(phi, -1e-10 * largest_term) << eta << " " << share << " law " << law[0];
                        }
                    }
                }
}

// Whatever part of its saturation a step takes, the cohesion at its end is that of the law: to the tolerance of the
// scalar return, 1e-13 of the trial force on its line (page 20, section 1).
TEST(DruckerPrager, CohesionSaturatesInAnyStep) {
    std::mt19937_64 random(8);
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    const double c0 = 2.0, range = 3.0, linear = 10.0, G = 400.0, K = 2000.0 / 3.0, eta = 0.4, xi = 1.1;
    int on_cone = 0, at_apex = 0;
    for (const double rate : {3.0, 100.0, 3000.0})
        for (const double eta_bar : {0.002, 0.05, 0.4})
            for (const double straight_from : {0.0, 0.01}) {
                UmatPoint point =
                    make_point(solid, {1000.0, 0.25, 0, eta, eta_bar, c0, xi, 8, range, rate, linear, straight_from});
                for (int i = 0; i < 300; ++i) {
                    const double before = point.state(EQPS), size = std::pow(10.0, -3.0 + 2.5 * u(random));
                    Numbers strain(6);
                    for (double& e : strain) e = size * u(random);
                    point.advance({.dstran = strain});
                    if (point.state(REGION) == 0.0) continue;
                    const double alpha = point.state(EQPS);
                    const double bent = straight_from > 0.0 ? std::min(alpha, straight_from) : alpha;
                    const double slope = range * rate * std::exp(-rate * bent) + linear;
                    const double cohesion =
                        c0 - range * std::expm1(-rate * bent) + linear * bent + slope * (alpha - bent);
                    const double trial = cohesion + (G + eta * eta_bar * K) / (xi * xi) * (alpha - before);
                    ASSERT_NEAR(point.state(COHC), cohesion, 1e-13 * trial) << rate << " " << eta_bar << " " << size;
                    ++(point.state(REGION) == 1.0 ? on_cone : at_apex);
                }
            }
    EXPECT_GT(on_cone, 1000);
    EXPECT_GT(at_apex, 50);
}

// Either side of the line at which the cone's return meets the apex: stress is continuous, and the tangent is that of
// the side, checked by one-sided differences.
TEST(DruckerPrager, TangentBesideTheApex) {
    const Numbers saturating = {1000.0, 0.25, 0, 0.4, 0.2, 2.0, 1.1, 8, 3.0, 3.0};
    for (const Numbers& props : {direct, hardening, saturating}) {
        // q_trial = G lambda: with de = v/3 1 + gamma12, bisect in gamma.
        const double v = 0.03;
        const auto strain = [v](double gamma) { return Numbers{v / 3, v / 3, v / 3, gamma, 0, 0}; };
        const UmatPoint point = make_point(solid, props);
        double low = 0.0, high = 1.0;
        for (int i = 0; i < 200; ++i) {
            const double middle = 0.5 * (low + high);
            (point.evaluate({.dstran = strain(middle)}).state[REGION - 1] == 2.0 ? low : high) = middle;
        }
        const Answer at_apex = point.evaluate({.dstran = strain(low)}),
                     on_cone = point.evaluate({.dstran = strain(high)});
        ASSERT_EQ(at_apex.state[REGION - 1], 2.0);
        ASSERT_EQ(on_cone.state[REGION - 1], 1.0);
        EXPECT_LE(distance(at_apex.stress, on_cone.stress), 1e-12 * largest(at_apex.stress));
        EXPECT_NEAR(at_apex.state[EQPS - 1], on_cone.state[EQPS - 1], 1e-13);
        const double h = 1e-6;
        for (const double side : {-1.0, 1.0}) {
            const Answer& here = side < 0 ? at_apex : on_cone;
            const double gamma = side < 0 ? low : high;
            const Numbers stress = point.evaluate({.dstran = strain(gamma + side * h)}).stress;
            for (int i = 0; i < 6; ++i) {
                const auto k = static_cast<std::size_t>(i);
                EXPECT_NEAR((stress[k] - here.stress[k]) / (side * h), here.tangent(i, 3), 1e-5) << side << " " << i;
            }
        }
    }
}

// eta_bar = 0: the cone's flow cannot lower the tension; nothing hardens at the apex.
TEST(DruckerPrager, WithoutDilatancyTheApexDoesNotHarden) {
    UmatPoint point = make_point(solid, {1000.0, 0.25, 0, 0.4, 0.0, 2.0, 1.1, 1, 50.0});
    const Answer answer = point.advance({.dstran = {0.01, 0.01, 0.01, 0.002, 0, 0}});
    EXPECT_NEAR(point.stress()[0], 1.1 * 2.0 / 0.4, 1e-13 * 5.5);
    EXPECT_EQ(point.state(EQPS), 0.0);
    EXPECT_NEAR(point.state(EPV), 0.03 - 5.5 / (2000.0 / 3), 1e-15);
    EXPECT_TRUE((answer.tangent.array() == 0.0).all());
}

// Plane stress is the solid with sigma33 = 0 where the page's closed form ends, at eta_bar >= sqrt3/2 and in biaxial
// compression where the yield surface is open.
TEST(DruckerPrager, PlaneStressWithStrongDilatancy) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    int yielding = 0;
    for (int i = 0; i < 400; ++i) {
        const double eta = 0.87 + 0.6 * (1 + u(random)), eta_bar = 0.87 + (eta - 0.87) * 0.5 * (1 + u(random));
        const Numbers props = {1000.0, 0.25 + 0.2 * u(random), 0, eta, eta_bar, 2.0, 1.0, 1, 25 * (1 + u(random))};
        const UmatPoint plane = make_point(plane_stress, props), full = make_point(solid, props);
        const double size = std::pow(10.0, -2 + u(random));
        const Numbers e = {size * u(random), size * u(random), size * u(random)};
        const Answer flat = plane.evaluate({.dstran = e});
        if (!flat.done()) ADD_FAILURE() << flat.first_error();
        yielding += flat.state[REGION - 1] > 0 ? 1 : 0;
        // The thickness strain that the return has found.
        const double elastic = -props[1] / props[0] * (flat.stress[0] + flat.stress[1]);
        const Answer spatial = full.evaluate({.dstran = {e[0], e[1], elastic + flat.state[EP + 2 - 1], e[2], 0, 0}});
        const double scale = 1000.0 * 3 * size;
        EXPECT_LE(std::fabs(spatial.stress[2]), 1e-11 * scale);
        EXPECT_LE(distance({spatial.stress[0], spatial.stress[1], spatial.stress[3]}, flat.stress), 1e-11 * scale)
            << eta << " " << eta_bar;
    }
    EXPECT_GT(yielding, 200);
}

// Substeps of METHOD 2 against as many increments of METHOD 0, states and energies.
TEST(DruckerPrager, SubstepsAreIncrements) {
    for (const auto kind : kinds) {
        Numbers props = hardening;
        UmatPoint increments = make_point(kind, props);
        props.resize(21, 0.0);
        props[19] = 2;
        props[20] = 5;
        UmatPoint substeps = make_point(kind, props);
        const Numbers full = {-0.02, 0.012, 0.006, 0.01, -0.004, 0.008};
        const Numbers strain(full.begin(), full.begin() + substeps.size());
        substeps.advance({.dstran = strain});
        Numbers fifth = strain;
        for (double& e : fifth) e /= 5;
        for (int i = 0; i < 5; ++i) increments.advance({.dstran = fifth, .dtime = 0.2});
        EXPECT_LE(distance(substeps.stress(), increments.stress()), 1e-13 * largest(increments.stress()));
        EXPECT_NEAR(substeps.spd(), increments.spd(), 1e-13 * increments.spd());
        for (const int slot : {+EQPS, +COHC, +EPV, +ASTOR, +PHI, +EP, EP + 1, EP + 2, EP + 3})
            EXPECT_NEAR(substeps.state(slot), increments.state(slot), 1e-13) << slot;
        EXPECT_GT(substeps.state(EQPS), 0.01);
    }
}

// DDSDDE, DDSDDT, DRPLDE and DRPLDT against central differences: perfect plasticity, both methods, all kinds and
// regions, with thermoelastic heat.
TEST(DruckerPrager, DerivativesAreThoseOfTheUpdate) {
    const Numbers laws[] = {{0, 0.0}, {1, 50.0}};
    const Numbers paths[] = {{-0.02, 0.012, 0.006, 0.01, -0.004, 0.008}, {0.03, 0.02, 0.025, 0.002, 0.001, 0.001}};
    for (const auto kind : kinds)
        for (const Numbers& law : laws)
            for (const double method : {0.0, 2.0})
                for (const Numbers& path : paths) {
                    Numbers props = direct;
                    props.insert(props.end(), law.begin(), law.end());
                    props.resize(21, 0.0);
                    props[13] = 1e-4, props[16] = 2.0, props[18] = 1, props[19] = method, props[20] = 3;
                    UmatPoint point = make_point(kind, props);
                    point.temperature(300.0);
                    const auto n = static_cast<std::size_t>(point.size());
                    const Load load{
                        .dstran = Numbers(path.begin(), path.begin() + point.size()), .dtime = 0.5, .dtemp = 2.0};
                    const Answer answer = point.evaluate(load);
                    ASSERT_GT(answer.state[REGION - 1], 0.0);
                    const double stiffness = 1200.0, heat = 300.0;  // sizes of DDSDDE and DRPLDE
                    const auto compare = [&](const Load& ahead, const Load& back, double h, const auto& stress,
                                             double rpl, double unit) {
                        const Answer a = point.evaluate(ahead), b = point.evaluate(back);
                        for (std::size_t i = 0; i < n; ++i)
                            EXPECT_NEAR(stress(i), (a.stress[i] - b.stress[i]) / (2 * h), 1e-6 * stiffness * unit);
                        EXPECT_NEAR(rpl, (a.rpl - b.rpl) / (2 * h), 1e-6 * heat * unit);
                    };
                    for (std::size_t k = 0; k < n; ++k) {
                        Load ahead = load, back = load;
                        ahead.dstran[k] += 1e-7, back.dstran[k] -= 1e-7;
                        const auto column = [&](std::size_t i) {
                            return answer.tangent(static_cast<int>(i), static_cast<int>(k));
                        };
                        compare(ahead, back, 1e-7, column, answer.drplde[k], 1.0);
                    }
                    Load hot = load, cold = load;
                    hot.dtemp += 1e-3, cold.dtemp -= 1e-3;
                    compare(
                        hot, cold, 1e-3, [&](std::size_t i) { return answer.ddsddt[i]; }, answer.drpldt, 1e-3);
                }
}

// METHOD 2 on a way from elastic states over the cone to the apex: DDSDDE and DRPLDE against central differences,
// whatever hardens or softens and whichever heat there is. Plane stress has no apex.
TEST(DruckerPrager, SubstepsToTheApexKnowTheirDerivatives) {
    const Numbers laws[] = {{0, 0.0}, {1, 50.0}, {2, 20.0, 0.4}, {6, 3.0, 0.5}, {8, 3.0, 30.0, 10.0}, {1, -40.0, 0.5}};
    const Numbers start = {-0.0041, -0.0037, -0.0043, 0.0, 0.0, 0.0},
                  path = {0.0123, 0.0091, 0.0067, 0.0083, -0.003, 0.002};
    for (const auto kind : kinds)
        for (const Numbers& law : laws)
            for (const double dilatancy : {0.0, 0.2})
                for (const double chi : {0.0, 0.9}) {
                    Numbers props = direct;
                    props[4] = dilatancy;
                    props.insert(props.end(), law.begin(), law.end());
                    props.resize(22, 0.0);
                    props[17] = chi, props[21] = 10.0;
                    const auto n = static_cast<std::size_t>(components(kind));
                    const Numbers strain(path.begin(), path.begin() + components(kind));
                    const auto loaded = [&](double method, double substeps) {
                        props[19] = method, props[20] = substeps;
                        UmatPoint point = make_point(kind, props);
                        point.celent(1.0);
                        point.advance({.dstran = Numbers(start.begin(), start.begin() + components(kind))});
                        return point;
                    };
                    UmatPoint increments = loaded(0, 0);
                    Numbers part = strain;
                    for (double& e : part) e /= 37;
                    bool seen[3] = {};
                    for (int i = 0; i < 37; ++i) {
                        increments.advance({.dstran = part});
                        seen[static_cast<int>(increments.state(REGION))] = true;
                    }
                    EXPECT_TRUE(seen[0] && seen[1] && seen[2] == (kind != plane_stress)) << kind_name(kind) << law[0];
                    for (const double substeps : {1.0, 2.0, 4.0, 37.0}) {
                        SCOPED_TRACE(kind_name(kind) + std::string(", law ") + std::to_string(law[0]) + ", NSUB " +
                                     std::to_string(substeps));
                        const UmatPoint point = loaded(2, substeps);
                        const Answer answer = point.evaluate({.dstran = strain, .dtime = 0.5});
                        const double h = 1e-7;
                        for (std::size_t k = 0; k < n; ++k) {
                            Numbers ahead = strain, back = strain;
                            ahead[k] += h, back[k] -= h;
                            const Answer a = point.evaluate({.dstran = ahead, .dtime = 0.5}),
                                         b = point.evaluate({.dstran = back, .dtime = 0.5});
                            for (std::size_t i = 0; i < n; ++i)
                                EXPECT_NEAR(answer.tangent(static_cast<int>(i), static_cast<int>(k)),
                                            (a.stress[i] - b.stress[i]) / (2 * h), 1e-6 * 1200.0);
                            EXPECT_NEAR(answer.drplde[k], (a.rpl - b.rpl) / (2 * h), 1e-6 * 300.0);
                        }
                    }
                }
}

TEST(DruckerPrager, SelfHeating) {
    // TMODE 3: dT = (dPhi - 3K alpha T d eps_v)/RHOCV, acting as thermal strain one increment later.
    Numbers props = hardening;
    props.resize(19, 0.0);
    const double alpha = 1e-4, capacity = 2.0, K = 2000.0 / 3;
    props[13] = alpha, props[16] = capacity, props[18] = 3;
    UmatPoint point = make_point(solid, props);
    point.temperature(300.0);
    const Answer answer = point.advance({.dstran = {-0.01, 0.002, 0.001, 0.012, 0, 0}});
    const double warmer = (point.state(PHI) - 3 * K * alpha * 300.0 * -0.007) / capacity;
    EXPECT_NEAR(point.state(5), warmer, 1e-13 * std::fabs(warmer));
    EXPECT_EQ(point.state(6), point.state(5));
    EXPECT_EQ(answer.rpl, 0.0);
    EXPECT_EQ(answer.drpldt, 0.0);
    EXPECT_EQ(largest(answer.drplde), 0.0);
    // The stored increment is the next thermal strain.
    UmatPoint follow = point;
    const Answer next = follow.evaluate({});
    EXPECT_NEAR(next.stress[0] - point.stress()[0], -3 * K * alpha * warmer, 1e-2 * K * alpha * std::fabs(warmer));
}

// xi^2 c' h/LREF <= -(G + eta eta_bar K) is refused with the largest legal size.
TEST(DruckerPrager, SofteningRefusesElementsThatAreTooLarge) {
    const double G = 400, K = 2000.0 / 3, phi = 20 * M_PI / 180, psi = 5 * M_PI / 180;
    const auto eta_of = [](double a) { return 6 * std::sin(a) / (std::sqrt(3.0) * (3 + std::sin(a))); };
    const double eta = eta_of(phi), eta_bar = eta_of(psi),
                 xi = 6 * std::cos(phi) / (std::sqrt(3.0) * (3 + std::sin(phi)));
    for (const auto kind : {solid, plane_strain}) {
        const double h_max = (G + eta * eta_bar * K) / (xi * xi) * 10.0 / 40.0;
        UmatPoint point = make_point(kind, softening());
        EXPECT_TRUE(point.celent(h_max * (1 - 1e-12)).evaluate({}).done());
        const Answer refused = point.celent(h_max * (1 + 1e-12)).evaluate({});
        EXPECT_EQ(refused.messages.stops, 1);
        EXPECT_NE(refused.first_error().find("h_max"), std::string::npos) << refused.first_error();
    }
    // Plane stress: the softest state is biaxial compression, z = -1/sqrt3.
    const double z = 1 / std::sqrt(3.0);
    const double unloading = 1000 / (2 * 0.75) * (2 * eta / 3 - z) * (2 * eta_bar / 3 - z);
    const double h_max = unloading / (xi * xi) * 10.0 / 40.0;
    UmatPoint point = make_point(plane_stress, softening());
    EXPECT_TRUE(point.celent(h_max * (1 - 1e-12)).evaluate({}).done());
    EXPECT_EQ(point.celent(h_max * (1 + 1e-12)).evaluate({}).messages.stops, 1);
    for (const double unknown : {0.0, -1.0, std::nan("")}) {
        const Answer no_size = point.celent(unknown).evaluate({});
        EXPECT_NE(no_size.first_error().find("CELENT"), std::string::npos) << no_size.first_error();
    }
}

// At the apex softening may be steeper than unloading: the smallest solution, held by the floor.
TEST(DruckerPrager, SteepSofteningAtTheApex) {
    for (const double slope : {-40.0, -400.0}) {
        UmatPoint point = make_point(solid, softening(slope));
        point.celent(5.0);
        const Answer answer = point.advance({.dstran = {0.02, 0.02, 0.02, 0.001, 0, 0}});
        const double eta = 0.35441, c = point.state(COHC);
        EXPECT_EQ(point.state(REGION), 2.0);
        EXPECT_GE(c, 0.5);
        EXPECT_NEAR(point.stress()[0], 0.97377 * c / eta, 1e-4 * point.stress()[0]);
        EXPECT_TRUE(answer.tangent.allFinite());
    }
}

// A floor of zero at the apex and on the cone: nothing divides by zero.
TEST(DruckerPrager, CohesionCanFallToZero) {
    Numbers props = softening();
    props[9] = 0.0;
    for (const auto kind : kinds)
        for (const double sign : {-1.0, 1.0}) {
            UmatPoint point = make_point(kind, props);
            point.celent(1.0);
            Numbers strain(static_cast<std::size_t>(point.size()), 0.0);
            strain[0] = sign * 1.0;
            const Answer answer = point.advance({.dstran = strain});
            EXPECT_EQ(point.state(COHC), 0.0);
            EXPECT_TRUE(answer.tangent.allFinite());
            const Answer again = point.advance({.dstran = strain});
            EXPECT_TRUE(again.tangent.allFinite());
            if (sign > 0.0) {
                EXPECT_LE(largest(point.stress()), 1e-10);
            }
        }
}

// The open section: biaxial compression does not yield in plane stress for eta >= sqrt3/2.
TEST(DruckerPrager, OpenSectionOfPlaneStress) {
    UmatPoint point = make_point(plane_stress, {1000.0, 0.25, 0, 0.9, 0.9, 2.0, 1.0});
    point.advance({.dstran = {-1.0, -1.0, 0}});
    EXPECT_EQ(point.state(REGION), 0.0);
}

TEST(DruckerPrager, ZeroIncrementOnTheYieldSurfaceIsElastic) {
    for (const auto kind : kinds)
        for (const double sign : {-1.0, 1.0}) {
            UmatPoint point = make_point(kind, hardening);
            Numbers strain(static_cast<std::size_t>(point.size()), 0.0);
            strain[0] = strain[1] = sign * 0.02;
            strain.back() = 0.03;
            point.advance({.dstran = strain});
            ASSERT_GT(point.state(EQPS), 0.0);
            const Answer answer = point.evaluate({}), elastic = make_point(kind, hardening).evaluate({});
            EXPECT_LE(distance(answer.stress, point.stress()), 1e-13 * largest(point.stress()));
            EXPECT_EQ(answer.state[EQPS - 1], point.state(EQPS));
            EXPECT_TRUE(answer.tangent == elastic.tangent);
        }
}

std::string refusal(const Numbers& props, int ndi = 3, int nshr = 3) {
    char message[400] = "";
    const int needed = lode_required_state("DRUCKER_PRAGER-BAD", props.data(), static_cast<int>(props.size()), ndi,
                                           nshr, message, 400);
    return needed < 0 ? message : "accepted";
}

TEST(DruckerPrager, RefusesWhatMakesNoSense) {
    const auto names = [](const std::string& message, const char* what) {
        EXPECT_NE(message.find(what), std::string::npos) << message;
    };
    EXPECT_EQ(refusal(direct), "accepted");
    names(refusal({1000.0, 0.25, 0, 0.4, 0.5, 2.0}), "DILA");  // eta_bar > eta
    names(refusal({1000.0, 0.25, 1, 30.0, 31.0, 2.0}), "DILA");
    names(refusal({1000.0, 0.25, 1, 90.0, 0.0, 2.0}), "FRIC");
    names(refusal({1000.0, 0.25, 0, 0.4, 0.2, 0.0}), "COH");
    names(refusal({1000.0, 0.25, 0, 0.4, 0.2, 2.0, -1.0}), "XI");
    names(refusal({1000.0, 0.25, 0, 0.4, 0.2, 2.0, 1.0, 3, 1, 1, 1, 1}), "HLAW");
    names(refusal({1000.0, 0.25, 0, 0.4, 0.2, 2.0, 1.0, 1}), "needs NPROPS >= 9");
    names(refusal({1000.0, 0.25, 0, 0.4, 0.2, 2.0, 1.0, 1, -40.0}), "LREF");
    names(refusal({1000.0, 0.25, 0, 0.4, 0.2, 2.0, 1.0, 1, -40.0, 3.0}), "H2");  // floor above c0
    Numbers options = direct;
    options.resize(21, 0.0);
    const auto with = [&](std::size_t index, double value) {
        Numbers props = options;
        props[index - 1] = value;
        return refusal(props);
    };
    names(with(18, -0.5), "CHI");
    names(with(19, 2), "TMODE 2, 3 need RHOCV > 0");
    names(with(20, 1), "METHOD");
    names(refusal(direct, 1, 0), "not served");
    names(refusal(direct, 1, 1), "not served");
    // TMODE 2 keeps its temperature in STATEV 5 and 6.
    options[16] = 2.0, options[18] = 2;
    EXPECT_EQ(lode_required_state("DRUCKER_PRAGER", options.data(), 21, 3, 3, nullptr, 0), 6);
    EXPECT_EQ(lode_required_state("DRUCKER_PRAGER", direct.data(), 7, 3, 3, nullptr, 0), 4);
}

// TMODE 1 and 3 need the absolute temperature.
TEST(DruckerPrager, ThermoelasticHeatNeedsAbsoluteTemperature) {
    Numbers props = direct;
    props.resize(19, 0.0);
    props[13] = 1e-5, props[16] = 2.0, props[18] = 1;
    UmatPoint point = make_point(solid, props);
    const Answer refused = point.temperature(-10.0).evaluate({.dstran = {0.001, 0, 0, 0, 0, 0}});
    EXPECT_EQ(refused.messages.stops, 1);
    EXPECT_NE(refused.first_error().find("absolute temperature"), std::string::npos) << refused.first_error();
}

}  // namespace
}  // namespace lode::test::test_drucker_prager
