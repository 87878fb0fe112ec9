// The chain rule through backward Euler substeps (page 20, METHOD 2): how stress, hardening variable, heat and
// thickness answer to the strain of the whole increment. A substep carries it on by the closed linearisation of its
// own step, in which the stress and the hardening variable at its start are further changes of the trial state.
#pragma once

#include "lode/elastic/voigt_column.hpp"
#include "lode/material/point.hpp"

namespace lode {

template <AnalysisKind kind>
struct SubstepChain {
    static constexpr int n = components(kind);
    using Row = Column<n>;  // over the components of the strain

    Row stress[n]{};   // or what the model has in its place
    Row elastic[n]{};  // what the strain of one substep adds to it elastically
    Row alpha{}, heat{}, thickness{};

    // From the end of a substep to the trial state of the next one.
    LODE_INLINE void add_strain() {
        for (int i = 0; i < n; ++i) stress[i] += elastic[i];
    }
    // The rows of stress into DDSDDE.
    LODE_INLINE void store(Tangent<kind>& tangent) const {
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) tangent(i, j) = stress[i][j];
    }
};

}  // namespace lode
