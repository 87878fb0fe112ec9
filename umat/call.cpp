#include "call.hpp"

#include <exception>

namespace lode {
namespace call_detail {

void refuse_kind(HostProgram host, const Material& material, int ndi, int nshr, int kind) {
    std::string message = material.name + ": " + material.entry->description->keyword + " does not serve kind ";
    message += kind >= 0 ? kind_name(static_cast<AnalysisKind>(kind))
                         : "(" + std::to_string(ndi) + "," + std::to_string(nshr) + ")";
    message += "; it serves";
    for (int k = 0; k < kind_count; ++k)
        if (material.entry->umat[k] != nullptr) message += std::string(" ") + kind_name(static_cast<AnalysisKind>(k));
    report_error_and_stop(host, message);
}

void refuse_state(HostProgram host, const Material& material, int nstatv, int needed) {
    report_error_and_stop(host, material.name + ": NSTATV = " + std::to_string(nstatv) + ", " +
                                    material.entry->description->keyword + " with these options needs " +
                                    std::to_string(needed) + " (*DEPVAR)");
}

Material* new_material(HostProgram host, const char* cmname, const double* props, int nprops) try {
    bool is_new = false;
    Material& material = make_material(cmname, props, nprops, is_new);
    if (is_new && !material.warnings.empty()) report_warning(host, material.name + ": " + material.warnings);
    return &material;
} catch (const std::exception& problem) {
    report_error_and_stop(host, problem.what());
    return nullptr;
}

}  // namespace call_detail

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
