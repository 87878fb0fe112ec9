// Reference values in extended precision, written for plainness: 3x3 algebra, spectral functions by Jacobi rotations.
#pragma once

#include <array>
#include <cmath>
#include <random>

#include "lode/tensor/matrix3.hpp"

namespace lode::test {

using Extended = long double;
using Matrix3x = std::array<std::array<Extended, 3>, 3>;

inline Matrix3x extended(const Matrix3<double>& a) {
    Matrix3x r{};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) r[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = a(i, j);
    return r;
}
inline Matrix3<double> rounded(const Matrix3x& a) {
    Matrix3<double> r;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            r(i, j) = static_cast<double>(a[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]);
    return r;
}
inline Matrix3x multiply(const Matrix3x& a, const Matrix3x& b) {
    Matrix3x r{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) r[i][j] += a[i][k] * b[k][j];
    return r;
}
inline Matrix3x transposed(const Matrix3x& a) {
    Matrix3x r{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) r[i][j] = a[j][i];
    return r;
}
// b = H + H^T + H H^T.
inline Matrix3x cauchy_green_minus_identity(const Matrix3x& h) {
    Matrix3x b = multiply(h, transposed(h));
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) b[i][j] += h[i][j] + h[j][i];
    return b;
}

struct EigenX {
    std::array<Extended, 3> values{};
    Matrix3x vectors{};
};
inline EigenX eigen_reference(Matrix3x a) {
    EigenX e;
    for (std::size_t i = 0; i < 3; ++i) e.vectors[i][i] = 1.0L;
    for (int sweep = 0; sweep < 60; ++sweep) {
        for (std::size_t p = 0; p < 2; ++p) {
            for (std::size_t q = p + 1; q < 3; ++q) {
                if (a[p][q] == 0.0L) continue;
                const Extended theta = (a[q][q] - a[p][p]) / (2.0L * a[p][q]);
                const Extended t = (theta < 0.0L ? -1.0L : 1.0L) / (std::abs(theta) + std::hypot(theta, 1.0L));
                const Extended c = 1.0L / std::hypot(t, 1.0L), s = t * c;
                Matrix3x g{};
                for (std::size_t i = 0; i < 3; ++i) g[i][i] = 1.0L;
                g[p][p] = g[q][q] = c;
                g[p][q] = s;
                g[q][p] = -s;
                const Extended app = a[p][p] - t * a[p][q], aqq = a[q][q] + t * a[p][q];
                a = multiply(transposed(g), multiply(a, g));
                a[p][p] = app;
                a[q][q] = aqq;
                a[p][q] = a[q][p] = 0.0L;
                e.vectors = multiply(e.vectors, g);
            }
        }
    }
    for (std::size_t i = 0; i < 3; ++i) e.values[i] = a[i][i];
    return e;
}
// sum f(l_i) n_i n_i^T.
template <class F>
Matrix3x spectral_reference(const F& f, const Matrix3x& a) {
    const EigenX e = eigen_reference(a);
    Matrix3x r{};
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) r[i][j] += f(e.values[k]) * e.vectors[i][k] * e.vectors[j][k];
    return r;
}
inline Extended sqrt_one_plus_minus_one(Extended b) { return b / (1.0L + std::sqrt(1.0L + b)); }

// V = sqrt(F F^T) = sum |g_i| u_i u_i^T from the orthogonal columns g_i = |g_i| u_i of F Q: nothing is squared, so
// small stretches do not drown in large ones.
inline Matrix3x left_stretch_reference(Matrix3x f) {
    for (int sweep = 0; sweep < 60; ++sweep) {
        for (std::size_t p = 0; p < 2; ++p) {
            for (std::size_t q = p + 1; q < 3; ++q) {
                Extended a = 0.0L, b = 0.0L, c = 0.0L;
                for (std::size_t i = 0; i < 3; ++i)
                    a += f[i][p] * f[i][p], b += f[i][q] * f[i][q], c += f[i][p] * f[i][q];
                if (c == 0.0L) continue;
                const Extended angle = 0.5L * std::atan2(2.0L * c, a - b);
                const Extended cosine = std::cos(angle), sine = std::sin(angle);
                for (std::size_t i = 0; i < 3; ++i) {
                    const Extended x = f[i][p], y = f[i][q];
                    f[i][p] = cosine * x + sine * y;
                    f[i][q] = cosine * y - sine * x;
                }
            }
        }
    }
    Matrix3x v{};
    for (std::size_t k = 0; k < 3; ++k) {
        const Extended size = std::sqrt(f[0][k] * f[0][k] + f[1][k] * f[1][k] + f[2][k] * f[2][k]);
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) v[i][j] += f[i][k] * f[j][k] / size;
    }
    return v;
}

inline double norm(const Matrix3<double>& a) {
    double sum = 0.0;
    for (double x : a.m) sum += x * x;
    return std::sqrt(sum);
}
// |a - b|/|b| in the Frobenius norm.
inline double relative_error(const Matrix3<double>& a, const Matrix3x& b) {
    Extended difference = 0.0L, size = 0.0L;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            const Extended x = b[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
            difference += (a(i, j) - x) * (a(i, j) - x);
            size += x * x;
        }
    }
    return size > 0.0L ? static_cast<double>(std::sqrt(difference / size)) : static_cast<double>(std::sqrt(difference));
}
inline double orthogonality_error(const Matrix3<double>& r) {
    return norm(r * transpose(r) - Matrix3<double>::identity());
}

// Random rotation, uniform by a normalised quaternion.
inline Matrix3<double> random_rotation(std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    Extended w = normal(random), x = normal(random), y = normal(random), z = normal(random);
    const Extended n = std::sqrt(w * w + x * x + y * y + z * z);
    w /= n, x /= n, y /= n, z /= n;
    Matrix3x r{};
    r[0] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)};
    r[1] = {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)};
    r[2] = {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)};
    return rounded(r);
}
inline Matrix3<double> random_matrix(std::mt19937_64& random, double size) {
    std::uniform_real_distribution<double> u(-size, size);
    Matrix3<double> a;
    for (double& x : a.m) x = u(random);
    return a;
}
inline Matrix3<double> diagonal(double a, double b, double c) {
    Matrix3<double> r{};
    r(0, 0) = a, r(1, 1) = b, r(2, 2) = c;
    return r;
}

// One lane of a batch, and a batch of one value in every lane but for lane `k`.
inline Matrix3<double> lane(const Matrix3<Batch>& a, int k) {
    Matrix3<double> r;
    for (std::size_t i = 0; i < 9; ++i) r.m[i] = a.m[i].get(static_cast<std::size_t>(k));
    return r;
}
inline Matrix3<Batch> gather(const std::array<Matrix3<double>, batch_lanes>& a) {
    Matrix3<Batch> r;
    for (std::size_t i = 0; i < 9; ++i) {
        std::array<double, batch_lanes> x{};
        for (std::size_t k = 0; k < x.size(); ++k) x[k] = a[k].m[i];
        r.m[i] = Batch::load_unaligned(x.data());
    }
    return r;
}

}  // namespace lode::test
