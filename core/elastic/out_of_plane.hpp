// The options OOP and TOOP (page 10, section 1.4): sigma33 of plane stress, or a strain on top of eps33 of the (3,1)
// kinds, ramped in time. Generalized plane stress and strain for hosts without such elements.
#pragma once

#include "lode/material/point.hpp"

namespace lode {

struct OutOfPlane {
    double value, ramp_time;

    bool present() const { return value != 0.0; }

    // At the end of the increment; 0 in the kinds that have none.
    template <AnalysisKind kind, class Real>
    LODE_INLINE Real at_end(const Increment<kind, Real>& increment) const {
        if (kind != AnalysisKind::plane_stress && kind != AnalysisKind::plane_strain) return Real(0.0);
        return Real(ramp_time > 0.0 ? value * min(1.0, increment.time_end / ramp_time) : value);
    }
};

// Adds a change of eps33 in the (3,1) kinds.
template <AnalysisKind kind, class Real>
LODE_INLINE void add_out_of_plane(Strain<kind, Real>& strain, const Real& imposed) {
    if constexpr (kind == AnalysisKind::plane_strain) strain[2] = strain[2] + imposed;
}

}  // namespace lode
