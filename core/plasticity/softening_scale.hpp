// Regularisation of softening by the element size (page 20, section 2): x = alpha h/LREF, so that an area dissipates
// what one of an element of size LREF does, as long as softening is not steeper than elastic unloading.
#pragma once

#include "lode/material/point.hpp"

namespace lode {

// h/LREF in `scale`; false, with the point refused, where h is unknown or exceeds h_max = unloading LREF/|slope|.
// `unloading` is the stiffness at which the point unloads elastically, `slope` the steepest one of the law, dk/dx < 0.
template <AnalysisKind kind, class Real>
LODE_INLINE bool softening_scale(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                                 double reference_length, double unloading, double slope, Real& scale) {
    const Real h = increment.element_length();
    const Mask<Real> unknown = !(h > Real(0.0)) || !is_finite(h);
    if (any(unknown)) [[unlikely]] {
        point.refuse(unknown, "softening needs the element size CELENT, which", h, "> 0");
        return false;
    }
    const double h_max = unloading * reference_length / -slope;
    const Mask<Real> too_large = h >= Real(h_max);
    if (any(too_large)) [[unlikely]] {
        point.refuse(too_large, "element size h exceeds h_max: h", h, "<", Real(h_max));
        return false;
    }
    scale = h * (1.0 / reference_length);
    return true;
}

}  // namespace lode
