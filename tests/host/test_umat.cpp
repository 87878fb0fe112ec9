// A small material library for the tests of the host, so that they do not depend on the real one. The keyword in
// CMNAME selects: ELASTIC, J2, PICKY, ECHO, SKEW, NEO, NAN, QUIT, BADTANGENT.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

extern "C" {
[[gnu::weak]] void xit_();
[[gnu::weak]] void stdb_abqerr_(const int* lop, const char* text, const int* integers, const double* reals,
                                const char* strings, std::size_t text_length, std::size_t string_length);
}

namespace {

std::string keyword(const char* cmname) {
    const std::string name(cmname, 80);
    return name.substr(0, name.find_first_of(" -"));
}

// Isotropic stiffness for the kinds by NDI, NSHR; normal and shear stiffness of traction separation.
void elastic_stiffness(double young, double poisson, int ndi, int nshr, bool cohesive, double* c) {
    const int n = ndi + nshr;
    std::fill_n(c, n * n, 0.0);
    const double shear = young / (2 * (1 + poisson));
    double direct = young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson)), off = direct * poisson / (1 - poisson);
    if (ndi == 2) {
        direct = young / (1 - poisson * poisson);
        off = poisson * direct;
    } else if (ndi == 1) {
        direct = young;
    }
    for (int i = 0; i < ndi; ++i)
        for (int j = 0; j < ndi; ++j) c[i + n * j] = i == j ? direct : off;
    for (int i = ndi; i < n; ++i) c[i + n * i] = cohesive ? poisson * young : shear;
}

// Von Mises plasticity with linear isotropic hardening: PROPS E, nu, yield stress, H. STATEV(1) equivalent strain.
void j2(double* stress, double* statev, double* c, double* sse, double* spd, const double* dstran, int ndi, int nshr,
        const double* props) {
    const int n = ndi + nshr;
    const double shear = props[0] / (2 * (1 + props[1])), bulk = props[0] / (3 * (1 - 2 * props[1]));
    elastic_stiffness(props[0], props[1], ndi, nshr, false, c);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) stress[i] += c[i + n * j] * dstran[j];
    const double mean = (stress[0] + stress[1] + stress[2]) / 3;
    std::vector<double> deviator(stress, stress + n);
    double square = 0;
    for (int i = 0; i < n; ++i) {
        if (i < 3) deviator[static_cast<std::size_t>(i)] -= mean;
        const double s = deviator[static_cast<std::size_t>(i)];
        square += (i < 3 ? 1 : 2) * s * s;
    }
    const double mises = std::sqrt(1.5 * square), excess = mises - (props[2] + props[3] * statev[0]);
    if (excess > 0) {
        const double dp = excess / (3 * shear + props[3]), ratio = 1 - 3 * shear * dp / mises;
        for (int i = 0; i < n; ++i) stress[i] = ratio * deviator[static_cast<std::size_t>(i)] + (i < 3 ? mean : 0);
        *spd += dp * (props[2] + props[3] * (statev[0] + 0.5 * dp));
        statev[0] += dp;
        // C = K 1x1 + 2G ratio dev + (..) N x N, with N = deviator / mises.
        const double factor = 9 * shear * shear * (dp / mises - 1 / (3 * shear + props[3]));
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                double value = factor * deviator[static_cast<std::size_t>(i)] * deviator[static_cast<std::size_t>(j)] /
                               (mises * mises);
                if (i < 3 && j < 3) value += bulk + 2 * shear * ratio * ((i == j ? 1 : 0) - 1.0 / 3);
                else if (i == j) value += shear * ratio;
                c[i + n * j] = value;
            }
    }
    square = 0;
    double pressure = (stress[0] + stress[1] + stress[2]) / 3;
    for (int i = 0; i < n; ++i) square += (i < 3 ? 1 : 2) * std::pow(stress[i] - (i < 3 ? pressure : 0), 2);
    *sse = pressure * pressure / (2 * bulk) + square / (4 * shear);
}

// Neo-Hookean, from DFGRD1 only: sigma = (mu (B - 1) + lambda ln J 1) / J. PROPS mu, lambda.
void neo_hookean(double* stress, double* c, const double* f, const double* props) {
    const auto F = [f](int i, int j) { return f[i + 3 * j]; };
    const double J = F(0, 0) * (F(1, 1) * F(2, 2) - F(1, 2) * F(2, 1)) -
                     F(0, 1) * (F(1, 0) * F(2, 2) - F(1, 2) * F(2, 0)) +
                     F(0, 2) * (F(1, 0) * F(2, 1) - F(1, 1) * F(2, 0));
    const double mu = props[0], lambda = props[1];
    constexpr int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
    double b[3][3] = {};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k) b[i][j] += F(i, k) * F(j, k);
    const auto one = [](int i, int j) { return i == j ? 1.0 : 0.0; };
    for (int a = 0; a < 6; ++a)
        stress[a] =
            (mu * (b[row[a]][column[a]] - one(row[a], column[a])) + lambda * std::log(J) * one(row[a], column[a])) / J;
    // Jaumann rate of Kirchhoff stress over J: Truesdell part plus the stress terms, which make mu b of mu (b - 1).
    for (int a = 0; a < 6; ++a)
        for (int d = 0; d < 6; ++d) {
            const int i = row[a], j = column[a], k = row[d], l = column[d];
            c[a + 6 * d] =
                (lambda * one(i, j) * one(k, l) +
                 0.5 * mu * (one(i, k) * b[j][l] + one(i, l) * b[j][k] + one(j, k) * b[i][l] + one(j, l) * b[i][k])) /
                J;
        }
}

}  // namespace

extern "C" void umat_(double* stress, double* statev, double* ddsdde, double* sse, double* spd, double*, double*,
                      double*, double*, double*, const double* stran, const double* dstran, const double* time,
                      const double* dtime, const double* temp, const double* dtemp, const double* predef,
                      const double* dpred, const char* cmname, const int* ndi, const int* nshr, const int* ntens,
                      const int* nstatv, const double* props, const int*, const double*, const double* drot,
                      double* pnewdt, const double* celent, const double* dfgrd0, const double* dfgrd1, const int* noel,
                      const int* npt, const int*, const int*, const int* jstep, const int* kinc) {
    const int n = *ntens;
    const std::string model = keyword(cmname);
    if (model == "J2") return j2(stress, statev, ddsdde, sse, spd, dstran, *ndi, *nshr, props);
    if (model == "NEO") return neo_hookean(stress, ddsdde, dfgrd1, props);
    if (model == "NAN") {
        std::fill_n(stress, n, std::numeric_limits<double>::quiet_NaN());
        return;
    }
    if (model == "QUIT" && *kinc >= 3) {
        const int severity = -2, none = 0;
        const double no_real = 0;
        const char text[] = "QUIT: that is enough";
        if (stdb_abqerr_ != nullptr) stdb_abqerr_(&severity, text, &none, &no_real, "        ", sizeof text - 1, 8);
        if (xit_ != nullptr) xit_();
    }
    if (model == "PICKY") {
        // Asks for half the increment where a strain component grows by more than PROPS(3).
        for (int i = 0; i < n; ++i)
            if (std::abs(dstran[i]) > props[2]) *pnewdt = 0.5;
        statev[0] += 1;
        if (*pnewdt < 1) return;
    }
    if (model == "ECHO") {
        // STATEV tells what the last call was given.
        const double values[] = {time[0],
                                 time[1],
                                 *dtime,
                                 *temp,
                                 *dtemp,
                                 predef[0],
                                 dpred[0],
                                 *celent,
                                 static_cast<double>(*ndi),
                                 static_cast<double>(*nshr),
                                 static_cast<double>(*noel),
                                 static_cast<double>(*npt),
                                 static_cast<double>(jstep[0]),
                                 static_cast<double>(*kinc),
                                 *pnewdt};
        std::copy(std::begin(values), std::end(values), statev);
        for (int i = 0; i < 9 && *nstatv >= 70; ++i) {
            statev[20 + i] = dfgrd0[i];
            statev[30 + i] = dfgrd1[i];
            statev[40 + i] = drot[i];
        }
        for (int i = 0; i < n && *nstatv >= 70; ++i) {
            statev[50 + i] = stran[i];
            statev[60 + i] = dstran[i];
        }
    }
    elastic_stiffness(props[0], props[1], *ndi, *nshr, model == "COHESIVE", ddsdde);
    if (model == "SKEW") {
        // Unsymmetric and nonlinear: stress 11 also feels the square of strain 22.
        const double strain22 = stran[1] + dstran[1];
        const std::vector<double> stiffness(ddsdde, ddsdde + n * n);
        for (int i = 0; i < n; ++i) {
            stress[i] = 0;
            for (int j = 0; j < n; ++j)
                stress[i] += stiffness[static_cast<std::size_t>(i + n * j)] * (stran[j] + dstran[j]);
        }
        stress[0] += props[2] * strain22 * strain22;
        ddsdde[0 + n * 1] += 2 * props[2] * strain22;
        return;
    }
    double energy = 0;
    for (int i = 0; i < n; ++i) {
        double change = 0;
        for (int j = 0; j < n; ++j) change += ddsdde[i + n * j] * dstran[j];
        energy += (stress[i] + 0.5 * change) * dstran[i];
        stress[i] += change;
    }
    *sse += energy;
    // Too stiff: Newton still has to arrive, linearly.
    if (model == "BADTANGENT") std::for_each(ddsdde, ddsdde + n * n, [](double& c) { c *= 1.25; });
}

// ELASTIC and COHESIVE in VUMAT's order (12, 23, 31 and tensor shears); ECHO as for UMAT; UNEQUAL spoils one point.
extern "C" void vumat_(const int* nblock, const int* ndir, const int* nshr, const int* nstatev, const int* nfieldv,
                       const int*, const int*, const double* step_time, const double* total_time, const double* dt,
                       const char* cmname, const double*, const double* char_length, const double* props,
                       const double* density, double* strain_inc, const double* spin, const double* temp_old,
                       const double* stretch_old, const double* defgrad_old, const double* field_old,
                       const double* stress_old, const double* state_old, const double* intern_old,
                       const double* inelas_old, const double* temp_new, const double* stretch_new,
                       const double* defgrad_new, const double* field_new, double* stress_new, double* state_new,
                       double* intern_new, double* inelas_new) {
    (void)stretch_old, (void)defgrad_old, (void)field_old, (void)temp_old;
    const int n = *nblock, components = *ndir + *nshr;
    const std::string model = keyword(cmname);
    const bool cohesive = model == "COHESIVE", thin = std::string(cmname, 80).find("-PS") != std::string::npos;
    std::vector<double> c(static_cast<std::size_t>(components) * static_cast<std::size_t>(components));
    elastic_stiffness(props[0], props[1], *ndir, *nshr, cohesive, c.data());
    for (int p = 0; p < n; ++p) {
        if (thin) strain_inc[p + 2 * n] = -props[1] / (1 - props[1]) * (strain_inc[p] + strain_inc[p + n]);
        double power = 0;
        for (int i = 0; i < components; ++i) {
            double stress = stress_old[p + i * n];
            for (int j = 0; j < components; ++j)
                stress += c[static_cast<std::size_t>(i + components * j)] * (j < *ndir ? 1 : 2) * strain_inc[p + j * n];
            if (thin && i == 2) stress = 0;
            power += 0.5 * (stress + stress_old[p + i * n]) * (i < *ndir ? 1 : 2) * strain_inc[p + i * n];
            stress_new[p + i * n] = stress;
        }
        intern_new[p] = intern_old[p] + power / density[p];
        inelas_new[p] = inelas_old[p];
        for (int s = 0; s < *nstatev; ++s) state_new[p + s * n] = state_old[p + s * n];
    }
    if (model == "UNEQUAL") stress_new[n - 1] *= 1 + 1e-6;
    if (model == "HISTORY" && *total_time == 0) state_new[0] = 1;
    if (model == "ECHO") {
        const double values[] = {*step_time,
                                 *total_time,
                                 *dt,
                                 temp_new[0],
                                 *nfieldv > 0 ? field_new[0] : 0,
                                 *char_length,
                                 *density,
                                 static_cast<double>(*ndir),
                                 static_cast<double>(*nshr)};
        for (int p = 0; p < n; ++p) {
            for (int s = 0; s < 9; ++s) state_new[p + s * n] = values[s];
            for (int i = 0; i < components; ++i) {
                state_new[p + (10 + i) * n] = strain_inc[p + i * n];
                state_new[p + (20 + i) * n] = stretch_new[p + i * n];
            }
            for (int i = 0; i < components + *nshr; ++i) state_new[p + (30 + i) * n] = defgrad_new[p + i * n];
            for (int i = 0; i < *nshr; ++i) state_new[p + (40 + i) * n] = spin[p + i * n];
        }
    }
}
