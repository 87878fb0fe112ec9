// STATEV of the solids that soften on a crack plane (page 30, section 2.3).
#pragma once

#include "lode/damage/softening_axes.hpp"
#include "lode/damage/softening_crack.hpp"
#include "lode/damage/softening_size.hpp"
#include "lode/material/description.hpp"

namespace lode::softening_state {

// 1-based STATEV indices.
enum Slot {
    STATE = 1,
    AXIS_N,
    AXIS_T = 5,
    DELTA = 8,
    D = 11,
    EC = 14,
    W = 17,
    H = 20,
    MODE,
    W_F,
    EZZ,
    REL_S,
    REL_G,
    STATUS,
    count = STATUS
};

inline constexpr lode_state states[] = {
    {"STATE", "0 intact, 1 damaged, 2 failed", 0.0},
    {"N1", "crack normal (crack x axis), component 1", 0.0},
    {"N2", "crack normal, component 2", 0.0},
    {"N3", "crack normal, component 3", 0.0},
    {"T1", "crack y axis, component 1; the z axis is N x T", 0.0},
    {"T2", "crack y axis, component 2", 0.0},
    {"T3", "crack y axis, component 3", 0.0},
    {"DELTA_N", "critical cracking strain, normal", 0.0},
    {"DELTA_Y", "critical cracking strain, shear y", 0.0},
    {"DELTA_Z", "critical cracking strain, shear z", 0.0},
    {"D_N", "damage, normal", 0.0},
    {"D_Y", "damage, shear y", 0.0},
    {"D_Z", "damage, shear z", 0.0},
    {"EC_N", "cracking strain, normal", 0.0},
    {"GC_Y", "cracking strain, shear y (engineering)", 0.0},
    {"GC_Z", "cracking strain, shear z (engineering)", 0.0},
    {"W_N", "dissipated energy per volume, normal; H W_N per area", 0.0},
    {"W_Y", "dissipated energy per volume, shear y", 0.0},
    {"W_Z", "dissipated energy per volume, shear z", 0.0},
    {"H", "characteristic length, frozen at initiation", 0.0},
    {"MODE", "how the crack formed: 1 tension, 2 shear, 3 mixed", 0.0},
    {"W_F", "frictional dissipation per volume", 0.0},
    {"EZZ", "out-of-plane strain, plane stress only", 0.0},
    {"REL_S", "relative strength of this point, 0 is read as 1", 0.0},
    {"REL_G", "relative toughness of this point, 0 is read as 1", 0.0},
    {"STATUS", "1 active, 0 deleted", 0.0},
};
static_assert(count_of(states) == count);

// h, REL_S and REL_G of a point.
template <class Real>
struct PointSize : SofteningSize<Real> {
    template <AnalysisKind kind>
    LODE_INLINE bool read(const Increment<kind, Real>& increment, Point<kind, Real>& point, const Mask<Real>& intact,
                          double fixed_length) {
        return SofteningSize<Real>::read(increment, point, {H, REL_S, REL_G}, intact, fixed_length);
    }
};

template <int m, class Real>
LODE_INLINE CrackState<m, Real> read(const State<Real>& state) {
    CrackState<m, Real> crack;
    for (int j = 0; j < m; ++j) {
        crack.delta[j] = state[DELTA + j];
        crack.damage[j] = state[D + j];
        crack.strain[j] = state[EC + j];
        crack.dissipated[j] = state[W + j];
    }
    return crack;
}

// All but EZZ.
template <int m, class Real>
LODE_INLINE void store(State<Real>& state, const CrackAxes<Real>& axes, const CrackState<m, Real>& crack,
                       const Mask<Real>& cracked, const Mask<Real>& failed, const Real& length, const Real& mode,
                       const Real& friction_work, bool deletes) {
    const Real zero(0.0), one(1.0);
    const Real friction = state[W_F] + friction_work, h = select(cracked, length, state[H]);
    state.set(STATE, select(failed, Real(2.0), select(cracked, one, zero)));
    for (int i = 0; i < 3; ++i) {
        state.set(AXIS_N + i, axes.N[i]);
        state.set(AXIS_T + i, axes.T[i]);
    }
    for (int j = 0; j < 3; ++j) {
        const int k = j < m ? j : 0;
        if (j < m) {
            state.set(DELTA + j, crack.delta[k]);
            state.set(D + j, crack.damage[k]);
            state.set(EC + j, crack.strain[k]);
            state.set(W + j, crack.dissipated[k]);
        } else {
            for (const int first : {DELTA, D, EC, W}) state.keep(first + j);
        }
    }
    state.set(H, h);
    state.set(MODE, mode);
    state.set(W_F, friction);
    state.keep(REL_S);
    state.keep(REL_G);
    state.set(STATUS, deletes ? select(failed, zero, one) : one);
}

// Of a point without a crack.
template <class Real>
LODE_INLINE void store_intact(State<Real>& state) {
    for (int i = STATE; i < EZZ; ++i) state.keep(i);
    state.keep(REL_S);
    state.keep(REL_G);
    state.set(STATUS, Real(1.0));
}

}  // namespace lode::softening_state
