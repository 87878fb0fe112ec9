// The scalar measures of strain that drive isotropic damage (page 35, section 3; Nairn, 6.2), in terms of the effective
// stress s~ = C eps. All are homogeneous of degree 1 in the strain.
#pragma once

#include "lode/damage/softening_onset.hpp"
#include "lode/elastic/isotropic_moduli.hpp"
#include "lode/tensor/eigen_deflation.hpp"
#include "lode/tensor/invariants.hpp"

namespace lode {

enum class StrainMetric {
    energy,          // sqrt(eps : C eps/E)
    tensile_energy,  // sqrt(sum <s~_i> eps_i/E), eps_i = (s~_i - nu (s~_j + s~_k))/E
    mixed_mode       // <s~1>/E in tension and (s~1 - s~3)/(2G) in shear
};

namespace strain_metric_detail {

// Of one point, by value: the point of the caller stays in registers.
[[gnu::noinline]] inline SymmetricEigen<double> eigen_of(Stress<AnalysisKind::solid, double> s) {
    return eigen_by_deflation(to_matrix<AnalysisKind::solid, double>(s, 1.0));
}
[[gnu::noinline]] inline Vector<Batch, 3> values_of(Stress<AnalysisKind::solid, Batch> s) {
    return eigen_by_deflation(to_matrix<AnalysisKind::solid, Batch>(s, 1.0)).values;
}

}  // namespace strain_metric_detail

// What is measured at a point.
template <AnalysisKind kind, class Real>
struct MeasuredStrain {
    Real normal = Real(0.0);  // of the single metric, or in tension
    Real shear = Real(0.0);   // METRIC 2
    Vector<Real, 3> principal{};
    Matrix3<double> directions;  // with a tangent only, columns in the order of `principal`

    // Where both are below the thresholds without doubt, from invariants alone: then nothing more is needed.
    LODE_INLINE static Mask<Real> is_below(StrainMetric metric, const IsotropicModuli& elastic,
                                           const Stress<kind, Real>& s, const Real& normal_threshold,
                                           const Real& shear_threshold) {
        if constexpr (kind == AnalysisKind::uniaxial) {
            return Mask<Real>(false);
        } else {
            if (metric == StrainMetric::tensile_energy) {
                // sum <s~_i> E eps_i <= c s~ : s~
                const double nu = elastic.poisson, c = nu >= 0.0 ? 1.0 + 0.7072 * nu : 1.0 - 2.0 * nu;
                return c * double_contraction(s, s) < square(elastic.young * normal_threshold);
            }
            const IsotropicOnset<Real> strengths{Real(elastic.young * normal_threshold),
                                                 Real(elastic.shear * shear_threshold),
                                                 Real(0.0),
                                                 true,
                                                 true,
                                                 false};
            return strengths.is_safe(Real((1.0 / 3.0) * trace(s)), second_deviatoric_invariant(s));
        }
    }

    // METRIC 1 and 2.
    template <class T>
    LODE_INLINE void measure(StrainMetric metric, const IsotropicModuli& elastic, const Stress<kind, Real>& s, T&) {
        const Real zero(0.0);
        if constexpr (kind == AnalysisKind::uniaxial) {
            principal[0] = s[0], principal[1] = principal[2] = zero;
        } else if constexpr (kind == AnalysisKind::solid && is_batch<Real>) {
            principal = strain_metric_detail::values_of(s);
        } else if constexpr (kind == AnalysisKind::solid && std::is_same_v<Real, double>) {
            const SymmetricEigen<double> eigen = strain_metric_detail::eigen_of(s);
            principal = eigen.values;
            directions = eigen.vectors;
        } else {
            const auto eigen = symmetric_eigen<kind>(to_matrix<kind, Real>(s, 1.0));
            principal = eigen.values;
            if constexpr (wants_tangent<T>) directions = eigen.vectors;
        }
        const auto& p = principal;
        if (metric == StrainMetric::tensile_energy) {
            const double nu = elastic.poisson;
            Real tension = zero, squares = zero, sum = zero;
            for (int i = 0; i < 3; ++i) {
                const Real positive = positive_part(p[i]);
                tension = tension + positive;
                squares = squares + square(positive);
                sum = sum + p[i];
            }
            normal = (1.0 / elastic.young) * sqrt(positive_part(Real((1.0 + nu) * squares - nu * sum * tension)));
        } else {
            const Real largest = max(max(p[0], p[1]), p[2]), smallest = min(min(p[0], p[1]), p[2]);
            normal = (1.0 / elastic.young) * positive_part(largest);
            shear = (0.5 / elastic.shear) * (largest - smallest);
        }
    }

    // d(eps_eff)/d(eps) = C : d(eps_eff)/d(s~); `in_shear` asks for that of the shear.
    LODE_INLINE Stress<kind, double> gradient(StrainMetric metric, const IsotropicModuli& elastic,
                                              const Stress<kind, double>& s, bool in_shear) const {
        if (metric == StrainMetric::energy) return (1.0 / (elastic.young * normal)) * s;
        Vector<double, 3> slope{};  // with the principal stresses
        const auto& p = principal;
        if (metric == StrainMetric::tensile_energy) {
            const double nu = elastic.poisson, sum = p[0] + p[1] + p[2];
            const double tension = positive_part(p[0]) + positive_part(p[1]) + positive_part(p[2]);
            const double factor = 0.5 / (square(elastic.young) * normal);
            for (int i = 0; i < 3; ++i) {
                const double own = p[i] > 0.0 ? (1.0 + nu) * p[i] - nu * sum : 0.0;  // E eps_i
                slope[i] = factor * (own + (1.0 + nu) * positive_part(p[i]) - nu * tension);
            }
        } else {
            int first = 0, last = 0;
            for (int i = 1; i < 3; ++i) {
                if (p[i] > p[first]) first = i;
                if (p[i] < p[last]) last = i;
            }
            slope[first] = in_shear ? 0.5 / elastic.shear : 1.0 / elastic.young;
            if (in_shear) slope[last] = -0.5 / elastic.shear;
        }
        if constexpr (kind == AnalysisKind::uniaxial) {
            return {{{elastic.young * slope[0]}}};
        } else {
            const auto& v = directions;
            Matrix3<double> by_stress;
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j <= i; ++j)
                    by_stress(i, j) = by_stress(j, i) =
                        slope[0] * v(i, 0) * v(j, 0) + slope[1] * v(i, 1) * v(j, 1) + slope[2] * v(i, 2) * v(j, 2);
            return elastic.stress<kind>(from_matrix<Strain<kind, double>, kind>(by_stress, 2.0));
        }
    }
};

}  // namespace lode
