// The thermal block of the plastic models (page 25, section 3): temperature of the point, heat of plastic work and of
// volume change, and what becomes of it. A model calls, in this order,
//   required_state                        STATEV entries that TMODE needs
//   is_absolute                           before anything is written: false, and the point refused, where T <= 0
//   temperature, temperature_increment    theta of the laws; what acts as thermal strain
//   plastic_heat, thermoelastic_heat      dPhi and H_is of the increment, and their derivatives
//   store                                 STATEV 5-10, those that the host provides
//   set_heat_rate                         RPL of an implicit call; DRPLDE, DRPLDT are the model's own
// With TMODE = 0 and NSTATV < 7 nothing of this costs more than a test of two constants.
#pragma once

#include "lode/material/point.hpp"
#include "lode/material/properties.hpp"

namespace lode {

class ThermalBlock {
  public:
    // The place of the block in STATEV (1-based), the same in all models that carry it.
    enum Slot { TAD = 5, DTAD, ASTOR, PHI, HEATQ, ENTR };

    // TABS, RHOCV, CHI, TMODE are PROPS(first), ..., PROPS(first + 3). A softening law stores no energy that it could
    // release: CHI = 0 is read as 1. Throws BadProperty.
    ThermalBlock(const Properties& p, int first, bool softens)
        : absolute_zero_offset_(p[first]),
          heat_capacity_(p[first + 1]),
          fraction_(p[first + 2]),
          mode_(p.code(first + 3)) {
        if (fraction_ < 0.0 && fraction_ != -1.0) p.refuse(first + 2, "-1, 0 or in (0, 1]");
        if (softens && fraction_ == 0.0) fraction_ = 1.0;
        if (heats_itself() && heat_capacity_ <= 0.0) p.refuse(first + 1, "> 0: TMODE 2, 3 need RHOCV > 0");
        inverse_heat_capacity_ = heat_capacity_ > 0.0 ? 1.0 / heat_capacity_ : 0.0;
    }

    bool heats_itself() const { return mode_ >= 2; }              // TMODE 2, 3
    bool is_thermoelastic() const { return (mode_ & 1) != 0; }    // TMODE 1, 3
    bool uses_source_rule() const { return fraction_ == 0.0; }    // CHI = 0
    bool makes_plastic_heat() const { return fraction_ >= 0.0; }  // CHI other than -1
    int required_state() const { return heats_itself() ? DTAD : TAD - 1; }

    // theta: TEMP + DTEMP, with TAD where the point heats itself.
    template <AnalysisKind kind, class Real>
    LODE_INLINE Real temperature(const Increment<kind, Real>& increment, const State<Real>& state) const {
        const Real theta = increment.temperature_end();
        return heats_itself() ? theta + state[TAD] : theta;
    }
    // What acts as thermal strain: DTEMP, with the self-heating of the increment before.
    template <AnalysisKind kind, class Real>
    LODE_INLINE Real temperature_increment(const Increment<kind, Real>& increment, const State<Real>& state) const {
        const Real change = increment.temperature_increment();
        return heats_itself() ? change + state[DTAD] : change;
    }
    // T of theta.
    template <class Real>
    LODE_INLINE Real absolute(const Real& theta) const {
        return theta + absolute_zero_offset_;
    }
    // Refuses the point where T <= 0.
    template <AnalysisKind kind, class Real>
    LODE_INLINE bool is_absolute(Point<kind, Real>& point, const Real& theta) const {
        const Mask<Real> cold = !(absolute(theta) > Real(0.0));
        if (!any(cold)) [[likely]]
            return true;
        point.refuse(cold, "the absolute temperature TEMP + TABS", absolute(theta), "> 0");
        return false;
    }

    // dPhi from what the source rule makes of the increment (sigma:dep - psi dalpha) and from the plastic work. It is
    // linear in both: their derivatives give its derivative.
    template <class Real>
    LODE_INLINE Real plastic_heat(const Real& by_source_rule, const Real& work) const {
        if (fraction_ == 0.0) return by_source_rule;
        return fraction_ < 0.0 ? Real(0.0) : fraction_ * work;
    }
    // H_is = T M : d eps_total from M : d eps_total (isotropic: -3K alpha d eps_v); 0 in TMODE 0, 2.
    template <class Real>
    LODE_INLINE Real thermoelastic_heat(const Real& theta, const Real& stress_work) const {
        return is_thermoelastic() ? absolute(theta) * stress_work : Real(0.0);
    }

    // Section 3, steps 3 and 4. Call it when success is certain.
    template <AnalysisKind kind, class Real>
    LODE_INLINE void store(const Increment<kind, Real>& increment, State<Real>& state, const Real& plastic_work,
                           const Real& plastic_heat, const Real& thermoelastic_heat) const {
        const bool keeps_balance = state.has(ASTOR);
        if (!keeps_balance && !heats_itself()) return;
        const Real theta = temperature(increment, state);
        if (heats_itself()) {
            const Real warmer = inverse_heat_capacity_ * (plastic_heat + thermoelastic_heat);
            const Real total = state[TAD] + warmer;
            state.set(TAD, total);
            state.set(DTAD, warmer);
        }
        if (!keeps_balance) return;
        Real received = heat_capacity_ * increment.temperature_increment();
        if (!heats_itself()) received = received - (thermoelastic_heat + plastic_heat);
        const Real T = absolute(theta);
        const Mask<Real> warm = T > Real(0.0);
        const Real entropy = select(warm, (received + plastic_heat) / select(warm, T, Real(1.0)), Real(0.0));
        add(state, ASTOR, plastic_work - plastic_heat);
        add(state, PHI, plastic_heat);
        add(state, HEATQ, received);
        add(state, ENTR, entropy);
    }

    // RPL, which a point that heats itself keeps.
    template <AnalysisKind kind>
    LODE_INLINE void set_heat_rate(Tangent<kind>& tangent, const Increment<kind, double>& increment,
                                   double heat) const {
        if (!heats_itself()) tangent.heat_rate = heat * increment.time_increment.inverse;
    }

  private:
    template <class Real>
    LODE_INLINE static void add(State<Real>& state, int slot, const Real& x) {
        if (!state.has(slot)) return;
        const Real sum = state[slot] + x;
        state.set(slot, sum);
    }

    double absolute_zero_offset_, heat_capacity_, inverse_heat_capacity_ = 0.0, fraction_;
    int mode_;
};

// DDSDDT and, by DRPLDE, DRPLDT of a material that feels temperature through its thermal strain alone; `expansion` is
// the expansion coefficient of each normal component. DDSDDE and the plastic part of DRPLDE must be set.
template <AnalysisKind kind, class Expansion>
LODE_INLINE void set_thermal_strain_tangent(Tangent<kind>& tangent, const Expansion& expansion) {
    for (int j = 0; j < normal_components(kind); ++j) {
        for (int i = 0; i < components(kind); ++i) tangent.thermal_stress[i] -= expansion(j) * tangent(i, j);
        tangent.heat_rate_temperature -= expansion(j) * tangent.heat_rate_strain[j];
    }
}

}  // namespace lode
