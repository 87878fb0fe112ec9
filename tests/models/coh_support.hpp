// What the tests of the traction-separation laws share: an interface that is led along a path of separations, and the
// rows of page 40's tables.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "umat_point.hpp"
#include "vumat_block.hpp"

namespace lode::test::coh {

inline constexpr AnalysisKind flat = AnalysisKind::cohesive_2d, spatial = AnalysisKind::cohesive_3d;
enum Entry { UN = 1, US1, US2, DN, DT, DAMN, DAMT, GI, GII, WORK, GDROP, STATUS };
constexpr double printed = 2e-11;  // twelve digits

class Interface {
  public:
    Interface(std::string keyword, AnalysisKind kind, Numbers props, double thickness = 1.0)
        : point(std::move(keyword) + "-TEST", kind, std::move(props)), thickness_(thickness) {}

    Load load_to(const Numbers& separation) const {
        Load load;
        for (std::size_t i = 0; i < separation.size(); ++i)
            load.dstran.push_back((separation[i] - point.state(int(i) + 1)) / thickness_);
        return load;
    }
    Answer to(const Numbers& separation) { return point.advance(load_to(separation)); }
    UmatPoint point;

  private:
    double thickness_;
};

inline double entry(const Answer& a, int index) { return a.state[std::size_t(index) - 1]; }

// What a row of the page's tables prints.
inline void expect_row(const Answer& a, const Numbers& tractions,
                       std::initializer_list<std::pair<int, double>> entries) {
    for (std::size_t i = 0; i < tractions.size(); ++i)
        EXPECT_NEAR(a.stress[i], tractions[i], printed * largest(tractions) + 1e-15) << "traction " << i;
    for (const auto& [index, value] : entries)
        EXPECT_NEAR(entry(a, index), value, printed * std::abs(value) + 1e-15) << "STATEV " << index;
}

// DDSDDE row by row.
inline void expect_tangent(const Answer& a, const Numbers& rows) {
    const auto n = static_cast<Eigen::Index>(a.stress.size());
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < n; ++j)
            EXPECT_NEAR(a.tangent(i, j), rows[std::size_t(i * n + j)], printed * largest(rows)) << i << ", " << j;
}

// A row of the table of strength laws (7.1): u_e, u_c, then S, phi, D, R and Omega at 40 % of the softening range.
struct LawRow {
    double elastic_limit, end, strength, phi, damage, rate, released;
};
template <class Law>
void check_law(const Law& law, const LawRow& row) {
    EXPECT_NEAR(law.elastic_limit, row.elastic_limit, printed * row.elastic_limit);
    EXPECT_NEAR(law.end, row.end, printed * row.end);
    const double delta = law.elastic_limit + 0.4 * (law.end - law.elastic_limit), q = law.integrity(delta);
    const double strength = law.stiffness * q * delta, phi = strength - delta * law.slope(delta);
    EXPECT_NEAR(strength, row.strength, printed * row.strength);
    EXPECT_NEAR(phi, row.phi, printed * phi);
    EXPECT_NEAR(2.0 * law.release_rate(delta), phi, 1e-13 * phi);
    EXPECT_NEAR(1.0 - q, row.damage, printed);
    EXPECT_NEAR(phi / (law.stiffness * delta * delta), row.rate, printed * row.rate);
    EXPECT_NEAR(law.released_energy(delta), row.released, printed * row.released);
    EXPECT_NEAR(law.opening(q), delta, 1e-13 * delta);
    if (law.elastic_limit > 0.0) {
        EXPECT_EQ(law.integrity(law.elastic_limit), 1.0);
    }
    EXPECT_NEAR(law.opening(1.0), law.elastic_limit, 1e-15 * law.end);
    EXPECT_NEAR(law.released_energy(law.elastic_limit), 0.0, 1e-16);
    if (law.end_integrity == 0.0) {
        EXPECT_NEAR(law.integrity(law.end), 0.0, 1e-16);
        EXPECT_NEAR(law.released_energy(law.end), law.toughness, 1e-15);
        EXPECT_NEAR(law.opening(0.0), law.end, 1e-7 * law.end);
    }
    // From the elastic limit to the end: every integrity belongs to one opening, S' and Omega' are derivatives.
    for (int i = 1; i < 200; ++i) {
        const double at = law.elastic_limit + (law.end - law.elastic_limit) * i / 200, h = 1e-6 * at;
        EXPECT_NEAR(law.opening(law.integrity(at)), at, 1e-13 * law.end) << i;
        const auto S = [&](double d) { return law.stiffness * law.integrity(d) * d; };
        EXPECT_NEAR(law.slope(at), (S(at + h) - S(at - h)) / (2 * h), 1e-6 * row.strength / at) << i;
        EXPECT_NEAR(law.release_rate(at), (law.released_energy(at + h) - law.released_energy(at - h)) / (2 * h),
                    1e-7 * row.phi + 1e-15 / h)
            << i;
        if constexpr (Law::has_psi) {
            const double psi = law.psi(at), middle = S(at) * 2.0 * law.release_rate(at) / at;
            EXPECT_NEAR(law.opening_at(psi), at, 1e-13 * law.end + 2e-14 * law.psi(law.end) / middle) << i;
            EXPECT_NEAR((law.psi(at + h) - law.psi(at - h)) / (2 * h), middle, 1e-5 * middle + 1e-15 * psi / h) << i;
        }
    }
}

// The message with which a material is refused.
inline std::string refusal(const std::string& keyword, const Numbers& props) {
    char text[512] = "";
    EXPECT_EQ(lode_required_state((keyword + "-BAD").c_str(), props.data(), int(props.size()), 1, 1, text, sizeof text),
              -1);
    return text;
}
inline void expect_refused(const std::string& keyword, const Numbers& props, const std::string& part) {
    const std::string message = refusal(keyword, props);
    EXPECT_NE(message.find(part), std::string::npos) << message;
}

// Random paths: DDSDDE against central differences wherever the point is not about to fail.
inline void check_tangent(const std::string& keyword, const Numbers& props, const Numbers& scale, double stiffness,
                          int paths = 20, double thickness = 1.0) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int path = 0; path < paths; ++path) {
        Interface face(keyword, spatial, props, thickness);
        for (int step = 0; step < 5; ++step) {
            Load load;
            for (const double size : scale) load.dstran.push_back(size * uniform(random) / thickness);
            const Answer a = face.point.evaluate(load);
            for (std::size_t j = 0; j < 3 && entry(a, STATUS) == 1.0; ++j) {
                double best = HUGE_VAL;
                for (const double relative : {1e-6, 1e-7}) {
                    const double h = relative * scale[0] / thickness;
                    Load plus = load, minus = load;
                    plus.dstran[j] += h;
                    minus.dstran[j] -= h;
                    const Answer up = face.point.evaluate(plus), down = face.point.evaluate(minus);
                    double error = 0.0;
                    for (std::size_t i = 0; i < 3; ++i)
                        error = std::max(
                            error, std::abs(a.tangent(int(i), int(j)) - (up.stress[i] - down.stress[i]) / (2 * h)));
                    best = std::min(best, error);
                }
                EXPECT_LT(best, 1e-6 * stiffness * thickness) << "path " << path << " step " << step << " column " << j;
            }
            face.point.advance(load);
        }
    }
}

// The sum of stored and released energy against the trapezoid sum of the work on a fine path, and how it converges.
inline void check_energy(const std::string& keyword, const Numbers& props, double un, double us, double tolerance) {
    double error[2];
    for (const int refinement : {0, 1}) {
        Interface face(keyword, spatial, props);
        const Numbers path[] = {{0, 0, 0},        {un, 0.5 * us, 0.1 * us},    {-0.02 * un, us, -0.8 * us},
                                {1.5 * un, 0, 0}, {-0.05 * un, -1.4 * us, us}, {0.3 * un, 1.6 * us, us}};
        const int steps = refinement == 0 ? 1000 : 2000;
        Answer a;
        for (std::size_t leg = 1; leg < std::size(path); ++leg)
            for (int i = 1; i <= steps; ++i) {
                Numbers u(3);
                for (std::size_t c = 0; c < 3; ++c)
                    u[c] = path[leg - 1][c] + (path[leg][c] - path[leg - 1][c]) * i / steps;
                a = face.to(u);
            }
        EXPECT_EQ(entry(a, STATUS), 1.0);
        EXPECT_NEAR(a.spd, entry(a, GI) + entry(a, GII) + entry(a, GDROP), 1e-12);
        error[refinement] = std::abs(entry(a, WORK) - (a.sse + a.spd)) / (a.sse + a.spd);
    }
    EXPECT_LT(error[1], tolerance);
    EXPECT_LT(error[1], 0.6 * error[0] + 1e-12);
}

// A VUMAT block with lanes on all branches against as many UMAT points.
inline void check_explicit(const std::string& keyword, const Numbers& props, double un, double us,
                           double tolerance = 1e-11) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (const AnalysisKind kind : {flat, spatial}) {
        constexpr std::size_t count = 37;
        VumatBlock block(keyword, kind, props);
        block.points.assign(count, block.fresh_point());
        std::vector<UmatPoint> points(count, UmatPoint(keyword, kind, props));
        for (int step = 0; step < 12; ++step) {
            for (std::size_t p = 0; p < count; ++p) {
                Numbers de = {un * (uniform(random) + 0.2), us * uniform(random)};
                if (kind == spatial) de.push_back(us * uniform(random));
                block.points[p].strain_increment = de;
                block.points[p].density = 2.0;
                points[p].advance({.dstran = de});
            }
            EXPECT_EQ(block.run().stops, 0);
            for (std::size_t p = 0; p < count; ++p) {
                const double size = 1.0 + largest(points[p].stress());
                EXPECT_LT(distance(points[p].stress(), block.points[p].stress), tolerance * size);
                EXPECT_LT(distance(points[p].state(), block.points[p].state), tolerance * size);
                EXPECT_NEAR(block.points[p].inelastic_energy, points[p].spd() / 2.0, tolerance);
            }
        }
    }
}

// Adaptive Lobatto quadrature with Kronrod's extension (Gander and Gautschi). The ends of a piece are nodes: a kink
// close to one of them does not go unseen. The first two levels are always divided.
template <class F>
double integral(const F& f, double from, double to, double f_from, double f_to, double tolerance, int depth) {
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from), a = std::sqrt(2.0 / 3.0) * half,
                 b = half / std::sqrt(5.0);
    const double x[] = {from, middle - a, middle - b, middle, middle + b, middle + a, to};
    double y[] = {f_from, f(x[1]), f(x[2]), f(x[3]), f(x[4]), f(x[5]), f_to};
    const double coarse = half / 6.0 * (y[0] + y[6] + 5.0 * (y[2] + y[4]));
    const double fine =
        half / 1470.0 * (77.0 * (y[0] + y[6]) + 432.0 * (y[1] + y[5]) + 625.0 * (y[2] + y[4]) + 672.0 * y[3]);
    if ((std::abs(fine - coarse) <= tolerance && depth <= 18) || depth == 0) return fine;
    double sum = 0.0;
    for (int i = 0; i < 6; ++i) sum += integral(f, x[i], x[i + 1], y[i], y[i + 1], tolerance, depth - 1);
    return sum;
}
template <class F>
double integral(const F& f, double from, double to, double tolerance) {
    return integral(f, from, to, f(from), f(to), tolerance, 20);
}

// A straight path at one of 19 mode ratios, s * direction, and what it releases until the zone fails. The reference is
// the work of each traction less what is stored: it uses nothing of the law but its tractions.
struct ModeRatio {
    Numbers direction;
    double end = 0.0;  // s at failure
    double GI = 0.0, GII = 0.0;

    // Where the path is after increment k of `steps`: small increments at both ends, the last one beyond failure. Where
    // a law ends in a double root, rounding moves the failure by the root of it.
    double at(int k, int steps) const {
        const double x = static_cast<double>(k) / steps;
        return (1.0 + 1e-7) * end * x * x * (3.0 - 2.0 * x);
    }
};
inline ModeRatio mode_ratio(const std::string& keyword, const Numbers& props, int i, double far) {
    const double angle = i * std::acos(0.0) / 18;
    ModeRatio path{{std::sin(angle), std::cos(angle)}};
    const Interface virgin(keyword, flat, props);
    const auto at = [&](double s) {
        return virgin.point.evaluate(virgin.load_to({s * path.direction[0], s * path.direction[1]}));
    };
    double sound = 0.0, failed = far;
    if (at(failed).state[STATUS - 1] != 0.0) ADD_FAILURE() << keyword << " does not fail at ratio " << i;
    for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (sound + failed);
        (at(middle).state[STATUS - 1] == 0.0 ? failed : sound) = middle;
    }
    path.end = failed;
    double released[2];
    for (const std::size_t mode : {std::size_t{0}, std::size_t{1}}) {
        // Both ends of the path may be steep.
        const auto work = [&](double x) {
            const double s = sound * x * x * (3.0 - 2.0 * x), slope = sound * 6.0 * x * (1.0 - x);
            return at(s).stress[mode] * path.direction[mode] * slope;
        };
        // Tractions may end like a root of the distance to failure: extrapolated from two states before.
        const double near = 1e-10, traction = 2.0 * at(path.end * (1.0 - near)).stress[mode] -
                                              at(path.end * (1.0 - 4.0 * near)).stress[mode];
        const double stored = 0.5 * traction * path.end * path.direction[mode];
        released[mode] = integral(work, 0.0, 1.0, 1e-12) - stored;
    }
    path.GI = released[0];
    path.GII = released[1];
    return path;
}
// The energies of a failure in `steps` increments.
inline Answer fail_along(const std::string& keyword, const Numbers& props, const ModeRatio& path, int steps) {
    Interface face(keyword, flat, props);
    Answer a;
    for (int k = 1; k <= steps; ++k) {
        const double s = path.at(k, steps);
        a = face.to({s * path.direction[0], s * path.direction[1]});
    }
    EXPECT_EQ(entry(a, STATUS), 0.0);
    return a;
}
// As a block of an explicit host, all mode ratios side by side.
inline void check_block_of_ratios(const std::string& keyword, const Numbers& props, const std::vector<ModeRatio>& paths,
                                  int steps, double tolerance) {
    VumatBlock block(keyword, flat, props);
    block.points.assign(paths.size(), block.fresh_point());
    for (int k = 1; k <= steps; ++k) {
        for (std::size_t i = 0; i < paths.size(); ++i) {
            const double ds = paths[i].at(k, steps) - paths[i].at(k - 1, steps);
            block.points[i].strain_increment = {ds * paths[i].direction[0], ds * paths[i].direction[1]};
        }
        EXPECT_EQ(block.run().stops, 0);
    }
    for (std::size_t i = 0; i < paths.size(); ++i) {
        EXPECT_EQ(block.points[i].state[STATUS - 1], 0.0);
        EXPECT_NEAR(block.points[i].state[GI - 1], paths[i].GI, tolerance) << i;
        EXPECT_NEAR(block.points[i].state[GII - 1], paths[i].GII, tolerance) << i;
    }
}

// Full mixed-mode failures at 19 mode ratios: what is released is the work of the tractions, whatever the increments,
// and meets (GI/GIc)^p + (GII/GIIc)^p = 1; an explicit host gets the same.
inline void check_failure_criterion(const std::string& keyword, const Numbers& props, double GIc, double GIIc,
                                    double power) {
    std::vector<ModeRatio> paths;
    for (int i = 0; i <= 18; ++i) {
        paths.push_back(mode_ratio(keyword, props, i, 1.0));
        const ModeRatio& path = paths.back();
        for (const int steps : {1, 100}) {
            const Answer a = fail_along(keyword, props, path, steps);
            EXPECT_NEAR(entry(a, GI), path.GI, 1e-9) << i << ", " << steps;
            EXPECT_NEAR(entry(a, GII), path.GII, 1e-9) << i << ", " << steps;
            EXPECT_NEAR(std::pow(entry(a, GI) / GIc, power) + std::pow(entry(a, GII) / GIIc, power), 1.0, 1e-12)
                << i << ", " << steps;
            EXPECT_NEAR(a.spd, entry(a, GI) + entry(a, GII) + entry(a, GDROP), 1e-14);
        }
    }
    check_block_of_ratios(keyword, props, paths, 100, 1e-9);
}

// What every one of them does with separations that are not numbers.
inline void check_nonsense(const std::string& keyword, const Numbers& props, const Numbers& separation) {
    Interface face(keyword, flat, props);
    face.to(separation);
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), HUGE_VAL, -HUGE_VAL}) {
        EXPECT_EQ(face.point.step({.dstran = {bad, 0}}).pnewdt, 0.25);
        EXPECT_EQ(face.point.step({.dstran = {0, bad}}).pnewdt, 0.25);
    }
}

}  // namespace lode::test::coh
