// The pore pressure of a Biot solid: how it moves in an increment, what of it the stress feels, and what the host's
// transport equation needs (page 45, sections 1, 3 and 4; Nairn, eqs. 8.1-8.31).
#pragma once

#include "lode/elastic/known_field.hpp"
#include "lode/material/description.hpp"
#include "lode/material/point.hpp"
#include "lode/material/properties.hpp"

namespace lode {

// Two texts in one, NUL-terminated.
template <std::size_t n, std::size_t m>
constexpr std::array<char, n + m - 1> joined(const char (&first)[n], const char (&second)[m]) {
    std::array<char, n + m - 1> text{};
    for (std::size_t i = 0; i + 1 < n; ++i) text[i] = first[i];
    for (std::size_t i = 0; i < m; ++i) text[n - 1 + i] = second[i];
    return text;
}

namespace pore_pressure {

// 1-based STATEV indices.
enum Slot { PE = 1, THETA, DP_UD, STORAGE, MOBILITY, DT_P = 8, EZZ, ROTATION, isotropic_count = EZZ, count = 18 };

inline constexpr lode_state states[] = {
    {"PE", "pore pressure minus P0", 0.0},
    {"THETA", "increment of fluid content since the start, 0 in MODE 1", 0.0},
    {"DP_UD", "undrained pressure increment of this increment, a source of the host's transport equation", 0.0},
    {"STORAGE", "1/Q of the transport equation", 0.0},
    {"MOB1", "mobility k/eta along material axis 1", 0.0},
    {"MOB2", "mobility along material axis 2", 0.0},
    {"MOB3", "mobility along material axis 3", 0.0},
    {"DT_P", "diffusion time step CELENT^2/(2 Q max k/eta), per dimension; 0 without permeability", 0.0},
    {"EZZ", "out-of-plane strain, plane stress only", 0.0},
    {"PQ11M1", "host rotation Q - I of the pore axes; 0 in a VUMAT", 0.0},
    {"PQ12", "", 0.0},
    {"PQ13", "", 0.0},
    {"PQ21", "", 0.0},
    {"PQ22M1", "", 0.0},
    {"PQ23", "", 0.0},
    {"PQ31", "", 0.0},
    {"PQ32", "", 0.0},
    {"PQ33M1", "", 0.0},
};
static_assert(count_of(states) == count);

inline constexpr char mode_note[] =
    "0 p is field variable 1; 1 undrained, no field is read; 2 undrained, DPRED(1) adds the transport part";
inline constexpr char limits[] =
    "- MODE 1 or 2 in a host whose own pressure equation has the coupling term -alpha.d(eps)/dt counts the volume "
    "change twice: use MODE 0 there. A host that subtracts p itself wants the stress of the skeleton: use the elastic "
    "keywords.\n"
    "- MODE 0 in a VUMAT without field variables: p = 0. An implicit host cannot tell: its PREDEF(1) is p.\n"
    "- Q large (an incompressible fluid): volumetric locking of the host's elements.\n"
    "- CLIP = 1, p crossing 0: DDSDDE jumps by Q g (x) g/(1 + QB), and the host's Newton iteration may cycle between "
    "the branches; p itself is unique. The probe of an explicit host is answered with the stiffer branch.\n"
    "- An explicit transport step is unstable beyond STATEV DT_P divided by the number of dimensions: the host "
    "decides.\n";

}  // namespace pore_pressure

// What the strain does to the pressure in a kind: vol = A + B d(eff p), A = g.d(eps) + heating d(temperature). B and
// `heating` are 0 where no stress component is free.
template <class Number>
struct PoreCoupling {
    Number B = Number(0.0), heating = Number(0.0);
    Number QB = Number(0.0), slope = Number(1.0);  // slope: 1/(1 + QB)

    PoreCoupling() = default;
    LODE_INLINE PoreCoupling(double Q, const Number& b, const Number& h)
        : B(b), heating(h), QB(Q * b), slope(1.0 / (1.0 + Q * b)) {}
};

// Pressure at the start of an increment, and what the host adds to it.
template <class Real>
struct PoreLoad {
    Real start, external;
};

class PorePressure {
  public:
    // PROPS(first) ... = mode, clip, p0; PROPS(viscosity) = eta. Q is the Biot modulus, k the permeabilities.
    PorePressure(const Properties& p, int first, int viscosity, double Q, const std::array<double, 3>& k)
        : Q_(Q), storage_(1.0 / Q), reference_(p[first + 2]), mode_(p.code(first)), clips_(p.code(first + 1) == 1) {
        for (std::size_t i = 0; i < 3; ++i) mobility_[i] = k[i] / p[viscosity];
        const double largest = std::max({mobility_[0], mobility_[1], mobility_[2]});
        diffusion_ = largest > 0.0 ? 0.5 / (Q * largest) : 0.0;
    }

    double modulus() const { return Q_; }
    double storage() const { return storage_; }
    bool is_generated() const { return mode_ != 0; }  // modes 1, 2: by the strain
    bool reads_field() const { return mode_ != 1; }

    // The pressure that acts on the stress, less that at the reference: eff(p) - eff(p0).
    template <class Real>
    LODE_INLINE Real carried(const Real& p) const {
        return effective(p) - effective(reference_);
    }
    template <class Real>
    LODE_INLINE Real effective(const Real& p) const {
        if (clips_) return positive_part(p);
        return p;
    }

    // False, with the point marked as failed, where field variable 1 is not finite.
    template <AnalysisKind kind, class Real>
    LODE_INLINE bool read(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                          PoreLoad<Real>& load) const {
        load = {Real(0.0), Real(0.0)};
        if (reads_field() && increment.field_count > 0) {
            load.external = increment.field_increment(1);
            if (mode_ == 0) load.start = increment.field_start(1);
            if (!is_known(Real(load.start + load.external), point)) return false;
        }
        if (is_generated()) load.start = point.state[pore_pressure::PE] + reference_;
        return true;
    }

    // Section 4, step 4: undrained condition and stress-free components together.
    template <class Real, class Number>
    LODE_INLINE Real at_end(const PoreLoad<Real>& load, const Real& A, const PoreCoupling<Number>& c) const {
        if (!is_generated()) return load.start + load.external;
        const Real r = load.start + load.external - Q_ * A + c.QB * effective(load.start);
        if (!clips_) return r * c.slope;
        return select(r > Real(0.0), Real(r * c.slope), r);
    }
    // Strain moves a pressure that the stress feels: DDSDDE has a pressure part.
    LODE_INLINE bool stiffens(double p) const { return is_generated() && (!clips_ || p > 0.0); }

    // Energy of the fluid, the integral of eff(p) - eff(p0) over p/Q.
    template <class Real>
    LODE_INLINE Real energy(const Real& p) const {
        const Real change = p - reference_;
        if (!clips_) return 0.5 * storage_ * change * change;
        const Real now = effective(p);
        const double before = effective(reference_);
        return storage_ * (0.5 * (now * now - before * before) - before * change);
    }

    // STATEV 1-8. `volume` is alpha.d(eps).
    template <AnalysisKind kind, class Real>
    LODE_INLINE void store(const Increment<kind, Real>& increment, State<Real>& state, const PoreLoad<Real>& load,
                           const Real& p, const Real& volume) const {
        using namespace pore_pressure;
        state.set(PE, p - reference_);
        if (mode_ == 1) state.keep(THETA);
        else state.set(THETA, state[THETA] + volume + storage_ * (p - load.start));
        state.set(DP_UD, -Q_ * volume);
        state.set(STORAGE, Real(storage_));
        for (int i = 0; i < 3; ++i) state.set(MOBILITY + i, Real(mobility_[static_cast<std::size_t>(i)]));
        Real step(0.0);
        if (diffusion_ > 0.0) {
            const Real length = increment.element_length();
            const Mask<Real> known = length > Real(0.0) && is_finite(Real(length * length));
            step = select(known, Real(diffusion_ * (length * length)), Real(0.0));
        }
        state.set(DT_P, step);
    }

  private:
    double Q_, storage_, reference_, diffusion_ = 0.0;
    std::array<double, 3> mobility_{};
    int mode_;
    bool clips_;
};

}  // namespace lode
