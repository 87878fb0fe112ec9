// What the tests of the hyperelastic solids share: deformations, the dilatational energies, and what each of the laws
// has to do whatever its formula.
#pragma once

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "finite_strain.hpp"
#include "vumat_block.hpp"

namespace lode::test {

inline Matrix3d matrix(double a11, double a12, double a13, double a21, double a22, double a23, double a31, double a32,
                       double a33) {
    Matrix3d m;
    m << a11, a12, a13, a21, a22, a23, a31, a32, a33;
    return m;
}
inline Matrix3d diagonal(double a, double b, double c) { return diagonal_gradient(a, b, c); }
inline const Matrix3d general = matrix(1.3, 0.2, -0.1, 0.15, 0.85, 0.25, -0.3, 0.1, 1.1);
inline Matrix3d without_out_of_plane_shear(Matrix3d f) {
    f(0, 2) = f(1, 2) = f(2, 0) = f(2, 1) = 0;
    return f;
}

// U with modulus k: 0 k/2 ((J^2 - 1)/2 - ln J), 1 k/2 (J - 1)^2, 2 k/2 (ln J)^2.
struct DilatationalEnergies {
    double modulus;
    double energy(int option, double J) const {
        if (option == 0) return modulus / 2 * ((J * J - 1) / 2 - std::log(J));
        return modulus / 2 * std::pow(option == 1 ? J - 1 : std::log(J), 2);
    }
    double derivative(int option, double J) const {
        if (option == 0) return modulus * (J * J - 1) / (2 * J);
        return option == 1 ? modulus * (J - 1) : modulus * std::log(J) / J;
    }
    double second_derivative(int option, double J) const {
        if (option == 0) return modulus * (1 + 1 / (J * J)) / 2;
        return option == 1 ? modulus : modulus * (1 - std::log(J)) / (J * J);
    }
};

struct HyperelasticModel {
    std::string name;
    std::function<Numbers(int uj, double alpha, double beta)> constants;
    double stiffness;       // what stresses are compared with
    std::size_t thickness;  // index of F33 - 1 in STATEV, from 0; what comes before is residual strain
    // Rounding of B - I is of the order of epsilon however small B is: near zero volume the stress has an error of a
    // few epsilon times stiffness J^-loss.
    double loss = 1.0;
    std::vector<int> options = {0, 1, 2};
    std::vector<AnalysisKind> kinds = {AnalysisKind::solid, AnalysisKind::plane_strain, AnalysisKind::plane_stress};

    UmatPoint point(AnalysisKind kind, int uj, double alpha = 0.0, double beta = 0.0) const {
        return UmatPoint(name, kind, constants(uj, alpha, beta));
    }
    Answer at(AnalysisKind kind, int uj, const Matrix3d& f) const { return point(kind, uj).advance({.dfgrd1 = f}); }
    Matrix3d fitting(AnalysisKind kind, const Matrix3d& f) const {
        return kind == AnalysisKind::solid ? f : without_out_of_plane_shear(f);
    }
};

// VUMAT at U is UMAT at F = U: stress, state, energy and thickness strain.
inline void expect_explicit_is_implicit(const HyperelasticModel& model, const Matrix3d& stretch,
                                        double relative = 1e-14) {
    for (const AnalysisKind kind : model.kinds)
        for (const int uj : model.options) {
            const Matrix3d u = model.fitting(kind, stretch);
            VumatBlock block(model.name, kind, model.constants(uj, 1e-3, 1e-2));
            for (int p = 0; p < 19; ++p) {
                VumatPoint point = block.fresh_point();
                point.stretch = Matrix3d::Identity() + (u - Matrix3d::Identity()) * (p / 18.0);
                point.temperature_new = 10.0;
                point.fields_new = {0.5};
                point.density = 2.0;
                block.points.push_back(point);
            }
            const auto before = block.points;
            EXPECT_EQ(block.run().stops, 0);
            for (std::size_t p = 0; p < block.points.size(); ++p) {
                const VumatPoint& point = block.points[p];
                const Answer a = model.point(kind, uj, 1e-3, 1e-2)
                                     .advance({.dtemp = 10.0, .dpred = {0.5}, .dfgrd1 = before[p].stretch});
                EXPECT_LE(distance(point.stress, a.stress), relative * model.stiffness);
                for (std::size_t i = 0; i < model.thickness; ++i) EXPECT_NEAR(point.state[i], a.state[i], 1e-17);
                EXPECT_NEAR(point.state[model.thickness], a.state[model.thickness], 4e-15);
                EXPECT_NEAR(point.internal_energy, a.sse / 2.0, relative * model.stiffness);
                if (kind == AnalysisKind::plane_stress) {
                    EXPECT_NEAR(point.thickness_strain_increment, std::log1p(a.state[model.thickness]), 1e-14);
                }
            }
        }
}

inline void expect_inverted_point_is_named(const HyperelasticModel& model) {
    VumatBlock block(model.name, AnalysisKind::solid, model.constants(0, 0, 0));
    block.points.assign(21, block.fresh_point());
    block.points[18].stretch = diagonal(-0.1, 1, 1);
    const HostMessages messages = block.run();
    ASSERT_EQ(messages.errors.size(), 1u);
    EXPECT_NE(messages.errors[0].find("det F <= 0"), std::string::npos) << messages.errors[0];
    EXPECT_NE(messages.errors[0].find("point 19"), std::string::npos) << messages.errors[0];
}

inline void expect_impossible_deformations_cut(const HyperelasticModel& model) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = HUGE_VAL;
    for (const AnalysisKind kind : model.kinds)
        for (const int uj : model.options) {
            for (const Matrix3d& f :
                 {diagonal(-1, 1, 1), diagonal(0, 1, 1), diagonal(-1, -1, -1), matrix(0, 1, 0, 1, 0, 0, 0, 0, 1)}) {
                if (kind == AnalysisKind::plane_stress && f(2, 2) < 0) continue;
                const Answer a = model.point(kind, uj).step({.dfgrd1 = f});
                EXPECT_TRUE(a.cut);
                EXPECT_EQ(a.pnewdt, 0.25);
            }
            const int size = kind == AnalysisKind::solid ? 3 : 2;
            for (const double bad : {nan, inf, -inf, 1e200})
                for (int i = 0; i < size; ++i)
                    for (int j = 0; j < size; ++j) {
                        Matrix3d f = general;
                        f(i, j) = bad;
                        EXPECT_TRUE(model.point(kind, uj).step({.dfgrd1 = f}).cut) << i << j << bad;
                    }
            EXPECT_TRUE(model.point(kind, uj, 1e-5).step({.dtemp = 1e12, .dfgrd1 = general}).cut);
        }
}

// (J+ sigma+ - J- sigma-)/(2 h J) for F <- (I +- h sym(e_k e_l)) F; DDSDDT the same way.
inline void expect_tangent_of_differences(const HyperelasticModel& model, const Matrix3d& deformation,
                                          double dtemp = 40.0) {
    constexpr double h = 1e-6;
    for (const AnalysisKind kind : model.kinds)
        for (const int uj : model.options) {
            const Matrix3d f = model.fitting(kind, deformation);
            const auto at = [&](const Matrix3d& deformed, double heat) {
                return model.point(kind, uj, 1e-3).advance({.dtemp = heat, .dfgrd1 = deformed});
            };
            const auto kirchhoff = [&](const Matrix3d& deformed) {
                const Answer a = at(deformed, dtemp);
                double J = deformed.determinant();
                if (kind == AnalysisKind::plane_stress)
                    J = deformed.topLeftCorner<2, 2>().determinant() * (1 + a.state[model.thickness]);
                Numbers tau = a.stress;
                for (double& t : tau) t *= J;
                return std::pair(tau, J);
            };
            const Answer a = at(f, dtemp);
            const double J = kirchhoff(f).second;
            for (int column = 0; column < components(kind); ++column) {
                Numbers unit(static_cast<std::size_t>(components(kind)), 0.0);
                unit[static_cast<std::size_t>(column)] = h;
                const Matrix3d d = strain_tensor(unit, kind);
                const Numbers plus = kirchhoff((Matrix3d::Identity() + d) * f).first;
                const Numbers minus = kirchhoff((Matrix3d::Identity() - d) * f).first;
                for (int row = 0; row < components(kind); ++row)
                    EXPECT_NEAR(a.tangent(row, column),
                                (plus[std::size_t(row)] - minus[std::size_t(row)]) / (2 * h * J),
                                1e-8 * a.tangent.cwiseAbs().maxCoeff());
            }
            for (std::size_t i = 0; i < a.stress.size(); ++i)
                EXPECT_NEAR(a.ddsddt[i], (at(f, dtemp + 0.01).stress[i] - at(f, dtemp - 0.01).stress[i]) / 0.02,
                            1e-11 * std::max(model.stiffness, largest(a.stress)));
        }
}

// The law has no integration error.
inline void expect_no_integration_error(const HyperelasticModel& model, const Matrix3d& in_plane) {
    for (const AnalysisKind kind : model.kinds) {
        const int uj = model.options.back();
        UmatPoint many = model.point(kind, uj, 1e-3);
        Answer last;
        for (int i = 1; i <= 64; ++i)
            last = many.advance(
                {.dtemp = 100.0 / 64,
                 .dfgrd1 = Matrix3d(Matrix3d::Identity() + (in_plane - Matrix3d::Identity()) * (i / 64.0))});
        const Answer one = model.point(kind, uj, 1e-3).advance({.dtemp = 100.0, .dfgrd1 = in_plane});
        EXPECT_LE(distance(one.stress, last.stress), 1e-13 * model.stiffness);
        EXPECT_NEAR(one.state[model.thickness], last.state[model.thickness], 1e-14);
    }
}

// Plane strain is the solid, and what a kind does not have is not read.
inline void expect_plane_kinds_read_the_plane(const HyperelasticModel& model) {
    for (const int uj : model.options) {
        const Matrix3d zeroed = without_out_of_plane_shear(general);
        const auto same = [&](AnalysisKind kind, const Matrix3d& f) {
            EXPECT_TRUE(identical(model.at(kind, uj, f).stress, model.at(kind, uj, zeroed).stress));
        };
        Matrix3d f = general;
        same(AnalysisKind::plane_strain, f);
        f(2, 2) = f(0, 2) = 1e300;
        same(AnalysisKind::plane_stress, f);
        const Answer full = model.at(AnalysisKind::solid, uj, zeroed),
                     plane = model.at(AnalysisKind::plane_strain, uj, zeroed);
        expect_close({full.stress[0], full.stress[1], full.stress[2], full.stress[3]}, plane.stress, 1e-14);
        EXPECT_LE((full.tangent.topLeftCorner(4, 4) - plane.tangent).cwiseAbs().maxCoeff(), 2e-14 * model.stiffness);
    }
}

// --- accuracy of an isotropic law --------------------------------------------------------------------------------

using Long = long double;
using LongVector = Eigen::Matrix<Long, 3, 1>;
// Principal Cauchy stresses of principal stretches.
using PrincipalLaw = std::function<LongVector(const LongVector& stretches, int uj)>;

// The law of F with twice the digits that it takes: Cauchy stress in long double.
inline Matrix3d reference_stress(const PrincipalLaw& law, const Matrix3d& f, int uj) {
    using LongMatrix = Eigen::Matrix<Long, 3, 3>;
    const LongMatrix F = f.cast<Long>();
    const Eigen::SelfAdjointEigenSolver<LongMatrix> b(F * F.transpose());
    const LongVector stretches = b.eigenvalues().cwiseSqrt();
    const LongMatrix sigma = b.eigenvectors() * law(stretches, uj).asDiagonal() * b.eigenvectors().transpose();
    return sigma.cast<double>();
}
inline Matrix3d turn(double angle) {
    return Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, -1.5).normalized()).toRotationMatrix();
}

// Equal and nearly equal stretches, volumes near 0 and stretches up to 10, all of them in oblique axes. The relative
// error of the stress is that of a few roundings of F, which the law amplifies by its stiffness over the stress.
inline void expect_accurate_stress(const HyperelasticModel& model, const PrincipalLaw& law) {
    std::vector<Eigen::Vector3d> stretches = {{10, 10, 10},   {10, 0.1, 1},       {10, 10, 0.1},
                                              {0.1, 0.1, 10}, {0.1, 0.1, 0.1},    {1e-3, 1, 1},
                                              {1e-3, 10, 1},  {0.01, 0.01, 0.01}, {0.05, 0.05, 8}};
    for (const double l : {0.2, 0.9, 1.0, 1.7, 10.0})
        for (const double d : {0.0, 3e-16, 1e-14, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4})
            stretches.insert(stretches.end(), {{l, l * (1 + d), l * (1 - d)}, {l, l * (1 + d), 0.7 * l}});
    for (const Eigen::Vector3d& l : stretches)
        for (const int uj : model.options) {
            const Matrix3d f = turn(0.7) * l.asDiagonal() * turn(-1.9).transpose();
            const Answer a = model.at(AnalysisKind::solid, uj, f);
            const Matrix3d exact = reference_stress(law, f, uj);
            // d sigma of a relative change of F by a rounding of its largest entry
            const double amplification = a.tangent.cwiseAbs().maxCoeff() * l.maxCoeff() / l.minCoeff();
            const double lost = model.stiffness * std::max(1.0, std::pow(l.prod(), -model.loss));
            const double rounding =
                8 * std::numeric_limits<double>::epsilon() * (amplification + exact.cwiseAbs().maxCoeff() + lost);
            EXPECT_LE((stress_tensor(a.stress, AnalysisKind::solid) - exact).cwiseAbs().maxCoeff(), rounding)
                << l.transpose() << ", UJ " << uj;
        }
}

// Infinitesimal general strain: Hooke's law to the order of the strain, so no digit is lost although F holds only a
// few.
inline void expect_hooke_at_tiny_strains(const HyperelasticModel& model, const Eigen::Matrix<double, 6, 6>& stiffness) {
    const Matrix3d h = matrix(0.7, 0.4, -0.3, -0.2, -0.5, 0.6, 0.1, -0.8, 0.9);
    for (const double size : {1e-9, 1e-10, 1e-11, 1e-12}) {
        const Matrix3d f = Matrix3d::Identity() + size * h, held = f - Matrix3d::Identity();
        const Numbers strain = to_components(0.5 * (held + held.transpose()), AnalysisKind::solid, 2.0);
        const Eigen::Matrix<double, 6, 1> hooke =
            stiffness * Eigen::Map<const Eigen::Matrix<double, 6, 1>>(strain.data());
        for (const int uj : model.options) {
            const Answer a = model.at(AnalysisKind::solid, uj, f);
            for (int i = 0; i < 6; ++i)
                EXPECT_NEAR(a.stress[std::size_t(i)], hooke[i], (20 * size + 4e-15) * hooke.cwiseAbs().maxCoeff())
                    << "strain " << size << ", component " << i + 1;
        }
    }
}
inline Eigen::Matrix<double, 6, 6> isotropic_stiffness(double lambda, double shear) {
    Eigen::Matrix<double, 6, 6> c = Eigen::Matrix<double, 6, 6>::Zero();
    c.topLeftCorner<3, 3>().setConstant(lambda);
    c.diagonal() << lambda + 2 * shear, lambda + 2 * shear, lambda + 2 * shear, shear, shear, shear;
    return c;
}

// Five turns in large steps: the stress turns along, the energy stays, to rounding at every angle.
inline void expect_objective_over_turns(const HyperelasticModel& model) {
    for (const int uj : model.options) {
        UmatPoint point = model.point(AnalysisKind::solid, uj);
        const Answer start = point.advance({.dfgrd1 = general});
        const Matrix3d sigma = stress_tensor(start.stress, AnalysisKind::solid);
        const int steps = 5 * 24;
        for (int i = 1; i <= steps; ++i) {
            const Matrix3d q = turn(10 * M_PI * i / steps), q_old = turn(10 * M_PI * (i - 1) / steps);
            const Answer a = point.advance({.dfgrd1 = q * general, .drot = q * q_old.transpose()});
            EXPECT_LE((stress_tensor(a.stress, AnalysisKind::solid) - q * sigma * q.transpose()).cwiseAbs().maxCoeff(),
                      2e-14 * model.stiffness);
            EXPECT_NEAR(a.sse, start.sse, 1e-14 * model.stiffness);
        }
    }
}

// Simple shear and its transpose have different stresses: DFGRD1 comes in Fortran order.
inline void expect_fortran_order(const HyperelasticModel& model, const PrincipalLaw& law) {
    for (const int uj : model.options)
        for (const Matrix3d& f : {simple_shear(0.4), Matrix3d(simple_shear(0.4).transpose())}) {
            const Answer a = model.at(AnalysisKind::solid, uj, f);
            const Matrix3d exact = reference_stress(law, f, uj);
            EXPECT_LE((stress_tensor(a.stress, AnalysisKind::solid) - exact).cwiseAbs().maxCoeff(),
                      1e-14 * model.stiffness);
            EXPECT_GT(std::abs(a.stress[0] - a.stress[1]), 1e-3 * model.stiffness);
            EXPECT_EQ(a.stress[0] > a.stress[1], f(0, 1) > 0) << "the longer side is direction 1";
        }
}

}  // namespace lode::test
