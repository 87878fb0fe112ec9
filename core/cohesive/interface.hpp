// What all traction-separation laws share (page 40, section 1): separation, contact, energies, the layout of STATEV.
#pragma once

#include "lode/material/description.hpp"
#include "lode/material/point.hpp"

namespace lode {

// STATEV of every COH_* keyword (section 1.2).
namespace interface_state {
enum Index { un = 1, us1, us2, dn, dt, Dn, Dt, GI, GII, W, Gdrop, status, count = status };
}
inline constexpr lode_state interface_states[] = {
    {"UN", "normal separation", 0.0},
    {"US1", "separation in shear 1", 0.0},
    {"US2", "separation in shear 2 (0 in 2D)", 0.0},
    {"DN", "largest opening of mode I, 0 = virgin", 0.0},
    {"DT", "largest sliding of mode II, 0 = virgin", 0.0},
    {"DAMN", "damage of mode I, 1 = failed", 0.0},
    {"DAMT", "damage of mode II, 1 = failed", 0.0},
    {"GI", "mode I energy released per area", 0.0},
    {"GII", "mode II energy released per area", 0.0},
    {"W", "work per area by the trapezoid rule", 0.0},
    {"GDROP", "elastic energy per area lost in the drop at failure", 0.0},
    {"STATUS", "1 active, 0 failed", 0.0},
};

// The optional entries that end the PROPS of the damaging laws.
constexpr lode_parameter failure_exponent() {
    return optional("NMIX", "exponent of the failure criterion", "-", any_value(), 1.0,
                    "(GI/GIC)^NMIX + (GII/GIIC)^NMIX = 1; NMIX <= 0 switches the criterion off");
}
constexpr lode_parameter contact_option() {
    return optional("CONTACT", "compression", "code", code(0, 2), 1.0,
                    "0 none (the host does contact), 1 penalty K_COMP, 2 the damaged stiffness of mode I");
}
constexpr lode_parameter contact_stiffness() {
    return optional("K_COMP", "penalty stiffness in compression", "stress/length", at_least(0.0), 0.0,
                    "0 means the initial stiffness of mode I");
}
constexpr lode_parameter constitutive_thickness() {
    return optional("T0", "constitutive thickness", "length", above(0.0), 1.0,
                    "the separation is T0 times the nominal strain of the element");
}

// Normal traction for u_n < 0 (section 1.3).
struct Contact {
    int option;
    double penalty, damaged_share;  // T_n/u_n = penalty + damaged_share (1 - D_n) k_n

    Contact(int code, double k_comp, double initial_stiffness)
        : option(code),
          penalty(code != 1      ? 0.0
                  : k_comp > 0.0 ? k_comp
                                 : initial_stiffness),
          damaged_share(code == 2 ? 1.0 : 0.0) {}

    // T_n/u_n, which is its slope too; `damaged` is (1 - D_n) k_n.
    template <class Real>
    Real stiffness(const Real& damaged) const {
        return penalty + damaged_share * damaged;
    }
};

// The straight path u(s) = start + s change, 0 <= s <= 1, of the separation in one increment (section 1.1).
template <AnalysisKind kind, class Real>
struct SeparationPath {
    static constexpr int n = components(kind);
    Vector<Real, n> start, change, end;

    SeparationPath(const Increment<kind, Real>& increment, const State<Real>& state, double thickness) {
        for (int i = 0; i < n; ++i) {
            start[i] = state[interface_state::un + i];
            change[i] = thickness * increment.strain_increment[i];
            end[i] = start[i] + change[i];
        }
    }

    Vector<Real, n> at(const Real& s) const {
        Vector<Real, n> u;
        for (int i = 0; i < n; ++i) u[i] = start[i] + s * change[i];
        return u;
    }
    // <u_n>
    static Real opening(const Vector<Real, n>& u) { return positive_part(u[0]); }
    // u_t
    static Real sliding(const Vector<Real, n>& u) {
        if constexpr (n == 2) return abs(u[1]);
        else return sqrt(u[1] * u[1] + u[2] * u[2]);
    }
};

// Tractions, energies and STATEV at the end of an increment, from the damaged stiffnesses (1 - D) k and what was
// released. A law fills the members and calls `finish`.
template <AnalysisKind kind, class Real>
struct InterfaceResult {
    Real normal_stiffness, shear_stiffness;    // (1 - D) k, 0 after failure
    Real dn, dt, normal_damage, shear_damage;  // delta and D
    Real GI, GII, Gdrop;
    Mask<Real> failed;

    // An interface that cannot be damaged.
    static InterfaceResult intact(const Real& normal_stiffness, const Real& shear_stiffness) {
        const Real zero(0.0);
        return {normal_stiffness, shear_stiffness, zero, zero, zero, zero, zero, zero, zero, Mask<Real>(false)};
    }

    // Slope of the normal traction while damage does not grow.
    Real secant(const Real& un, const Contact& contact) const {
        return select(un < Real(0.0), contact.stiffness(normal_stiffness), normal_stiffness);
    }

    // False, with the point marked as failed, where the work overflows.
    LODE_INLINE bool finish(const SeparationPath<kind, Real>& path, const Contact& contact, double per_thickness,
                            Point<kind, Real>& point) const {
        constexpr int n = components(kind);
        const auto &u = path.end, &du = path.change;
        Vector<Real, n> traction;
        traction[0] = secant(u[0], contact) * u[0];
        for (int i = 1; i < n; ++i) traction[i] = shear_stiffness * u[i];
        // The shear stiffness comes last: all else is ready by then.
        Real before = point.stress[0] * du[0], along = u[1] * du[1], square_sum = u[1] * u[1];
        for (int i = 1; i < n; ++i) before = before + point.stress[i] * du[i];
        for (int i = 2; i < n; ++i) along = along + u[i] * du[i], square_sum = square_sum + u[i] * u[i];
        Real work = (before + traction[0] * du[0]) + shear_stiffness * along;
        Real stored = traction[0] * u[0] + shear_stiffness * square_sum;
        // Squares can overflow where tractions, which may be zero, do not.
        const Mask<Real> usual = is_finite(work + stored);
        if (!all(usual)) [[unlikely]] {
            Real plain_work, plain_stored;
            sum_work(path, traction, point, plain_work, plain_stored);
            work = select(usual, work, plain_work);
            stored = select(usual, stored, plain_stored);
        }
        return finish(path, traction, work, stored, per_thickness, point);
    }
    // The same with tractions that do not follow from the stiffnesses.
    LODE_INLINE bool finish(const SeparationPath<kind, Real>& path, const Vector<Real, components(kind)>& traction,
                            double per_thickness, Point<kind, Real>& point) const {
        Real work, stored;
        sum_work(path, traction, point, work, stored);
        return finish(path, traction, work, stored, per_thickness, point);
    }

    // (T_old + T).du and T.u
    static void sum_work(const SeparationPath<kind, Real>& path, const Vector<Real, components(kind)>& traction,
                         const Point<kind, Real>& point, Real& work, Real& stored) {
        work = stored = Real(0.0);
        for (int i = 0; i < components(kind); ++i) {
            work = work + (point.stress[i] + traction[i]) * path.change[i];
            stored = stored + traction[i] * path.end[i];
        }
    }
    LODE_INLINE bool finish(const SeparationPath<kind, Real>& path, const Vector<Real, components(kind)>& traction,
                            const Real& work, const Real& stored, double per_thickness,
                            Point<kind, Real>& point) const {
        namespace index = interface_state;
        constexpr int n = components(kind);
        State<Real>& state = point.state;
        const Real released_before = state[index::GI] + state[index::GII] + state[index::Gdrop];
        const Real work_before = state[index::W];

        const Mask<Real> sound = is_finite(work + stored);
        if (!all(sound)) [[unlikely]] {
            point.fail(!sound, "the separation is out of range");
            return false;
        }
        for (int i = 0; i < n; ++i) point.stress[i] = traction[i];
        point.elastic_energy = 0.5 * per_thickness * stored;
        point.plastic_dissipation = per_thickness * (GI + GII + Gdrop - released_before);

        for (int i = 0; i < n; ++i) state.set(index::un + i, path.end[i]);
        if constexpr (n == 2) state.set(index::us2, Real(0.0));
        state.set(index::dn, dn);
        state.set(index::dt, dt);
        state.set(index::Dn, normal_damage);
        state.set(index::Dt, shear_damage);
        state.set(index::GI, GI);
        state.set(index::GII, GII);
        state.set(index::W, work_before + 0.5 * work);
        state.set(index::Gdrop, Gdrop);
        state.set(index::status, select(failed, Real(0.0), Real(1.0)));
        return true;
    }
};

}  // namespace lode
