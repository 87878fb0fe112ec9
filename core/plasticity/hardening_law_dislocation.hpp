// Hardening by dislocation densities in cell walls and interiors (HLAW 7; page 20, section 2.4; after Estrin and Toth):
// K = Y + sqrt(3) M ad G b [f sqrt(rw) + (1 - f) sqrt(rc)] (grdot/g0)^(1/m), with the resolved shear gr = M sqrt(3)
// alpha, the wall fraction f = finf + (f0 - finf) exp(-gr/gt) of the end and the densities rw, rc of the start of the
// increment.
#pragma once

#include "lode/plasticity/hardening_law.hpp"
#include "lode/plasticity/surroundings.hpp"

namespace lode {

class DislocationHardening {
  public:
    static constexpr bool softens = false, feels_rate = true, feels_temperature = true, changes_shear = false;
    static constexpr bool melts = false, remembers = true;

    template <class Real>
    struct At {
        Densities<Real> densities;
        Real inverse_m, inverse_n;  // 1/m, 1/n
        TimeIncrement time;
        double log_rate_scale;  // ln(grdot/g0) = ln(dalpha) + this
    };

    // The constants H1..H10 and H11..H19 start at these indices.
    DislocationHardening(const Properties& p, int first, int second, double yield, double shear, double offset,
                         double radial_stiffness, double axial_stiffness)
        : yield_(yield), absolute_zero_offset_(offset), stiffness_{radial_stiffness, axial_stiffness} {
        const auto h = [&](int i) { return i <= 10 ? first + i - 1 : second + i - 11; };
        for (int i = 1; i <= 15; ++i)
            if (p[h(i)] <= 0.0) p.refuse(h(i), "> 0");
        for (const int i : {7, 8})
            if (p[h(i)] >= 1.0) p.refuse(h(i), "< 1");
        interior_ = p[h(1)], wall_ = p[h(2)];
        burgers_ = p[h(3)], reference_rate_ = p[h(4)];
        fraction_start_ = p[h(7)], fraction_end_ = p[h(8)];
        inverse_m_ = 1.0 / p[h(10)], inverse_n_ = 1.0 / p[h(11)];
        cell_ = p[h(12)], source_ = p[h(13)], exchange_ = p[h(14)], annihilation_ = p[h(15)];
        resolved_ = p[h(6)] * std::sqrt(3.0);
        strain_rate_ = resolved_ / p[h(9)];
        const double G = p[h(19)] != 0.0 ? p[h(19)] : shear;
        if (G < 0.0) p.refuse(h(19), ">= 0");
        strength_ = resolved_ * p[h(5)] * G * burgers_;
        if (p[h(16)] != 0.0) {
            inverse_Am_ = 1.0 / p[h(17)], inverse_An_ = 1.0 / p[h(18)];
            if (p[h(17)] <= 0.0) p.refuse(h(17), "> 0 with TDEP");
            if (p[h(18)] <= 0.0) p.refuse(h(18), "> 0 with TDEP");
        }
        log_scale_ = std::log(resolved_ / reference_rate_);
    }

    bool depends_on_temperature() const { return inverse_Am_ != 0.0; }

    template <class Real>
    LODE_INLINE At<Real> at(const Surroundings<Real>& s) const {
        At<Real> at{s.densities, Real(inverse_m_), Real(inverse_n_), s.time, log_scale_};
        if (s.time.value > 0.0) at.log_rate_scale = log_scale_ - quick_log(s.time.value);
        if (depends_on_temperature()) {
            const Real T = s.temperature + absolute_zero_offset_;
            at.inverse_m = inverse_Am_ * T;
            at.inverse_n = inverse_An_ * T;
        }
        return at;
    }
    // A virgin point starts with the densities of the constants.
    template <class Real>
    LODE_INLINE Densities<Real> initial(const Densities<Real>& d) const {
        const auto used = d.interior > Real(0.0) && d.wall > Real(0.0);
        return {select(used, d.interior, Real(interior_)), select(used, d.wall, Real(wall_))};
    }

    // K at rate 0.
    template <class Real>
    LODE_INLINE FlowStress<Real> start(const At<Real>&, const Real&) const {
        return {Real(yield_), Real(0.0), Real(0.0)};
    }
    template <class Real>
    LODE_INLINE FlowStress<Real> flow(const At<Real>& at, const Real& alpha, const Real& x) const {
        const Real safe = max(x, Real(1e-290)), per_x = 1.0 / safe;
        const Growth<Real> g = growth(at, alpha, safe, quick_log(safe));
        return {g.value, g.slope * per_x, (g.bend - g.slope) * (per_x * per_x)};
    }

    template <class Real>
    ReturnResult<Real> solve_on(Line line, const At<Real>& at, const Real& q_trial, const Real& alpha,
                                const FlowStress<Real>& k, const Mask<Real>& yields,
                                const SolveCounter<Real>& solves) const {
        return solve_along(stiffness_[line], at, q_trial, alpha, k, yields, solves);
    }
    template <Line line>
    double plastic_share(const At<double>&, double H) const {
        return stiffness_[line] / (stiffness_[line] + H);
    }
    // Everything is dissipated.
    template <class Real>
    LODE_INLINE PlasticWork<Real> work(const At<Real>&, const Real&, const Real&, const FlowStress<Real>&,
                                       const FlowStress<Real>& k_end) const {
        return {k_end.value, Real(0.0)};
    }
    HeatSlopes slopes(const At<double>& at, double, double dalpha, const FlowStress<double>&,
                      const FlowStress<double>& k_end) const {
        HeatSlopes s;
        if (depends_on_temperature())
            s.flow_temperature = (k_end.value - yield_) * (quick_log(dalpha) + at.log_rate_scale) * inverse_Am_;
        s.source_strain = s.work_strain = k_end.value + dalpha * k_end.slope;
        s.source_temperature = s.work_temperature = dalpha * s.flow_temperature;
        return s;
    }

    template <class Real>
    LODE_INLINE Real wall_fraction(const Real& alpha) const {
        return fraction_end_ + (fraction_start_ - fraction_end_) * quick_exp(-strain_rate_ * alpha);
    }
    template <class Real>
    LODE_INLINE Real cell_size(const Densities<Real>& r, const Real& f) const {
        return cell_ / sqrt(f * r.wall + (1.0 - f) * r.interior);
    }

    // The densities after the increment, at its constant rate: Runge and Kutta's classical method in equal substeps of
    // at most 0.02 of resolved shear. Past a shear of 200 the densities are stationary and are left as they are.
    template <class Real>
    [[gnu::noinline]] Densities<Real> evolved(const At<Real>& at, const Real& alpha, const Real& dalpha) const {
        constexpr double stationary_shear = 200.0;
        const Real shear = min(resolved_ * dalpha, Real(stationary_shear));
        const Real count = max(ceiling(shear * (1.0 / 0.02)), Real(1.0));
        const Mask<Real> flows = dalpha > Real(0.0);
        const Real log_rate = select(flows, quick_log(select(flows, dalpha, Real(1.0))) + at.log_rate_scale, Real(0.0));
        const Real loss = annihilation_ * quick_exp(Real(0.0) - at.inverse_n * log_rate);
        const Real h = shear / count, dx = h * (1.0 / resolved_);
        Densities<Real> r = at.densities;
        const double floor_wall = 1e-12 * wall_, floor_interior = 1e-12 * interior_;
        for (int i = 0;; ++i) {
            const Mask<Real> active = flows && Real(double(i)) < count;
            if (!any(active)) return r;
            const Real x = alpha + double(i) * dx;
            const Densities<Real> k1 = rates(r, x, loss);
            const Densities<Real> k2 = rates(moved(r, 0.5 * h, k1), x + 0.5 * dx, loss);
            const Densities<Real> k3 = rates(moved(r, 0.5 * h, k2), x + 0.5 * dx, loss);
            const Densities<Real> k4 = rates(moved(r, h, k3), x + dx, loss);
            const Real sixth = (1.0 / 6.0) * h;
            const Real interior = r.interior + sixth * (k1.interior + 2.0 * (k2.interior + k3.interior) + k4.interior);
            const Real wall = r.wall + sixth * (k1.wall + 2.0 * (k2.wall + k3.wall) + k4.wall);
            r.interior = select(active, max(interior, Real(floor_interior)), r.interior);
            r.wall = select(active, max(wall, Real(floor_wall)), r.wall);
        }
    }

  private:
    template <class Real>
    struct Growth {
        Real value, slope, bend;  // K and its derivatives by ln(x)
    };
    template <class Real>
    LODE_INLINE Growth<Real> growth(const At<Real>& at, const Real& alpha, const Real& x, const Real& log_x) const {
        const Real decayed = (fraction_start_ - fraction_end_) * quick_exp(-strain_rate_ * (alpha + x));
        const Real f = fraction_end_ + decayed;
        const Real wall = sqrt(at.densities.wall), interior = sqrt(at.densities.interior);
        const Real z = f * wall + (1.0 - f) * interior;
        const Real z1 = -strain_rate_ * x * decayed * (wall - interior);
        const Real z2 = z1 * (1.0 - strain_rate_ * x);
        const Real m = at.inverse_m;
        const Real power = strength_ * quick_exp(m * (log_x + at.log_rate_scale));
        return {yield_ + power * z, power * (m * z + z1), power * (m * (m * z + 2.0 * z1) + z2)};
    }

    // In y = ln(dalpha).
    template <class Real>
    ReturnResult<Real> solve_along(double S, const At<Real>& at, const Real& q_trial, const Real& alpha,
                                   const FlowStress<Real>& k, const Mask<Real>& yields,
                                   const SolveCounter<Real>& solves) const {
        const auto residual = [self = *this, at, S, q_trial, alpha](const Real& y) {
            const Real x = quick_exp(y), drop = S * x;
            const Growth<Real> g = self.growth(at, alpha, x, y);
            return ReturnTrial<Real>{
                q_trial - drop - g.value, -drop - g.slope, -drop - g.bend, x, {g.value, g.slope / x, Real(0.0)}};
        };
        const Real excess = select(yields, q_trial - k.value, Real(1.0));
        const Real upper = quick_log(excess * (1.0 / S)), lower = upper - 600.0;
        // A point that hardly yields flows too slowly to matter.
        const Mask<Real> flows = yields && residual(lower).value > Real(0.0);
        const Real f = wall_fraction(alpha);
        const Real z = strength_ * (f * sqrt(at.densities.wall) + (1.0 - f) * sqrt(at.densities.interior));
        const Real plastic_limit = quick_log(excess / z) / at.inverse_m - at.log_rate_scale;
        const auto root = solve_bracketed<Slope::decreasing>(
            residual, lower, upper, max(min(upper, plastic_limit), lower), return_tolerance * q_trial, flows);
        solves.count(root);
        return either(flows, ReturnResult<Real>{root.last.dalpha, root.last.flow}, ReturnResult<Real>{Real(0.0), k});
    }

    // drc/dgr, drw/dgr.
    template <class Real>
    LODE_INLINE Densities<Real> rates(const Densities<Real>& r, const Real& alpha, const Real& loss) const {
        const Real f = wall_fraction(alpha), g = 1.0 - f, third = quick_exp((1.0 / 3.0) * quick_log(g));
        const Real d = cell_size(r, f), root_wall = sqrt(r.wall);
        const double root3 = std::sqrt(3.0);
        const Real into_walls = (6.0 * exchange_ / burgers_) / d;
        return {(source_ / (root3 * burgers_)) * root_wall - into_walls / third - loss * r.interior,
                into_walls * (third * third) / f + (root3 * exchange_ / burgers_) * g * root_wall / f - loss * r.wall};
    }
    template <class Real>
    LODE_INLINE static Densities<Real> moved(const Densities<Real>& r, const Real& h, const Densities<Real>& k) {
        return {max(r.interior + h * k.interior, Real(1e-300)), max(r.wall + h * k.wall, Real(1e-300))};
    }
    template <class Real>
    LODE_INLINE static Real ceiling(const Real& x) {
        using std::ceil;
        if constexpr (is_batch<Real>) return ceil(x);
        else return Real(std::ceil(value_of(x)));
    }

    double yield_, absolute_zero_offset_;
    double stiffness_[2];
    double interior_, wall_, burgers_, reference_rate_, fraction_start_, fraction_end_, inverse_m_, inverse_n_;
    double cell_, source_, exchange_, annihilation_, resolved_, strain_rate_, strength_, log_scale_;
    double inverse_Am_ = 0.0, inverse_An_ = 0.0;
};

}  // namespace lode
