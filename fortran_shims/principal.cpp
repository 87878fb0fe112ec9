#include "principal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lode::utility {

// Cyclic Jacobi: rotations keep the directions orthonormal to rounding however close the principal values are, which
// the trigonometric closed form does not.
Principal principal(const Matrix3& tensor) {
    Matrix3 a = tensor;
    Matrix3 v = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  // columns converge to the directions
    constexpr int max_sweeps = 30;                    // quadratic convergence: 5 are typical
    for (int sweep = 0; sweep < max_sweeps; ++sweep) {
        const double off = std::max({std::abs(a[0][1]), std::abs(a[0][2]), std::abs(a[1][2])});
        const double diagonal = std::max({std::abs(a[0][0]), std::abs(a[1][1]), std::abs(a[2][2])});
        if (!(off > std::numeric_limits<double>::epsilon() * 1e-3 * diagonal)) break;
        for (const auto& [p, q] : {std::pair<std::size_t, std::size_t>{0, 1}, {0, 2}, {1, 2}}) {
            if (a[p][q] == 0.0) continue;
            const double theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
            const double c = 1.0 / std::hypot(t, 1.0), s = t * c;
            const std::size_t r = 3 - p - q;
            const double apq = a[p][q], arp = a[r][p], arq = a[r][q];
            a[p][p] -= t * apq;
            a[q][q] += t * apq;
            a[p][q] = a[q][p] = 0.0;
            a[r][p] = a[p][r] = c * arp - s * arq;
            a[r][q] = a[q][r] = s * arp + c * arq;
            for (auto& row : v) {
                const double vp = row[p], vq = row[q];
                row[p] = c * vp - s * vq;
                row[q] = s * vp + c * vq;
            }
        }
    }

    std::array<std::size_t, 3> order = {0, 1, 2};
    std::stable_sort(order.begin(), order.end(), [&a](std::size_t i, std::size_t j) { return a[i][i] > a[j][j]; });
    Principal result;
    for (std::size_t i = 0; i < 3; ++i) {
        result.value[i] = a[order[i]][order[i]];
        for (std::size_t j = 0; j < 3; ++j) result.direction[i][j] = v[j][order[i]];
    }
    const auto& d = result.direction;
    const double handedness = d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) +
                              d[0][1] * (d[1][2] * d[2][0] - d[1][0] * d[2][2]) +
                              d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]);
    if (handedness < 0.0)
        for (double& x : result.direction[2]) x = -x;
    return result;
}

}  // namespace lode::utility
