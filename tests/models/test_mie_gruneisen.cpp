// MIE_GRUNEISEN: the verification cases and failure modes of page 55, section 2.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "finite_strain.hpp"
#include "lode/eos/shock_curve.hpp"
#include "vumat_block.hpp"

namespace lode::test::test_mie_gruneisen {
namespace {

constexpr AnalysisKind solid = AnalysisKind::solid, plane_strain = AnalysisKind::plane_strain;
constexpr double printed = 1e-13;  // fourteen digits
const std::string name = "MIE_GRUNEISEN-TEST";

enum State { CPI11, CPI22, CPI33, CPI12, CPI13, CPI23, ALPHA, TREL, ETA, PDISS, EINT, XFLAG };

const Numbers copper = {8.93e-9, 3.94e6, 1.99, 1.489, 0, 0, 3.83e8, 300};
const Numbers tungsten = {1.93e-8, 4.029e6, 1.54, 1.24, 0, 0, 1.32e8, 300};
const Numbers water = {1e-9, 1.48e6, .11, 2.56, -1.986, .2268};
constexpr double K0 = 8.93e-9 * 3.94e6 * 3.94e6, rc = 8.93e-9 * 3.83e8, gamma0 = 1.99, T0 = 300;

// Copper from PROPS(9) on: THERM, UJ, KMAX, G, HLAW, SY, H1, ...
Numbers with(Numbers props, const Numbers& more) {
    props.resize(8, 0.0);
    props.insert(props.end(), more.begin(), more.end());
    return props;
}
Numbers extended(Numbers props, std::size_t index, const Numbers& more) {
    if (props.size() < index - 1) {
        const std::size_t first = props.size();
        props.resize(index - 1, 0.0);
        if (first < 26 && index > 26) props[25] = 1.0;  // CHI
    }
    props.resize(std::max(props.size(), index - 1 + more.size()), 0.0);
    std::copy(more.begin(), more.end(), props.begin() + static_cast<std::ptrdiff_t>(index - 1));
    return props;
}
Answer at(const Numbers& props, const Matrix3d& f, double dtemp = 0.0, AnalysisKind kind = solid) {
    return UmatPoint(name, kind, props).temperature(T0).advance({.dtemp = dtemp, .dfgrd1 = f});
}
Matrix3d pressed(double eta) { return diagonal_gradient(1 - eta, 1, 1); }
Matrix3d general() {
    Matrix3d x;
    x << 0.93, .06, -.02, .03, .95, .05, -.04, .02, .99;
    return x;
}

// Reference values by an independent quadrature: composite Gauss rule of three points in extended precision.
long double isentrope_energy(long double K, long double g, long double s1, long double s2, long double s3,
                             long double eta) {
    const auto hugoniot = [&](long double x) {
        const long double d = 1 - s1 * x - s2 * x * x - s3 * x * x * x;
        return K * x * (1 - g * x / 2) / (d * d);
    };
    const int cells = 20000;
    const long double node = std::sqrt(0.6L), h = eta / cells / 2;
    long double sum = 0;
    for (int i = 0; i < cells; ++i) {
        const long double middle = h * (2 * i + 1);
        const auto f = [&](long double x) { return std::exp(g * (eta - x)) * hugoniot(x); };
        sum += h / 9 * (5 * f(middle - node * h) + 8 * f(middle) + 5 * f(middle + node * h));
    }
    return sum;
}

// --- 2.8, the printed tables -------------------------------------------------------------------------------------

TEST(MieGruneisen, ReferenceCurvesOfCopper) {
    const ShockCurve curve(K0, gamma0, 1.489, 0, 0, 0);
    EXPECT_NEAR(curve.pole, 0.67159167226326, 1e-14);
    EXPECT_NEAR(K0, 138625.748, 1e-9);
    EXPECT_NEAR(rc, 3.42019, 1e-14);
    EXPECT_NEAR(rc * gamma0 / K0, 4.9097503156484e-5, 1e-18);  // 3 alpha
    Isentrope isentrope(curve);
    std::vector<double> table;
    isentrope.tabulate(table);
    struct Row {
        double eta, P_h, e_s, P_s, T, P_300, K_h, K_adiabatic;
    };
    for (const Row& row : {Row{0.01, 1414.267545347, 7.0708858122917, 1428.3386081135, 306.02979749808, 1387.2987324346,
                               142837.95705381, 145651.92694565},
                           Row{0.1, 17233.220253743, 853.38088839805, 18931.448221655, 366.05458976996, 18481.868919358,
                               192230.6029298, 226136.82669478},
                           Row{0.2, 45038.587739992, 4302.0006226778, 53599.568979121, 446.65320897218, 52601.42111992,
                               288202.27384841, 373532.78766317},
                           Row{0.35, 137909.44262182, 19974.499838142, 177658.69729972, 602.01506785569,
                               175603.12895901, 676750.28482842, 906551.80978561},
                           Row{0.5, 533541.44913661, 73991.341243251, 680784.21821068, 811.41730238384, 677303.42096723,
                               3114675.6715669, 3792055.9686865}}) {
        EXPECT_NEAR(isentrope.hugoniot(row.eta), row.P_h, printed * row.P_h);
        EXPECT_NEAR(isentrope.energy(row.eta), row.e_s, printed * row.e_s);
        EXPECT_NEAR((1 - row.eta) * curve.slope_at(row.eta), row.K_h, printed * row.K_h);
        const Answer adiabatic = at(with(copper, {1}), pressed(row.eta)), isothermal = at(copper, pressed(row.eta));
        expect_hydrostatic(-row.P_s, adiabatic.stress, printed);
        EXPECT_NEAR(T0 + adiabatic.state[TREL], row.T, printed * row.T);
        EXPECT_NEAR(adiabatic.state[EINT], row.e_s, printed * row.e_s);
        expect_hydrostatic(-row.P_300, isothermal.stress, printed);
        // C_1111 = K - P of the adiabatic fluid
        EXPECT_NEAR(adiabatic.tangent(0, 0) + row.P_s, row.K_adiabatic, printed * row.K_adiabatic);
        // J dP/deta on the isentrope is K_h + gamma J P (9.107)
        EXPECT_NEAR(row.K_adiabatic, row.K_h + gamma0 * (1 - row.eta) * row.P_s, 1e-12 * row.K_adiabatic);
    }
    EXPECT_NEAR(at(copper, pressed(0.2)).state[EINT], 3800.4187838832, printed * 3800);
}

TEST(MieGruneisen, TensionAndHeat) {
    const Answer stretched = at(with(copper, {1, 1}), diagonal_gradient(1.05, 1, 1));
    expect_hydrostatic(6931.2874, stretched.stress, 1e-13);
    EXPECT_NEAR(stretched.state[TREL], -28.413015039448, printed * 28);
    expect_hydrostatic(-680.61781, at(copper, Matrix3d::Identity(), 100).stress, 1e-14);
}

TEST(MieGruneisen, Strength) {
    const Answer a = at(with(copper, {1, 1, 0, 47700, 1, 120, 200}), pressed(0.15));
    expect_close({-33741.281740053, -33576.350048447, -33576.350048447, 0, 0, 0}, a.stress, printed);
    EXPECT_NEAR(a.state[ALPHA], 0.10095968932722, printed);
    EXPECT_NEAR(a.state[TREL], 108.48895011172, printed * 108);
    EXPECT_NEAR(a.state[PDISS], 14.153734493076, 2e-13 * 14);
    EXPECT_NEAR(a.state[EINT], 2162.3410067093, printed * 2162);
    EXPECT_NEAR(a.spd, a.state[PDISS] / 0.85, 1e-14 * a.spd);
}

TEST(MieGruneisen, TungstenWithLimitedStiffness) {
    const double K = 1.93e-8 * 4.029e6 * 4.029e6;
    const ShockCurve curve(K, 1.54, 1.24, 0, 0, 5);
    EXPECT_NEAR(curve.stiff_from, 0.43408088901969, 1e-14);
    EXPECT_NEAR(curve.stiff_pressure, 424662.86894294, printed * 424662);
    const Numbers props = with(tungsten, {1, 1, 5});
    struct Row {
        double eta, P_h, P_s;
    };
    for (const Row& row : {Row{0.4, 341394.76451814, 428130.58071943}, Row{0.7, 1418851.7805583, 2010669.7698477},
                           Row{0.9, 3139794.0457087, 4696306.0828353}}) {
        EXPECT_NEAR(curve.pressure_at(row.eta), row.P_h, printed * row.P_h);
        const Answer a = at(props, pressed(row.eta));
        expect_hydrostatic(-row.P_s, a.stress, printed);
        EXPECT_EQ(a.state[XFLAG], row.eta > 0.43 ? 1.0 : 0.0);
    }
    EXPECT_NEAR(at(props, pressed(0.7)).state[TREL], 581.63882321947, printed * 581);
}

TEST(MieGruneisen, WaterLike) { expect_hydrostatic(-375.28943275615, at(water, pressed(0.1)).stress, printed); }

// --- 2.4, the isentrope ------------------------------------------------------------------------------------------

TEST(MieGruneisen, TabulatedIsentrope) {
    struct Set {
        double K, g, s1, s2, s3, largest;
    };
    for (const Set& s :
         {Set{1, 1.99, 1.489, 0, 0, 0.99}, Set{1, 0, 1.24, 0, 0, 0.9}, Set{1, 0.11, 2.56, -1.986, .2268, .75},
          Set{1, 2.17, 0, 0, 0, 0.4}, Set{1, 1.5, 1.3, 0.2, 0.1, 0.97}, Set{1, 1.0, 0.4, 0, 0, 0.9}}) {
        Isentrope isentrope{ShockCurve(s.K, s.g, s.s1, s.s2, s.s3, 0)};
        std::vector<double> table;
        isentrope.tabulate(table);
        const double scale = std::min(isentrope.curve().pole, isentrope.curve().limit);
        for (const double part : {1e-9, 1e-4, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.97, 0.99})
            if (part * scale <= s.largest) {
                const double eta = part * scale;
                const double exact = static_cast<double>(isentrope_energy(s.K, s.g, s.s1, s.s2, s.s3, eta));
                EXPECT_NEAR(isentrope.energy(eta) / exact, 1.0, 1e-14) << s.s1 << " at " << eta;
            }
    }
    // without GAMMA0 the energy is the area below the Hugoniot: K0 [ln(1 - S x) + S x/(1 - S x)]/S^2
    Isentrope cold{ShockCurve(1, 0, 1.5, 0, 0, 0)};
    std::vector<double> table;
    cold.tabulate(table);
    for (const double x : {0.1, 0.6, 0.66, 0.6665, 0.66666})  // the last ones beyond the table
        EXPECT_NEAR(cold.energy(x), (std::log1p(-1.5 * x) + 1.5 * x / (1 - 1.5 * x)) / 2.25,
                    1e-13 * cold.energy(x) / (1 - 1.5 * x));
}

// Poles near each other, near 1, or none.
TEST(MieGruneisen, LimitsOfTheHugoniot) {
    EXPECT_EQ(ShockCurve(1, 1, 0.5, 0, 0, 0).pole, 1.0);
    EXPECT_NEAR(ShockCurve(1, 0, 2.0, -1.0, 0, 0).pole, 1.0, 1e-7);  // double root at 1
    EXPECT_NEAR(ShockCurve(1, 0, 4.0, -4.0, 0, 0).pole, 0.5, 1e-7);  // double root at 1/2
    EXPECT_NEAR(ShockCurve(1, 0.11, 2.56, -1.986, .2268, 0).limit, 0.7595, 1e-4);
    EXPECT_NEAR(ShockCurve(1, 2, 0, 0, 0, 0).limit, 0.5, 1e-14);  // 1 - GAMMA0 eta
    EXPECT_EQ(ShockCurve(1, 1.99, 1.489, 0, 0, 3).limit, 1.0);
}

TEST(MieGruneisen, TinyStrainsKeepFullRelativeAccuracy) {
    for (const double wanted : {1e-6, 1e-9, 1e-12})
        for (const double sign : {-1.0, 1.0}) {
            const double h = (1.0 + sign * wanted) - 1.0;
            const double s11 = at(with(copper, {1}), diagonal_gradient(1 + h, 1, 1)).stress[0];
            EXPECT_NEAR(s11, K0 * h, 4 * wanted * K0 * wanted + 2e-15 * K0 * wanted);
        }
}

// --- 2.3, 2.5, one state function --------------------------------------------------------------------------------

TEST(MieGruneisen, PressureDoesNotDependOnThePath) {
    for (const double thermal : {0.0, 1.0})
        for (const int steps : {1, 5, 50}) {
            UmatPoint point(name, solid, with(copper, {thermal}));
            point.temperature(T0);
            for (int i = 1; i <= steps; ++i) point.advance({.dfgrd1 = pressed(0.35 * i / steps)});
            const double expected = thermal == 1.0 ? 177658.69729972 : 175603.12895901;
            EXPECT_NEAR(point.stress()[0], -expected, printed * steps * expected);
        }
}

TEST(MieGruneisen, ClosedAdiabaticCycle) {
    const Numbers props = with(copper, {1, 1, 0, 47700});  // elastic deviator
    VumatBlock block(name, solid, props);
    block.points.push_back(block.fresh_point());
    const int steps = 64;
    for (int i = 1; i <= steps; ++i) {
        const double s = std::sin(2 * M_PI * i / steps);
        VumatPoint& p = block.points.front();
        p.stretch = diagonal_gradient(1 + 0.2 * s, 1 - 0.1 * s * s, 1);
        p.stretch(0, 1) = p.stretch(1, 0) = 0.1 * s;
        p.density = 8.93e-9 / p.stretch.determinant();
        ASSERT_EQ(block.run().stops, 0);
    }
    const VumatPoint& end = block.points.front();
    EXPECT_LE(largest(end.stress), 1e-12 * K0);
    EXPECT_NEAR(end.state[TREL], 0.0, 1e-11);
    EXPECT_NEAR(end.internal_energy * 8.93e-9, 0.0, 1e-11);
}

TEST(MieGruneisen, ContinuousAtTheReferenceVolume) {
    for (const double uj : {0.0, 1.0, 2.0}) {
        const Numbers props = with(copper, {1, uj});
        const Answer in = at(props, pressed(1e-9), 50), out = at(props, pressed(-1e-9), 50);
        EXPECT_NEAR(in.stress[0], out.stress[0], 1e-8 * K0);
        EXPECT_NEAR(in.tangent(0, 0), out.tangent(0, 0), 1e-7 * K0);
    }
}

TEST(MieGruneisen, HostTemperatureAndKeptTemperatureAgree) {
    const double eta = 0.2;
    const Answer adiabatic = at(with(copper, {1}), pressed(eta));
    const Answer heated = at(copper, pressed(eta), adiabatic.state[TREL]);
    EXPECT_NEAR(heated.stress[0], adiabatic.stress[0], 1e-13 * std::abs(heated.stress[0]));
    // external heating of an adiabatic point
    const Answer warmed = at(with(copper, {1}), pressed(eta), 40.0);
    EXPECT_NEAR(warmed.state[TREL], adiabatic.state[TREL] + 40, 1e-11);
    EXPECT_NEAR(warmed.stress[0], adiabatic.stress[0] - gamma0 * rc * 40, 1e-13 * std::abs(heated.stress[0]));
}

// d(EINT) = P deta + CHI d(plastic work); the explicit host's internal energy adds the elastic shear energy.
template <class Volume>
void expect_balance(const Volume& volume, double limit) {
    double errors[3];
    for (int k = 0; k < 3; ++k) {
        const int steps = 40 << (2 * k);
        VumatBlock block(name, solid, with(copper, {1, 1, 0, 47700, 1, 120, 200}));
        block.points.push_back(block.fresh_point());
        double work = 0.0, old_pressure = 0.0;
        for (int i = 1; i <= steps; ++i) {
            VumatPoint& p = block.points.front();
            const double now = volume(static_cast<double>(i) / steps),
                         before = volume(static_cast<double>(i - 1) / steps);
            p.stretch = diagonal_gradient(now, 1, 1);
            p.density = 8.93e-9 / now;
            ASSERT_EQ(block.run().stops, 0);
            const double pressure = -(p.stress[0] + p.stress[1] + p.stress[2]) / 3;
            work += 0.5 * (old_pressure + pressure) * (before - now);
            old_pressure = pressure;
        }
        const VumatPoint& end = block.points.front();
        EXPECT_GT(end.state[PDISS], 10.0);
        errors[k] = std::abs(work + end.state[PDISS] - end.state[EINT]) / end.state[EINT];
        EXPECT_NEAR(end.inelastic_energy * 8.93e-9, end.state[PDISS], 1e-12 * end.state[PDISS]);
        // elastic shear energy: q^2/(6 G) but for its square
        const double q = end.stress[0] - end.stress[1], J = 8.93e-9 / end.density;
        EXPECT_NEAR(end.internal_energy * 8.93e-9, end.state[EINT] + J * J * q * q / (6 * 47700), 1e-3);
    }
    EXPECT_GE(errors[0] / errors[1], 3.5);  // order 1 at least, steps by 4
    EXPECT_GE(errors[1] / errors[2], 3.5);
    EXPECT_LE(errors[2], limit);
}
TEST(MieGruneisen, EnergyBalance) {
    expect_balance([](double t) { return 1.0 - 0.2 * std::pow(std::sin(2.0 * t), 2); }, 1e-5);
}
TEST(MieGruneisen, EnergyBalanceOfAShockAndRarefaction) {
    expect_balance([](double t) { return shock_tube(t, 0.8, 0.97); }, 1e-2);
}

TEST(MieGruneisen, PlaneStrainIsTheSolid) {
    Matrix3d f = general();
    f(0, 2) = f(1, 2) = f(2, 0) = f(2, 1) = 0;
    const Numbers props = with(copper, {1, 1, 0, 47700, 1, 120, 200});
    const Answer a = at(props, f, 0, plane_strain), b = at(props, f);
    expect_close({b.stress[0], b.stress[1], b.stress[2], b.stress[3]}, a.stress, 1e-14);
    expect_close(b.state, a.state, 1e-14);
}

TEST(MieGruneisen, LocalBasis) {
    const Numbers props = with(copper, {1, 1, 0, 47700, 1, 120, 200});
    const Matrix3d q = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    const Eigen::SelfAdjointEigenSolver<Matrix3d> u(general().transpose() * general());
    const Matrix3d stretch = u.operatorSqrt();
    const Answer fixed = at(props, stretch), turned = at(extended(props, 27, {1}), stretch * q);
    expect_close(fixed.stress, turned.stress, 1e-12);
}

TEST(MieGruneisen, JohnsonCookFeelsTheRightTemperature) {
    // THERM 0: that of the host; THERM 1: that of the start of the increment
    const Numbers law = {47700, 3, 90, 292, .31, 0, 1, 1, 1356, 0, 0, 0, 298};
    Numbers isothermal = {0, 1, 0}, adiabatic = {1, 1, 0};
    isothermal.insert(isothermal.end(), law.begin(), law.end());
    adiabatic.insert(adiabatic.end(), law.begin(), law.end());
    const auto mises = [](const Answer& a) { return std::sqrt(3.0) * a.stress[3]; };
    // K (1 - T*), at the alpha of either
    const auto yield = [](double alpha, double T) {
        return (90 + 292 * std::pow(alpha, .31)) * (1 - (T - 298) / (1356 - 298));
    };
    const Answer cold = at(with(copper, isothermal), simple_shear(0.05));
    EXPECT_NEAR(mises(cold), yield(cold.state[ALPHA], 300), 0.01 * mises(cold));
    const Answer hot = at(with(copper, isothermal), simple_shear(0.05), 500);
    EXPECT_NEAR(mises(hot), yield(hot.state[ALPHA], 800), 0.01 * mises(hot));
    UmatPoint point(name, solid, with(copper, adiabatic));
    const Answer first = point.advance({.dtemp = 500, .dfgrd1 = simple_shear(0.05)});
    EXPECT_NEAR(mises(first), yield(first.state[ALPHA], 300), 0.01 * mises(first));
    const Answer second = point.advance({.dfgrd1 = simple_shear(0.1)});
    EXPECT_NEAR(mises(second), yield(second.state[ALPHA], 800), 0.02 * mises(second));
}

// --- 2.6 ---------------------------------------------------------------------------------------------------------

TEST(MieGruneisen, TangentAgainstCentralDifferences) {
    constexpr double h = 1e-6;
    const Numbers deviators[] = {{},
                                 {47700},
                                 {47700, 1, 120, 200},
                                 {47700, 6, 120, 1.5, .4},
                                 {47700, 3, 90, 292, .31, .025, 1, 1.09, 1356, 0, 0, 0, 0, 250}};
    for (const AnalysisKind kind : {solid, plane_strain})
        for (const double thermal : {0.0, 1.0})
            for (const Numbers& deviator : deviators)
                for (const double cauchy : {0.0, 1.0})
                    for (const double size : {1.0, -0.3}) {
                        Numbers props = with(copper, {thermal, 2, 0});
                        props.insert(props.end(), deviator.begin(), deviator.end());
                        if (deviator.size() > 1) props = extended(props, 25, {cauchy, 0.7});
                        UmatPoint point(name, kind, props);
                        Matrix3d f = Matrix3d::Identity() + size * (general() - Matrix3d::Identity());
                        if (kind != solid) f(0, 2) = f(1, 2) = f(2, 0) = f(2, 1) = 0;
                        point.temperature(T0).advance({.dtemp = 20, .dfgrd1 = pressed(0.01)});
                        const Load load{.dtime = 0.01, .dtemp = 10, .dfgrd1 = f};
                        const Answer a = point.evaluate(load);
                        ASSERT_TRUE(a.done()) << a.first_error();
                        const double J = f.determinant(), stiffness = a.tangent.cwiseAbs().maxCoeff();
                        for (int k = 0; k < point.size(); ++k) {
                            Numbers unit(static_cast<std::size_t>(point.size()), 0.0);
                            unit[static_cast<std::size_t>(k)] = 1.0;
                            const Matrix3d d = strain_tensor(unit, kind);
                            Load ahead = load, back = load;
                            ahead.dfgrd1 = (Matrix3d::Identity() + h * d) * f;
                            back.dfgrd1 = (Matrix3d::Identity() - h * d) * f;
                            const Answer up = point.evaluate(ahead), down = point.evaluate(back);
                            for (int i = 0; i < point.size(); ++i) {
                                const auto row = static_cast<std::size_t>(i);
                                const double slope = (ahead.dfgrd1->determinant() * up.stress[row] -
                                                      back.dfgrd1->determinant() * down.stress[row]) /
                                                     (2 * h * J);
                                EXPECT_NEAR(a.tangent(i, k), slope, 1e-8 * stiffness);
                            }
                            EXPECT_NEAR(a.drplde[static_cast<std::size_t>(k)], (up.rpl - down.rpl) / (2 * h),
                                        1e-6 * largest(a.drplde));
                        }
                        Load warm = load, cold = load;
                        warm.dtemp += 0.1;
                        cold.dtemp -= 0.1;
                        const Answer up = point.evaluate(warm), down = point.evaluate(cold);
                        for (std::size_t i = 0; i < a.stress.size(); ++i)
                            EXPECT_NEAR(a.ddsddt[i], (up.stress[i] - down.stress[i]) / 0.2, 1e-6 * largest(a.ddsddt));
                        EXPECT_NEAR(a.drpldt, (up.rpl - down.rpl) / 0.2, 1e-6 * std::abs(a.drpldt) + 1e-6);
                        EXPECT_TRUE(thermal == 0.0 || a.rpl == 0.0);
                    }
}

// RPL of the isothermal solid: what it gives off when compressed, and CHI of the plastic work.
TEST(MieGruneisen, HeatOfAnIsothermalPoint) {
    UmatPoint point(name, solid, copper);
    const Answer a = point.temperature(T0).advance({.dtime = 0.5, .dfgrd1 = pressed(0.01)});
    EXPECT_NEAR(a.rpl, rc * gamma0 * T0 * 0.01 / (0.99 * 0.5), 1e-11);
}

TEST(MieGruneisen, ProbeOfAnExplicitHost) {
    VumatBlock block(name, solid, with(copper, {0, 1, 0, 47700}));
    block.points.push_back(block.fresh_point());
    block.points[0].strain_increment = {1e-3, 0, 0, 5e-3, 0, 0};
    block.step_time = block.total_time = 0.0;
    ASSERT_EQ(block.run().stops, 0);
    const double lame = K0 - 2 * 47700 / 3.0;
    expect_close({(lame + 2 * 47700) * 1e-3, lame * 1e-3, lame * 1e-3, 47700 * 5e-3, 0, 0}, block.points[0].stress,
                 1e-14);
}

// --- 2.7 ---------------------------------------------------------------------------------------------------------

TEST(MieGruneisen, CompressionBeyondTheHugoniot) {
    UmatPoint point(name, solid, with(copper, {1}));
    point.temperature(T0).advance({.dfgrd1 = pressed(0.6)});
    for (const double eta : {0.67159167226327, 0.7, 0.99}) {
        const Answer a = point.evaluate({.dfgrd1 = pressed(eta)});
        EXPECT_TRUE(a.cut) << eta;
        EXPECT_EQ(a.pnewdt, 0.25);
        EXPECT_TRUE(identical(a.state, point.state()));
    }
    EXPECT_TRUE(point.evaluate({.dfgrd1 = pressed(0.6715)}).done());
    UmatPoint liquid(name, solid, water);
    EXPECT_TRUE(liquid.evaluate({.dfgrd1 = pressed(0.7594)}).done());
    EXPECT_TRUE(liquid.evaluate({.dfgrd1 = pressed(0.7596)}).cut);

    VumatBlock block(name, solid, with(copper, {1}));
    block.points.assign(3, block.fresh_point());
    block.points[2].stretch = pressed(0.68);
    const HostMessages messages = block.run();
    EXPECT_EQ(messages.stops, 1);
    ASSERT_FALSE(messages.errors.empty());
    EXPECT_NE(messages.errors[0].find("KMAX"), std::string::npos);
    EXPECT_NE(messages.errors[0].find("point 3"), std::string::npos) << messages.errors[0];
}

TEST(MieGruneisen, LimitedStiffnessTakesAnyCompression) {
    const Numbers props = with(tungsten, {1, 1, 5});
    double previous = 0.0;
    for (const double eta : {0.4, 0.5, 0.8, 0.9, 0.99, 0.9999}) {
        const Answer a = at(props, pressed(eta));
        EXPECT_LT(a.stress[0], previous);
        EXPECT_TRUE(a.tangent.allFinite());
        previous = a.stress[0];
    }
    // a warning, once
    UmatPoint point("MIE_GRUNEISEN-STIFF", solid, props);
    point.temperature(T0);
    EXPECT_TRUE(point.evaluate({.dfgrd1 = pressed(0.3)}).messages.warnings.empty());
    EXPECT_EQ(point.evaluate({.dfgrd1 = pressed(0.5)}).messages.warnings.size(), 1u);
    EXPECT_TRUE(point.evaluate({.dfgrd1 = pressed(0.5)}).messages.warnings.empty());
    // lanes on either side of the limit
    VumatBlock block(name, solid, props);
    block.points.assign(11, block.fresh_point());
    for (std::size_t i = 0; i < 11; ++i) block.points[i].stretch = pressed(0.09 * static_cast<double>(i));
    ASSERT_EQ(block.run().stops, 0);
    for (std::size_t i = 0; i < 11; ++i) {
        const Answer a = at(props, pressed(0.09 * static_cast<double>(i)));
        EXPECT_NEAR(block.points[i].stress[0], a.stress[0], 1e-14 * std::abs(a.stress[0]));
    }
}

TEST(MieGruneisen, TemperaturesAreAbsolute) {
    UmatPoint point(name, solid, copper);
    const Answer a = point.evaluate({.dfgrd1 = pressed(0.1)});  // TEMP = 0
    EXPECT_EQ(a.messages.stops, 1);
    EXPECT_NE(a.first_error().find("absolute temperature"), std::string::npos) << a.first_error();
    // neither with CV = 0 nor when the model keeps the temperature
    EXPECT_TRUE(UmatPoint(name, solid, water).evaluate({.dfgrd1 = pressed(0.1)}).done());
    EXPECT_TRUE(UmatPoint(name, solid, with(copper, {1})).evaluate({.dfgrd1 = pressed(0.1)}).done());
}

TEST(MieGruneisen, TensionHasALimitWithTheLogarithmicEnergy) {
    const double peak = at(with(copper, {1, 2}), diagonal_gradient(std::exp(1.0), 1, 1)).stress[0];
    EXPECT_NEAR(peak, K0 / std::exp(1.0), 1e-12 * K0);
    for (const double J : {2.5, 3.0}) EXPECT_LT(at(with(copper, {1, 2}), diagonal_gradient(J, 1, 1)).stress[0], peak);
}

TEST(MieGruneisen, ImpossibleDeformations) {
    UmatPoint point(name, solid, with(copper, {1, 1, 0, 47700, 1, 120, 200}));
    point.advance({.dfgrd1 = pressed(0.1)});
    for (const double x : {0.0, -0.5, std::numeric_limits<double>::infinity(), std::nan("")}) {
        const Answer a = point.evaluate({.dfgrd1 = diagonal_gradient(x, 1, 1)});
        EXPECT_TRUE(a.cut);
        EXPECT_TRUE(identical(a.stress, point.stress()));
    }
}

TEST(MieGruneisen, RefusesBadConstants) {
    const auto changed = [](std::size_t index, double value) {
        Numbers props = with(copper, {1, 1, 0, 47700, 1, 120, 200});
        props.resize(27, 0.0);
        props[25] = 1.0;
        props[index - 1] = value;
        return props;
    };
    EXPECT_EQ(refusal(name, changed(1, 8.93e-9)), "");
    expect_refused(name, changed(1, 0), {name, "PROPS(1)", "RHO0"});
    expect_refused(name, changed(2, 0), {"PROPS(2)", "C0"});
    expect_refused(name, changed(3, -1), {"PROPS(3)", "GAMMA0"});
    expect_refused(name, changed(4, -1), {"PROPS(4)", "S1"});
    expect_refused(name, changed(7, -1), {"PROPS(7)", "CV"});
    expect_refused(name, changed(8, 0), {"PROPS(8)", "T0", "THERM = 1"});
    expect_refused(name, changed(9, 2), {"PROPS(9)", "THERM"});
    expect_refused(name, changed(10, 3), {"PROPS(10)", "UJ"});
    expect_refused(name, changed(12, -1), {"PROPS(12)", "(G,"});
    expect_refused(name, changed(13, 5), {"PROPS(13)", "HLAW"});
    expect_refused(name, changed(14, 0), {"PROPS(14)", "SY"});
    expect_refused(name, changed(15, -1), {"PROPS(15)", "softening"});
    expect_refused(name, changed(25, 2), {"PROPS(25)", "YCAU"});
    expect_refused(name, changed(26, 1.1), {"PROPS(26)", "CHI"});
    expect_refused(name, changed(27, 2), {"PROPS(27)", "ORI"});
    for (const AnalysisKind kind : {AnalysisKind::plane_stress, AnalysisKind::uniaxial, AnalysisKind::cohesive_2d})
        expect_refused(name, copper, {name, "not served"}, kind);
}

}  // namespace
}  // namespace lode::test::test_mie_gruneisen
