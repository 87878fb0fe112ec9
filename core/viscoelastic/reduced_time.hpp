// The reduced time increment of rheologically simple materials (page 60, 1.1; Nairn, 10.1.2 and 10.1.3):
//     dtr = int dt/(a_T a_c) + taums |dc/dt| int dt/(a_T a_mu)
// with temperature and moisture concentration linear in time over the increment.
#pragma once

#include "lode/material/description.hpp"
#include "lode/material/point.hpp"
#include "lode/material/properties.hpp"
#include "lode/numerics/functions.hpp"

namespace lode {

class ReducedTime {
  public:
    // Offsets of the constants from the first one.
    enum Constant { TSHIFT, TREF, C1, C2, CSHIFT, CREF, CC1, CC2, TAUMS, C5, DTRM };
    static constexpr int constant_count = DTRM + 1;
    static constexpr lode_parameter parameters[] = {
        optional(
            "TSHIFT", "shift by temperature", "code", code(0, 2), 0.0,
            "0 none; 1 WLF, -log10 a_T = C1 (T - TREF)/(C2 + T - TREF); 2 Arrhenius, -ln a_T = -C1 (1/T - 1/TREF)"),
        optional("TREF", "reference temperature", "temp", any_value(), 0.0, "absolute and > 0 for the Arrhenius shift"),
        optional("C1", "first WLF constant, or activation energy over gas constant", "- or temp", above(0.0), 17.44),
        optional("C2", "second WLF constant", "temp", above(0.0), 51.6),
        optional("CSHIFT", "shift by concentration (field 1)", "code", code(0, 1), 0.0,
                 "1: -log10 a_c = CC1 (c - CREF)/(CC2 + c)"),
        optional("CREF", "reference concentration", "field", at_least(0.0), 0.0),
        optional("CC1", "first constant of the shift by concentration", "-", at_least(0.0), 10.0),
        optional("CC2", "second constant of the shift by concentration", "field", above(0.0), 0.0625),
        optional("TAUMS", "mechanosorption time per unit concentration", "time/field", at_least(0.0), 0.0),
        optional("C5", "slope of 1/a_mu = 1 + C5 (c - CREF)", "1/field", any_value(), 0.0),
        optional("DTRM", "rule of the time integral", "code", code(0, 3), 0.0,
                 "0 ln a linear in time; 1 trapezoid; 2 midpoint; 3 three Gauss points, for steps of many degrees"),
    };

    ReducedTime() = default;
    // The constants are PROPS(first), ...
    ReducedTime(const Properties& p, int first)
        : temperature_shift_(p.code(first + TSHIFT)),
          concentration_shift_(p.code(first + CSHIFT) != 0),
          rule_(p.code(first + DTRM)),
          reference_temperature_(p[first + TREF]),
          C1_(p[first + C1] * (temperature_shift_ == 1 ? ln10 : 1.0)),
          C2_(p[first + C2]),
          reference_concentration_(p[first + CREF]),
          Cc1_(p[first + CC1] * ln10),
          Cc2_(p[first + CC2]),
          mechanosorption_(p[first + TAUMS]),
          C5_(p[first + C5]) {
        if (temperature_shift_ == 2 && !(reference_temperature_ > 0.0))
            p.refuse(first + TREF, "> 0: the Arrhenius shift needs absolute temperatures");
    }

    // False if dtr is DTIME, the same for all points.
    bool is_shifted() const { return temperature_shift_ != 0 || reads_concentration(); }
    bool reads_concentration() const { return concentration_shift_ || mechanosorption_ > 0.0; }

    // Sets dtr; false where the shifts are not defined: the point has been refused. The numbers are plain ones: DDSDDT
    // leaves the shifts out.
    template <AnalysisKind kind, class Real, class X>
    LODE_INLINE bool increment(const Increment<kind, Real>& increment, Point<kind, Real>& point, X& dtr) const {
        const double dt = max(increment.time_increment.value, 0.0);
        X T0(0.0), T1(0.0), c0(0.0), c1(0.0);
        Mask<X> frozen(false);
        if (temperature_shift_ != 0) {
            T0 = value_of(increment.temperature_start());
            T1 = T0 + value_of(increment.temperature_increment());
            if (!are_finite(point, T0 + T1)) return false;
            const X lowest = min(T0, T1);
            if (temperature_shift_ == 2) {
                const Mask<X> bad = !(lowest > X(0.0));
                if (any(bad)) return refuse(point, bad, "the absolute temperature", lowest);
            } else {
                frozen = !(lowest > X(reference_temperature_ - C2_));
                T0 = select(frozen, X(reference_temperature_), T0);
                T1 = select(frozen, X(reference_temperature_), T1);
            }
        }
        if (reads_concentration()) {
            c0 = value_of(increment.field_start(1));
            c1 = c0 + value_of(increment.field_increment(1));
            if (!are_finite(point, c0 + c1)) return false;
            const X lowest = min(c0, c1);
            if (concentration_shift_) {
                const Mask<X> bad = !(Cc2_ + lowest > X(0.0));
                if (any(bad)) return refuse(point, bad, "CC2 + c (concentration c = field 1)", Cc2_ + lowest);
            }
            if (mechanosorption_ > 0.0) {
                const X rate = min(mobility(c0), mobility(c1));
                const Mask<X> bad = !(rate > X(0.0));
                if (any(bad)) return refuse(point, bad, "1/a_mu = 1 + C5 (c - CREF)", rate);
            }
        }
        const bool sorbs = any(c1 != c0), is_constant = !sorbs && !any(T1 != T0);
        dtr = dt * mean(is_constant, [&](double part) {
                  const X T = T0 + part * (T1 - T0), c = c0 + part * (c1 - c0);
                  return temperature_exponent(T) + concentration_exponent(c);
              });
        if (mechanosorption_ > 0.0 && sorbs) {
            const X sorbed = mean(false, [&](double part) {
                const X T = T0 + part * (T1 - T0), c = c0 + part * (c1 - c0);
                return temperature_exponent(T) + log(mobility(c));
            });
            dtr = dtr + mechanosorption_ * abs(c1 - c0) * sorbed;
        }
        dtr = select(frozen, X(0.0), dtr);
        return true;
    }

  private:
    static constexpr double ln10 = 2.302585092994045684;

    int temperature_shift_ = 0;
    bool concentration_shift_ = false;
    int rule_ = 0;
    double reference_temperature_ = 0.0, C1_ = 0.0, C2_ = 1.0;  // C1 of natural logarithms
    double reference_concentration_ = 0.0, Cc1_ = 0.0, Cc2_ = 1.0;
    double mechanosorption_ = 0.0, C5_ = 0.0;

    // -ln a_T, -ln a_c, 1/a_mu.
    template <class X>
    LODE_INLINE X temperature_exponent(const X& T) const {
        if (temperature_shift_ == 0) return X(0.0);
        const X above = T - reference_temperature_;
        if (temperature_shift_ == 1) return C1_ * above / (C2_ + above);
        return C1_ * above / (reference_temperature_ * T);
    }
    template <class X>
    LODE_INLINE X concentration_exponent(const X& c) const {
        if (!concentration_shift_) return X(0.0);
        return Cc1_ * (c - reference_concentration_) / (Cc2_ + c);
    }
    template <class X>
    LODE_INLINE X mobility(const X& c) const {
        return 1.0 + C5_ * (c - reference_concentration_);
    }

    // (1/dt) int exp(f) dt by the chosen rule; `exponent(s)` is f at the fraction s of the increment.
    template <class F>
    LODE_INLINE auto mean(bool is_constant, const F& exponent) const {
        using X = decltype(exponent(0.0));
        const auto f = [&](double part) { return max(min(exponent(part), X(300.0)), X(-300.0)); };
        if (is_constant) return X(quick_exp(f(0.0)));
        switch (rule_) {
            case 1: {
                const X sum = quick_exp(f(0.0)) + quick_exp(f(1.0));
                return X(0.5 * sum);
            }
            case 2:
                return X(quick_exp(f(0.5)));
            case 3: {
                constexpr double node = 0.11270166537925831148;  // (1 - sqrt(3/5))/2
                const X outer = quick_exp(f(node)) + quick_exp(f(1.0 - node));
                return X((5.0 / 18.0) * outer + (8.0 / 18.0) * quick_exp(f(0.5)));
            }
            default: {
                // exp(f0) expm1(L)/L
                const X f0 = f(0.0), L = f(1.0) - f0;
                const Mask<X> tiny = abs(L) < X(1e-8);
                const X divisor = select(tiny, X(1.0), L);
                return X(quick_exp(f0) * select(tiny, 1.0 + 0.5 * L, quick_expm1(L) / divisor));
            }
        }
    }

    template <AnalysisKind kind, class Real, class X>
    LODE_INLINE static bool are_finite(Point<kind, Real>& point, const X& sum) {
        const Mask<X> finite = is_finite(sum);
        if (all(finite)) [[likely]]
            return true;
        point.fail(!finite, "temperature or field 1 is not finite");
        return false;
    }
    template <AnalysisKind kind, class Real, class X>
    static bool refuse(Point<kind, Real>& point, const Mask<X>& where, const char* what, const X& value) {
        point.refuse(where, what, Real(value), "> 0");
        return false;
    }
};

}  // namespace lode
