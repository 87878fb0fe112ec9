// A library that describes its models: the tests of `lode models` and of what the host takes from a catalogue.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "lode/lode.h"

namespace {

const lode_parameter parameters[] = {
    {"K", "stiffness", "stress", 0.0, HUGE_VAL, 0.0, LODE_LOWER_OPEN, ""},
    {"NU", "Poisson's ratio", "-", -1.0, 0.5, 0.0, LODE_LOWER_OPEN | LODE_UPPER_OPEN, ""},
    {"MODE", "algorithm", "code", 0, 2, 1, LODE_INTEGER | LODE_OPTIONAL | LODE_ZERO_IS_DEFAULT, "0 slow; 1 fast"},
};
const lode_state states[] = {{"COUNT", "calls so far", 0.0}, {"AGE", "time so far", 2.5}};
const double eight[] = {1000, 0.25, 1, 4, 5, 6, 7, 8};
const double two[] = {1000, 0.25};
const lode_sample samples[] = {
    {"EIGHT", "eight constants, MPa", eight, 8, 0.01, LODE_SOLID | LODE_PLANE_STRESS},
    {"TWO", "two constants", two, 2, 0.01, LODE_PLANE_STRESS},
};
const lode_algorithm algorithms[] = {{"fast", 3, 1, HUGE_VAL}, {"slow", 3, 0, 2}};
const lode_model spring = {"SPRING",
                           "A spring",
                           "elastic",
                           "Shows what a page looks like.",
                           "no text",
                           LODE_SOLID | LODE_PLANE_STRESS,
                           LODE_UNSYMMETRIC | LODE_ELASTIC,
                           parameters,
                           3,
                           2,
                           states,
                           2,
                           samples,
                           2,
                           algorithms,
                           2,
                           "- Fails at nothing.\n"};
const double finite_constants[] = {10, 40};
const lode_sample finite_samples[] = {{"RUBBER", "soft", finite_constants, 2, 0.5, LODE_SOLID}};
const lode_model rubber = {"FINITE",
                           "A finite model",
                           "hyperelastic",
                           "Reads F.",
                           "no text",
                           LODE_SOLID,
                           LODE_FINITE_STRAIN,
                           parameters,
                           2,
                           2,
                           states,
                           0,
                           finite_samples,
                           1,
                           algorithms,
                           0,
                           ""};

}  // namespace

extern "C" {

int lode_model_count(void) { return 2; }
const lode_model* lode_model_at(int index) { return index == 0 ? &spring : index == 1 ? &rubber : nullptr; }
const char* lode_version(void) { return "9.9.9"; }
const char* lode_instruction_set(void) { return "test"; }

int lode_required_state(const char* name, const double* constants, int count, int ndi, int nshr, char* error,
                        int size) {
    if (count < 2 || !(constants[0] > 0)) {
        std::snprintf(error, static_cast<std::size_t>(size), "%s: K has to be positive", name);
        return -1;
    }
    return std::string(name).starts_with("FINITE") ? 0 : ndi == 3 && nshr == 3 ? 2 : 1;
}

// Linear springs without coupling; STATEV(1) counts.
void umat_(double* stress, double* statev, double* ddsdde, double*, double*, double*, double*, double*, double*,
           double*, const double*, const double* dstran, const double*, const double*, const double*, const double*,
           const double*, const double*, const char*, const int*, const int*, const int* ntens, const int* nstatv,
           const double* props) {
    for (int i = 0; i < *ntens; ++i) {
        stress[i] += props[0] * dstran[i];
        ddsdde[i + *ntens * i] = props[0];
    }
    if (*nstatv > 0) statev[0] += 1;
}

// STATEV(1) is 1 where the name has the label PS.
void vumat_(const int* nblock, const int* ndir, const int* nshr, const int*, const int*, const int*, const int*,
            const double*, const double* total_time, const double*, const char* cmname, const double*, const double*,
            const double* props, const double*, double* strain_inc, const double*, const double*, const double*,
            const double*, const double*, const double* stress_old, const double* state_old, const double*,
            const double*, const double*, const double*, const double*, const double*, double* stress_new,
            double* state_new) {
    const bool thin = std::string(cmname, 80).starts_with("SPRING-PS-TWO ");
    for (int i = 0; i < (*ndir + *nshr) * *nblock; ++i) stress_new[i] = stress_old[i] + props[0] * strain_inc[i];
    for (int i = 0; i < *nblock; ++i) state_new[i] = *total_time == 0 ? state_old[i] : thin ? 1 : 0;
}

}  // extern "C"
