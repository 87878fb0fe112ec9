// A field variable, which swells a material, must be there: some hosts leave PREDEF and DPRED uninitialised.
#pragma once

#include "lode/material/point.hpp"

namespace lode {

// False, with the point marked as failed, where it is not finite. Nothing may have been written yet.
template <AnalysisKind kind, class Real>
LODE_INLINE bool is_known(const Real& field, Point<kind, Real>& point,
                          const char* otherwise = "field variable 1 on entry is not finite") {
    const Mask<Real> known = is_finite(field);
    if (all(known)) [[likely]]
        return true;
    point.fail(!known, otherwise);
    return false;
}

}  // namespace lode
