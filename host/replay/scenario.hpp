// What is to be replayed, as plain data: one material point, its material and the steps it goes through.
// A deck becomes a Scenario; other callers fill one in directly.
#ifndef LODE_HOST_REPLAY_SCENARIO_HPP
#define LODE_HOST_REPLAY_SCENARIO_HPP

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "../verify/solution.hpp"
#include "analysis.hpp"

namespace lode::host {

// A word of the deck that can only be judged later; the location goes into the message.
struct Located {
    std::string text;
    std::string location;  // "deck.toml:12: output.columns"
};

struct MaterialSpec {
    std::string name;  // CMNAME, upper case
    std::vector<double> constants;
    std::optional<int> state_variables;  // not given: the library is asked
    std::vector<double> initial_state;   // leading entries; the rest is zero
    std::vector<std::pair<Located, double>> initial_named_state;
    std::optional<Components> initial_stress;
    double density = 1;
    std::vector<double> expansion;  // none, one (isotropic) or three (orthotropic)
    std::string library;            // empty: the default library
    bool reads_gradient = false;    // stress follows from F, not from DSTRAN; known from the catalogue
};

enum class Control { strain, stress };

struct AnalysisSpec {
    Kind kind = Kind::solid;
    Entry entry = Entry::umat;
    Precision precision = Precision::double_;
    std::optional<bool> large_rotation;  // not given: as the material needs it
    std::string large_rotation_location;
    double element_length = 1;
    int block = 1;  // points in a VUMAT block
    double temperature = 0;
    std::vector<double> fields;
    Control unnamed = Control::stress;  // what components do that no step has named yet
    double tolerance = 1e-9;            // of the stress scale
    int maximum_iterations = 25;
};

struct FixedIncrements {
    int count = 100;
};
struct AutomaticIncrements {
    double initial = 0, minimum = 0, maximum = 0;
};

struct Prescribed {
    Control control = Control::strain;
    double value = 0;
};
struct Rotation {
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
    double angle = 0;  // radians
};
struct AmplitudePoint {
    double time = 0;   // fraction of the step's time
    double value = 0;  // fraction of the way from the values at the start of the step to its targets
};

struct Step {
    std::string name;
    double time = 1;
    std::variant<FixedIncrements, AutomaticIncrements> increments = FixedIncrements{};
    std::array<std::optional<Prescribed>, 6> components;
    std::optional<Matrix3> deformation_gradient;
    std::optional<Rotation> rotation;
    std::optional<double> temperature;
    std::optional<std::vector<double>> fields;
    std::vector<AmplitudePoint> amplitude;  // empty: a straight ramp
    bool relative = false;                  // targets are changes from the start of the step
    // A motion with a closed form. The body is undeformed and as new at the start of the step.
    std::optional<ManufacturedMotion> manufactured;
    std::shared_ptr<const ManufacturedSolution> solution;  // of the material; `resolve` finds it

    bool moves_by_gradient() const {
        return deformation_gradient || rotation || (manufactured && manufactured->drive == Drive::gradient);
    }
};

struct Plot {
    std::string name;  // file stem after that of the deck, may be empty
    Located x;
    std::vector<Located> y;
    std::string title, x_label, y_label;
};

struct OutputSpec {
    std::vector<Located> columns;  // empty: the default ones
    std::vector<Plot> plots;
    bool plot = true;
    int every = 1;
    std::string stress_unit, length_unit, time_unit;
};

struct Scenario {
    std::string title;
    std::string stem = "replay";  // of the output files
    MaterialSpec material;
    AnalysisSpec analysis;
    std::vector<Step> steps;
    OutputSpec output;
    std::vector<MaterialSpec> alternatives;  // simpler materials that `lode advise` is to try: name and constants
};

}  // namespace lode::host

#endif
