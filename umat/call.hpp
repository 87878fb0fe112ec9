// What UMAT and VUMAT share: finding the material and the kernel of a call.
#pragma once

#include <string>

#include "errors.hpp"
#include "material_cache.hpp"

namespace lode {

struct Call {
    Material* material = nullptr;  // null: the call was refused and reported
    int kind = -1;
};

namespace call_detail {

// Null if refused and reported.
[[gnu::noinline, gnu::cold]] Material* new_material(HostProgram host, const char* cmname, const double* props,
                                                    int nprops);
[[gnu::noinline, gnu::cold]] void refuse_kind(HostProgram host, const Material& material, int ndi, int nshr, int kind);
[[gnu::noinline, gnu::cold]] void refuse_state(HostProgram host, const Material& material, int nstatv, int needed);

}  // namespace call_detail

// Finds the material and checks kind and NSTATV; reports what is wrong. `kind` is -1 for a layout that does not exist.
[[gnu::always_inline]] inline Call prepare_call(HostProgram host, const char* cmname, const double* props, int nprops,
                                                int ndi, int nshr, int nstatv) {
    Material* material = known_material(cmname, props, nprops);
    if (material == nullptr) [[unlikely]] {
        material = call_detail::new_material(host, cmname, props, nprops);
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
    if (kind < 0 || material->umat[static_cast<std::size_t>(kind)] == nullptr) [[unlikely]] {
        call_detail::refuse_kind(host, *material, ndi, nshr, kind);
        return {};
    }
    const int needed = material->required_state[static_cast<std::size_t>(kind)];
    if (nstatv < needed) [[unlikely]] {
        call_detail::refuse_state(host, *material, nstatv, needed);
        return {};
    }
    return {material, kind};
}

// A failure in words: "<what> = <value> must be <allowed> <limit>", or the reason alone.
std::string failure_text(const Material& material, const CallStatus& status);

// Once per material.
void warn_once(HostProgram host, Material& material, const char* warning);

}  // namespace lode
