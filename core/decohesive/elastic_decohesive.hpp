// ELASTIC_DECOHESIVE: linear elastic, with up to N_c fixed smeared cracks (page 80; Sanchez, 3.5, 4.5). The planes
// start where a decohesion function of the uncracked material is first violated; a displacement jump on them softens
// it.
#pragma once

#include "lode/decohesive/crack_set.hpp"
#include "lode/decohesive/elastic_decohesive_description.hpp"
#include "lode/material/properties.hpp"
#include "lode/tensor/rotation.hpp"

namespace lode {

struct ElasticDecohesive {
    static constexpr const lode_model& description = elastic_decohesive::description;

    explicit ElasticDecohesive(const Properties& p)
        : moduli(IsotropicModuli::from_young_poisson(p[elastic_decohesive::E], p[elastic_decohesive::NU])),
          most_cracks_(p.code(elastic_decohesive::N_C)),
          integration(p.code(elastic_decohesive::INTEG)),
          exponential(p.code(elastic_decohesive::SOFT) == 1),
          lowers_strength(p.code(elastic_decohesive::SNAP) == 1),
          G_f(p[elastic_decohesive::G_F]),
          mu(p[elastic_decohesive::MU]),
          fixed_length(p[elastic_decohesive::L_C]),
          thermal_expansion(p[elastic_decohesive::ALPHA]),
          field_expansion(p[elastic_decohesive::BETA]) {
        using namespace elastic_decohesive;
        const double f_c = p[F_C], f_b = p[F_B] > 0.0 ? p[F_B] : 1.16 * f_c, tau_sf = p[TAU_SF];
        if (!(p[TAU_SM] >= tau_sf)) p.refuse(TAU_SM, ">= TAU_SF = " + format_number(tau_sf));
        if (!(f_b > 0.5 * f_c)) p.refuse(F_B, "0 or > F_C/2 = " + format_number(0.5 * f_c));
        strength = {.tau_nf = p[TAU_NF],
                    .tau_sf = tau_sf,
                    .f_c = f_c,
                    .chi = square(f_c / f_b) - 2.0,
                    .C = square(tau_sf / p[TAU_SM]),
                    .C_n = p[C_N],
                    .C_s = p[C_S],
                    .C_psi = p[C_PSI],
                    .rankine = p.code(CRIT) == 1,
                    .inverse_tau_nf = 0.0,
                    .inverse_tau_sf_square = 0.0,
                    .inverse_f_c_square = 0.0,
                    .inverse_C = 0.0};
        strength.set_inverses();
        closest_cosine = std::cos(p[ALPHA_TH] * degree) + 1e-12;

        for (int i = 0; i < 3; ++i) normal[i] = p[N_X + i];
        const double size = std::hypot(normal[0], normal[1], normal[2]);
        prescribed = size > 0.0 && most_cracks_ > 0;
        if (prescribed) {
            most_cracks_ = 1;
            for (int i = 0; i < 3; ++i) normal[i] /= size;
            normal = oriented(normal);
        }
        // Lengths at which the local return and the split between two cracks lose uniqueness (8.2, 8.5).
        snap_back_length = (exponential ? 1.0 : 2.0) * G_f / square(strength.tau_nf);
        const double sine = std::sin(p[ALPHA_TH] * degree);
        unique_split_length = most_cracks_ > 1 ? 4.0 * moduli.shear * G_f * square(sine / strength.tau_nf) : HUGE_VAL;
    }

    int required_state(AnalysisKind) const { return 4 + elastic_decohesive::CRACK_SIZE * most_cracks_; }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& c) const {
        moduli.set_stiffness<kind>(c);
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        using namespace elastic_decohesive;
        Strain<kind, Real> strain = increment.strain_increment;
        Real expansion = Real(0.0);
        if (thermal_expansion != 0.0) expansion = thermal_expansion * increment.temperature_increment();
        if (field_expansion != 0.0) expansion = expansion + field_expansion * increment.field_increment(1);
        if (thermal_expansion != 0.0 || field_expansion != 0.0)
            add_to_normals(strain, normal_components(kind), -expansion);

        const Stress<kind, Real> start = point.stress;
        const Stress<kind, Real> trial = start + moduli.stress<kind>(strain);
        Situation<Real> at;
        at.uncracked = Mask<Real>(true);
        if (most_cracks_ > 0) {
            at.uncracked = point.state[J] == Real(0.0);
            at.length = Real(fixed_length);
            if (fixed_length == 0.0) at.length = increment.element_length();
            const double alert = min(snap_back_length * KindStiffness<kind>(moduli).E_1, unique_split_length);
            const Mask<Real> plain = at.uncracked && at.length > Real(0.0) && at.length < Real(alert) &&
                                     is_certainly_intact<kind, Real>(strength, trial);
            if (!all(plain) || prescribed) [[unlikely]] {
                at.plain = plain;
                if (!crack(increment, strain, trial, at, point, tangent)) return;
                return finish(increment, start, expansion, point, tangent);
            }
        }
        point.stress = trial;
        for (int i = 1; i <= required_state(kind); ++i) point.state.keep(i);
        if constexpr (wants_tangent<T>) moduli.set_stiffness<kind>(tangent);
        finish(increment, start, expansion, point, tangent);
    }

    IsotropicModuli moduli;
    DecohesionConstants strength;
    int most_cracks_, integration;
    bool exponential, lowers_strength, prescribed;
    double G_f, mu, fixed_length, thermal_expansion, field_expansion;
    double closest_cosine;
    double snap_back_length;     // per unit of E_1
    double unique_split_length;  // of two cracks at the angle ALPHA_TH
    Vector<double, 3> normal;    // the prescribed one

  private:
    template <class Real>
    struct Situation {
        Mask<Real> uncracked, plain;  // plain: elastic beyond doubt
        Real length;
    };

    // What depends on the end stress alone.
    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void finish(const Increment<kind, Real>&, const Stress<kind, Real>& start, const Real& expansion,
                            Point<kind, Real>& point, T& tangent) const {
        point.elastic_energy = moduli.energy(point.stress);
        if constexpr (kind == AnalysisKind::plane_stress)
            point.thickness_strain_increment =
                (-moduli.poisson / moduli.young) * (trace(point.stress) - trace(start)) + expansion;
        if constexpr (wants_tangent<T>)
            if (thermal_expansion != 0.0)
                for (int j = 0; j < normal_components(kind); ++j)
                    for (int i = 0; i < components(kind); ++i)
                        tangent.thermal_stress[i] -= thermal_expansion * tangent(i, j);
    }

    // The strength of a point with this smearing length: an element too large may lower it (8.2).
    template <AnalysisKind kind>
    CrackLaw law_for(double length) const {
        const KindStiffness<kind> stiffness(moduli);
        DecohesionConstants k = strength;
        if (lowers_strength && length >= snap_back_length * stiffness.E_1) {
            k.tau_nf = std::sqrt(0.99 * (exponential ? 1.0 : 2.0) * G_f * stiffness.E_1 / length);
            k.set_inverses();
        }
        return CrackLaw(k, exponential, G_f, mu, length, moduli, stiffness);
    }
    template <AnalysisKind kind>
    CrackControl control(bool accepts_unconverged) const {
        return {most_cracks_, integration, closest_cosine, prescribed && kind != AnalysisKind::uniaxial,
                accepts_unconverged};
    }

    // Refuses and warns about element lengths of uncracked points; false if a lane was refused.
    template <AnalysisKind kind, class Real>
    bool admits(const Situation<Real>& at, Point<kind, Real>& point) const {
        const Mask<Real> unknown = at.uncracked && !(at.length > Real(0.0));
        if (any(unknown)) {
            point.refuse(unknown, "element length (CELENT)", at.length, "> 0, or the smearing length L_C be given");
            return false;
        }
        const double limit = snap_back_length * KindStiffness<kind>(moduli).E_1;
        const Mask<Real> large = at.uncracked && at.length >= Real(limit);
        if (any(large) && !lowers_strength) {
            point.refuse(large, "element length L_c", at.length,
                         exponential ? "(refine, or set snap = 1) below G_f E_1/tau_nf^2 ="
                                     : "(refine, or set snap = 1) below 2 G_f E_1/tau_nf^2 =",
                         Real(limit));
            return false;
        }
        if (any(at.uncracked && at.length >= Real(unique_split_length)))
            point.warn(
                "the element length exceeds 4 G G_f sin^2(alpha_th)/tau_nf^2: two cracks at the smallest angle would "
                "not share the opening uniquely");
        constexpr bool plane = kind == AnalysisKind::plane_strain || kind == AnalysisKind::plane_stress;
        const bool oblique = std::abs(normal[2]) > 1e-9 && std::hypot(normal[0], normal[1]) > 1e-9;
        if (plane && prescribed && (oblique || (kind == AnalysisKind::plane_stress && std::abs(normal[2]) > 0.5))) {
            point.refuse(Mask<Real>(true), "component N_Z of the prescribed normal", Real(normal[2]),
                         oblique ? "0, or N_X and N_Y be 0, in a plane kind" : "0 in plane stress");
            return false;
        }
        return true;
    }

    // Everything but plain elasticity; false if the increment cannot be done.
    template <AnalysisKind kind, class Real, class T>
    [[gnu::noinline]] bool crack(const Increment<kind, Real>& increment, const Strain<kind, Real>& strain,
                                 const Stress<kind, Real>& trial, const Situation<Real>& at, Point<kind, Real>& point,
                                 T& tangent) const {
        if (!admits(at, point)) return false;
        if constexpr (is_batch<Real>) return crack_lanes(strain, trial, at, point);
        else return crack_point(strain, at.length, increment.rotation_source, point, tangent);
    }

    // The lanes one after the other.
    template <AnalysisKind kind>
    bool crack_lanes(const Strain<kind, Batch>& strain, const Stress<kind, Batch>& trial, const Situation<Batch>& at,
                     Point<kind, Batch>& point) const {
        constexpr int most_entries = 4 + elastic_decohesive::CRACK_SIZE * most_cracks, n = components(kind);
        constexpr auto lanes = static_cast<std::size_t>(batch_lanes);
        const int entries = required_state(kind);
        std::array<double, most_entries * lanes> state;
        std::array<double, 2 * n * lanes> vectors;
        std::array<double, lanes> length, dissipation{};
        for (int i = 0; i < entries; ++i)
            point.state[i + 1].store_unaligned(state.data() + static_cast<std::size_t>(i) * lanes);
        for (std::size_t i = 0; i < n; ++i) {
            const int k = static_cast<int>(i);
            select(at.plain, trial[k], point.stress[k]).store_unaligned(vectors.data() + i * lanes);
            strain[k].store_unaligned(vectors.data() + (n + i) * lanes);
        }
        at.length.store_unaligned(length.data());
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            const bool plain = at.plain.get(lane);
            if (plain && !prescribed) continue;
            Point<kind, double> one;
            Strain<kind, double> e;
            for (std::size_t i = 0; i < n; ++i) {
                one.stress[static_cast<int>(i)] = vectors[i * lanes + lane];
                e[static_cast<int>(i)] = plain ? 0.0 : vectors[(n + i) * lanes + lane];
            }
            one.state = State<double>(state.data() + lane, state.data() + lane, batch_lanes, entries);
            NoTangent none;
            if (!crack_point<kind, double, NoTangent, true>(e, length[lane], nullptr, one, none)) {
                std::array<bool, lanes> failed{};
                failed[lane] = true;
                point.fail(Mask<Batch>::load_unaligned(failed.data()), one.failure, one.time_step_ratio);
                point.refusal = one.refusal;
                point.refused_value = Batch(one.refused_value);
                point.refused_limit = Batch(one.refused_limit);
                return false;
            }
            if (one.warning != nullptr) point.warn(one.warning);
            for (std::size_t i = 0; i < n; ++i) vectors[i * lanes + lane] = one.stress[static_cast<int>(i)];
            dissipation[lane] = one.plastic_dissipation;
        }
        for (int i = 0; i < entries; ++i)
            point.state.set(i + 1, Batch::load_unaligned(state.data() + static_cast<std::size_t>(i) * lanes));
        for (std::size_t i = 0; i < n; ++i)
            point.stress[static_cast<int>(i)] = Batch::load_unaligned(vectors.data() + i * lanes);
        point.plastic_dissipation = Batch::load_unaligned(dissipation.data());
        return true;
    }

    // The cracks of STATEV, turned by DROT.
    template <AnalysisKind kind, class Real>
    void load(const State<Real>& state, const double* rotation, CrackSet<kind, Real>& set) const {
        using namespace elastic_decohesive;
        set.count = static_cast<int>(value_of(state[J]));
        const bool waits = prescribed && kind != AnalysisKind::uniaxial && set.count == 0;
        const auto read = [&](int first) {
            Vector<Real, 3> v;
            for (int i = 0; i < 3; ++i) v[i] = state[first + i];
            return v;
        };
        for (int j = 0; j < set.count || (j == 0 && waits); ++j) {
            Crack<Real>& c = set.cracks[static_cast<std::size_t>(j)];
            const int first = FIRST_CRACK + CRACK_SIZE * j;
            c.n = read(first + NORMAL);
            c.u = read(first + JUMP);
            c.G = state[first + ENERGY];
            c.phase = static_cast<int>(value_of(state[first + PHASE]));
            if (waits && value_of(dot(c.n, c.n)) == 0.0)
                for (int i = 0; i < 3; ++i) c.n[i] = Real(normal[i]);
            if (kind == AnalysisKind::uniaxial || rotation == nullptr) continue;
            const auto turned = [&](const Vector<Real, 3>& v) {
                Vector<Real, 3> r;
                for (int i = 0; i < 3; ++i) r[i] = rotation[i] * v[0] + rotation[i + 3] * v[1] + rotation[i + 6] * v[2];
                return r;
            };
            c.n = turned(c.n);
            const Real sign(orientation(c.n));
            c.n = sign * c.n;
            c.u = sign * turned(c.u);
        }
    }
    template <AnalysisKind kind, class Real>
    void store(const CrackSet<kind, Real>& set, double length, State<Real>& state) const {
        using namespace elastic_decohesive;
        const Real w = state[W] + set.dissipated;
        state.set(J, Real(set.count));
        state.set(W, w);
        state.set(DAMAGE, set.damage());
        if (set.count > 0) state.set(LENGTH, Real(length));
        const bool waits = prescribed && kind != AnalysisKind::uniaxial && set.count == 0;
        for (int j = 0; j < set.count || (j == 0 && waits); ++j) {
            const Crack<Real>& c = set.cracks[static_cast<std::size_t>(j)];
            const int first = FIRST_CRACK + CRACK_SIZE * j;
            for (int i = 0; i < 3; ++i) state.set(first + NORMAL + i, c.n[i]);
            if (waits) break;
            for (int i = 0; i < 3; ++i) state.set(first + JUMP + i, c.u[i]);
            state.set(first + ENERGY, c.G);
            state.set(first + PHASE, Real(c.phase));
        }
    }

    template <AnalysisKind kind, class Real, class T, bool explicit_host = false>
    bool crack_point(const Strain<kind, Real>& strain, const Real& element_length, const double* rotation,
                     Point<kind, Real>& point, T& tangent) const {
        using namespace elastic_decohesive;
        constexpr double largest_stress = 1e30;  // in units of F_C: squares of cubes are still numbers
        const KindStiffness<kind> stiffness(moduli);
        const double given = value_of(point.state[J]);
        if (!(given >= 0.0 && given <= most_cracks_)) {
            point.refuse(Mask<Real>(true), "STATEV(1), the number of cracks,", point.state[J], "within 0 and",
                         Real(most_cracks_));
            return false;
        }
        const bool cracked = given > 0.0;
        const double length = cracked ? value_of(point.state[LENGTH]) : value_of(element_length);
        const CrackLaw law = law_for<kind>(length);
        const CrackControl rules = control<kind>(explicit_host);

        CrackSet<kind, Real> set(law, rules, stiffness);
        load(point.state, rotation, set);
        set.stress = point.stress;
        set.solves = point.solves;
        const Stress<kind, Real> trial = point.stress + moduli.stress<kind>(strain);
        for (int i = 0; i < components(kind); ++i)
            if (!(abs(trial[i]) < Real(largest_stress * strength.f_c))) {
                point.fail(Mask<Real>(true), "the stress increment is beyond all bounds", 0.25);
                return false;
            }
        const CrackStatus status = set.advance(strain);
        if (status != CrackStatus::done) {
            point.fail(Mask<Real>(true),
                       status == CrackStatus::unconverged ? "the coupled cracks do not converge in 5000 sweeps"
                                                          : "the cutting plane finds no way back to the surface",
                       0.5);
            return false;
        }
        if (!finite(set)) {
            point.fail(Mask<Real>(true), "the stress is not finite", 0.25);
            return false;
        }
        if (set.unconverged) point.warn("the coupled cracks did not converge in 5000 sweeps in an increment");
        if constexpr (wants_tangent<T>) {
            moduli.set_stiffness<kind>(tangent);
            if (set.initiated || (set.active && integration != 0))
                set_tangent_by_gradient(strain, law, rules, rotation, point, tangent);
            else if (set.active) set.set_tangent(tangent);
        }
        point.stress = set.stress;
        point.plastic_dissipation = set.dissipated;
        store(set, length, point.state);
        return true;
    }
    template <AnalysisKind kind, class Real>
    static bool finite(const CrackSet<kind, Real>& set) {
        bool good = is_finite(set.dissipated);
        for (int i = 0; i < components(kind); ++i) good = good && is_finite(set.stress[i]);
        return good;
    }

    // Where the normal of a new crack depends on the strain, or substeps do on each other: the increment once more, on
    // numbers with derivatives. (The page's central differences, exactly.)
    template <AnalysisKind kind>
    [[gnu::noinline]] void set_tangent_by_gradient(const Strain<kind, double>& strain, const CrackLaw& law,
                                                   const CrackControl& rules, const double* rotation,
                                                   const Point<kind, double>& point, Tangent<kind>& tangent) const {
        constexpr int n = components(kind);
        using Number = Gradient<n>;
        const KindStiffness<kind> stiffness(moduli);
        CrackSet<kind, double> plain(law, rules, stiffness);
        load(point.state, rotation, plain);
        plain.stress = point.stress;
        CrackSet<kind, Number> set(plain);
        Strain<kind, Number> e;
        for (int i = 0; i < n; ++i) e[i] = Number::variable(strain[i], i);
        if (set.advance(e) != CrackStatus::done) return;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) tangent(i, j) = set.stress[i].slope[static_cast<std::size_t>(j)];
    }
};

}  // namespace lode
