// CalculiX from outside: texts of input decks, runs, and what the result files say.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "mesh.hpp"

namespace ccx {

namespace fs = std::filesystem;
using Numbers = std::vector<double>;

// A material of the library: the text before the first '-' of the name is the model.
struct UserMaterial {
    std::string name;
    Numbers constants;
    int depvar;
};

// Route A: linked, small strain or finite strain. Route B: found at run time.
inline constexpr const char *small_strain = "ABAQUS", *finite_strain = "ABAQUSNL", *at_run_time = "@ABAQUS_LODE_UMAT@";

// What a deck says of one material: its card, and the name that sections use.
struct Material {
    std::string name, card;
};
Material user_material(const UserMaterial& material, const std::string& prefix = small_strain);
Material native_material(const std::string& name, const std::string& card);

std::string number(double value);
std::string mesh_cards(const Mesh& mesh);  // *NODE, *ELEMENT; sets NALL and EALL
std::string node_set(const std::string& name, const std::vector<int>& nodes);
std::string element_set(const std::string& name, const std::vector<int>& elements);
std::string section(const std::string& elements, const Material& material);  // with the card of the material

struct StepOptions {
    double first = 1.0, duration = 1.0, smallest = 1e-5, largest = 1.0;
    bool nonlinear_geometry = false;
    double tolerance = 1e-8;  // of forces and corrections
};
std::string step(const StepOptions& options, const std::string& contents);

// One row of a table of the .dat file: element and point, or node, are among the numbers.
struct Table {
    double time;
    std::vector<Numbers> rows;
};

struct Results {
    int status = 0;
    std::string log;
    int increments = 0, iterations = 0, cuts = 0;
    double time = 0.0;
    // By quantity and set: "displacements/NALL", "forces/...", "total force/...", "stresses/...",
    // "internal state variables/...".
    std::map<std::string, std::vector<Table>> tables;

    const std::vector<Table>& history(const std::string& name) const;
    const std::vector<Numbers>& last(const std::string& name) const { return history(name).back().rows; }
};

// Largest difference of two tables relative to the largest number of the reference; the first `keys` columns are
// numbers of elements, points and nodes.
double deviation(const std::vector<Numbers>& result, const std::vector<Numbers>& reference, std::size_t keys);

struct RunOptions {
    int threads = 1;
    std::string environment = "";  // NAME=value ... in front of the command
    bool at_run_time = false;      // the program that finds the library by the name of the material
    bool may_fail = false;
};

class Host {
  public:
    Host(fs::path ccx, fs::path library, fs::path lode, fs::path output);

    // Runs a deck in the output directory; throws if CalculiX fails and may not.
    Results run(const std::string& name, const std::string& deck, const RunOptions& options = {}) const;
    // Runs `lode` with these arguments in the output directory; returns its status, with the output in NAME.log.
    int lode(const std::string& name, const std::string& arguments) const;

    const fs::path& output() const { return output_; }
    const fs::path& library() const { return library_; }

  private:
    fs::path ccx_, library_, lode_, output_;
};

// The larger one; NaN is larger than any.
inline double worse(double a, double b) { return b <= a ? a : b; }

void write_text(const fs::path& file, const std::string& text);
std::string read_text(const fs::path& file);

}  // namespace ccx
