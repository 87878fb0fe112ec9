// A double cantilever beam is pulled open: two elastic beams joined by a cohesive interface, COH_TRIANGULAR of the
// library, which is called through umat_ as a finite element code calls it. README.md has the theory.
//
//     double_cantilever [directory]      writes load.csv, load.gp and, where gnuplot is installed, load.svg
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include "lode/entry_points.h"

namespace {

// --- the specimen, N and mm ---------------------------------------------------------------------------------------

constexpr double width = 20.0, arm_height = 1.5, length = 150.0, initial_crack = 40.0;
constexpr double young = 120000.0;
constexpr double bending_stiffness = young * width * arm_height * arm_height * arm_height / 12.0;
constexpr double toughness = 0.3;
// Of the interface: K_N, SIG_N, GIC, K_T, SIG_T, GIIC.
constexpr double interface_constants[] = {100000.0, 30.0, toughness, 100000.0, 30.0, toughness};

constexpr double element_length = 0.2;
constexpr int elements = static_cast<int>(length / element_length), nodes = elements + 1, unknowns = 2 * nodes;
constexpr double largest_opening = 10.0, usual_step = 0.02;  // of the loaded ends
constexpr double force_tolerance = 1e-5;                     // rounding of the stiff short elements leaves about 1e-6 N

// --- the interface: one call of umat_ a point ---------------------------------------------------------------------

constexpr int state_count = 12;

struct InterfacePoint {
    double separation = 0.0, traction = 0.0, stiffness = 0.0;
    std::array<double, state_count> state{};
};

// The point after the separation has become `separation`; false if the material wants a smaller increment.
bool update(const InterfacePoint& before, double separation, InterfacePoint& after) {
    const int ndi = 1, nshr = 1, ntens = 2, nstatv = state_count, nprops = 6, one = 1;
    const double zero = 0.0, zeros[2] = {}, time[2] = {}, identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, coords[3] = {};
    const double dstran[2] = {separation - before.separation, 0.0}, celent = 1.0, dtime = 1.0;
    static const std::array<char, LODE_CMNAME_LENGTH> name = [] {
        std::array<char, LODE_CMNAME_LENGTH> text;
        text.fill(' ');
        std::memcpy(text.data(), "COH_TRIANGULAR-ADHESIVE", 23);
        return text;
    }();
    double stress[2] = {before.traction, 0.0}, ddsdde[4] = {}, ddsddt[2] = {}, drplde[2] = {};
    double sse = 0.0, spd = 0.0, scd = 0.0, rpl = 0.0, drpldt = 0.0, pnewdt = 1.0;
    after = before;
    umat_(stress, after.state.data(), ddsdde, &sse, &spd, &scd, &rpl, ddsddt, drplde, &drpldt, zeros, dstran, time,
          &dtime, &zero, &zero, &zero, &zero, name.data(), &ndi, &nshr, &ntens, &nstatv, interface_constants, &nprops,
          coords, identity, &pnewdt, &celent, identity, identity, &one, &one, &one, &one, &one, &one,
          LODE_CMNAME_LENGTH);
    after.separation = separation;
    after.traction = stress[0];
    after.stiffness = ddsdde[0];
    return pnewdt >= 1.0;
}

// --- the beam: cubic elements, deflection and slope at each node --------------------------------------------------

struct Gauss {
    double x, weight;  // on [0, 1]
};
constexpr Gauss gauss[] = {{0.0694318442029737, 0.1739274225687269},
                           {0.3300094782075719, 0.3260725774312731},
                           {0.6699905217924281, 0.3260725774312731},
                           {0.9305681557970263, 0.1739274225687269}};
constexpr int points = 4;

std::array<double, 4> shape(double x) {
    const double h = element_length;
    return {1.0 - 3.0 * x * x + 2.0 * x * x * x, h * (x - 2.0 * x * x + x * x * x), 3.0 * x * x - 2.0 * x * x * x,
            h * (x * x * x - x * x)};
}

constexpr double beam_element[4][4] = {{12, 6, -12, 6}, {6, 4, -6, 2}, {-12, -6, 12, -6}, {6, 2, -6, 4}};
double beam_stiffness(int i, int j) {
    const double h = element_length, scale = bending_stiffness / (h * h * h);
    return scale * beam_element[i][j] * (i % 2 == 1 ? h : 1.0) * (j % 2 == 1 ? h : 1.0);
}

// A matrix with three diagonals on either side, and its solution by elimination.
class Banded {
  public:
    double& at(int i, int j) { return rows_[static_cast<std::size_t>(i)][static_cast<std::size_t>(j - i + half)]; }
    void clear() {
        for (auto& row : rows_) row.fill(0.0);
    }
    void solve(std::vector<double>& b) {
        for (int k = 0; k < unknowns; ++k)
            for (int i = k + 1; i <= std::min(k + half, unknowns - 1); ++i) {
                const double factor = at(i, k) / at(k, k);
                for (int j = k; j <= std::min(k + half, unknowns - 1); ++j) at(i, j) -= factor * at(k, j);
                b[static_cast<std::size_t>(i)] -= factor * b[static_cast<std::size_t>(k)];
            }
        for (int k = unknowns - 1; k >= 0; --k) {
            double& x = b[static_cast<std::size_t>(k)];
            for (int j = k + 1; j <= std::min(k + half, unknowns - 1); ++j)
                x -= at(k, j) * b[static_cast<std::size_t>(j)];
            x /= at(k, k);
        }
    }

  private:
    static constexpr int half = 3;
    std::vector<std::array<double, 2 * half + 1>> rows_ = std::vector<std::array<double, 2 * half + 1>>(unknowns);
};

// Half of the specimen: the other beam is the mirror image, and the separation is twice the deflection.
struct Specimen {
    std::vector<double> deflection = std::vector<double>(unknowns, 0.0);
    std::vector<InterfacePoint> interface_points = std::vector<InterfacePoint>(elements * points);
    double load = 0.0;

    // Equilibrium with the loaded end at `end`; false if Newton's method does not get there.
    bool open_to(double end) {
        std::vector<double> u = deflection, residual(unknowns);
        std::vector<InterfacePoint> now = interface_points;
        Banded stiffness;
        u[0] = end;
        for (int iteration = 0; iteration < 40; ++iteration) {
            stiffness.clear();
            std::fill(residual.begin(), residual.end(), 0.0);
            for (int e = 0; e < elements; ++e)
                if (!add_element(e, u, now, stiffness, residual)) return false;
            const double reaction = residual[0];
            double largest = 0.0;
            for (int i = 1; i < unknowns - 2; ++i)
                largest = std::max(largest, std::abs(residual[static_cast<std::size_t>(i)]));
            if (iteration > 0 && largest < force_tolerance * (1.0 + std::abs(reaction))) {
                deflection = u;
                interface_points = now;
                load = reaction;
                return true;
            }
            // The loaded end has its deflection, the far end is held.
            for (const int fixed : {0, unknowns - 2, unknowns - 1}) {
                stiffness.at(fixed, fixed) = 1e30;
                residual[static_cast<std::size_t>(fixed)] = 0.0;
            }
            stiffness.solve(residual);
            for (int i = 0; i < unknowns; ++i) u[static_cast<std::size_t>(i)] -= residual[static_cast<std::size_t>(i)];
        }
        return false;
    }

    double slope() const { return -deflection[1]; }  // of the loaded end
    // Where the interface has failed.
    double crack_length() const {
        double tip = initial_crack;
        for (int i = 0; i < elements * points; ++i)
            if (interface_points[static_cast<std::size_t>(i)].state[5] >= 1.0)
                tip = element_length * (i / points + gauss[i % points].x);
        return tip;
    }

  private:
    bool add_element(int e, const std::vector<double>& u, std::vector<InterfacePoint>& now, Banded& stiffness,
                     std::vector<double>& residual) const {
        const int first = 2 * e;
        const auto value = [&](int i) { return u[static_cast<std::size_t>(first + i)]; };
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) {
                stiffness.at(first + i, first + j) += beam_stiffness(i, j);
                residual[static_cast<std::size_t>(first + i)] += beam_stiffness(i, j) * value(j);
            }
        if (element_length * e < initial_crack - 1e-9) return true;
        for (int p = 0; p < points; ++p) {
            const std::array<double, 4> n = shape(gauss[p].x);
            double separation = 0.0;
            for (int i = 0; i < 4; ++i) separation += 2.0 * n[static_cast<std::size_t>(i)] * value(i);
            const auto k = static_cast<std::size_t>(e * points + p);
            if (!update(interface_points[k], separation, now[k])) return false;
            const double area = width * element_length * gauss[p].weight;
            for (int i = 0; i < 4; ++i) {
                const double n_i = n[static_cast<std::size_t>(i)];
                residual[static_cast<std::size_t>(first + i)] += area * now[k].traction * n_i;
                for (int j = 0; j < 4; ++j)
                    stiffness.at(first + i, first + j) +=
                        2.0 * area * now[k].stiffness * n_i * n[static_cast<std::size_t>(j)];
            }
        }
        return true;
    }
};

// --- beam theory --------------------------------------------------------------------------------------------------

// The load at which a sharp crack grows, with the crack length eliminated from G = P^2 a^2/(b EI) = GIc and
// opening = 2 P a^3/(3 EI).
double propagation_load(double opening) {
    const double moment = std::sqrt(toughness * width * bending_stiffness);
    return moment * std::sqrt(2.0 * moment / (3.0 * bending_stiffness * opening));
}
double elastic_load(double opening) {
    return 1.5 * bending_stiffness * opening / (initial_crack * initial_crack * initial_crack);
}

bool draw(const std::filesystem::path& directory) {
    std::ofstream script(directory / "load.gp");
    script << "set datafile separator ','\nset terminal svg size 720,480\nset output 'load.svg'\n"
              "set xlabel 'opening of the loaded ends (mm)'\nset ylabel 'load (N)'\nset grid\n"
              "plot 'load.csv' skip 1 using 1:3 with lines dt 2 lc 'gray40' title 'beam theory, sharp crack', \\\n"
              "     '' skip 1 using 1:2 with lines lw 2 lc 'dark-blue' title 'cohesive interface'\n";
    script.close();
    const std::string command = "cd '" + directory.string() + "' && gnuplot load.gp 2>/dev/null";
    return std::system(command.c_str()) == 0;
}

}  // namespace

int main(int argc, char** argv) {
    const std::filesystem::path directory = argc > 1 ? argv[1] : ".";
    std::filesystem::create_directories(directory);
    std::ofstream table(directory / "load.csv");
    table << "opening,load,beam_theory,crack_length,J\n";
    table.precision(10);

    Specimen specimen;
    double opening = 0.0, step = usual_step, worst_load = 0.0, worst_J = 0.0;
    int compared = 0;
    std::printf("  opening      load    theory     crack         J\n");
    for (int row = 1; opening < largest_opening - 1e-9; ++row) {
        if (!specimen.open_to(0.5 * std::min(opening + step, largest_opening))) {
            step *= 0.5;
            if (step < 1e-6) {
                std::printf("no equilibrium beyond an opening of %g\n", opening);
                return 1;
            }
            continue;
        }
        opening = std::min(opening + step, largest_opening);
        step = std::min(usual_step, 2.0 * step);
        const double crack = specimen.crack_length(), load = specimen.load;
        const double theory = std::min(elastic_load(opening), propagation_load(opening));
        const double J = 2.0 * load * specimen.slope() / width;
        table << opening << ',' << load << ',' << theory << ',' << crack << ',' << J << '\n';
        if (row % 50 == 0) std::printf("%9.3f %9.3f %9.3f %9.2f %9.5f\n", opening, load, theory, crack, J);
        // Steady growth: the process zone is complete and far from the held end.
        if (crack > initial_crack + 5.0 && crack < length - 30.0) {
            ++compared;
            worst_load = std::max(worst_load, std::abs(load / theory - 1.0));
            worst_J = std::max(worst_J, std::abs(J / toughness - 1.0));
        }
    }
    table.close();
    const bool drawn = draw(directory);
    std::printf("%d states of steady growth: load within %.3f %% of beam theory, J within %.4f %% of the toughness\n",
                compared, 100.0 * worst_load, 100.0 * worst_J);
    std::printf("written: load.csv, load.gp%s\n", drawn ? ", load.svg" : "; gnuplot draws load.gp");
    const double load_tolerance = 0.001, J_tolerance = 0.001;
    return compared > 100 && worst_load < load_tolerance && worst_J < J_tolerance ? 0 : 1;
}
