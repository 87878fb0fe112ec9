// The law of PORO_TRANSISO and PORO_ORTHO (page 45, section 4): Biot poroelasticity in material axes that turn with the
// host's rotation. Pore pressure acts as a field variable that swells the material by h = S alpha.
#pragma once

#include "lode/elastic/material_axes.hpp"
#include "lode/elastic/rotated_moduli.hpp"
#include "lode/poroelastic/pore_pressure.hpp"

namespace lode {

namespace poro_anisotropic {

// Section 1: h, K, and Q from the undrained bulk modulus.
struct Biot {
    std::array<double, 3> alpha, h{};
    double K = 0.0, h_ii = 0.0, ha = 0.0, Q = 0.0;

    // Throws BadProperty; PROPS(first_alpha) is named where all alpha are 0, PROPS(undrained) = Ku.
    Biot(const Properties& p, const OrthotropicModuli& m, const std::array<double, 3>& biot, int first_alpha,
         int undrained)
        : alpha(biot) {
        if (alpha[0] == 0.0 && alpha[1] == 0.0 && alpha[2] == 0.0)
            p.refuse(first_alpha, "above 0, or another Biot coefficient be: Ku says nothing of Q where all are 0");
        double compliance = 0.0;
        for (int i = 0; i < 3; ++i) {
            const auto k = static_cast<std::size_t>(i);
            for (int j = 0; j < 3; ++j) {
                h[k] += m.compliance(i, j) * alpha[static_cast<std::size_t>(j)];
                compliance += m.compliance(i, j);
            }
            h_ii += h[k];
            ha += h[k] * alpha[k];
        }
        K = 1.0 / compliance;
        const double Ku = p[undrained];
        if (!(Ku > K)) p.refuse(undrained, "above the drained bulk modulus " + format_number(K));
        // 1/Q = [K Ku h_ii^2 - (Ku - K) ha]/(Ku - K) (8.18); no bound where all alpha are equal.
        const double spread = ha - K * h_ii * h_ii;
        const bool bounded = spread > 1e-13 * ha;
        const double storage = K * h_ii * h_ii / (Ku - K) * K - (bounded ? spread : 0.0);
        if (!(storage > 0.0)) p.refuse(undrained, "below " + format_number(K * ha / spread) + ", where 1/Q ends");
        Q = 1.0 / storage;
    }
};

struct Constants {
    OrthotropicModuli moduli;
    MaterialAxes axes;
    Biot biot;
    Expansion thermal;
    PorePressure pores;
};

inline constexpr auto limits_text = joined(
    "- KU at or above K ha/(ha - K hii^2), where 1/Q ends, is refused with that value.\n"
    "- 2D elements whose material axes are tilted out of the plane (no axis normal to it) end the analysis with a "
    "message.\n"
    "- Large rotation in an increment: as in the elastic keyword, keep below 1 degree an increment for 1 %.\n",
    pore_pressure::limits);
inline constexpr const char* limits = limits_text.data();

// A model with these constants.
class Law {
  public:
    explicit Law(const Constants& constants)
        : c_(constants),
          swelling_(swelling(constants)),
          energy_(c_.moduli),
          at_3d_(c_, swelling_, c_.axes.r),
          at_plane_strain_(c_, swelling_, c_.axes.r),
          at_plane_stress_(c_, swelling_, c_.axes.r),
          at_1d_(c_, swelling_, c_.axes.r),
          along_host_(c_.axes.along_host()) {}

    int required_state(AnalysisKind) const { return pore_pressure::count; }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& tangent) const {
        set_stiffness(unturned<kind>(), c_.pores.is_generated(), tangent);
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        using Frame = HostRotation<kind, Real>;
        using Turned = InHostAxes<kind, Number<Real>>;
        if (!c_.axes.serve(point)) return;
        Frame frame;
        Turned own;
        const Turned* current = nullptr;
        const bool turned = !Frame::is_identity(increment, point.state, pore_pressure::ROTATION);
        if constexpr (Frame::turns && !is_batch<Real>)
            if (turned) {
                frame = Frame::advanced(increment, point.state, pore_pressure::ROTATION);
                own = Turned(c_, swelling_, frame.times(c_.axes));
                current = &own;
            }
        if (current == nullptr) {
            if constexpr (std::is_same_v<Number<Real>, double>) current = &unturned<kind>();
            else own = Turned(unturned<kind>()), current = &own;
        }
        if (!update_in(*current, increment, point, tangent)) return;
        if (turned) frame.store(point.state, pore_pressure::ROTATION);
        else
            for (int i = 0; i < 9; ++i) point.state.keep(pore_pressure::ROTATION + i);
    }

  private:
    // The axes of all lanes of a batch are those of the host's frame, which turns.
    template <class Real>
    using Number = std::conditional_t<is_batch<Real>, double, Real>;

    // D, g (as `moisture`) and the coupling in axes R.
    template <AnalysisKind kind, class Real>
    struct InHostAxes {
        RotatedModuli<kind, Real> moduli;
        PoreCoupling<Real> coupling;

        InHostAxes() = default;
        LODE_INLINE InHostAxes(const Constants& c, const Expansion& swelling, const Matrix3<Real>& r)
            : moduli(c.moduli, r, c.thermal, swelling) {
            const double Q = c.pores.modulus();
            if constexpr (kind == AnalysisKind::plane_stress) {
                const Real a33 = moduli.lateral_moisture / moduli.thickness_compliance;
                coupling = {Q, a33 * moduli.lateral_moisture, a33 * moduli.lateral_thermal};
            } else if constexpr (kind == AnalysisKind::uniaxial) {
                // B = h.alpha - h_1 g, and alpha.a - g a_1
                const Real h_1 = moduli.moisture[0] / moduli.stiffness[0];
                double alpha_a = 0.0;
                for (std::size_t i = 0; i < 3; ++i) alpha_a += c.biot.alpha[i] * c.thermal.strain[i];
                coupling = {Q, max(Real(c.biot.ha - h_1 * moduli.moisture[0]), Real(0.0)),
                            alpha_a - h_1 * moduli.thermal[0]};
            }
        }
        // Constants for an update on numbers that carry derivatives.
        template <class Other>
        explicit InHostAxes(const InHostAxes<kind, Other>& other)
            : moduli(other.moduli), coupling(0.0, Real(other.coupling.B), Real(other.coupling.heating)) {
            coupling.QB = Real(other.coupling.QB), coupling.slope = Real(other.coupling.slope);
        }
    };

    static Expansion swelling(const Constants& c) {
        Expansion e = Expansion::from(c.moduli, c.biot.h[0], c.biot.h[1], c.biot.h[2]);
        e.stress = c.biot.alpha;  // C h
        return e;
    }

    template <AnalysisKind kind>
    LODE_INLINE const InHostAxes<kind, double>& unturned() const {
        if constexpr (kind == AnalysisKind::solid) return at_3d_;
        else if constexpr (kind == AnalysisKind::plane_strain) return at_plane_strain_;
        else if constexpr (kind == AnalysisKind::plane_stress) return at_plane_stress_;
        else return at_1d_;
    }

    // False where the increment cannot be done.
    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE bool update_in(const InHostAxes<kind, Number<Real>>& at, const Increment<kind, Real>& increment,
                               Point<kind, Real>& point, T& tangent) const {
        constexpr int n = components(kind);
        const auto& m = at.moduli;
        auto& state = point.state;
        PoreLoad<Real> load;
        if (!c_.pores.read(increment, point, load)) return false;
        const Strain<kind, Real>& strain = increment.strain_increment;

        // Elastic predictor e and A = alpha.d(eps) without what dp itself does (section 4, step 3).
        Stress<kind, Real> change;
        if (is_batch<Real> && along_host_) change = m.template stress<true>(strain);
        else change = m.stress(strain);
        Real warmer(0.0), A = m.moisture[0] * strain[0];
        for (int i = 1; i < n; ++i) A = A + m.moisture[i] * strain[i];
        if (c_.thermal.present) {
            warmer = increment.temperature_increment();
            for (int i = 0; i < n; ++i) change[i] = change[i] - m.thermal[i] * warmer;
            A = A + at.coupling.heating * warmer;
        }
        const Real p = c_.pores.at_end(load, A, at.coupling);
        const Real dp = c_.pores.effective(p) - c_.pores.effective(load.start);
        for (int i = 0; i < n; ++i) change[i] = change[i] - m.moisture[i] * dp;
        point.stress += change;
        const Real volume = A + at.coupling.B * dp;

        if constexpr (kind == AnalysisKind::plane_stress) {
            Real thickness = m.lateral[0] * strain[0] + m.lateral[1] * strain[1] + m.lateral[2] * strain[2] +
                             m.lateral_moisture * dp;
            if (c_.thermal.present) thickness = thickness + m.lateral_thermal * warmer;
            point.thickness_strain_increment = thickness;
            state.set(pore_pressure::EZZ, state[pore_pressure::EZZ] + thickness);
        } else {
            state.keep(pore_pressure::EZZ);
        }
        if constexpr (!is_batch<Real>)
            point.elastic_energy = solid_energy(at, point.stress, c_.pores.carried(p)) + c_.pores.energy(p);
        if constexpr (wants_tangent<T>) {
            const bool stiffens = c_.pores.stiffens(p);
            set_stiffness(at, stiffens, tangent);
            if (c_.thermal.present) {
                const double pressure = stiffens ? c_.pores.modulus() * at.coupling.heating * at.coupling.slope : 0.0;
                for (int i = 0; i < n; ++i) tangent.thermal_stress[i] = m.moisture[i] * pressure - m.thermal[i];
            }
        }
        c_.pores.store(increment, state, load, p, volume);
        return true;
    }

    // sigma_s : S : sigma_s/2 of the solid stress sigma + alpha dp, whose free components are alpha dp alone.
    template <AnalysisKind kind, class Real>
    LODE_INLINE Real solid_energy(const InHostAxes<kind, Number<Real>>& at, Stress<kind, Real> s,
                                  const Real& carried) const {
        const auto& m = at.moduli;
        if constexpr (kind == AnalysisKind::uniaxial) {
            const Real strain = s[0] / m(0, 0);
            return 0.5 * s[0] * strain + carried * (m.moisture[0] * strain + (0.5 * c_.biot.ha) * carried);
        } else {
            Real out_of_plane(0.0);
            if constexpr (kind == AnalysisKind::plane_stress) {
                const Real a33 = m.lateral_moisture / m.thickness_compliance;
                for (int i = 0; i < 3; ++i) s[i] = s[i] + (m.moisture[i] - m.lateral[i] * a33) * carried;
                out_of_plane = a33 * carried;
            } else {
                for (int i = 0; i < components(kind); ++i) s[i] = s[i] + m.moisture[i] * carried;
            }
            return energy_(m.axes, s, out_of_plane);
        }
    }

    // D, or D + Q g (x) g/(1 + QB).
    template <AnalysisKind kind>
    LODE_INLINE void set_stiffness(const InHostAxes<kind, double>& at, bool with_pressure,
                                   Tangent<kind>& tangent) const {
        constexpr int n = components(kind);
        if (!with_pressure) return at.moduli.store(tangent);
        const double factor = c_.pores.modulus() * at.coupling.slope;
        const auto& g = at.moduli.moisture;
        if constexpr (n == 1) {
            tangent(0, 0) = at.moduli(0, 0) + factor * g[0] * g[0];
        } else {
            Column<n> pressure{};
            for (int i = 0; i < n; ++i) pressure[i] = g[i];
            for (int j = 0; j < n; ++j)
                store_column<n>(tangent.stiffness, j, at.moduli.column(j) + (factor * g[j]) * pressure);
        }
    }

    Constants c_;
    Expansion swelling_;
    ElasticEnergy energy_;
    InHostAxes<AnalysisKind::solid, double> at_3d_;
    InHostAxes<AnalysisKind::plane_strain, double> at_plane_strain_;
    InHostAxes<AnalysisKind::plane_stress, double> at_plane_stress_;
    InHostAxes<AnalysisKind::uniaxial, double> at_1d_;
    bool along_host_;
};

}  // namespace poro_anisotropic

}  // namespace lode
