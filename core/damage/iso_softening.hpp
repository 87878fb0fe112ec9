// ISO_SOFTENING: an isotropic solid that softens on one crack plane (page 30; Nairn, chapter 5). The stress is that of
// elasticity less the cracking strain, sigma = C (eps - eps_res - eps_c), eps_c = (EC_N; GC_Y; GC_Z) in crack axes.
#pragma once

#include "lode/damage/iso_softening_description.hpp"
#include "lode/damage/softening_onset.hpp"
#include "lode/damage/softening_update.hpp"
#include "lode/elastic/isotropic_moduli.hpp"

namespace lode {

struct IsoSoftening {
    static constexpr const lode_model& description = iso_softening::description;

    explicit IsoSoftening(const Properties& p)
        : elastic(IsotropicModuli::from_young_poisson(p[iso_softening::E], p[iso_softening::NU])),
          crack(SofteningLaw(p, iso_softening::LAW_I, iso_softening::A1_I, iso_softening::A2_I, iso_softening::FMIN),
                SofteningLaw(p, iso_softening::LAW_II, iso_softening::A1_II, iso_softening::A2_II, iso_softening::FMIN),
                static_cast<TractionSurface>(p.code(iso_softening::SURF)), p[iso_softening::MIX_I],
                p[iso_softening::MIX_II], p[iso_softening::MU], p.code(iso_softening::METH) == 1),
          pressure(p.code(iso_softening::PDM), p[iso_softening::TAUC], p[iso_softening::TAUH], p[iso_softening::P1],
                   p[iso_softening::P2]),
          strength_I(p[iso_softening::SIGC]),
          strength_II(p[iso_softening::TAUC]),
          toughness_I(p[iso_softening::GIC]),
          toughness_II(p[iso_softening::GIIC]),
          thermal_expansion(p[iso_softening::ALPHA]),
          field_expansion(p[iso_softening::BETA]),
          fixed_length(p[iso_softening::HFIX]),
          reduces_strength(p.code(iso_softening::HPOL) == 1),
          deletes(p.code(iso_softening::DELFLAG) == 1) {
        check(p);
    }

    int required_state(AnalysisKind) const { return softening_state::count; }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& tangent) const {
        elastic.set_stiffness<kind>(tangent);
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        const State<Real>& state = point.state;
        Step<kind, Real> step;
        step.strain = increment.strain_increment;
        if (thermal_expansion != 0.0 || field_expansion != 0.0) {
            step.residual = thermal_expansion * increment.temperature_increment();
            if (field_expansion != 0.0) step.residual = step.residual + field_expansion * increment.field_increment(1);
            add_to_normals(step.strain, normal_components(kind), -step.residual);
        }
        step.trial = elastic.stress<kind>(step.strain);
        step.trial += point.stress;

        const Real stage = state[softening_state::STATE];
        const Mask<Real> intact = stage == Real(0.0);
        if (!set_size(increment, point, intact, step)) return;
        step.cracks = Mask<Real>(false);
        OnsetPlane<Real> plane{};
        if (any(intact)) {
            plane = onset(increment, intact, step);
            step.cracks = plane.cracks;
        }
        if (all(intact && !step.cracks)) {
            point.stress = step.trial;
            point.elastic_energy = elastic.energy<kind>(point.stress);
            set_thickness(point, step, Real(0.0));
            softening_state::store_intact(point.state);
            if constexpr (wants_tangent<T>) {
                elastic.set_stiffness<kind>(tangent);
                set_thermal_stress(tangent);
            }
            return;
        }
        update_cracked(increment, point, stage, intact, plane, step, tangent);
    }

    IsotropicModuli elastic;
    SofteningCrack<true> crack;
    PressureDependence pressure;
    double strength_I, strength_II, toughness_I, toughness_II;
    double thermal_expansion, field_expansion;
    double fixed_length;
    bool reduces_strength, deletes;

  private:
    // What is known of an increment before the crack is looked at.
    template <AnalysisKind kind, class Real>
    struct Step {
        Strain<kind, Real> strain;  // mechanical part of DSTRAN
        Real residual = Real(0.0);
        Stress<kind, Real> trial;  // sigma_old + C strain
        softening_state::PointSize<Real> size;
        Mask<Real> cracks;  // a crack forms in this increment
    };
    template <AnalysisKind kind, class Real>
    using Directions = Vector<SofteningDirection<Real>, crack_directions(kind)>;

    // Pressure acts on the shears, which a bar does not have.
    template <AnalysisKind kind>
    LODE_INLINE bool depends_on_pressure() const {
        return kind != AnalysisKind::uniaxial && pressure.active();
    }
    // dP/dEC_N = (C11 + C12 + C13)/3.
    template <AnalysisKind kind>
    LODE_INLINE double pressure_stiffness() const {
        return elastic.thermal_stiffness<kind>() * (1.0 / 3.0);
    }

    void check(const Properties& p) const {
        using namespace iso_softening;
        const auto surface = crack.surface();
        const bool couples = surface != TractionSurface::cuboid && surface != TractionSurface::cylinder;
        if (couples && strength_I == 0.0) p.refuse(SIGC, "> 0 for SURF 2, 3, 4");
        if (couples && strength_II == 0.0) p.refuse(TAUC, "> 0 for SURF 2, 3, 4");
        const int model = p.code(PDM);
        if (crack.steps() && couples && surface != TractionSurface::ovoid) p.refuse(METH, "0 for SURF 3, 4");
        if (crack.steps() && model != 0) p.refuse(METH, "0 with a pressure dependence (PDM)");
        if (model == 0) return;
        if (couples && surface != TractionSurface::ovoid) p.refuse(PDM, "0 for SURF 3, 4");
        if (strength_II == 0.0) p.refuse(TAUC, "> 0 with a pressure dependence (PDM)");
        if (model == 1 && !(p[TAUH] > strength_I && p[TAUH] > 0.0))
            p.refuse(TAUH, "> SIGC = " + format_number(strength_I) + " for PDM 1");
        if (model > 1 && !(p[TAUH] > strength_II))
            p.refuse(TAUH, "> TAUC = " + format_number(strength_II) + " for PDM 2, 3, 4");
        if (model == 2 && !(p[P2] > p[P1])) p.refuse(P2, "> P1 = " + format_number(p[P1]) + " for PDM 2");
        if (model > 2 && !(p[P2] > 0.0)) p.refuse(P2, "> 0 for PDM 3, 4");
    }

    // False where the point cannot be used (section 8).
    template <AnalysisKind kind, class Real>
    LODE_INLINE bool set_size(const Increment<kind, Real>& increment, Point<kind, Real>& point,
                              const Mask<Real>& intact, Step<kind, Real>& step) const {
        if (!step.size.read(increment, point, intact, fixed_length)) return false;
        if (reduces_strength || all(step.size.frozen)) return true;
        // h_max = eta G C/sig^2
        const double C = elastic.normal_stiffness<kind>();
        if (strength_I > 0.0 &&
            !step.size.fits(point, crack.normal_law.eta() * toughness_I * C / square(strength_I),
                            "mode I would snap back (refine, raise GIC or lower SIGC): element length h"))
            return false;
        if (kind == AnalysisKind::uniaxial || strength_II == 0.0) return true;
        return step.size.fits(point, crack.shear_law.eta() * toughness_II * elastic.shear / square(strength_II),
                              "mode II would snap back (refine, raise GIIC or lower TAUC): element length h");
    }

    template <AnalysisKind kind, class Real>
    LODE_INLINE Directions<kind, Real> directions(const Step<kind, Real>& step) const {
        Directions<kind, Real> d;
        const Real energy = step.size.toughness / step.size.length;
        d[0] = {Real(step.size.strength * strength_I), Real(energy * toughness_I),
                Real(elastic.normal_stiffness<kind>())};
        if (reduces_strength) d[0].limit_strength(crack.normal_law);
        if constexpr (kind != AnalysisKind::uniaxial) {
            d[1] = {Real(step.size.strength * strength_II), Real(energy * toughness_II), Real(elastic.shear)};
            if (reduces_strength) d[1].limit_strength(crack.shear_law);
            if constexpr (d.size() > 2) d[2] = d[1];
        }
        return d;
    }

    // P0 = -tr(C eps)/3 at the end, from the trial stress and the opening at the start.
    template <AnalysisKind kind, class Real>
    LODE_INLINE CrackPressure<Real> crack_pressure(const Step<kind, Real>& step, const Real& opening_old,
                                                   const SofteningDirection<Real>& shear) const {
        const double K = pressure_stiffness<kind>();
        const Real largest = sqrt((0.98 * crack.shear_law.eta() * elastic.shear) * shear.energy());
        return {&pressure, step.size.strength, Real((-1.0 / 3.0) * trace(step.trial) - K * opening_old), K, largest};
    }

    template <AnalysisKind kind, class Real>
    LODE_INLINE OnsetPlane<Real> onset(const Increment<kind, Real>&, const Mask<Real>& intact,
                                       const Step<kind, Real>& step) const {
        Real tensile = step.size.strength * strength_I, shear = step.size.strength * strength_II;
        Real shear_slope = Real(0.0);
        if (reduces_strength || depends_on_pressure<kind>()) {
            const auto d = directions(step);
            tensile = select(d[0].enabled, d[0].strength, Real(0.0));
            if constexpr (kind != AnalysisKind::uniaxial) {
                shear = select(d[1].enabled, d[1].strength, Real(0.0));
                if (depends_on_pressure<kind>()) {
                    const ShearStrength<Real> tau = crack_pressure(step, Real(0.0), d[1]).strength(Real(0.0));
                    shear = tau.value;
                    shear_slope = tau.slope;
                }
            }
        }
        const IsotropicOnset<Real> strengths{tensile,           shear,
                                             shear_slope,       strength_I > 0.0,
                                             strength_II > 0.0, crack.surface() == TractionSurface::ovoid};
        return find_onset<kind>(strengths, step.trial, intact);
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update_cracked(const Increment<kind, Real>& increment, Point<kind, Real>& point, const Real& stage,
                                    const Mask<Real>& intact, const OnsetPlane<Real>& plane,
                                    const Step<kind, Real>& step, T& tangent) const {
        using Update = CrackUpdate<kind, Real>;
        const State<Real>& state = point.state;
        Update crack_update;
        auto& law = crack_update.law = directions(step);
        auto& axes = crack_update.axes = CrackAxes<Real>::read(state, softening_state::AXIS_N);
        if (frame_turns(increment)) axes.turn(increment.rotation());
        crack_update.old = softening_state::read<Update::m>(state);
        const Mask<Real> preset = !intact && !step.size.frozen;
        if (any(preset)) [[unlikely]] {
            axes.normalise(preset, kind != AnalysisKind::solid);
            crack.set_predamaged(preset, stage, law, crack_update.old, point.solves);
        }
        if (any(step.cracks)) axes.choose(step.cracks, plane.N, plane.T);
        axes.set_third();
        set_stiffness_vectors(crack_update);

        // The increment in which a crack forms is exact in any case.
        const Mask<Real> cracked = !intact && stage < Real(1.5);
        const Mask<Real> stepping = cracked && Mask<Real>(crack.steps());
        const Mask<Real> damaging = step.cracks || (cracked && !stepping);
        std::conditional_t<wants_tangent<T>, DamageRates<Update::m>, NoRates> rates;
        const auto damage = [&](const auto& q_old, const auto& q) LODE_INLINE_LAMBDA {
            if constexpr (Update::m > 1)
                if (depends_on_pressure<kind>()) {
                    const auto p = crack_pressure(step, crack_update.old.strain[0], law[1]);
                    return crack.damage(q_old, q, damaging, law, p, crack_update.now, rates, point.solves);
                }
            return crack.damage(q_old, q, damaging, law, NoPressure{}, crack_update.now, rates, point.solves);
        };
        CrackLinearisation<kind> linear;
        crack_update.run(crack, point.stress, step.trial, stage, damaging, stepping, damage, &linear, tangent);

        point.stress = crack_update.stress;
        point.elastic_energy = elastic.energy<kind>(point.stress) + crack_update.stored;
        point.plastic_dissipation = crack_update.dissipated;
        set_thickness(point, step, Real(crack_update.now.strain[0] - crack_update.old.strain[0]));

        if constexpr (wants_tangent<T>) {
            crack_update.linearise(rates, pressure_stiffness<kind>(), linear);
            elastic.set_stiffness<kind>(tangent);
            if (step.cracks && kind != AnalysisKind::uniaxial)
                set_turning_tangent(axes, plane, step, crack_update.now.strain, linear, tangent);
            else linear.apply(tangent);
            set_thermal_stress(tangent);
        }
        const Real mode = select(step.cracks, plane.mode, state[softening_state::MODE]);
        softening_state::store(point.state, axes, crack_update.now, step.cracks || !intact, crack_update.failed,
                               step.size.length, mode, crack_update.friction_work, deletes);
    }

    // Elastic out-of-plane strain of plane stress and its residual part; `opening`: change of EC_N.
    template <AnalysisKind kind, class Real>
    LODE_INLINE void set_thickness(Point<kind, Real>& point, const Step<kind, Real>& step, const Real& opening) const {
        using softening_state::EZZ;
        if constexpr (kind == AnalysisKind::plane_stress) {
            const double ratio = elastic.poisson / (1.0 - elastic.poisson);
            point.thickness_strain_increment = step.residual - ratio * (trace(step.strain) - opening);
            point.state.set(EZZ, point.state[EZZ] + point.thickness_strain_increment);
        } else {
            point.state.keep(EZZ);
        }
    }

    // C_n m_n = lambda 1 + 2G N N, C_y m_y = G (N T + T N), C_z m_z = G (N Z + Z N).
    template <AnalysisKind kind, class Real>
    LODE_INLINE void set_stiffness_vectors(CrackUpdate<kind, Real>& update) const {
        if constexpr (kind == AnalysisKind::uniaxial) {
            update.stiffness[0][0] = Real(elastic.young);
        } else {
            for (int j = 0; j < update.m; ++j) {
                const auto dyad = symmetric_dyad<kind>(update.axes.N, update.axes[j]);
                for (int i = 0; i < components(kind); ++i) update.stiffness[j][i] = elastic.shear * dyad[i];
            }
            for (int i = 0; i < normal_components(kind); ++i)
                update.stiffness[0][i] = update.stiffness[0][i] + elastic.coupling_stiffness<kind>();
        }
    }

    // (T.9). The principal axes turn by d e_i = sum_j e_j (e_j.dsigma e_i)/(s_i - s_j); the crack axes with them, and
    // by the change of the angle theta of MODE 3.
    template <AnalysisKind kind>
    [[gnu::noinline]] void set_turning_tangent(const CrackAxes<double>& axes, const OnsetPlane<double>& plane,
                                               const Step<kind, double>& step,
                                               const Vector<double, crack_directions(kind)>& strain,
                                               const CrackLinearisation<kind>& linear, Tangent<kind>& tangent) const {
        constexpr int n = components(kind), normals = normal_components(kind);
        const double G = elastic.shear, coupling = elastic.coupling_stiffness<kind>();
        const auto NN = symmetric_dyad<kind>(axes.N, axes.N), TT = symmetric_dyad<kind>(axes.T, axes.T);
        const auto NT = symmetric_dyad<kind>(axes.N, axes.T), NZ = symmetric_dyad<kind>(axes.N, axes.Z);
        const auto TZ = symmetric_dyad<kind>(axes.T, axes.Z);
        const double c = plane.cosine, s = plane.sine;
        const double s1 = plane.s1, s2 = plane.s2, s3 = plane.s3;
        const auto over = [](double x, double gap) { return gap == 0.0 ? 0.0 : x / gap; };
        double spin[n][3];
        for (int j = 0; j < n; ++j) {
            const double volumetric = j < normals ? coupling : 0.0;
            // dsigma in crack axes for a unit strain j
            const double xx = volumetric + G * NN[j], yy = volumetric + G * TT[j], xy = G * NT[j];
            const double first = c * c * xx + s * s * yy - 2.0 * s * c * xy;
            const double last = s * s * xx + c * c * yy + 2.0 * s * c * xy;
            double turn = over(s * c * (xx - yy) + (c * c - s * s) * xy, s1 - s3);
            if (plane.mode == 3.0) {
                // cos 2 theta = p tau^2/(r (SIGC^2 - tau^2))
                const double dp = 0.5 * (first + last), dr = 0.5 * (first - last);
                const double dP = j < normals ? -pressure_stiffness<kind>() : 0.0;
                const double cosine = c * c - s * s,
                             change = dp / plane.mean - dr / plane.radius + plane.by_pressure * dP;
                turn -= 0.5 * cosine * change / (2.0 * s * c);
            }
            spin[j][0] = turn;
            spin[j][1] = spin[j][2] = 0.0;
            if constexpr (kind == AnalysisKind::solid) {
                const double xz = G * NZ[j], yz = G * TZ[j];
                const double first_z = over(c * xz - s * yz, s1 - s2), last_z = over(s * xz + c * yz, s3 - s2);
                spin[j][1] = c * first_z + s * last_z;
                spin[j][2] = c * last_z - s * first_z;
            }
        }
        double trial[3][3];
        const Matrix3<double> sigma = to_matrix<kind, double>(step.trial, 1.0);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) trial[i][j] = dot(axes[i], sigma * axes[j]);
        linear.apply_turning(axes, trial, strain, spin, tangent);
    }

    // DDSDDT = -DDSDDE alpha.
    template <AnalysisKind kind>
    LODE_INLINE void set_thermal_stress(Tangent<kind>& tangent) const {
        if (thermal_expansion == 0.0) return;
        for (int i = 0; i < components(kind); ++i) {
            double sum = 0.0;
            for (int j = 0; j < normal_components(kind); ++j) sum += tangent(i, j);
            tangent.thermal_stress[i] = -thermal_expansion * sum;
        }
    }
};

}  // namespace lode
