// Stiffness and expansion of an orthotropic material in the host's axes, condensed to a kind (page 10, sections 1.1,
// 1.2, 1.6; Nairn, eqs. 1.4-1.8, 1.12-1.15). Made once where the axes are constant, anew in each call where they turn.
#pragma once

#include "lode/elastic/orthotropic_moduli.hpp"
#include "lode/elastic/voigt_column.hpp"
#include "lode/material/point.hpp"

namespace lode {

// Free strain per unit of temperature or of a field variable, in material axes.
struct Expansion {
    std::array<double, 3> strain{}, stress{};  // alpha_i and C_ij alpha_j
    bool present = false;

    static Expansion from(const OrthotropicModuli& moduli, double a1, double a2, double a3) {
        Expansion e;
        e.strain = {a1, a2, a3};
        e.present = a1 != 0.0 || a2 != 0.0 || a3 != 0.0;
        for (int i = 0; i < 3; ++i)
            e.stress[static_cast<std::size_t>(i)] =
                moduli.stiffness(i, 0) * a1 + moduli.stiffness(i, 1) * a2 + moduli.stiffness(i, 2) * a3;
        return e;
    }
};

namespace rotated_moduli_detail {

// Components 11, 22, 33, 12[, 13, 23] in one vector where that is a hardware one.
template <AnalysisKind full, class Real>
using Components =
    std::conditional_t<std::is_same_v<Real, double>, Column<components(full)>, Vector<Real, components(full)>>;

inline constexpr int first_index[] = {0, 1, 2, 0, 0, 1}, second_index[] = {0, 1, 2, 1, 2, 2};

// Stress-like components of the dyads of the axes m_a (columns of R): m_a m_a^T, and m_a m_b^T + m_b m_a^T in the order
// 12, 13, 23.
template <AnalysisKind full, class Real>
struct Dyads {
    static constexpr int n = components(full);  // 6 or 4
    Components<full, Real> normal[3], shear[3];

    LODE_INLINE explicit Dyads(const Matrix3<Real>& r) {
        if constexpr (std::is_same_v<Real, double>) {
            Column<n> first[3], second[3];
            for (int a = 0; a < 3; ++a) {
                const ColumnOf4 axis = {r(0, a), r(1, a), r(2, a), 0.0};
                if constexpr (full == AnalysisKind::solid) {
                    first[a] = __builtin_shufflevector(axis, axis, 0, 1, 2, 0, 0, 1, 3, 3);
                    second[a] = __builtin_shufflevector(axis, axis, 0, 1, 2, 1, 2, 2, 3, 3);
                } else {
                    first[a] = __builtin_shufflevector(axis, axis, 0, 1, 2, 0);
                    second[a] = __builtin_shufflevector(axis, axis, 0, 1, 2, 1);
                }
            }
            for (int a = 0; a < 3; ++a) {
                normal[a] = first[a] * second[a];
                const int i = first_index[3 + a], j = second_index[3 + a];
                shear[a] = first[i] * second[j] + first[j] * second[i];
            }
        } else {
            for (int k = 0; k < n; ++k) {
                const int i = first_index[k], j = second_index[k];
                for (int a = 0; a < 3; ++a) {
                    normal[a][k] = r(i, a) * r(j, a);
                    const int p = first_index[3 + a], q = second_index[3 + a];
                    shear[a][k] = r(i, p) * r(j, q) + r(i, q) * r(j, p);
                }
            }
        }
    }
};

}  // namespace rotated_moduli_detail

template <AnalysisKind kind, class Real>
struct RotatedModuli {
    static constexpr int n = components(kind), normals = normal_components(kind);
    static constexpr int padding = kind == AnalysisKind::solid ? 2 : kind == AnalysisKind::plane_stress ? 1 : 0;

    Matrix3<Real> axes;  // R: columns are the material axes
    // C (plane stress: Q = (S_ab)^-1, 1D: 1/S11), column by column, with room to read the last as a whole vector.
    std::array<Real, static_cast<std::size_t>(n* n + padding)> stiffness;
    Vector<Real, n> thermal, moisture;  // C alpha, C beta: minus the stress per unit at fixed strain
    // Plane stress: eps33 = lateral . eps + lateral_thermal T + lateral_moisture c + thickness_compliance sigma33
    Vector<Real, n> lateral;
    Real lateral_thermal, lateral_moisture, thickness_compliance;

    LODE_INLINE const Real& operator()(int i, int j) const { return stiffness[static_cast<std::size_t>(i + n * j)]; }

    RotatedModuli() = default;
    // Expansions that are not present are not rotated.
    LODE_INLINE RotatedModuli(const OrthotropicModuli& m, const Matrix3<Real>& r, const Expansion& heat,
                              const Expansion& moist)
        : axes(r) {
        if constexpr (kind == AnalysisKind::uniaxial) set_uniaxial(m, heat, moist);
        else set(m, heat, moist);
    }
    // Constants for an update on numbers that carry derivatives.
    template <class Other>
    explicit RotatedModuli(const RotatedModuli<kind, Other>& c) {
        for (std::size_t i = 0; i < 9; ++i) axes.m[i] = Real(c.axes.m[i]);
        for (std::size_t i = 0; i < stiffness.size(); ++i) stiffness[i] = Real(c.stiffness[i]);
        for (int i = 0; i < n; ++i) {
            thermal[i] = Real(c.thermal[i]), moisture[i] = Real(c.moisture[i]);
            if constexpr (kind == AnalysisKind::plane_stress) lateral[i] = Real(c.lateral[i]);
        }
        if constexpr (kind == AnalysisKind::plane_stress) {
            lateral_thermal = Real(c.lateral_thermal), lateral_moisture = Real(c.lateral_moisture);
            thickness_compliance = Real(c.thickness_compliance);
        }
    }

    // C eps; along the host's axes C couples no normal component with a shear.
    template <bool along_host = false, class Number>
    LODE_INLINE Stress<kind, Number> stress(const Strain<kind, Number>& e) const {
        Stress<kind, Number> s;
        if constexpr (std::is_same_v<Number, double> && n > 1) {
            // Two sums: the latency of one chain would be felt.
            Column<n> sum = column(0) * e[0], other = column(1) * e[1];
            for (int j = 2; j < n; ++j) (j % 2 == 0 ? sum : other) += column(j) * e[j];
            sum += other;
            for (int i = 0; i < n; ++i) s[i] = sum[i];
        } else {
            for (int i = 0; i < n; ++i) {
                Number sum = (*this)(i, i) * e[i];
                for (int j = 0; j < n; ++j)
                    if (i != j && !(along_host && (i >= normals || j >= normals))) sum = sum + (*this)(i, j) * e[j];
                s[i] = sum;
            }
        }
        return s;
    }
    LODE_INLINE void store(Tangent<kind>& tangent) const {
        if constexpr (n == 1) tangent(0, 0) = stiffness[0];
        else
            for (int j = 0; j < n; ++j) store_column<n>(tangent.stiffness, j, column(j));
    }
    // Column j as a hardware vector.
    LODE_INLINE Column<n> column(int j) const {
        Column<n> c;
        std::memcpy(&c, stiffness.data() + n * j, sizeof c);
        return c;
    }

  private:
    // C = sum_ab C_ab (m_a m_a) (x) (m_b m_b) + sum_ab G_ab (m_a m_b + m_b m_a) (x) (m_a m_b + m_b m_a)
    LODE_INLINE void set(const OrthotropicModuli& m, const Expansion& heat, const Expansion& moist) {
        using namespace rotated_moduli_detail;
        constexpr AnalysisKind full = kind == AnalysisKind::solid ? kind : AnalysisKind::plane_strain;
        const Dyads<full, Real> d(axes);
        Components<full, Real> row[3], c[components(full)];
        for (int a = 0; a < 3; ++a)
            row[a] =
                m.stiffness(a, 0) * d.normal[0] + m.stiffness(a, 1) * d.normal[1] + m.stiffness(a, 2) * d.normal[2];
        for (int j = 0; j < components(full); ++j) {
            c[j] = d.normal[0][j] * row[0] + d.normal[1][j] * row[1] + d.normal[2][j] * row[2];
            for (int a = 0; a < 3; ++a)
                c[j] = c[j] + (m.shear[static_cast<std::size_t>(a)] * d.shear[a][j]) * d.shear[a];
        }
        const auto stress_of = [&](const Expansion& e, Components<full, Real>& t) {
            t = e.stress[0] * d.normal[0] + e.stress[1] * d.normal[1] + e.stress[2] * d.normal[2];
        };
        if constexpr (kind == AnalysisKind::plane_stress) {
            // eps33 is eliminated from the (3,1) law.
            constexpr int in_plane[] = {0, 1, 3};
            thickness_compliance = 1.0 / c[2][2];
            for (int i = 0; i < n; ++i) lateral[i] = -(thickness_compliance * c[2][in_plane[i]]);
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i)
                    stiffness[static_cast<std::size_t>(i + n * j)] =
                        c[in_plane[j]][in_plane[i]] + lateral[i] * c[in_plane[j]][2];
            const auto condense = [&](const Expansion& e, Vector<Real, n>& target, Real& change) {
                if (!e.present) {
                    target.v.fill(Real(0.0)), change = Real(0.0);
                    return;
                }
                Components<full, Real> t;
                stress_of(e, t);
                for (int i = 0; i < n; ++i) target[i] = t[in_plane[i]] + lateral[i] * t[2];
                change = thickness_compliance * t[2];
            };
            condense(heat, thermal, lateral_thermal);
            condense(moist, moisture, lateral_moisture);
        } else {
            for (int j = 0; j < n; ++j) {
                if constexpr (std::is_same_v<Real, double>) store_column<n>(stiffness.data(), j, c[j]);
                else
                    for (int i = 0; i < n; ++i) stiffness[static_cast<std::size_t>(i + n * j)] = c[j][i];
            }
            const auto keep = [&](const Expansion& e, Vector<Real, n>& target) {
                if (!e.present) return target.v.fill(Real(0.0));
                Components<full, Real> t;
                stress_of(e, t);
                for (int i = 0; i < n; ++i) target[i] = t[i];
            };
            keep(heat, thermal);
            keep(moist, moisture);
        }
    }

    // S11 = sum_ab S_ab R_1a^2 R_1b^2 + sum_ab (R_1a R_1b)^2/G_ab
    LODE_INLINE void set_uniaxial(const OrthotropicModuli& m, const Expansion& heat, const Expansion& moist) {
        using namespace rotated_moduli_detail;
        Real compliance = Real(0.0), alpha = Real(0.0), beta = Real(0.0);
        for (int a = 0; a < 3; ++a) {
            const Real square_a = axes(0, a) * axes(0, a);
            for (int b = 0; b < 3; ++b)
                compliance = compliance + m.compliance(a, b) * square_a * (axes(0, b) * axes(0, b));
            const Real product = axes(0, first_index[3 + a]) * axes(0, second_index[3 + a]);
            const auto k = static_cast<std::size_t>(a);
            compliance = compliance + product * product / m.shear[k];
            alpha = alpha + heat.strain[k] * square_a;
            beta = beta + moist.strain[k] * square_a;
        }
        stiffness[0] = 1.0 / compliance;
        thermal[0] = alpha * stiffness[0];
        moisture[0] = beta * stiffness[0];
    }
};

// sigma : S : sigma/2 of a stress in host axes, by its components in material axes.
class ElasticEnergy {
  public:
    explicit ElasticEnergy(const OrthotropicModuli& m) {
        for (std::size_t j = 0; j < 3; ++j) {
            compliance_[j] = {};
            for (std::size_t i = 0; i < 3; ++i)
                compliance_[j][i] = m.compliance(static_cast<int>(i), static_cast<int>(j));
        }
        compliance_[3] = {0.0, 0.0, 0.0, 1.0 / m.shear[0], 1.0 / m.shear[1], 1.0 / m.shear[2], 0.0, 0.0};
    }

    // `axes` as in RotatedModuli, `out_of_plane` is sigma33 of plane stress.
    template <AnalysisKind kind, class Real, class Number>
    LODE_INLINE Real operator()(const Matrix3<Number>& axes, const Stress<kind, Real>& s,
                                const Real& out_of_plane) const {
        using namespace rotated_moduli_detail;
        constexpr AnalysisKind solid = AnalysisKind::solid;
        constexpr int n = normal_components(kind);
        // What the host's dyads are in material axes.
        const Dyads<solid, Number> host(transpose(axes));
        const Real& s33 = [&]() -> const Real& {
            if constexpr (kind == AnalysisKind::plane_stress) return out_of_plane;
            else return s[2];
        }();
        // Sums in pairs: the latency of a chain would be felt.
        Components<solid, Real> t =
            (s[0] * host.normal[0] + s[1] * host.normal[1]) + (s33 * host.normal[2] + s[n] * host.shear[0]);
        if constexpr (kind == solid) t = t + (s[4] * host.shear[1] + s[5] * host.shear[2]);
        if constexpr (std::is_same_v<Real, double>) {
            ColumnOf8 column[4];
            std::memcpy(column, compliance_, sizeof column);
            const ColumnOf8 twice = t * ((column[3] * t + t[0] * column[0]) + (t[1] * column[1] + t[2] * column[2]));
            return 0.5 * (((twice[0] + twice[1]) + (twice[2] + twice[3])) + (twice[4] + twice[5]));
        } else {
            Real twice = Real(0.0);
            for (int i = 0; i < 6; ++i) {
                const auto k = static_cast<std::size_t>(i);
                Real strain = compliance_[3][k] * t[i];
                for (int j = 0; j < 3; ++j) strain = strain + compliance_[static_cast<std::size_t>(j)][k] * t[j];
                twice = twice + strain * t[i];
            }
            return 0.5 * twice;
        }
    }

  private:
    std::array<double, 8> compliance_[4];  // columns of the normal block; the shear compliances in their places
};

}  // namespace lode
