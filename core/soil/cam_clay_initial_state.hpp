// CAM_CLAY on the first call: the elastic strain and the preconsolidation pressure behind the host's stress (page 70,
// "Initial state").
#pragma once

#include <string>

#include "lode/material/point.hpp"
#include "lode/material/properties.hpp"
#include "lode/soil/cam_clay_description.hpp"
#include "lode/soil/cam_clay_return.hpp"

namespace lode {

struct CamClayInitialState {
    CamClayElasticity elasticity;
    double M;
    double pc0, p_ini, biot;
    bool pc0_is_ratio;

    CamClayInitialState(const Properties& p, const CamClayElasticity& law)
        : elasticity(law),
          M(p[cam_clay::M]),
          pc0(p[cam_clay::PC0]),
          p_ini(p[cam_clay::P_INI] > 0.0 ? p[cam_clay::P_INI] : p[cam_clay::P_REF]),
          biot(p[cam_clay::BIOT]),
          pc0_is_ratio(p.code(cam_clay::PCMODE) == 1) {
        if (pc0_is_ratio && pc0 < 1.0)
            p.refuse(cam_clay::PC0, ">= 1 (with pcmode = 1 it is an overconsolidation ratio)");
    }

    // What the host should hear: "<refused> = <value> must be <allowed>", or a warning.
    struct Remarks {
        const char* refused = nullptr;
        double value = 0.0;
        const char* allowed = nullptr;
        const char* warning = nullptr;
    };

    // From the stress at the start of the increment and the pore pressure there. `pc` is STATEV(2) on entry.
    template <AnalysisKind kind>
    Remarks find(const Stress<kind, double>& stress, double pore_pressure, double& v, Stress<kind, double>& e,
                 double& pc) const {
        Stress<kind, double> effective = stress;
        add_to_normals(effective, 3, biot * pore_pressure);
        double size = 0.0;
        for (int i = 0; i < components(kind); ++i) size = max(size, abs(effective[i]));
        double p = p_ini, q = 0.0, s = 0.0;
        Stress<kind, double> deviatoric{};
        if (size > 1e-12 * elasticity.p_ref) {
            p = trace(effective) * (-1.0 / 3.0);
            deviatoric = deviator(effective);
            q = sqrt(1.5 * double_contraction(deviatoric, deviatoric));
            if (!(p > 0.0))
                return {.refused = "the initial stress is not compressive: its mean effective pressure p",
                        .value = p,
                        .allowed = "> 0"};
        }
        if (!elasticity.invert(p, q, v, s))
            return {.refused = "the initial q/p exceeds what alpha, mu0 can carry: q/p",
                    .value = q / p,
                    .allowed = "smaller, or mu0 larger"};
        e = (q > 0.0 ? 1.5 * s / q : 0.0) * deviatoric;

        Remarks remarks;
        if (has_negative_poisson(p) && !has_negative_poisson(p_ini)) remarks.warning = negative_poisson;
        const double p_fit = p + q * q / (M * M * p);  // the ellipse through the stress
        if (!(pc > 0.0)) pc = pc0_is_ratio ? pc0 * p_fit : pc0;
        if (pc < (1.0 - 1e-12) * p_fit)
            remarks.warning = "CAM_CLAY: the initial stress is outside the yield surface, which is enlarged to it";
        pc = max(pc, p_fit);
        if (misses_critical_state(pc) && !misses_critical_state(expected_pc())) remarks.warning = no_critical_state;
        return remarks;
    }

    // The lanes `fresh` of a point, one by one; false, with the point marked as failed, where a stress is refused.
    template <AnalysisKind kind, class Real>
    [[gnu::noinline]] bool find_lanes(const Mask<Real>& fresh, const Real& pore_pressure, Point<kind, Real>& point,
                                      Real& v, Stress<kind, Real>& e, Real& pc) const {
        constexpr int n = components(kind);
        std::array<Lanes<Real>, std::size_t{n}> stresses, strains;
        for (int i = 0; i < n; ++i) {
            stresses[static_cast<std::size_t>(i)] = to_lanes(point.stress[i]);
            strains[static_cast<std::size_t>(i)] = to_lanes(e[i]);
        }
        const Lanes<Real> pore = to_lanes(pore_pressure);
        Lanes<Real> volume = to_lanes(v), preconsolidation = to_lanes(pc), refused{}, values{};
        const char *refusal = nullptr, *allowed = nullptr, *warning = nullptr;
        for (std::size_t lane = 0; lane < pore.size(); ++lane) {
            if (!is_set<Real>(fresh, lane)) continue;
            Stress<kind, double> stress, strain{};
            for (int i = 0; i < n; ++i) stress[i] = stresses[static_cast<std::size_t>(i)][lane];
            const Remarks remarks = find(stress, pore[lane], volume[lane], strain, preconsolidation[lane]);
            for (int i = 0; i < n; ++i) strains[static_cast<std::size_t>(i)][lane] = strain[i];
            if (remarks.warning != nullptr) warning = remarks.warning;
            if (remarks.refused != nullptr) {
                refusal = remarks.refused;
                allowed = remarks.allowed;
                refused[lane] = 1.0;
                values[lane] = remarks.value;
            }
        }
        if (warning != nullptr) point.warn(warning);
        if (refusal != nullptr) {
            point.refuse(from_lanes<Real>(refused) > Real(0.0), refusal, from_lanes<Real>(values), allowed);
            return false;
        }
        for (int i = 0; i < n; ++i) e[i] = from_lanes<Real>(strains[static_cast<std::size_t>(i)]);
        v = from_lanes<Real>(volume);
        pc = from_lanes<Real>(preconsolidation);
        return true;
    }

    // What can be foreseen without the host's stress.
    std::string warnings() const {
        std::string text;
        if (misses_critical_state(expected_pc()))
            text += std::string(no_critical_state) + " = " + format_number(expected_pc()) + "\n";
        if (has_negative_poisson(p_ini)) text += std::string(negative_poisson) + " = " + format_number(p_ini) + "\n";
        return text;
    }

  private:
    static constexpr const char* no_critical_state =
        "CAM_CLAY: critical state is not reachable with these alpha, mu0, M, kappa at the initial pc";
    static constexpr const char* negative_poisson =
        "CAM_CLAY: Poisson's ratio is negative (mu0 + alpha p > 3 p/(2 kappa)) at the initial p";

    double expected_pc() const { return pc0_is_ratio ? pc0 * p_ini : pc0; }

    // Failure mode 2: the critical state exists up to pc = 4 A_lim.
    bool misses_critical_state(double pc) const {
        const double alpha = elasticity.alpha, kappa = elasticity.kappa;
        if (alpha == 0.0 || alpha >= 2.0 * M * M / (3.0 * kappa)) return false;
        return pc > 4.0 * elasticity.mu0 / (M * sqrt(2.0 * alpha / (3.0 * kappa)) - alpha);
    }
    // Failure mode 5.
    bool has_negative_poisson(double p) const {
        return elasticity.mu0 + elasticity.alpha * p > 1.5 * p * elasticity.inverse_kappa;
    }
};

}  // namespace lode
