// Material axes of HILL_PLASTIC in the host's: R = Q R0, where Q is what the host has turned so far (page 20, section
// 5). Q itself is kept in STATEV, row by row; all zero means I. An explicit host and one that keeps stress in the
// unrotated frame need no Q: R = R0 there.
#pragma once

#include <variant>

#include "lode/elastic/material_axes.hpp"
#include "lode/elastic/rotated_moduli.hpp"

namespace lode {

// Turns six components between material and host: sigma_host = sum of sigma_a times the dyads of the axes, as hardware
// vectors.
class VoigtRotation {
  public:
    VoigtRotation() = default;  // not set
    LODE_INLINE explicit VoigtRotation(const Matrix3<double>& r) {
        set(r, to_host_);
        set(transpose(r), to_material_);
    }
    using S = Stress<AnalysisKind::solid, double>;
    using E = Strain<AnalysisKind::solid, double>;
    LODE_INLINE S to_host(const S& s) const { return turned(to_host_, s, 1.0); }
    LODE_INLINE E to_host(const E& e) const { return turned(to_host_, e, 0.5); }
    LODE_INLINE S to_material(const S& s) const { return turned(to_material_, s, 1.0); }
    LODE_INLINE E to_material(const E& e) const { return turned(to_material_, e, 0.5); }
    // T D T^T in place.
    LODE_INLINE void turn(double* D) const {
        Column<n> product[n];
        for (int j = 0; j < n; ++j) {
            Column<n> sum = column(to_host_, 0) * D[n * j], other = column(to_host_, 1) * D[n * j + 1];
            for (int i = 2; i < n; ++i) (i % 2 == 0 ? sum : other) += column(to_host_, i) * D[n * j + i];
            product[j] = sum + other;
        }
        for (int c = 0; c < n; ++c) {
            Column<n> sum = product[0] * to_host_[0][c], other = product[1] * to_host_[1][c];
            for (int j = 2; j < n; ++j) (j % 2 == 0 ? sum : other) += product[j] * to_host_[j][c];
            store_column<n>(D, c, sum + other);
        }
    }

  private:
    static constexpr int n = components(AnalysisKind::solid), padded = sizeof(Column<n>) / sizeof(double);
    using Columns = double[n][padded];
    Columns to_host_, to_material_;

    LODE_INLINE static void set(const Matrix3<double>& r, Columns& columns) {
        const rotated_moduli_detail::Dyads<AnalysisKind::solid, double> d(r);
        for (int a = 0; a < 3; ++a) {
            std::memcpy(columns[a], &d.normal[a], sizeof d.normal[a]);
            std::memcpy(columns[3 + a], &d.shear[a], sizeof d.shear[a]);
        }
    }
    LODE_INLINE static Column<n> column(const Columns& columns, int i) {
        Column<n> c;
        std::memcpy(&c, columns[i], sizeof c);
        return c;
    }
    // `shear`: a tensor's shear per component.
    template <class V>
    LODE_INLINE static V turned(const Columns& columns, const V& x, double shear) {
        Column<n> sum = column(columns, 0) * x[0], other = column(columns, 3) * (shear * x[3]);
        for (int i = 1; i < 3; ++i) {
            sum += column(columns, i) * x[i];
            other += column(columns, 3 + i) * (shear * x[3 + i]);
        }
        sum += other;
        V result;
        for (int i = 0; i < n; ++i) result[i] = i < 3 ? sum[i] : sum[i] * (1.0 / shear);
        return result;
    }
};

// Axes of a material with what turns to them.
struct TurnedAxes : MaterialAxes {
    bool are_host = true;
    VoigtRotation rotation;

    TurnedAxes() = default;
    explicit TurnedAxes(const MaterialAxes& axes)
        : MaterialAxes(axes), are_host(r.m == Matrix3<double>::identity().m), rotation(r) {}
};

template <AnalysisKind kind, class Real>
struct MaterialFrame {
    static constexpr bool in_vectors = kind == AnalysisKind::solid && std::is_same_v<Real, double>;

    bool is_turned = false;  // the axes are not those of the host
    bool is_kept = false;    // Q belongs into STATEV
    Matrix3<Real> R, Q;
    const VoigtRotation* rotation = nullptr;  // `in_vectors`: of R
    std::conditional_t<in_vectors, VoigtRotation, std::monostate> own_rotation;

    // At the end of the increment: Q <- DROT Q.
    LODE_INLINE void set(const Increment<kind, Real>& increment, const State<Real>& state, int first,
                         const TurnedAxes& axes) {
        for (std::size_t i = 0; i < 9; ++i) R.m[i] = Real(axes.r.m[i]);
        is_turned = !axes.are_host;
        rotation = &axes.rotation;
        if constexpr (!is_batch<Real>) {
            if (!increment.has_rotation()) return;
            bool is_zero = true, is_identity = true;
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) {
                    Q(i, j) = state[first + 3 * i + j];
                    is_zero = is_zero && Q(i, j) == Real(0.0);
                    is_identity = is_identity && Q(i, j) == Real(i == j ? 1.0 : 0.0);
                }
            is_kept = true;
            if (is_zero) Q = Matrix3<Real>::identity();
            const bool turns = increment.turns();
            if (turns) Q = increment.rotation() * Q;
            if (turns || !(is_zero || is_identity)) {
                R = Q * R;
                is_turned = true;
                if constexpr (in_vectors) {
                    own_rotation = VoigtRotation(R);
                    rotation = &own_rotation;
                }
            }
        }
    }

    template <class V>
    LODE_INLINE V to_material(const V& x) const {
        if (!is_turned) return x;
        if constexpr (in_vectors) return rotation->to_material(x);
        else return rotate(x, transpose(R));
    }
    template <class V>
    LODE_INLINE V to_host(const V& x) const {
        if (!is_turned) return x;
        if constexpr (in_vectors) return rotation->to_host(x);
        else return rotate(x, R);
    }

    // D_host = T^T D T of eps_material = T eps_host, and DDSDDT, DRPLDE with it.
    LODE_INLINE void turn(Tangent<kind>& tangent) const {
        if constexpr (std::is_same_v<Real, double>) {
            if (!is_turned) return;
            constexpr int n = components(kind);
            if constexpr (in_vectors) {
                rotation->turn(tangent.stiffness);
            } else {
                VoigtMatrix<kind, double> d;
                std::copy_n(tangent.stiffness, n * n, d.m.begin());
                d = rotate_stiffness<kind>(d, R);
                std::copy_n(d.m.begin(), n * n, tangent.stiffness);
            }
            Stress<kind, double> by_temperature, heat;
            for (int i = 0; i < n; ++i)
                by_temperature[i] = tangent.thermal_stress[i], heat[i] = tangent.heat_rate_strain[i];
            by_temperature = to_host(by_temperature);
            heat = to_host(heat);
            for (int i = 0; i < n; ++i)
                tangent.thermal_stress[i] = by_temperature[i], tangent.heat_rate_strain[i] = heat[i];
        }
    }

    LODE_INLINE void store(State<Real>& state, int first) const {
        for (int i = 0; i < 9; ++i) {
            if (is_kept) state.set(first + i, Q.m[static_cast<std::size_t>(i)]);
            else state.keep(first + i);
        }
    }
};

}  // namespace lode
