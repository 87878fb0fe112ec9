#include "ccx.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace ccx {
namespace {

constexpr int cells_per_line = 8;

std::string lines_of(const std::vector<int>& numbers) {
    std::string text;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        text += std::to_string(numbers[i]);
        text += i + 1 == numbers.size() || (i + 1) % cells_per_line == 0 ? "\n" : ", ";
    }
    return text;
}

std::string quoted(const fs::path& path) { return "'" + path.string() + "'"; }

int exit_status(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128; }

bool read_numbers(const std::string& line, Numbers& numbers) {
    numbers.clear();
    std::istringstream text(line);
    std::string word;
    while (text >> word) {
        char* end = nullptr;
        const double value = std::strtod(word.c_str(), &end);
        if (*end != '\0') return false;
        numbers.push_back(value);
    }
    return !numbers.empty();
}

std::string trimmed(std::string text) {
    text.erase(0, text.find_first_not_of(' '));
    text.erase(text.find_last_not_of(' ') + 1);
    return text;
}

void read_dat(const fs::path& file, Results& results) {
    std::ifstream in(file);
    std::string line;
    Table* table = nullptr;
    Numbers row;
    while (std::getline(in, line)) {
        if (const auto set = line.find("for set "), time = line.find(" and time "); time != std::string::npos) {
            const std::string quantity = trimmed(line.substr(0, line.find(" (")));
            const std::string name = trimmed(line.substr(set + 8, time - set - 8));
            auto& tables = results.tables[quantity + "/" + name];
            tables.push_back({std::strtod(line.c_str() + time + 10, nullptr), {}});
            table = &tables.back();
        } else if (table != nullptr && read_numbers(line, row)) table->rows.push_back(row);
    }
}

// Step, increment, attempt, iterations of that attempt, times.
void read_sta(const fs::path& file, Results& results) {
    std::ifstream in(file);
    std::string line;
    Numbers row;
    while (std::getline(in, line)) {
        if (!read_numbers(line, row) || row.size() < 7) continue;
        ++results.increments;
        results.cuts += static_cast<int>(row[2]) - 1;
        results.iterations += static_cast<int>(row[3]);
        results.time = row[4];
    }
}

}  // namespace

std::string number(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.15g", value);
    // CalculiX reads at most 20 characters.
    for (int digits = 14; std::char_traits<char>::length(text) > 20; --digits)
        std::snprintf(text, sizeof text, "%.*g", digits, value);
    return text;
}

Material native_material(const std::string& name, const std::string& card) {
    return {name, "*MATERIAL, NAME=" + name + "\n" + card};
}

Material user_material(const UserMaterial& material, const std::string& prefix) {
    std::string card = "*USER MATERIAL, CONSTANTS=" + std::to_string(material.constants.size()) + "\n";
    for (std::size_t i = 0; i < material.constants.size(); ++i)
        card += number(material.constants[i]) +
                (i + 1 == material.constants.size() || (i + 1) % cells_per_line == 0 ? "\n" : ", ");
    if (material.constants.size() % cells_per_line == 0) card += "0\n";  // the temperature, which ends the list
    card += "*DEPVAR\n" + std::to_string(material.depvar) + "\n";
    return native_material(prefix + material.name, card);
}

std::string mesh_cards(const Mesh& mesh) {
    std::string text = "*NODE, NSET=NALL\n";
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
        text += std::to_string(n + 1);
        for (const double x : mesh.nodes[n]) text += ", " + number(x);
        text += "\n";
    }
    text += "*ELEMENT, TYPE=" + mesh.type + ", ELSET=EALL\n";
    for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
        std::vector<int> line{static_cast<int>(e) + 1};
        line.insert(line.end(), mesh.elements[e].begin(), mesh.elements[e].end());
        std::string numbers = lines_of(line);
        // A line that goes on ends in a comma.
        for (std::size_t at = 0; (at = numbers.find('\n', at)) + 1 < numbers.size(); at += 2) numbers.insert(at, ",");
        text += numbers;
    }
    return text;
}

std::string node_set(const std::string& name, const std::vector<int>& nodes) {
    return "*NSET, NSET=" + name + "\n" + lines_of(nodes);
}

std::string element_set(const std::string& name, const std::vector<int>& elements) {
    return "*ELSET, ELSET=" + name + "\n" + lines_of(elements);
}

std::string section(const std::string& elements, const Material& material) {
    return material.card + "*SOLID SECTION, ELSET=" + elements + ", MATERIAL=" + material.name + "\n";
}

std::string step(const StepOptions& o, const std::string& contents) {
    return std::string("*STEP, INC=10000") + (o.nonlinear_geometry ? ", NLGEOM" : "") + "\n*STATIC\n" +
           number(o.first) + ", " + number(o.duration) + ", " + number(o.smallest) + ", " + number(o.largest) +
           "\n*CONTROLS, PARAMETERS=FIELD\n" + number(o.tolerance) + ", " + number(o.tolerance) +
           // The defaults, but for the last: a residual that is small enough whatever the correction.
           ", 0, 0, 0.02, 1e-5, 1e-3, " + number(std::min(1e-8, o.tolerance)) + "\n" + contents + "*END STEP\n";
}

const std::vector<Table>& Results::history(const std::string& name) const {
    const auto found = tables.find(name);
    if (found == tables.end()) throw std::runtime_error("CalculiX printed no " + name);
    return found->second;
}

double deviation(const std::vector<Numbers>& result, const std::vector<Numbers>& reference, std::size_t keys) {
    if (result.size() != reference.size()) throw std::runtime_error("tables of different length");
    double difference = 0.0, size = 0.0;
    for (std::size_t i = 0; i < reference.size(); ++i)
        for (std::size_t k = keys; k < reference[i].size(); ++k) {
            difference = worse(difference, std::abs(result[i].at(k) - reference[i][k]));
            size = std::max(size, std::abs(reference[i][k]));
        }
    return difference / size;
}

void write_text(const fs::path& file, const std::string& text) {
    std::ofstream out(file);
    out << text;
    if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

std::string read_text(const fs::path& file) {
    std::ifstream in(file);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

Host::Host(fs::path ccx, fs::path library, fs::path lode, fs::path output)
    : ccx_(fs::absolute(ccx)),
      library_(fs::canonical(library)),
      lode_(fs::absolute(lode)),
      output_(fs::absolute(output)) {}

Results Host::run(const std::string& name, const std::string& deck, const RunOptions& options) const {
    write_text(output_ / (name + ".inp"), deck);
    for (const char* extension : {".dat", ".sta", ".log"}) fs::remove(output_ / (name + extension));
    const std::string command =
        "cd " + quoted(output_) + " && env CCX_NPROC_EQUATION_SOLVER=1 OMP_WAIT_POLICY=passive OMP_NUM_THREADS=" +
        std::to_string(options.threads) + " CCX_NPROC_RESULTS=" + std::to_string(options.threads) +
        " LD_LIBRARY_PATH=" + quoted(output_) + " " + options.environment + " " +
        quoted(options.at_run_time ? ccx_ / "ccx" : output_ / "ccx") + " -i " + name + " >" + name + ".log 2>&1";
    Results results;
    results.status = exit_status(std::system(command.c_str()));
    results.log = read_text(output_ / (name + ".log"));
    if (results.status != 0 && !options.may_fail)
        throw std::runtime_error("CalculiX failed, see " + (output_ / (name + ".log")).string());
    read_dat(output_ / (name + ".dat"), results);
    read_sta(output_ / (name + ".sta"), results);
    return results;
}

int Host::lode(const std::string& name, const std::string& arguments) const {
    const std::string command = "cd " + quoted(output_) + " && " + quoted(lode_) + " " + arguments + " --library " +
                                quoted(library_) + " >" + name + ".log 2>&1";
    return exit_status(std::system(command.c_str()));
}

}  // namespace ccx
