// Two stiff bars joined by a soft layer are pulled apart by a phase-field crack: a one-dimensional finite element
// program that solves for the phase and asks `umat_` (PHASE_FIELD) for everything constitutive, as a host would.
// README.md has the theory behind the tables.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "lode/entry_points.h"

namespace {

constexpr double layer_modulus = 3.0, bar_modulus = 210000.0, Gc = 1.0;  // MPa, MPa, N/mm
constexpr double thickness = 0.2;                                        // of the layer and of the elements, mm
constexpr int nstatv = 16, W = 12, SRC = 13, DSRC = 14;                  // STATEV, 0-based

// One integration point. Poisson's ratio is 0: the strain of the bar is all the strain there is.
struct Element {
    std::vector<double> props;
    double strain = 0.0, phase = 0.0, stress = 0.0;  // accepted
    double state[nstatv] = {};
    double new_strain = 0.0, new_phase = 0.0, new_stress = 0.0;  // tried
    double new_state[nstatv] = {};
    double stiffness = 0.0;

    // UMAT from the accepted state to (new_strain, new_phase).
    void update() {
        double s[6] = {stress, 0, 0, 0, 0, 0}, ddsdde[36], sse = 0, spd = 0, scd = 0, rpl = 0, ddsddt[6], drplde[6],
               drpldt = 0, pnewdt = 1;
        const double stran[6] = {strain, 0, 0, 0, 0, 0}, dstran[6] = {new_strain - strain, 0, 0, 0, 0, 0};
        const double time[2] = {0, 0}, dtime = 1, zero = 0, one = 1, unit[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
        const double change = new_phase - phase, coords[3] = {};
        const int ndi = 3, nshr = 3, ntens = 6, nstates = nstatv, nprops = static_cast<int>(props.size()), number = 1;
        char name[81];
        std::snprintf(name, sizeof name, "%-80s", "PHASE_FIELD-BAR");
        std::copy_n(state, nstatv, new_state);
        umat_(s, new_state, ddsdde, &sse, &spd, &scd, &rpl, ddsddt, drplde, &drpldt, stran, dstran, time, &dtime, &zero,
              &zero, &phase, &change, name, &ndi, &nshr, &ntens, &nstates, props.data(), &nprops, coords, unit, &pnewdt,
              &one, unit, unit, &number, &number, &number, &number, &number, &number, LODE_CMNAME_LENGTH);
        new_stress = s[0];
        stiffness = ddsdde[0];
    }
    void accept() {
        strain = new_strain, phase = new_phase, stress = new_stress;
        std::copy_n(new_state, nstatv, state);
    }
};

struct Law {
    const char* name;
    double code, argument;  // GLAW, GARG
};
struct Result {
    double dissipated = 0.0, work = 0.0, surface = 0.0;  // per area
    double peak = 0.0, phase = 0.0;                      // stress; phase of the layer at the end
    int iterations = 0;
};

auto& at(auto& v, int i) { return v[static_cast<std::size_t>(i)]; }

// The joint with bars of length 8 ELL each; the layer is one element. Its strain is prescribed, so that the way down
// can be followed; the stress is the same everywhere.
class Joint {
  public:
    Joint(const Law& law, double length_scale)
        : ell(length_scale),
          middle(static_cast<int>(std::ceil(8.0 * ell / h))),
          elements(2 * middle + 1),
          bar(static_cast<std::size_t>(elements)),
          phi(bar.size() + 1, 0.0),
          old(phi) {
        for (int i = 0; i < elements; ++i)
            at(bar, i).props = {i == middle ? layer_modulus : bar_modulus, 0.0, Gc, ell, law.code, law.argument};
    }

    Result pull_apart() {
        Result result;
        double elongation = 0.0, stress_before = 0.0;
        for (double control = 1e-2 * std::sqrt(Gc / (layer_modulus * thickness));; control *= 1.02) {
            do {
                if (++result.iterations > 1000000) return {};
                find_strains(control);
            } while (improve_phase() > 1e-8);
            double length = 0.0;
            for (Element& e : bar) {
                e.accept();
                length += h * e.strain;
            }
            old = phi;
            const double stress = at(bar, middle).stress;
            result.work += 0.5 * (stress_before + stress) * (length - elongation);
            result.peak = std::max(result.peak, stress);
            elongation = length, stress_before = stress;
            if (stress < 1e-5 * result.peak) break;
        }
        result.phase = at(bar, middle).phase;
        for (int i = 0; i < elements; ++i) {
            const double slope = (at(phi, i + 1) - at(phi, i)) / h, phase = at(bar, i).phase;
            result.dissipated += h * at(bar, i).state[W];
            result.surface += 0.5 * h * Gc * (phase * phase / ell + ell * slope * slope);
        }
        return result;
    }

  private:
    // Displacement problem: at a given phase the stress is linear in the strain.
    void find_strains(double control) {
        Element& center = at(bar, middle);
        center.new_strain = control;
        for (int i = 0; i < elements; ++i) at(bar, i).new_phase = 0.5 * (at(phi, i) + at(phi, i + 1));
        center.update();
        for (Element& e : bar) {
            if (&e == &center) continue;
            e.new_strain = e.strain;
            e.update();
            e.new_strain += (center.new_stress - e.new_stress) / e.stiffness;
            e.update();
        }
    }

    // Phase problem: a step of Newton for GC ELL phi'' + SRC = 0 with one Gauss point an element, where a crack does
    // not heal. Returns the largest change.
    double improve_phase() {
        const int nodes = elements + 1;
        std::vector<double> diagonal(phi.size(), 0.0), off(phi.size(), 0.0), r(phi.size(), 0.0);
        for (int i = 0; i < elements; ++i) {
            const double *state = at(bar, i).new_state, gradient = Gc * ell / h;
            const double flux = gradient * (at(phi, i + 1) - at(phi, i));
            at(r, i) += 0.5 * h * state[SRC] + flux;
            at(r, i + 1) += 0.5 * h * state[SRC] - flux;
            at(diagonal, i) += gradient - 0.25 * h * state[DSRC];
            at(diagonal, i + 1) += gradient - 0.25 * h * state[DSRC];
            at(off, i) = -gradient - 0.25 * h * state[DSRC];
        }
        for (int i = 1; i < nodes; ++i) {
            const double factor = at(off, i - 1) / at(diagonal, i - 1);
            at(diagonal, i) -= factor * at(off, i - 1);
            at(r, i) -= factor * at(r, i - 1);
        }
        double largest = 0.0, change = 0.0;
        for (int i = nodes - 1; i >= 0; --i) {
            change = (at(r, i) - at(off, i) * change) / at(diagonal, i);
            const double to = std::clamp(at(phi, i) + change, at(old, i), 1.0);
            largest = std::max(largest, std::abs(to - at(phi, i)));
            at(phi, i) = to;
        }
        return largest;
    }

    static constexpr double h = thickness;
    double ell;
    int middle, elements;
    std::vector<Element> bar;
    std::vector<double> phi, old;  // at the nodes; of the last accepted increment
};

void row(const Law& law, double ratio) {
    const double ell = thickness * ratio;
    const Result r = Joint(law, ell).pull_apart();
    std::printf("%-12s %6.2f %8.5f %8.4f %9.6f %10.6f %10.6f %10.6f %10.6f %8d\n", law.name, ell, 1.0 / ratio, r.peak,
                r.phase, r.dissipated / Gc, r.work / Gc, r.surface / Gc, 1.0 + 0.5 / ratio, r.iterations);
}

}  // namespace

int main() {
    const Law quadratic{"quadratic", 1, 1}, exponential{"exponential", 2, 3}, cubic{"cubic", 3, 0.9};
    std::printf("Toughness recovered from a joint that is pulled apart, over GC\n\n");
    std::printf("%-12s %6s %8s %8s %9s %10s %10s %10s %10s %8s\n", "degradation", "ELL", "h/ELL", "peak", "phase",
                "sum W h", "work", "surface", "expected", "updates");
    for (const double ratio : {1.0, 2.0, 4.0, 8.0, 16.0}) row(quadratic, ratio);
    for (const Law& law : {exponential, cubic}) row(law, 8.0);
    return 0;
}
