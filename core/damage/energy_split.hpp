// The parts of the elastic energy in phase-field fracture (page 35, section 8; Nairn, 6.3.1 and 6.3.2): Psi+ drives
// cracks and is degraded, Psi- is not. sigma = g sigma+ + sigma-.
#pragma once

#include "lode/elastic/isotropic_moduli.hpp"
#include "lode/tensor/eigen_deflation.hpp"
#include "lode/tensor/spectral.hpp"

namespace lode {

// <x> as a function of a tensor; at 0 the compressive side.
struct PositivePartFunction {
    template <class Real>
    Real value(const Real& x) const {
        return select(x > Real(0.0), x, Real(0.0));
    }
    template <class Real>
    Real derivative(const Real& x) const {
        return select(x > Real(0.0), Real(1.0), Real(0.0));
    }
    template <class Real>
    Real divided_difference(const Real& a, const Real& b) const {
        const Mask<Real> equal = a == b;
        return select(equal, derivative(a), (value(a) - value(b)) / select(equal, Real(1.0), a - b));
    }
};

enum class EnergySplitCode { dilation = 1, principal_strains = 2 };

// Of a strain with three normal components.
template <AnalysisKind kind, class Real>
struct EnergySplit {
    static_assert(normal_components(kind) == 3);
    Real energy, passive_energy;         // Psi+, Psi-
    Stress<kind, Real> active, passive;  // sigma+, sigma-
    Mask<Real> dilates;                  // tr eps > 0
    SymmetricEigen<double> eigen;        // PART 2, with a tangent only

    // PART 1: dilation and shape.
    LODE_INLINE void by_dilation(const IsotropicModuli& elastic, const Strain<kind, Real>& strain) {
        const double K = elastic.bulk, mu = elastic.shear;
        const Real t = trace(strain);
        dilates = t > Real(0.0);
        const Real expansion = select(dilates, t, Real(0.0)), compression = t - expansion;
        const Stress<kind, Real> e = deviator(strain);
        energy = (0.5 * K) * square(expansion) + mu * double_contraction(e, e);
        passive_energy = (0.5 * K) * square(compression);
        const Real pull = K * expansion, push = K * compression;
        for (int i = 0; i < components(kind); ++i) {
            active[i] = i < 3 ? pull + 2.0 * mu * e[i] : 2.0 * mu * e[i];
            passive[i] = i < 3 ? push : Real(0.0);
        }
    }

    // PART 2: positive and negative principal strains.
    template <class T>
    LODE_INLINE void by_principal_strains(const IsotropicModuli& elastic, const Strain<kind, Real>& strain, T&) {
        const double lambda = elastic.lame, mu = elastic.shear;
        const Matrix3<Real> tensor = to_matrix<kind, Real>(strain, 0.5);
        Matrix3<Real> positive;
        if constexpr (std::is_same_v<Real, double>) {
            eigen = eigen_of(tensor);
            positive = spectral_function(PositivePartFunction{}, eigen);
        } else {
            positive = positive_part_of(tensor);
        }
        const auto plus = from_matrix<Stress<kind, Real>, kind>(positive, 1.0);
        const auto minus = from_matrix<Stress<kind, Real>, kind>(tensor - positive, 1.0);
        const Real t = trace(strain);
        dilates = t > Real(0.0);
        const Real expansion = select(dilates, t, Real(0.0)), compression = t - expansion;
        energy = (0.5 * lambda) * square(expansion) + mu * double_contraction(plus, plus);
        passive_energy = (0.5 * lambda) * square(compression) + mu * double_contraction(minus, minus);
        const Real pull = lambda * expansion, push = lambda * compression;
        for (int i = 0; i < components(kind); ++i) {
            active[i] = i < 3 ? pull + 2.0 * mu * plus[i] : 2.0 * mu * plus[i];
            passive[i] = i < 3 ? push + 2.0 * mu * minus[i] : 2.0 * mu * minus[i];
        }
    }

    // d(g sigma+ + sigma-)/d(eps) + weight sigma+ x sigma+ at fixed g.
    LODE_INLINE void set_tangent(EnergySplitCode part, const IsotropicModuli& elastic, double g, double weight,
                                 Tangent<kind>& c) const {
        const double mu = elastic.shear, coupling = dilates ? g : 1.0;
        if (part == EnergySplitCode::dilation) {
            set_isotropic_less_dyad(c, coupling * elastic.bulk - (2.0 / 3.0) * g * mu, 2.0 * g * mu, -weight, active);
            return;
        }
        // g P+ + (1 - P+). One principal strain, or none, has a sign other than the rest: from the projection N onto
        // it, P+ = N or P+ = 1 - N.
        const Vector<double, 3>& e = eigen.values;
        int odd = 0, positive = 0;
        for (int i = 0; i < 3; ++i) positive += e[i] > 0.0;
        const bool mostly_positive = positive >= 2;
        for (int i = 0; i < 3; ++i)
            if ((e[i] > 0.0) != mostly_positive) odd = i;
        double rest = 1.0, change = g - 1.0;  // 2 mu (rest 1 + change N)
        if (mostly_positive) rest = g, change = 1.0 - g;
        if (positive == 0 || positive == 3) change = 0.0;
        double dyad_weight[4];
        Stress<kind, double> dyad[4];
        for (int k = 0; k < 3; ++k) {
            const int j = (odd + k) % 3;
            // (<e_odd> - <e_j>)/(e_odd - e_j), or that of the negative parts
            const double factor = k == 0 ? 1.0 : e[odd] / (e[odd] - e[j]);
            dyad_weight[k] = change == 0.0 ? 0.0 : 2.0 * mu * change * (k == 0 ? 1.0 : 2.0 * factor);
            Matrix3<double> n;
            for (int a = 0; a < 3; ++a)
                for (int b = 0; b < 3; ++b)
                    n(a, b) = 0.5 * (eigen.vectors(a, odd) * eigen.vectors(b, j) +
                                     eigen.vectors(a, j) * eigen.vectors(b, odd));
            dyad[k] = from_matrix<Stress<kind, double>, kind>(n, 1.0);
        }
        dyad_weight[3] = weight;
        dyad[3] = active;
        set_isotropic_plus_dyads(c, coupling * elastic.lame, 2.0 * rest * mu, dyad_weight, dyad);
    }

  private:
    static constexpr bool in_space = kind == AnalysisKind::solid;

    // By value, so that the point of the caller stays in registers.
    [[gnu::noinline]] static SymmetricEigen<double> eigen_in_space(Matrix3<double> a) { return eigen_by_deflation(a); }
    [[gnu::noinline]] static Matrix3<Real> positive_part_in_space(Matrix3<Real> a) {
        if constexpr (is_differentiated<Real>) return spectral_function<AnalysisKind::solid>(PositivePartFunction{}, a);
        else return spectral_function(PositivePartFunction{}, eigen_by_deflation(a));
    }
    LODE_INLINE static SymmetricEigen<double> eigen_of(const Matrix3<double>& a) {
        if constexpr (in_space) return eigen_in_space(a);
        else return symmetric_eigen<kind>(a);
    }
    LODE_INLINE static Matrix3<Real> positive_part_of(const Matrix3<Real>& a) {
        if constexpr (in_space) return positive_part_in_space(a);
        else return spectral_function<kind>(PositivePartFunction{}, a);
    }
};

}  // namespace lode
