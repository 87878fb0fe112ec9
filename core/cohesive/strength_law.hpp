// The strength law that a code of page 40, section 2 selects, for models that leave the choice to the user.
#pragma once

#include <variant>

#include "lode/cohesive/cubic_laws.hpp"
#include "lode/cohesive/exponential_laws.hpp"
#include "lode/cohesive/strength_laws.hpp"

namespace lode {

class StrengthLaw : public StrengthConstants {
    using Variant = std::variant<Sawtooth, GeneralCubic, Needleman, ExponentialDecay, AbaqusExponential, Bilinear>;

  public:
    StrengthLaw(int code, const Properties& p, const LawEntries& at) : StrengthLaw(code, make(code, p, at)) {}

    int code() const { return code_; }
    bool has_psi() const { return code_ != 4 && code_ != 5; }
    const Sawtooth& sawtooth() const { return *std::get_if<Sawtooth>(&law_); }
    // Where the law has a kink beyond u_e; 0 if nowhere.
    double break_point() const { return code_ == 6 ? std::get_if<Bilinear>(&law_)->break_point : 0.0; }

    template <class F>
    auto visit(const F& f) const {
        switch (code_) {
            case 1:
                return f(*std::get_if<0>(&law_));
            case 2:
                return f(*std::get_if<1>(&law_));
            case 3:
                return f(*std::get_if<2>(&law_));
            case 4:
                return f(*std::get_if<3>(&law_));
            case 5:
                return f(*std::get_if<4>(&law_));
            default:
                return f(*std::get_if<5>(&law_));
        }
    }

    template <class Real>
    Real integrity(const Real& delta) const {
        return visit([&](const auto& law) { return law.integrity(delta); });
    }
    template <class Real>
    Real slope(const Real& delta) const {
        return visit([&](const auto& law) { return law.slope(delta); });
    }
    template <class Real>
    Real released_energy(const Real& delta) const {
        return visit([&](const auto& law) { return law.released_energy(delta); });
    }
    template <class Real>
    Real release_rate(const Real& delta) const {
        return visit([&](const auto& law) { return law.release_rate(delta); });
    }
    template <class Real>
    Real damage_rate(const Real& delta) const {
        return visit([&](const auto& law) { return lode::damage_rate(law, delta); });
    }
    template <class Real>
    Real opening(const Real& q) const {
        return visit([&](const auto& law) { return law.opening(q); });
    }
    template <class Real>
    Real psi(const Real& delta) const {
        return visit([&](const auto& law) {
            if constexpr (std::decay_t<decltype(law)>::has_psi) return law.psi(delta);
            else return Real(0.0);
        });
    }
    template <class Real>
    Real opening_at(const Real& psi_value) const {
        return visit([&](const auto& law) {
            if constexpr (std::decay_t<decltype(law)>::has_psi) return law.opening_at(psi_value);
            else return Real(law.end);
        });
    }

  private:
    StrengthLaw(int code, const Variant& law)
        : StrengthConstants(std::visit([](const auto& l) -> const StrengthConstants& { return l; }, law)),
          law_(law),
          code_(code) {}

    static Variant make(int code, const Properties& p, const LawEntries& at) {
        if (code != 3 && !(p[at.k] > 0.0)) p.refuse(at.k, "> 0");
        switch (code) {
            case 1:
                return Sawtooth(p, at);
            case 2:
                return GeneralCubic(p, at);
            case 3:
                return Needleman(p, at);
            case 4:
                return ExponentialDecay(p, at);
            case 5:
                return AbaqusExponential(p, at);
            default:
                return Bilinear(p, at);
        }
    }

    Variant law_;
    int code_;
};

inline double break_point(const StrengthLaw& law) { return law.break_point(); }
inline double break_point(const Sawtooth&) { return 0.0; }

}  // namespace lode
