// What regularises softening at a material point: the characteristic length h and, kept in STATEV, the point's relative
// strength and toughness (page 30, sections 2.3 and 8).
#pragma once

#include "lode/material/point.hpp"

namespace lode {

// 1-based STATEV indices.
struct SofteningSizeEntries {
    int length, strength, toughness;
};

template <class Real>
struct SofteningSize {
    Real length, strength, toughness;
    Mask<Real> frozen;  // the length is that of STATEV

    // False, with the point refused, where they make no sense.
    template <AnalysisKind kind>
    LODE_INLINE bool read(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                          const SofteningSizeEntries& entry, const Mask<Real>& intact, double fixed_length) {
        const Real zero(0.0), one(1.0);
        const Real stored = point.state[entry.length], relative_strength = point.state[entry.strength],
                   relative_toughness = point.state[entry.toughness];
        frozen = !intact && stored > zero;
        strength = select(relative_strength == zero, one, relative_strength);
        toughness = select(relative_toughness == zero, one, relative_toughness);
        length = stored;
        if (all(frozen)) return true;

        const Real host = fixed_length > 0.0 ? Real(fixed_length) : increment.element_length();
        length = select(frozen, stored, host);
        Mask<Real> bad = !frozen && !(host > zero && is_finite(host));
        if (any(bad)) [[unlikely]] {
            point.refuse(bad, "softening needs the element length CELENT (charLength), which", host, "> 0");
            return false;
        }
        bad = !frozen && !(min(strength, toughness) > zero);
        if (any(bad)) [[unlikely]] {
            point.refuse(bad, "STATEV REL_S or REL_G", Real(min(strength, toughness)), "> 0");
            return false;
        }
        return true;
    }
    // False, with the point refused, where a new crack would snap back: h >= h_max REL_G/REL_S^2.
    template <AnalysisKind kind>
    LODE_INLINE bool fits(Point<kind, Real>& point, double largest_length, const char* text) const {
        const Real limit = largest_length * toughness / square(strength);
        const Mask<Real> large = !frozen && length >= limit;
        if (!any(large)) [[likely]]
            return true;
        point.refuse(large, text, length, "below", limit);
        return false;
    }
};

}  // namespace lode
