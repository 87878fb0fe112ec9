// Square matrices over the Voigt components of a kind: derivatives, moduli, rotations.
#pragma once

#include "lode/tensor/voigt.hpp"

namespace lode {

// (i, j) in UMAT order. Stored column by column like DDSDDE.
template <AnalysisKind kind, class Real>
struct VoigtMatrix {
    static constexpr int n = components(kind);
    std::array<Real, static_cast<std::size_t>(n* n)> m;  // not set

    constexpr Real& operator()(int i, int j) { return m[static_cast<std::size_t>(i + n * j)]; }
    constexpr const Real& operator()(int i, int j) const { return m[static_cast<std::size_t>(i + n * j)]; }
    static constexpr int size() { return n; }
};

template <AnalysisKind kind, class Real>
inline VoigtMatrix<kind, Real> operator*(const VoigtMatrix<kind, Real>& a, const VoigtMatrix<kind, Real>& b) {
    VoigtMatrix<kind, Real> r;
    constexpr int n = components(kind);
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            Real sum = a(i, 0) * b(0, j);
            for (int k = 1; k < n; ++k) sum = sum + a(i, k) * b(k, j);
            r(i, j) = sum;
        }
    return r;
}
template <AnalysisKind kind, class Real>
inline VoigtMatrix<kind, Real> transpose(const VoigtMatrix<kind, Real>& a) {
    VoigtMatrix<kind, Real> r;
    for (int i = 0; i < a.size(); ++i)
        for (int j = 0; j < a.size(); ++j) r(i, j) = a(j, i);
    return r;
}

}  // namespace lode
