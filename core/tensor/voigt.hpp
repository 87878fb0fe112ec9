// Stress and strain in the host's Voigt layouts, generic in analysis kind and number type.
// Order 11, 22, 33, 12, 13, 23 (2D: 11, 22, [33,] 12; cohesive: normal, shears). `Strain` carries engineering shears
// (gamma = 2 eps), `Stress` tensor shears; the two are different types so that a factor of two cannot slip.
#pragma once

#include <array>

#include "lode/material/kind.hpp"
#include "lode/numerics/scalar.hpp"

namespace lode {

template <class Real, int n>
struct Vector {
    std::array<Real, n> v;  // not set: kernels fill what they use

    constexpr Real& operator[](int i) { return v[static_cast<std::size_t>(i)]; }
    constexpr const Real& operator[](int i) const { return v[static_cast<std::size_t>(i)]; }
    static constexpr int size() { return n; }
};

template <AnalysisKind kind, class Real>
struct Stress : Vector<Real, components(kind)> {};
template <AnalysisKind kind, class Real>
struct Strain : Vector<Real, components(kind)> {};

// Componentwise algebra for any of the above; both operands have the same type.
template <class V>
concept VoigtVector = requires(V a) {
    V::size();
    a.v;
};

// Component by component: copied as a block, a tensor that was just computed goes through memory, where loads wait for
// stores of another width.
template <VoigtVector V>
LODE_INLINE void assign(V& to, const V& from) {
    for (int i = 0; i < V::size(); ++i) to[i] = from[i];
}
template <VoigtVector V>
inline V operator+(const V& a, const V& b) {
    V r;
    for (int i = 0; i < V::size(); ++i) r[i] = a[i] + b[i];
    return r;
}
template <VoigtVector V>
LODE_INLINE V& operator+=(V& a, const V& b) {
    for (int i = 0; i < V::size(); ++i) a[i] = a[i] + b[i];
    return a;
}
template <VoigtVector V>
inline V operator-(const V& a, const V& b) {
    V r;
    for (int i = 0; i < V::size(); ++i) r[i] = a[i] - b[i];
    return r;
}
template <VoigtVector V, class Real>
inline V operator*(const Real& factor, const V& a) {
    V r;
    for (int i = 0; i < V::size(); ++i) r[i] = factor * a[i];
    return r;
}

// Sum of the normal components.
template <AnalysisKind kind, class Real>
inline Real trace(const Stress<kind, Real>& s) {
    Real sum = s[0];
    for (int i = 1; i < normal_components(kind); ++i) sum = sum + s[i];
    return sum;
}
template <AnalysisKind kind, class Real>
inline Real trace(const Strain<kind, Real>& e) {
    Real sum = e[0];
    for (int i = 1; i < normal_components(kind); ++i) sum = sum + e[i];
    return sum;
}

// a : b of two stress-like tensors: shear components count twice.
template <AnalysisKind kind, class Real>
inline Real double_contraction(const Stress<kind, Real>& a, const Stress<kind, Real>& b) {
    Real normal = a[0] * b[0];
    for (int i = 1; i < normal_components(kind); ++i) normal = normal + a[i] * b[i];
    if constexpr (shear_components(kind) > 0) {
        constexpr int first = normal_components(kind);
        Real shear = a[first] * b[first];
        for (int i = first + 1; i < components(kind); ++i) shear = shear + a[i] * b[i];
        normal = normal + 2.0 * shear;
    }
    return normal;
}
// sigma : eps; the engineering shears already hold the factor of two.
template <AnalysisKind kind, class Real>
inline Real double_contraction(const Stress<kind, Real>& s, const Strain<kind, Real>& e) {
    Real sum = s[0] * e[0];
    for (int i = 1; i < components(kind); ++i) sum = sum + s[i] * e[i];
    return sum;
}

// Tensor deviator of a stress with three normal components (3D, plane strain).
template <AnalysisKind kind, class Real>
inline Stress<kind, Real> deviator(const Stress<kind, Real>& s) {
    static_assert(normal_components(kind) == 3, "a deviator needs all three normal components");
    const Real mean = trace(s) * (1.0 / 3.0);
    Stress<kind, Real> d = s;
    for (int i = 0; i < 3; ++i) d[i] = d[i] - mean;
    return d;
}
// Tensor deviator (tensor shears) of a strain given with engineering shears.
template <AnalysisKind kind, class Real>
inline Stress<kind, Real> deviator(const Strain<kind, Real>& e) {
    static_assert(normal_components(kind) == 3, "a deviator needs all three normal components");
    const Real mean = trace(e) * (1.0 / 3.0);
    Stress<kind, Real> d;
    for (int i = 0; i < 3; ++i) d[i] = e[i] - mean;
    for (int i = 3; i < components(kind); ++i) d[i] = 0.5 * e[i];
    return d;
}

// Adds `x` to the normal components.
template <class V, class Real>
inline void add_to_normals(V& s, int normals, const Real& x) {
    for (int i = 0; i < normals; ++i) s[i] = s[i] + x;
}

}  // namespace lode
