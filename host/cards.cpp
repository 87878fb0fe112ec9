#include "cards.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "status.hpp"

namespace lode::host {
namespace {

constexpr int values_per_line = 8;
constexpr int calculix_constants = 21;  // what CalculiX 2.20 has room for
constexpr int cohesive_kinds = LODE_COHESIVE_2D | LODE_COHESIVE_3D;

unsigned sample_kinds(const lode_model& model, const lode_sample& sample) {
    const unsigned kinds = model.kinds & sample.kinds;
    return kinds != 0 ? kinds : model.kinds;
}

std::vector<double> constants_of(const lode_sample& sample) {
    return {sample.constants, sample.constants + sample.constant_count};
}

int state_count(const lode_model& model, const lode_sample& sample, const Library& library, Kind kind) {
    const auto [ndi, nshr] = layout_of(kind);
    try {
        return library.required_state(material_name(model, sample), constants_of(sample), ndi, nshr)
            .value_or(model.state_count);
    } catch (const Refused&) {
        return model.state_count;
    }
}

std::string data_lines(const std::vector<double>& values) {
    std::string text;
    for (std::size_t i = 0; i < values.size(); ++i) {
        text += fmt::format("{}", values[i]);
        const bool last = i + 1 == values.size();
        text += last || (i + 1) % values_per_line == 0 ? "\n" : ", ";
    }
    return text;
}

std::string depvar(int count) { return count > 0 ? fmt::format("*DEPVAR\n{}\n", count) : ""; }

}  // namespace

std::vector<Kind> kinds_of(unsigned mask) {
    constexpr std::array<std::pair<unsigned, Kind>, 6> bits{{{LODE_SOLID, Kind::solid},
                                                             {LODE_PLANE_STRAIN, Kind::plane_strain},
                                                             {LODE_PLANE_STRESS, Kind::plane_stress},
                                                             {LODE_UNIAXIAL, Kind::uniaxial},
                                                             {LODE_COHESIVE_2D, Kind::cohesive_2d},
                                                             {LODE_COHESIVE_3D, Kind::cohesive_3d}}};
    std::vector<Kind> kinds;
    for (const auto& [bit, kind] : bits)
        if ((mask & bit) != 0) kinds.push_back(kind);
    return kinds;
}

std::pair<int, int> layout_of(Kind kind) {
    const Layout layout(kind);
    return {layout.ndi(), layout.nshr()};
}

std::string material_name(const lode_model& model, const lode_sample& sample) {
    return fmt::format("{}-{}", model.keyword, sample.label);
}

std::string material_cards(const std::string& name, const std::vector<double>& constants, int state_variables,
                           bool unsymmetric) {
    return fmt::format("*MATERIAL, NAME={}\n*USER MATERIAL, CONSTANTS={}{}\n", name, constants.size(),
                       unsymmetric ? ", UNSYMM" : "") +
           data_lines(constants) + depvar(state_variables);
}

std::string abaqus_cards(const lode_model& model, const lode_sample& sample, const Library& library) {
    int count = 0;
    for (const Kind kind : kinds_of(sample_kinds(model, sample)))
        count = std::max(count, state_count(model, sample, library, kind));
    return material_cards(material_name(model, sample), constants_of(sample), count,
                          (model.traits & LODE_UNSYMMETRIC) != 0);
}

std::string calculix_cards(const lode_model& model, const lode_sample& sample, const Library& library) {
    if ((sample_kinds(model, sample) & LODE_SOLID) == 0) return {};
    const bool finite = (model.traits & LODE_FINITE_STRAIN) != 0;
    // CalculiX: the symmetric card only, and after a multiple of eight constants a line for the temperature.
    std::string text =
        fmt::format("*MATERIAL, NAME={}{}\n*USER MATERIAL, CONSTANTS={}\n", finite ? "ABAQUSNL" : "ABAQUS",
                    material_name(model, sample), sample.constant_count) +
        data_lines(constants_of(sample));
    if (sample.constant_count % values_per_line == 0) text += "0\n";
    text += depvar(state_count(model, sample, library, Kind::solid));
    if (!finite) text += "** with NLGEOM: NAME=ABAQUSNL" + material_name(model, sample) + "\n";
    if (sample.constant_count > calculix_constants)
        text += fmt::format("** CalculiX 2.20 has room for {} constants only: enlarge elconloc there\n",
                            calculix_constants);
    return text;
}

std::string replay_deck(const lode_model& model, const lode_sample& sample) {
    const auto kinds = kinds_of(sample_kinds(model, sample));
    const Kind kind = kinds.empty() ? Kind::solid : kinds.front();
    std::string constants;
    for (const double value : constants_of(sample))
        constants += fmt::format("{}{}", constants.empty() ? "" : ", ", value);
    const bool cohesive = (model.kinds & ~static_cast<unsigned>(cohesive_kinds)) == 0;
    return fmt::format(
        "title = \"{}\"\n[material]\nname = \"{}\"\nconstants = [{}]\n[analysis]\nkind = \"{}\"\n[[step]]\n{} = {{ {} "
        "= "
        "{} }}\nincrements = 100\n",
        model.title, material_name(model, sample), constants, name_of(kind), cohesive ? "separation" : "strain",
        cohesive ? "n" : "11", sample.strain_scale);
}

}  // namespace lode::host
