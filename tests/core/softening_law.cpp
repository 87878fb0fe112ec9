// The softening laws of page 30, section 3: the table of section 9.1, inverses, energies, batches, derivatives.
#include "lode/damage/softening_law.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "support/dual.hpp"

namespace {

using namespace lode;
using lode::test::Dual;

struct Row {
    int code;
    double a1, a2;
    double delta_max, f, slope, omega, phi, R, eta, d, delta_of_d, delta_of_strain;
};
// sig = 5, G = 0.1, h = 2, C = 20000, FMIN = 0.01; values at delta = 0.004, d = 0.9, eps = 0.003.
constexpr Row table[] = {
    {1, 0, 0, 0.02, 0.8, -50, 0.002, 1, 14.1723356009, 2, 0.952380952381, 0.00202247191011, 0.00278481012658},
    {2, 0, 0, 0.0460517018599, 0.670320046036, -67.0320046036, 0.00195615944757, 0.93844806445, 13.5077296158, 1,
     0.959789611466, 0.00186683851228, 0.00281126682687},
    {3, 0, 0, 0.02, 0.896, -48, 0.002064, 1.088, 15.2447773186, 1.33333333333, 0.94696969697, 0.00217589947014,
     0.00276299570294},
    {4, 5, 0, 0.0109090909091, 1.43062962963, -156.75, 0.00282011111111, 2.05762962963, 27.0895035705, 0.357954545455,
     0.917924385979, 0.00339329978888, 0.00261300484172},
    {5, 3, 0.6, 0.0276072565882, 0.987245480359, -143.018324098, 0.00263569187104, 1.55931877675, 21.6146881646,
     0.697137002317, 0.941883133348, 0.0026280874117, 0.00271028626388},
    {6, 1.5, 0, 0.0306618642782, 0.804938776299, -65.4985902806, 0.00206529463714, 1.06693313742, 15.1120480593,
     1.48644468978, 0.952101058682, 0.00207480815036, 0.00277952819169},
};

void expect_digits(double actual, double page) { EXPECT_NEAR(actual, page, 6e-12 * std::abs(page)); }

TEST(SofteningLaw, PageTable) {
    for (const Row& row : table) {
        SCOPED_TRACE("law " + std::to_string(row.code));
        const SofteningLaw law(row.code, row.a1, row.a2, 0.01);
        const SofteningDirection<double> point(5.0, 0.1 / 2.0, 20000.0);
        const double L = point.length, r = point.brittleness;
        EXPECT_EQ(L, 0.01);
        const Softened<double> s = law.at(0.004 / L);
        const double e = L * s.strain(r);
        expect_digits(law.end() * L, row.delta_max);
        expect_digits(s.f, row.f);
        expect_digits(s.slope / L, row.slope);
        expect_digits(law.omega(0.004 / L) * L, row.omega);
        expect_digits(s.phi(), row.phi);
        expect_digits(5.0 * s.phi() / (20000.0 * e * e), row.R);
        expect_digits(law.eta(), row.eta);
        expect_digits(0.004 / e, row.d);
        expect_digits(law.at_damage(0.9, r, 0.0, true).u * L, row.delta_of_d);
        expect_digits(law.at_strain(0.003 / L, r, 0.0, true).u * L, row.delta_of_strain);
    }
    const double kappas[] = {1, 5, 10, 20, 100};
    const double peaks[] = {0.94921875, 0.64599609375, 0.442421483842, 0.268513191419, 0.0642676533113};
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(1.0 / SofteningLaw(4, kappas[i], 0, 0.01).peak(), peaks[i], 6e-13);
    expect_digits(SofteningLaw(6, 2.84246893356, 0, 0.01).eta(), 1.0);
}

TEST(SofteningLaw, Figure51) {
    // E = 1000, G = 1, sig = 50, h = 0.1.
    const SofteningDirection<double> point(50.0, 1.0 / 0.1, 1000.0);
    const auto R = [&](int code, double delta) {
        const Softened<double> s = SofteningLaw(code, 0, 0, 0.01).at(delta / point.length);
        return 50.0 * s.phi() / (1000.0 * square(point.length * s.strain(point.brittleness)));
    };
    expect_digits(SofteningLaw(1, 0, 0, 0.01).end() * point.length, 0.4);
    expect_digits(R(1, 0.0), 20.0);
    expect_digits(R(1, 0.4), 0.3125);
    expect_digits(R(1, 0.2), 0.987654320988);
    expect_digits(R(2, 0.2), 0.771301584993);
    expect_digits(R(3, 0.2), 1.23456790123);
}

struct Parameters {
    int code;
    double a1, a2;
};
constexpr Parameters shapes[] = {{1, 0, 0},    {2, 0, 0},     {3, 0, 0}, {4, 0.5, 0}, {4, 20, 0}, {5, 3, 0.6},
                                 {5, 2, -1.0}, {5, 1.2, 0.1}, {6, 1, 0}, {6, 1.5, 0}, {6, 8, 0}};

// f' and omega against sums over the law itself; the area is 1.
TEST(SofteningLaw, SlopeAndEnergyBelongToTheLaw) {
    for (const Parameters& p : shapes) {
        SCOPED_TRACE("law " + std::to_string(p.code) + " " + std::to_string(p.a1));
        const SofteningLaw law(p.code, p.a1, p.a2, 1e-6);
        // Simpson's rule
        const int n = 20000;
        const double h = law.end() / n;
        double integral = 0.0;
        for (int i = 2; i <= n; i += 2) {
            integral += h / 3.0 * (law.at((i - 2) * h).f + 4.0 * law.at((i - 1) * h).f + law.at(i * h).f);
            const double u = i * h;
            ASSERT_NEAR(law.omega(u), integral - 0.5 * u * law.at(u).f, 1e-7);
            const double du = 1e-5 * law.end();
            if (i > 100 && i < n - 100) {
                ASSERT_NEAR(law.at(u).slope, (law.at(u + du).f - law.at(u - du).f) / (2.0 * du), 1e-6);
            }
            ASSERT_GT(law.at(u - 0.5 * h).phi(), -1e-12);
            ASSERT_LE(law.at(u).f, law.peak() * (1.0 + 1e-12));
        }
        EXPECT_NEAR(integral, 1.0, 2e-5);
        EXPECT_NEAR(law.at(law.end()).f, law.end_value(), 1e-15 + 1e-9 * law.end_value());
        EXPECT_NEAR(law.end_release(0.0), 1.0, 2e-5);
    }
}

// r = eta is where e(delta) stops growing.
TEST(SofteningLaw, EtaIsTheLimitOfGrowth) {
    for (const Parameters& p : shapes) {
        SCOPED_TRACE("law " + std::to_string(p.code) + " " + std::to_string(p.a1));
        const SofteningLaw law(p.code, p.a1, p.a2, 1e-6);
        double steepest = 0.0;
        for (int i = 0; i <= 200000; ++i) steepest = std::min(steepest, law.at(law.end() * i / 200000).slope);
        EXPECT_NEAR(law.eta() * -steepest, 1.0, 1e-6);
    }
}

// The inverses, for damage from 1e-8 to 1 and brittleness up to the limit; the same in a batch, to rounding.
TEST(SofteningLaw, Inverses) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (const Parameters& p : shapes) {
        SCOPED_TRACE("law " + std::to_string(p.code) + " " + std::to_string(p.a1));
        const SofteningLaw law(p.code, p.a1, p.a2, 1e-3);
        for (int i = 0; i < 20000; ++i) {
            const double r = 0.95 * law.eta() * std::pow(10.0, -6.0 * uniform(random));
            const double u = 0.999 * law.end() * std::pow(10.0, -8.0 * uniform(random)), start = u * uniform(random);
            const double x = law.at(u).strain(r), d = u / x;
            const Softened<double> a = law.at_strain(x, r, start, true), b = law.at_damage(d, r, start, true);
            ASSERT_NEAR(a.strain(r), x, 4e-15 * x);
            ASSERT_NEAR(b.u * (1.0 - d), d * r * b.f, 4e-15 * d * r * law.peak());
            ASSERT_NEAR(a.f, law.at(a.u).f, 1e-14);
            ASSERT_NEAR(b.slope, law.at(b.u).slope, 1e-11 * std::max(1.0, std::abs(b.slope)));
            const Mask<Batch> all_lanes(true);
            ASSERT_NEAR(law.at_strain(Batch(x), Batch(r), Batch(start), all_lanes).u.get(0), a.u,
                        1e-13 * x / (1.0 + r * a.slope));
        }
    }
}

// Beyond FMIN the laws without an end go on.
TEST(SofteningLaw, Tails) {
    for (const Parameters& p : shapes) {
        const SofteningLaw law(p.code, p.a1, p.a2, 0.01), whole(p.code, p.a1, p.a2, 1e-8);
        if (law.has_end()) continue;
        SCOPED_TRACE("law " + std::to_string(p.code) + " " + std::to_string(p.a1));
        for (const double u : {1.01 * law.end(), 0.5 * (law.end() + whole.end())})
            EXPECT_NEAR(law.omega(u), whole.omega(u), 1e-14);
        for (const double d : {0.5 * (1.0 + law.end_damage(0.1)), 1.0 - 1e-9}) {
            const Softened<double> s = law.at_damage(d, 0.1, 0.0, true);
            EXPECT_GT(s.u, law.end());
            EXPECT_NEAR(s.u * (1.0 - d), d * 0.1 * s.f, 1e-14);
        }
    }
}

// Derivatives of the inverses: implicit function theorem.
TEST(SofteningLaw, InversesCarryDerivatives) {
    for (const Parameters& p : shapes) {
        SCOPED_TRACE("law " + std::to_string(p.code) + " " + std::to_string(p.a1));
        const SofteningLaw law(p.code, p.a1, p.a2, 0.01);
        const double r = 0.4 * law.eta(), u = 0.6 * law.end();
        const Softened<double> s = law.at(u);
        const double x = s.strain(r), d = u / x;
        const Dual<1> by_strain = law.at_strain(Dual<1>::variable(x, 0), Dual<1>(r), Dual<1>(0.5 * u), true).u;
        EXPECT_NEAR(by_strain(0), 1.0 / (1.0 + r * s.slope), 1e-10 / (1.0 + r * s.slope));
        const Dual<1> by_damage = law.at_damage(Dual<1>::variable(d, 0), Dual<1>(r), Dual<1>(0.5 * u), true).u;
        const double rate = x * x / (r * s.phi());
        EXPECT_NEAR(by_damage(0), rate, 1e-9 * rate);
    }
}

}  // namespace
