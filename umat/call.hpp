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

// Finds the material and checks kind and NSTATV; reports what is wrong. `kind` is -1 for a layout that does not exist.
Call prepare_call(HostProgram host, const char* cmname, const double* props, int nprops, int ndi, int nshr, int nstatv);

// A failure in words: "<what> = <value> must be <allowed> <limit>", or the reason alone.
std::string failure_text(const Material& material, const CallStatus& status);

// Once per material.
void warn_once(HostProgram host, Material& material, const char* warning);

}  // namespace lode
