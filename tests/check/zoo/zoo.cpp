// A user material in C++ with the mistakes that such materials have: ZOO_DEFECT names the one that this build makes;
// "none" is the correct twin. Yield q + 3 a p_m = k + H e with isochoric flow (J2 plasticity for a = 0), 3D and plane
// strain, for UMAT and VUMAT.
//   PROPS E, nu, k, H, a     STATEV e
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string_view>

extern "C" {
[[gnu::weak]] void xit_();
[[gnu::weak]] void xplb_exit_();
}

namespace {

constexpr std::string_view defect = ZOO_DEFECT;

struct Material {
    double shear, bulk, yield, hardening, friction;
    explicit Material(const double* props)
        : shear(props[0] / (2 * (1 + props[1]))),
          bulk(props[0] / (3 * (1 - 2 * props[1]))),
          yield(props[2]),
          hardening(props[3]),
          friction(props[4]) {}
};

double mean_of(const double* stress) { return (stress[0] + stress[1] + stress[2]) / 3; }

double mises_of(const double* stress, int n) {
    const double mean = mean_of(stress);
    double square = 0;
    for (int i = 0; i < n; ++i) {
        const double s = stress[i] - (i < 3 ? mean : 0);
        square += (i < 3 ? 1 : 2) * s * s;
    }
    return std::sqrt(1.5 * square);
}

struct Update {
    bool possible = true;
    double plastic = 0;           // increment of e
    double ratio = 1, mises = 0;  // of the trial deviator
};

// Stress becomes that of the end. `trial` is the elastic predictor.
Update return_to_yield(const Material& m, double* trial, int n, double e) {
    Update u;
    u.mises = mises_of(trial, n);
    const double mean = mean_of(trial);
    const double excess = u.mises + 3 * m.friction * mean - (m.yield + m.hardening * e);
    if (!(excess > 0)) return u;
    u.plastic = excess / (3 * m.shear + m.hardening);
    u.ratio = 1 - 3 * m.shear * u.plastic / u.mises;
    u.possible = u.ratio > 0;
    if (u.possible)
        for (int i = 0; i < n; ++i) {
            const double part = i < 3 ? mean : 0;
            trial[i] = part + u.ratio * (trial[i] - part);
        }
    return u;
}

void add_elastic(const Material& m, double* stress, const double* strain, int n, bool tensor_shears) {
    const double volume = strain[0] + strain[1] + strain[2];
    for (int i = 0; i < n; ++i)
        stress[i] += i < 3 ? 2 * m.shear * (strain[i] - volume / 3) + m.bulk * volume
                           : (tensor_shears ? 2 : 1) * m.shear * strain[i];
}

double stored_energy(const Material& m, const double* stress, int n) {
    const double mean = mean_of(stress), q = mises_of(stress, n);
    return mean * mean / (2 * m.bulk) + q * q / (6 * m.shear);
}

// Derivative of the end stress: deviator of the trial stress in `s`.
void tangent(const Material& m, const Update& u, const double* s, int n, double* ddsdde) {
    const double slope = 3 * m.shear + m.hardening;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            double value = 0;
            if (i < 3 && j < 3) value = m.bulk + 2 * m.shear * u.ratio * ((i == j ? 1 : 0) - 1.0 / 3);
            else if (i == j) value = m.shear * u.ratio;
            if (u.plastic > 0) {
                // d ratio = -3 G (d e / q - e dq / q^2), with d e = (dq + 3 a dp) / slope
                const double dq = 3 * m.shear * s[j] / u.mises, dp = j < 3 ? m.bulk : 0;
                const double de = (dq + 3 * m.friction * dp) / slope;
                value -= s[i] * 3 * m.shear * (de - u.plastic * dq / u.mises) / u.mises;
            }
            ddsdde[i + n * j] = value;
        }
    if (defect == "tangent_transposed")
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < j; ++i) std::swap(ddsdde[i + n * j], ddsdde[j + n * i]);
}

void quit(void (*host)()) {
    if (host != nullptr) host();
    std::abort();
}

volatile double shared_trial[6];  // for the race
double* nowhere() { return nullptr; }

}  // namespace

extern "C" void umat_(double* stress, double* statev, double* ddsdde, double* sse, double* spd, double* scd, double*,
                      double*, double*, double*, const double* stran, const double* dstran, const double*,
                      const double*, const double*, const double*, const double*, const double*, const char*,
                      const int*, const int*, const int* ntens, const int* nstatv, const double* props,
                      const int* nprops, const double*, const double*, double* pnewdt, const double*, const double*,
                      const double*, const int*, const int*, const int*, const int*, const int*, const int* kinc) {
    const int n = *ntens;
    if (*nprops < 5 || *nstatv < 1) quit(xit_);
    if (defect == "null_pointer" && *kinc > 3) *nowhere() = 1;
    static const double* kept = nullptr;
    static double first_props[5];
    if (kept == nullptr) kept = static_cast<const double*>(std::memcpy(first_props, props, sizeof first_props));
    const Material m(defect == "stale_constants" ? kept : props);
    double size = 0;
    for (int i = 0; i < n; ++i) size = std::isnan(dstran[i]) ? NAN : std::max(size, std::abs(dstran[i]));
    if (defect == "endless_loop" && size > 0.1)
        for (volatile double residual = size; residual > 1e-9;) residual = residual + 0 * size;
    double trial[6];
    std::copy_n(stress, n, trial);
    add_elastic(m, trial, dstran, n, false);
    if (defect == "global_array") {
        for (int i = 0; i < n; ++i) shared_trial[i] = trial[i];
        for (int i = 0; i < n; ++i) trial[i] = shared_trial[i];
    }
    if (defect == "path_dependent") {
        // Stiffness by the strain at the start of the increment, stress by increments.
        double square = 0;
        for (int i = 0; i < n; ++i) square += stran[i] * stran[i];
        double change[6] = {};
        add_elastic(m, change, dstran, n, false);
        for (int i = 0; i < n; ++i) trial[i] = stress[i] + change[i] * (1 + 1e5 * square);
    }
    double deviator[6];
    for (int i = 0; i < n; ++i) deviator[i] = trial[i] - (i < 3 ? mean_of(trial) : 0);
    const Update u = return_to_yield(m, trial, n, statev[0]);
    if (defect == "cut_changes_state" && u.plastic > 0.05) {
        std::copy_n(trial, n, stress);
        statev[0] += u.plastic;
        *pnewdt = 0.5;
        return;
    }
    if (!u.possible || !(size < 1)) {
        *pnewdt = defect == "pnewdt_zero" ? 0 : 0.25;
        return;
    }
    const double q = mises_of(stress, n);
    std::copy_n(trial, n, stress);
    statev[0] += u.plastic;
    *sse = stored_energy(m, stress, n);
    // Trapezoidal rule, which is exact if the plastic strain grows all the way.
    const double q_end = mises_of(stress, n);
    const double dissipation =
        u.plastic * (m.friction == 0 ? q_end - 0.5 * m.hardening * u.plastic : 0.5 * (q + q_end));
    if (defect == "energy_overwritten") *spd = dissipation;
    else *spd += dissipation;
    if (defect == "scd_decreases") *scd -= dissipation;
    double own[36];
    tangent(m, u, deviator, n, own);
    for (int i = 0; i < n * n; ++i) ddsdde[i] = defect == "adds_to_ddsdde" ? ddsdde[i] + own[i] : own[i];
}

// Shears 12, 23, 31, as tensor components.
extern "C" void vumat_(const int* nblock, const int* ndir, const int* nshr, const int* nstatev, const int*,
                       const int* nprops, const int*, const double* step_time, const double* total_time, const double*,
                       const char*, const double*, const double*, const double* props, const double* density,
                       const double* strain_inc, const double*, const double*, const double*, const double*,
                       const double*, double* stress_old, const double* state_old, const double* intern_old,
                       const double* inelas_old, const double*, const double*, const double*, const double*,
                       double* stress_new, double* state_new, double* intern_new, double* inelas_new) {
    if (*nprops < 5 || *nstatev < 1) quit(xplb_exit_);
    const int points = *nblock, n = *ndir + *nshr;
    Material m(props);
    const bool probe = *step_time == 0 && *total_time == 0;
    if (probe) m.yield = 1e300;
    double before = 0;  // plastic increment of the point before
    for (int p = 0; p < points; ++p) {
        double old[6], stress[6], strain[6];
        for (int i = 0; i < n; ++i) {
            old[i] = stress[i] = stress_old[p + i * points];
            strain[i] = strain_inc[p + i * points];
        }
        add_elastic(m, stress, strain, n, defect != "vumat_shear_factor");
        double e = state_old[p];
        if (defect == "vumat_block" && p > 0) e += before;
        const Update u = return_to_yield(m, stress, n, e);
        before = u.plastic;
        double work = 0;
        for (int i = 0; i < n; ++i) work += (i < 3 ? 0.5 : 1) * (old[i] + stress[i]) * strain[i];
        if (defect == "vumat_component_order" && n == 6) std::swap(stress[4], stress[5]);
        for (int i = 0; i < n; ++i) {
            stress_new[p + i * points] = stress[i];
            if (defect == "vumat_writes_stress_old") stress_old[p + i * points] = stress[i];
        }
        if (defect != "vumat_state_unset" || u.plastic > 0) state_new[p] = state_old[p] + u.plastic;
        intern_new[p] = intern_old[p] + work / density[p];
        inelas_new[p] = inelas_old[p] + u.plastic * mises_of(stress, n) / density[p];
    }
}
