// Hill's quadratic criterion h = sqrt(sigma . A sigma) in material axes (page 20, section 5; Nairn, eqs. 2.104-2.108).
#pragma once

#include "lode/material/properties.hpp"
#include "lode/tensor/matrix3.hpp"

namespace lode {

struct HillCriterion {
    Matrix3<double> normal;       // A of the normal components; A 1 = 0
    std::array<double, 3> shear;  // A of 12, 13, 23: 1/Y^2
    double reference;             // sigma_ref

    // PROPS(first) ... PROPS(first + 5) = Y11, Y22, Y33, Y12, Y13, Y23; 0: never yields in this mode. Throws
    // BadProperty where A is not positive semidefinite.
    static HillCriterion from_properties(const Properties& p, int first) {
        double largest = 0.0, smallest = HUGE_VAL;
        std::array<double, 6> inverse;  // 1/Y
        for (int i = 0; i < 6; ++i) {
            const double Y = p[first + i];
            inverse[static_cast<std::size_t>(i)] = Y > 0.0 ? 1.0 / Y : 0.0;
            if (Y == 0.0) continue;
            largest = std::max(largest, Y);
            smallest = std::min(smallest, Y);
        }
        if (largest == 0.0) p.refuse(first, "> 0, or another of the yield stresses: all are 0");
        if (largest > 1e6 * smallest)
            p.refuse("the yield stresses differ by a factor of " + format_number(largest / smallest) +
                     ", which must be <= 1e6; 0 means that a mode never yields");

        const double a = inverse[0] * inverse[0], b = inverse[1] * inverse[1], c = inverse[2] * inverse[2];
        const double F = 0.5 * (b + c - a), G = 0.5 * (c + a - b), H = 0.5 * (a + b - c);
        const double size = std::max({a, b, c});
        if (F * G + G * H + H * F < -1e-12 * size * size) refuse_indefinite(p, inverse);

        HillCriterion hill;
        hill.normal.m = {G + H, -H, -G, -H, F + H, -F, -G, -F, F + G};
        double strongest = 0.0;
        for (std::size_t i = 0; i < 3; ++i) {
            hill.shear[i] = inverse[3 + i] * inverse[3 + i];
            strongest = std::max(strongest, inverse[3 + i]);
        }
        const double sum = F + G + H;
        hill.reference = sum > 0.0 ? 1.0 / std::sqrt(2.0 / 3.0 * sum) : std::sqrt(3.0) / strongest;
        return hill;
    }

  private:
    // Which of the yield stresses do not go together: some 1/Y above the sum of the others, in other words below the
    // difference of two.
    [[noreturn]] static void refuse_indefinite(const Properties& p, const std::array<double, 6>& inverse) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
            const double difference = std::fabs(inverse[j] - inverse[k]);
            if (difference <= inverse[i]) continue;
            const auto name = [](std::size_t n) { return "1/Y" + std::to_string(11 * (n + 1)); };
            p.refuse("Hill matrix is not positive semidefinite: abs(" + name(std::min(j, k)) + " - " +
                     name(std::max(j, k)) + ") = " + format_number(difference) + " > " + name(i) + " = " +
                     format_number(inverse[i]));
        }
        p.refuse("Hill matrix is not positive semidefinite");
    }
};

}  // namespace lode
