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

}  // namespace

Call prepare_call(HostProgram host, const char* cmname, const double* props, int nprops, int ndi, int nshr,
                  int nstatv) {
    Call call;
    try {
        bool is_new = false;
        Material& material = find_material(cmname, props, nprops, is_new);
        if (is_new && !material.warnings.empty()) [[unlikely]]
            report_warning(host, material.name + ": " + material.warnings);
        int kind = kind_from_layout(ndi, nshr);
        if (host == HostProgram::explicit_ && kind == static_cast<int>(AnalysisKind::plane_strain) &&
            material.labelled_plane_stress)
            kind = static_cast<int>(AnalysisKind::plane_stress);
        if (kind < 0 || material.entry->umat[kind] == nullptr) [[unlikely]] {
            refuse_kind(host, material, ndi, nshr, kind);
            return call;
        }
        if (nstatv < material.required_state[static_cast<std::size_t>(kind)]) [[unlikely]] {
            refuse_state(host, material, nstatv, material.required_state[static_cast<std::size_t>(kind)]);
            return call;
        }
        call.material = &material;
        call.kind = kind;
    } catch (const std::exception& problem) {
        report_error_and_stop(host, problem.what());
    }
    return call;
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
