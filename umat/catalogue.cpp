// The C API (lode.h).
#include <cstdio>
#include <exception>

#include "dispatch.hpp"
#include "lode/lode.h"
#include "material_cache.hpp"
#include "record/recorder.hpp"

extern "C" {

int lode_model_count(void) { return lode::kernels().count; }

const lode_model* lode_model_at(int index) {
    const lode::KernelTable& table = lode::kernels();
    return index >= 0 && index < table.count ? table.entries[index]->description : nullptr;
}

int lode_required_state(const char* name, const double* constants, int constant_count, int ndi, int nshr, char* error,
                        int error_size) {
    const auto refuse = [&](const char* message) {
        if (error != nullptr && error_size > 0)
            std::snprintf(error, static_cast<std::size_t>(error_size), "%s", message);
        return -1;
    };
    try {
        const lode::Material material(name, constants, constant_count);
        const int kind = lode::kind_from_layout(ndi, nshr);
        if (kind < 0 || material.entry->umat[kind] == nullptr)
            return refuse((material.name + ": this kind is not served").c_str());
        return material.required_state[static_cast<std::size_t>(kind)];
    } catch (const std::exception& problem) {
        return refuse(problem.what());
    }
}

const char* lode_version(void) { return LODE_VERSION; }
const char* lode_instruction_set(void) { return lode::kernels().instruction_set; }

}  // extern "C"

lode::record::Recorded lode::record::recorded_library() { return {"Lode", LODE_VERSION, kernels().instruction_set}; }
