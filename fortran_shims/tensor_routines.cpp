// SINV, SPRINC, SPRIND, ROTSIG of Abaqus/Standard and VSPRINC, VSPRIND of Abaqus/Explicit.
//
// Standard stores NDI direct components 11, 22, 33, then NSHR shears 12, 13, 23; Explicit stores the shears as
// 12, 23, 31. Components that are not stored are zero. LSTR = 1 is a stress, LSTR = 2 a strain with engineering shears;
// Explicit knows tensor shears only.
// Abaqus leaves the order of the principal values open; here the largest comes first, and the directions form a
// right-handed triad.
#include <cmath>
#include <cstddef>

#include "principal.hpp"
#include "utility_state.hpp"

namespace {

using lode::utility::Matrix3;
using lode::utility::Principal;

constexpr std::size_t standard_shear[3][2] = {{0, 1}, {0, 2}, {1, 2}};
constexpr std::size_t explicit_shear[3][2] = {{0, 1}, {1, 2}, {2, 0}};

struct Layout {
    std::size_t direct, shear;
    Layout(const int* ndi, const int* nshr) : direct(clamp(*ndi)), shear(clamp(*nshr)) {}

  private:
    static std::size_t clamp(int n) { return n < 0 ? 0 : n > 3 ? 3 : static_cast<std::size_t>(n); }
};

constexpr int strain = 2;

Matrix3 unpack(const double* s, const Layout& n, int lstr) {
    const double factor = lstr == strain ? 0.5 : 1.0;
    Matrix3 a = {};
    for (std::size_t i = 0; i < n.direct; ++i) a[i][i] = s[i];
    for (std::size_t k = 0; k < n.shear; ++k) {
        const auto [i, j] = standard_shear[k];
        a[i][j] = a[j][i] = factor * s[n.direct + k];
    }
    return a;
}

void pack(const Matrix3& a, double* s, const Layout& n, int lstr) {
    const double factor = lstr == strain ? 2.0 : 1.0;
    for (std::size_t i = 0; i < n.direct; ++i) s[i] = a[i][i];
    for (std::size_t k = 0; k < n.shear; ++k) {
        const auto [i, j] = standard_shear[k];
        s[n.direct + k] = factor * a[i][j];
    }
}

template <class Real>
Principal block_principal(const Real* tensor, std::size_t point, std::size_t block, const Layout& n) {
    Matrix3 a = {};
    for (std::size_t i = 0; i < n.direct; ++i) a[i][i] = static_cast<double>(tensor[point + block * i]);
    for (std::size_t k = 0; k < n.shear; ++k) {
        const auto [i, j] = explicit_shear[k];
        a[i][j] = a[j][i] = static_cast<double>(tensor[point + block * (n.direct + k)]);
    }
    return lode::utility::principal(a);
}

template <class Real>
void principal_values(std::size_t block, const void* tensor, void* values, void* directions, const Layout& n) {
    auto* const value = static_cast<Real*>(values);
    auto* const direction = static_cast<Real*>(directions);
    for (std::size_t k = 0; k < block; ++k) {
        const Principal p = block_principal(static_cast<const Real*>(tensor), k, block, n);
        for (std::size_t i = 0; i < 3; ++i) {
            value[k + block * i] = static_cast<Real>(p.value[i]);
            if (direction == nullptr) continue;
            for (std::size_t j = 0; j < 3; ++j)
                direction[k + block * (i + 3 * j)] = static_cast<Real>(p.direction[i][j]);
        }
    }
}

void explicit_principal(const int* nblock, const void* tensor, void* values, void* directions, const Layout& n) {
    const std::size_t block = *nblock > 0 ? static_cast<std::size_t>(*nblock) : 0;
    if (lode::utility::explicit_real_bytes() == sizeof(float))
        principal_values<float>(block, tensor, values, directions, n);
    else principal_values<double>(block, tensor, values, directions, n);
}

}  // namespace

extern "C" {

// SINV1 = tr(sigma)/3, SINV2 = sqrt(3/2 s:s).
void sinv_(const double* stress, double* sinv1, double* sinv2, const int* ndi, const int* nshr) {
    const Matrix3 a = unpack(stress, {ndi, nshr}, 1);
    const double mean = (a[0][0] + a[1][1] + a[2][2]) / 3.0;
    // Differences of the direct components: no cancellation under a large mean stress.
    const double d1 = a[0][0] - a[1][1], d2 = a[1][1] - a[2][2], d3 = a[2][2] - a[0][0];
    const double shear = a[0][1] * a[0][1] + a[0][2] * a[0][2] + a[1][2] * a[1][2];
    *sinv1 = mean;
    *sinv2 = std::sqrt(0.5 * (d1 * d1 + d2 * d2 + d3 * d3) + 3.0 * shear);
}

void sprinc_(const double* s, double* ps, const int* lstr, const int* ndi, const int* nshr) {
    const Principal p = lode::utility::principal(unpack(s, {ndi, nshr}, *lstr));
    for (std::size_t i = 0; i < 3; ++i) ps[i] = p.value[i];
}

// AN(i, 1:3) is the direction of PS(i).
void sprind_(const double* s, double* ps, double* an, const int* lstr, const int* ndi, const int* nshr) {
    const Principal p = lode::utility::principal(unpack(s, {ndi, nshr}, *lstr));
    for (std::size_t i = 0; i < 3; ++i) {
        ps[i] = p.value[i];
        for (std::size_t j = 0; j < 3; ++j) an[i + 3 * j] = p.direction[i][j];
    }
}

// SPRIME = R S R^T. S and SPRIME may be the same array.
void rotsig_(const double* s, const double* r, double* sprime, const int* lstr, const int* ndi, const int* nshr) {
    const Layout n(ndi, nshr);
    const Matrix3 a = unpack(s, n, *lstr);
    Matrix3 half = {}, full = {};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) half[i][j] += r[i + 3 * k] * a[k][j];
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) full[i][j] += half[i][k] * r[j + 3 * k];
    pack(full, sprime, n, *lstr);
}

// TENSOR(nblock, ndir + nshr), EIGVAL(nblock, 3).
void vsprinc_(const int* nblock, const void* tensor, void* eigval, const int* ndir, const int* nshr) {
    explicit_principal(nblock, tensor, eigval, nullptr, {ndir, nshr});
}

// EIGVEC(nblock, 3, 3): EIGVEC(k, i, 1:3) is the direction of EIGVAL(k, i).
void vsprind_(const int* nblock, const void* tensor, void* eigval, void* eigvec, const int* ndir, const int* nshr) {
    explicit_principal(nblock, tensor, eigval, eigvec, {ndir, nshr});
}

}  // extern "C"
