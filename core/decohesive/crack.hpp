// A crack of STATEV, and the rules by which cracks start and increments are integrated (page 80, sections 1, 2).
#pragma once

#include "lode/numerics/scalar.hpp"
#include "lode/tensor/voigt.hpp"

namespace lode {

inline constexpr int most_cracks = 20;

template <class Real>
struct Crack {
    Vector<Real, 3> n, u;  // normal, displacement jump
    Real G;                // energy dissipated per area
    int phase;             // 0 none, 1 softening, 2 failed and open, 3 failed and closed

    Crack() = default;  // not set
    template <class Other>
    explicit Crack(const Crack<Other>& c) : G(value_of(c.G)), phase(c.phase) {
        for (int i = 0; i < 3; ++i) {
            n[i] = Real(value_of(c.n[i]));
            u[i] = Real(value_of(c.u[i]));
        }
    }
};

// How cracks start and increments are integrated.
struct CrackControl {
    int most;         // N_c
    int integration;  // 0 backward Euler, 1 cutting plane, n >= 2: backward Euler in n substeps
    double closest;   // cos alpha_th + 1e-12
    bool prescribed;  // the normal is in the first crack already
    bool accepts_unconverged;

    int substeps() const { return integration >= 2 ? integration : 1; }
    bool cutting_plane() const { return integration == 1; }
};

enum class CrackStatus { done, unconverged, no_cutting_plane };

}  // namespace lode
