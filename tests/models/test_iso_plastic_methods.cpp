// The integration methods of ISO_PLASTIC: case V11 of page 20, the iso-error maps of section 6, convergence orders.
#include <gtest/gtest.h>

#include <cmath>

#include "iso_plastic_support.hpp"
#include "vumat_block.hpp"

namespace lode::test::test_iso_plastic_methods {
namespace {

using namespace iso_plastic_cases;

enum { METHOD = 22, NSUB = 23, STOL = 34 };

const Numbers steel = {200000.0, 0.3, 400.0, 1, 2000.0};

Numbers with_method(const Numbers& props, int method, int substeps = 0, double tolerance = 0.0) {
    return iso_plastic_props(props, {{METHOD, double(method)}, {NSUB, double(substeps)}, {STOL, tolerance}});
}

TEST(IsoPlasticMethods, V11NonProportional) {
    const struct {
        int method;
        Numbers stress;
        double alpha, row4[4], d14;
    } cases[] = {{0,
                  {86.3366802778, -43.1683401389, -43.1683401389, 225.226122464, 0, 0},
                  0.00551883674818,
                  {-6252.30722667, 3126.15361333, 3126.15361333, 2458.47686038},
                  -6252.30722667},
                 {2,
                  {58.9730658571, -29.4865329285, -29.4865329285, 231.844064346, 0, 0},
                  0.00559676014882,
                  {-4245.97625824, 2122.98812912, 2122.98812912, 1866.83741132},
                  -6391.26582934},
                 {1,
                  {46.9767081087, -23.4883540543, -23.4883540543, 233.967209815, 0, 0},
                  0.00566191358148,
                  {-3446.23524114, 1723.11762057, 1723.11762057, 1472.01895312},
                  -5477.22758372}};
    for (const auto kind : {solid, plane_strain})
        for (const auto& c : cases) {
            SCOPED_TRACE("METHOD " + std::to_string(c.method));
            const std::size_t n = kind == solid ? 6 : 4;
            UmatPoint point("ISO_PLASTIC-V11", kind, with_method(steel, c.method, 4));
            Numbers start = {200, -100, -100, 0, 0, 0}, strain = {0.001, -0.0005, -0.0005, 0.012, 0, 0},
                    stress = c.stress;
            start.resize(n), strain.resize(n), stress.resize(n);
            point.stress(start);
            const Answer answer = point.advance({.dstran = strain});
            expect_printed(point.stress(), stress);
            expect_printed(point.state(1), c.alpha);
            for (int j = 0; j < 4; ++j) expect_printed(answer.tangent(3, j), c.row4[j]);
            expect_printed(answer.tangent(0, 3), c.d14);
        }
}

// Perfect plasticity, one increment from s = R n with 2G dev(de) = R (x n + y t): the error in percent of R against the
// exact rotation tan(psi1/2) = tan(psi0/2) exp(-sqrt(x^2 + y^2)).
double iso_error(double x, double y, int method, int substeps = 1, double tolerance = 0.0) {
    const double E = 200000.0, nu = 0.3, yield = 400.0, G = E / (2 * (1 + nu)), R = std::sqrt(2.0 / 3.0) * yield;
    const double n1 = 2 / std::sqrt(6.0), t12 = 1 / std::sqrt(2.0);
    UmatPoint point("ISO_PLASTIC-MAP", solid, with_method({E, nu, yield, 0}, method, substeps, tolerance));
    point.stress({R * n1, -R * n1 / 2, -R * n1 / 2, 0, 0, 0});
    const double along = R * x / (2 * G), across = R * y / (2 * G);
    point.advance({.dstran = {along * n1, -along * n1 / 2, -along * n1 / 2, 2 * across * t12, 0, 0}});
    const double psi0 = std::atan2(y, x), psi1 = 2 * std::atan(std::tan(psi0 / 2) * std::exp(-std::hypot(x, y)));
    const double s_n = point.stress()[0] / n1, s_t = point.stress()[3] / t12;
    return 100 * std::hypot(s_n - R * std::cos(psi0 - psi1), s_t - R * std::sin(psi0 - psi1)) / R;
}

TEST(IsoPlasticMethods, IsoErrorMap) {
    const double x_grid[] = {0, 0.5, 1, 2, 3, 4, 5, 6}, y_grid[] = {0.5, 1, 2, 3, 4, 5, 6};
    const double percent[7][8] = {{1.673, 6.071, 6.461, 4.850, 3.289, 2.248, 1.587, 1.163},
                                  {8.035, 12.034, 12.095, 9.141, 6.302, 4.359, 3.104, 2.287},
                                  {19.430, 20.012, 18.955, 14.830, 10.785, 7.773, 5.698, 4.287},
                                  {22.180, 21.718, 20.489, 16.811, 12.990, 9.855, 7.513, 5.817},
                                  {20.797, 20.272, 19.308, 16.554, 13.506, 10.771, 8.555, 6.840},
                                  {18.366, 17.965, 17.289, 15.355, 13.090, 10.901, 8.993, 7.418},
                                  {16.002, 15.721, 15.259, 13.920, 12.277, 10.590, 9.025, 7.658}};
    for (int iy = 0; iy < 7; ++iy)
        for (int ix = 0; ix < 8; ++ix) {
            SCOPED_TRACE(std::to_string(x_grid[ix]) + ", " + std::to_string(y_grid[iy]));
            EXPECT_NEAR(iso_error(x_grid[ix], y_grid[iy], 0), percent[iy][ix], 0.0005 + 1e-9);
            EXPECT_NEAR(iso_error(x_grid[ix], y_grid[iy], 3), percent[iy][ix], 0.0005 + 1e-9);
            EXPECT_LE(iso_error(x_grid[ix], y_grid[iy], 1), 1e-11);
        }
}

// The table of section 6: maximum and mean over x, y in {0, 0.5, .., 6} for equal substeps, and error control.
TEST(IsoPlasticMethods, ErrorsOfSubsteps) {
    struct Errors {
        double largest, mean;
    };
    const auto over_the_grid = [](int method, int substeps, double tolerance, int increments = 1) {
        (void)increments;
        Errors e{0.0, 0.0};
        for (int ix = 0; ix <= 12; ++ix)
            for (int iy = 0; iy <= 12; ++iy) {
                const double one = iso_error(0.5 * ix, 0.5 * iy, method, substeps, tolerance);
                e.largest = std::max(e.largest, one);
                e.mean += one / 169.0;
            }
        return e;
    };
    const struct {
        int n;
        double backward[2], forward[2];
    } rows[] = {{1, {22.18, 10.60}, {77.5, 35.9}},  {2, {13.45, 5.36}, {61.2, 25.0}},
                {4, {7.80, 2.55}, {19.6, 2.73}},    {8, {4.24, 1.20}, {4.24, 0.864}},
                {16, {2.21, 0.574}, {2.21, 0.485}}, {32, {1.13, 0.280}, {1.13, 0.257}}};
    for (const auto& row : rows) {
        SCOPED_TRACE(std::to_string(row.n) + " substeps");
        const Errors backward = over_the_grid(2, row.n, 0.0), forward = over_the_grid(6, row.n, 0.0);
        EXPECT_NEAR(backward.largest, row.backward[0], 0.006);
        EXPECT_NEAR(backward.mean, row.backward[1], 0.06 * row.backward[1]);
        EXPECT_NEAR(forward.largest, row.forward[0], 0.06);
        EXPECT_NEAR(forward.mean, row.forward[1], 0.06 * row.forward[1]);
    }
    const Errors trapezoidal = over_the_grid(5, 1, 0.0);
    EXPECT_NEAR(trapezoidal.largest, 89.9, 0.06);
    for (const auto& [tolerance, most] : {std::pair{1e-2, 0.228}, {1e-3, 0.0252}, {1e-4, 0.0026}}) {
        const Errors controlled = over_the_grid(4, 1, tolerance);
        EXPECT_LE(controlled.largest, 1.5 * most);
        EXPECT_GE(controlled.largest, 0.3 * most);
    }
}

// A curved path: half a turn of the strain deviator, in n increments. The exact method is exact on straight pieces, so
// that its error here is that of the polygon; the others show their order on it.
TEST(IsoPlasticMethods, ConvergenceOrders) {
    const auto end_of_path = [](const Numbers& law, int method, int n, int pieces) {
        UmatPoint point("ISO_PLASTIC-ORDER", solid, with_method(law, method, 4, 1e-2));
        for (int i = 0; i < n; ++i) {
            // A polygon of `pieces` straight parts.
            const auto at = [&](double t) {
                const double s = t * pieces, k = std::min(std::floor(s), pieces - 1.0), f = s - k;
                const auto corner = [&](double j) {
                    const double angle = 2.5 * j / pieces;
                    return Numbers{0.01 * std::sin(angle),        -0.005 * std::sin(angle),    -0.005 * std::sin(angle),
                                   0.015 * (1 - std::cos(angle)), 0.003 * std::sin(2 * angle), 0.0};
                };
                const Numbers a = corner(k), b = corner(k + 1);
                Numbers e(6);
                for (std::size_t c = 0; c < 6; ++c) e[c] = a[c] + f * (b[c] - a[c]);
                return e;
            };
            const Numbers from = at(double(i) / n), to = at(double(i + 1) / n);
            Numbers strain(6);
            for (std::size_t c = 0; c < 6; ++c) strain[c] = to[c] - from[c];
            point.advance({.dstran = strain});
        }
        return point.stress();
    };
    const int pieces = 8;
    for (const Numbers& law : {Numbers{200000.0, 0.3, 400.0, 0},
                               {200000.0, 0.3, 400.0, 1, 2000.0},
                               {200000.0, 0.3, 400.0, 2, 20, 0.4},
                               {200000.0, 0.3, 400.0, 6, 3, 0.35},
                               {200000.0, 0.3, 400.0, 8, 300, 12, 500}}) {
        const Numbers exact = end_of_path(law, 1, pieces, pieces);
        // The exact method does not care how a straight piece is cut.
        EXPECT_LE(distance(end_of_path(law, 1, 4 * pieces, pieces), exact), 1e-10 * largest(exact))
            << "HLAW " << law[3];
        const struct {
            int method;
            double order;
        } methods[] = {{0, 1}, {2, 1}, {3, 1}, {4, 2}, {5, 2}, {6, 1}};
        for (const auto& m : methods) {
            if (m.method == 5 && law[3] != 0) continue;
            const double coarse = distance(end_of_path(law, m.method, 128 * pieces, pieces), exact);
            const double fine = distance(end_of_path(law, m.method, 512 * pieces, pieces), exact);
            // The first flow of law 6 is singular: n < 1.
            EXPECT_NEAR(std::log(coarse / fine) / std::log(4.0), law[3] == 6 ? 1 : m.order, 0.1)
                << "METHOD " << m.method << ", HLAW " << law[3] << ": " << coarse << ", " << fine;
        }
    }
}

TEST(IsoPlasticMethods, ExplicitCallsAgree) {
    for (const int method : {0, 1, 2, 3, 4, 5, 6})
        for (const auto kind : {solid, plane_strain}) {
            SCOPED_TRACE("METHOD " + std::to_string(method));
            UmatPoint point("ISO_PLASTIC-BLOCK", kind, with_method({200000.0, 0.3, 400.0, 0}, method));
            point.nstatv(16);
            VumatBlock block(point);
            for (int i = 0; i < 11; ++i) block.points.push_back(block.fresh_point());
            Numbers strain(static_cast<std::size_t>(point.size()), 0.002);
            strain[0] = 0.006;
            for (int i = 0; i < 3; ++i) {
                for (VumatPoint& p : block.points) p.strain_increment = strain;
                ASSERT_EQ(block.run().stops, 0);
                point.advance({.dstran = strain});
                strain[3] = 0.01;
            }
            for (const VumatPoint& p : block.points) {
                EXPECT_LE(distance(p.stress, point.stress()), 1e-12 * largest(point.stress()));
                EXPECT_LE(distance(p.state, point.state()), 1e-12 * largest(point.state()));
            }
            // The plastic strain is the strain that the stress does not show.
            EXPECT_NEAR(point.state(11) + point.state(12) + point.state(13), 0.0, 1e-14);
        }
}

TEST(IsoPlasticMethods, RefusesWhatTheyCannotDo) {
    const auto refuses = [](const Numbers& props, const char* what) {
        const std::string message = iso_plastic_refusal(props);
        EXPECT_NE(message.find(what), std::string::npos) << message;
    };
    refuses(with_method({200000.0, 0.3, 500.0, 3, 500.0, 0.26, 0.014, 1.0}, 1), "needs HLAW 0, 1, 2, 6 or 8");
    refuses(with_method(steel, 5), "METHOD 5 needs HLAW 0");
    refuses(with_method(steel, 7), "METHOD");
    refuses(with_method(steel, 2, 1001), "NSUB");
    for (const auto kind : {plane_stress, uniaxial}) {
        UmatPoint point("ISO_PLASTIC-FLAT", kind, with_method(steel, 1));
        const Answer answer = point.evaluate({});
        EXPECT_EQ(answer.messages.stops, 1);
        EXPECT_NE(answer.first_error().find("METHOD"), std::string::npos) << answer.first_error();
    }
}

// Stresses from outside the yield surface and unloading first.
TEST(IsoPlasticMethods, StartAnywhere) {
    for (const int method : {1, 3, 4, 5, 6}) {
        SCOPED_TRACE("METHOD " + std::to_string(method));
        for (const double start : {0.0, 100.0, 266.0, 300.0}) {
            UmatPoint point("ISO_PLASTIC-START", solid, with_method({200000.0, 0.3, 400.0, 0}, method, 20));
            point.stress({start, -start / 2, -start / 2, 0, 0, 0});
            const Answer answer = point.advance({.dstran = {-0.01, 0.005, 0.005, 0.001, 0, 0}});
            const auto& s = point.stress();
            const double q = std::sqrt(1.5 * (s[0] * s[0] + s[1] * s[1] + s[2] * s[2]) + 3 * s[3] * s[3]);
            EXPECT_NEAR(q, 400.0, method == 5 ? 1.0 : 1e-9);
            EXPECT_TRUE(answer.tangent.allFinite());
            EXPECT_GT(point.spd(), 0.0);
        }
    }
}

}  // namespace
}  // namespace lode::test::test_iso_plastic_methods
