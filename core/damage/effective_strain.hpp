// The mechanical strain of the scalar damage models, kept in STATEV 1-6 (page 35): strain less its residual part, in
// the current basis, components 11, 22, 33, 12, 13, 23 with engineering shears in every kind.
#pragma once

#include "lode/damage/softening_axes.hpp"
#include "lode/elastic/isotropic_moduli.hpp"
#include "lode/elastic/known_field.hpp"

namespace lode {

// Thermal and moisture expansion, the latter by field variable `field_number`.
struct ResidualExpansion {
    double thermal, moisture;
    int field_number = 1;

    bool is_absent() const { return thermal == 0.0 && moisture == 0.0; }

    // The residual strain of the increment. False, with the point marked as failed, where the field is not known.
    template <AnalysisKind kind, class Real>
    LODE_INLINE bool of(const Increment<kind, Real>& increment, Point<kind, Real>& point, Real& residual) const {
        residual = Real(0.0);
        if (thermal != 0.0) residual = thermal * increment.temperature_increment();
        if (moisture == 0.0) return true;
        if (increment.field_count < field_number) [[unlikely]] {
            point.refuse(Mask<Real>(true), "moisture expansion (BETA) reads a field variable: their number",
                         Real(increment.field_count), ">=", Real(field_number));
            return false;
        }
        const Real change = increment.field_increment(field_number);
        if (!is_known(change, point, "the field variable of BETA on entry is not finite")) return false;
        residual = residual + moisture * change;
        return true;
    }
};

namespace effective_strain {

inline constexpr int E33 = 3, count = 6;  // STATEV

// Where component i of a kind stands in STATEV.
template <AnalysisKind kind>
constexpr int entry(int i) {
    return i < normal_components(kind) ? 1 + i : 4 + i - normal_components(kind);
}

// At the start of the increment, in the frame of its end. Where STATEV holds no strain yet, it is that of the initial
// stress; `fresh` tells where.
template <AnalysisKind kind, class Real>
LODE_INLINE Strain<kind, Real> start(const Increment<kind, Real>& increment, const Point<kind, Real>& point,
                                     const IsotropicModuli& elastic, Mask<Real>& fresh) {
    constexpr int n = components(kind), normals = normal_components(kind);
    const Real zero(0.0);
    Strain<kind, Real> strain;
    for (int i = 0; i < n; ++i) strain[i] = point.state[entry<kind>(i)];
    fresh = strain[0] == zero;
    for (int i = 1; i < n; ++i) fresh = fresh && strain[i] == zero;
    if (frame_turns(increment)) strain = rotate<kind>(strain, increment.rotation());
    if (!any(fresh)) [[likely]]
        return strain;
    const Real mean = (elastic.poisson / elastic.young) * trace(point.stress);
    for (int i = 0; i < n; ++i) {
        const Real compliant =
            i < normals ? Real((2.0 * elastic.half_compliance * (1.0 + elastic.poisson)) * point.stress[i] - mean)
                        : Real((1.0 / elastic.shear) * point.stress[i]);
        strain[i] = select(fresh, compliant, strain[i]);
    }
    return strain;
}

// `lateral`: eps22 = eps33 of a bar, eps33 of plane stress.
template <AnalysisKind kind, class Real>
LODE_INLINE void store(State<Real>& state, const Strain<kind, Real>& strain, const Real& lateral) {
    for (int i = 0; i < components(kind); ++i) state.set(entry<kind>(i), strain[i]);
    if constexpr (kind == AnalysisKind::uniaxial) {
        state.set(2, lateral);
        state.set(E33, lateral);
        for (int i = 4; i <= count; ++i) state.keep(i);
    } else if constexpr (kind != AnalysisKind::solid) {
        if constexpr (kind == AnalysisKind::plane_stress) state.set(E33, lateral);
        state.keep(5);
        state.keep(6);
    }
}

}  // namespace effective_strain
}  // namespace lode
