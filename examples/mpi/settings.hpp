// What a run is: the material's card, the bar, the loading, the solver. Lengths, stresses and forces are in one system
// of units of the user's choice; the defaults are in mm, MPa and N.
#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

namespace bar {

struct Material {
    std::string name = "ISO_PLASTIC-STEEL";                       // CMNAME
    std::vector<double> constants = {210000, 0.3, 250, 1, 2000};  // PROPS
    int state_variables = -1;                                     // NSTATV; -1: what the library asks for
    std::vector<double> initial_state;                            // STATEV(1), ... at the beginning
    std::array<double, 6> initial_stress = {};                    // 11, 22, 33, 12, 13, 23
    std::string watch;  // the state whose largest value is followed; empty: EQPS, or the first one
};

// Of the whole bar, of which an eighth is modelled. It is pulled along its length (axis 2), the notches face along the
// width (axis 1).
struct Geometry {
    double width = 20, length = 50, thickness = 10;
    double notch_radius = 5;    // 0: no notch
    bool plane_strain = false;  // no displacement along the thickness
    int divisions = 4;          // elements in 45 degrees of the notch (no notch: across half the width)
    int layers = 3;             // elements across half the thickness
    int refine = 2;             // each element is divided into eight, so many times
    int refine_notch = 0;       // and those at the notch so many times more
};

struct Loading {
    double elongation = 0.1;  // of the whole bar
    double time = 1;          // in which it is reached
    double first = 0.05;      // increments, as parts of the whole
    double largest = 0.05;
    double smallest = 1e-5;
    std::vector<double> increments;  // exactly these, if there are any
};

struct Solver {
    double tolerance = 1e-10;     // residual forces relative to the force on the bar
    int maximum_iterations = 12;  // Newton
    std::string linear = "auto";  // cg, gmres; auto: gmres where tangents are not symmetric
};

struct Settings {
    Material material;
    Geometry geometry;
    Loading loading;
    Solver solver;
    std::string output = "mpi_bar";
    int write_every = 0;  // PVTU files: 0 at the end only, n after every n-th increment
};

// Bad command line or card; the text says where and what. An empty text: nothing is wrong, help was asked for.
struct BadSettings : std::runtime_error {
    BadSettings(const std::string& text, int status) : std::runtime_error(text), exit_status(status) {}
    int exit_status;
};

Settings read_settings(int count, char** words);

// The material in the library that is linked: what is to be known before the first call of umat_.
struct MaterialFacts {
    int state_variables = 0;
    int watched = 0;                       // STATEV index from 0; -1 if there is no state
    std::vector<std::string> state_names;  // one for each state variable
};
// Throws BadSettings with the library's own words if it refuses the constants.
MaterialFacts examine(const Material& material);

}  // namespace bar
