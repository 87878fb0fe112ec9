#include "call.hpp"

#include <exception>

namespace lode {
namespace {

[[gnu::noinline, gnu::cold]] void refuse_kind(HostProgram host, const Material& material, int ndi, int nshr, int kind) {
    std::string message = material.name + ": " + material.entry->description->keyword + " does not serve kind ";
    message += kind >= 0 ? kind_name(static_cast<AnalysisKind>(kind))
                         : "(" + std::to_string(ndi) + "," + std::to_string(nshr) + ")";
    message += "; it serves";
    for (int k = 0; k < kind_count; ++k)
        if (material.entry->umat[k] != nullptr) message += std::string(" ") + kind_name(static_cast<AnalysisKind>(k));
    report_error_and_stop(host, message);
}

[[gnu::noinline, gnu::cold]] void refuse_state(HostProgram host, const Material& material, int nstatv, int needed) {
    report_error_and_stop(host, material.name + ": NSTATV = " + std::to_string(nstatv) + ", " +
                                    material.entry->description->keyword + " with these options needs " +
                                    std::to_string(needed) + " (*DEPVAR)");
}

// Null if refused and reported.
[[gnu::noinline, gnu::cold]] Material* new_material(HostProgram host, const char* cmname, const double* props,
                                                    int nprops) try {
    bool is_new = false;
    Material& material = make_material(cmname, props, nprops, is_new);
    if (is_new && !material.warnings.empty()) report_warning(host, material.name + ": " + material.warnings);
    return &material;
} catch (const std::exception& problem) {
    report_error_and_stop(host, problem.what());
    return nullptr;
}

}  // namespace

Call prepare_call(HostProgram host, const char* cmname, const double* props, int nprops, int ndi, int nshr,
                  int nstatv) {
    Material* material = known_material(cmname, props, nprops);
    if (material == nullptr) [[unlikely]] {
        material = new_material(host, cmname, props, nprops);
        if (material == nullptr) return {};
    }
    constexpr int plane_strain = static_cast<int>(AnalysisKind::plane_strain);
    constexpr int plane_stress = static_cast<int>(AnalysisKind::plane_stress);
    int kind = kind_from_layout(ndi, nshr);
    if (host == HostProgram::explicit_) {
        // An explicit host passes plane stress with component 33: the label tells it from plane strain.
        if (kind == plane_stress) kind = -1;
        if (kind == plane_strain && material->labelled_plane_stress) kind = plane_stress;
    }
    if (kind < 0 || material->entry->umat[kind] == nullptr) [[unlikely]] {
        refuse_kind(host, *material, ndi, nshr, kind);
        return {};
    }
    const int needed = material->required_state[static_cast<std::size_t>(kind)];
    if (nstatv < needed) [[unlikely]] {
        refuse_state(host, *material, nstatv, needed);
        return {};
    }
    return {material, kind};
}

std::string failure_text(const Material& material, const CallStatus& status) {
    std::string text = material.name + ": " + status.failure;
    if (status.refusal != nullptr) {
        text += " = " + format_number(status.refused_value) + " must be " + status.refusal;
        if (status.refused_limit != 0.0) text += " " + format_number(status.refused_limit);
    }
    return text;
}

void warn_once(HostProgram host, Material& material, const char* warning) {
    if (!material.has_warned.exchange(true)) report_warning(host, material.name + ": " + warning);
}

}  // namespace lode
