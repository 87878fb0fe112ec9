#include "library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>

#include <array>
#include <cstdlib>
#include <filesystem>

#include "guard.hpp"
#include "status.hpp"
#include "text.hpp"

namespace lode::host {
namespace {

constexpr const char* default_library = "liblode.so";

template <class Function>
void resolve(void* handle, const char* symbol, Function& function) {
    function = reinterpret_cast<Function>(dlsym(handle, symbol));
}

// The library that belongs to this program, in the build tree or the installation; else whatever the loader finds. The
// program's run path alone would not do: sanitizers call dlopen from a library of theirs, which has another one.
std::string own_library() {
    std::error_code ignored;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
    for (const char* place : {"../umat", "../" LODE_LIBRARY_DIRECTORY}) {
        const std::filesystem::path candidate = program.parent_path() / place / default_library;
        if (std::filesystem::exists(candidate, ignored)) return candidate.lexically_normal().string();
    }
    return default_library;
}

// The name of an existing file is taken as that file, any other goes to the loader.
std::string what_to_open(const std::string& request) {
    std::string name = request;
    if (name.empty())
        if (const char* variable = std::getenv("LODE_LIBRARY")) name = variable;
    if (name.empty()) return own_library();
    std::error_code ignored;
    if (std::filesystem::exists(name, ignored)) return std::filesystem::absolute(name).string();
    return name;
}

}  // namespace

std::string padded_material_name(const std::string& name) {
    std::string padded = upper(name);
    padded.resize(material_name_length, ' ');
    return padded;
}

Library::Library(const std::string& request) {
    const std::string name = what_to_open(request);
    // All symbols now: a routine that this host does not provide is named here and not in the middle of a run.
    void* const handle = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) {
        const char* const reason = dlerror();
        throw NotLoaded(
            fmt::format("cannot load the library {}: {}\n(--library, the deck's material.library or the "
                        "environment variable LODE_LIBRARY name another one)",
                        name, reason != nullptr ? reason : "unknown reason"));
    }
    handle_ = {handle, [](void* h) { dlclose(h); }};
    link_map* map = nullptr;
    path_ = dlinfo(handle, RTLD_DI_LINKMAP, &map) == 0 && map != nullptr ? map->l_name : name;

    resolve(handle, "umat_", umat_);
    resolve(handle, "vumat_", vumat_);
    resolve(handle, "lode_umat_observed", observed_umat_);
    resolve(handle, "lode_model_count", model_count_);
    resolve(handle, "lode_model_at", model_at_);
    resolve(handle, "lode_required_state", required_state_);
    resolve(handle, "lode_version", version_);
    resolve(handle, "lode_instruction_set", instruction_set_);
    if (umat_ == nullptr && vumat_ == nullptr && !has_catalogue())
        throw NotLoaded(
            fmt::format("{} has neither umat_ nor vumat_: a Fortran compiler makes these symbols of "
                        "SUBROUTINE UMAT and SUBROUTINE VUMAT",
                        path_));
}

std::vector<const lode_model*> Library::models() const {
    std::vector<const lode_model*> models;
    if (!has_catalogue()) return models;
    for (int i = 0; i < model_count_(); ++i)
        if (const lode_model* model = model_at_(i)) models.push_back(model);
    return models;
}

const lode_model* Library::model_of(const std::string& material_name) const {
    std::string keyword = upper(material_name);
    if (keyword.starts_with('@')) keyword.erase(0, keyword.rfind('@') + 1);
    keyword = keyword.substr(0, keyword.find('-'));
    for (const lode_model* model : models())
        if (keyword == model->keyword) return model;
    return nullptr;
}

std::optional<int> Library::required_state(const std::string& name, const std::vector<double>& constants, int ndi,
                                           int nshr) const {
    if (required_state_ == nullptr) return std::nullopt;
    std::array<char, 1024> error{};
    int count = -1;
    const bool returned = guarded([&] {
        count = required_state_(name.c_str(), constants.data(), static_cast<int>(constants.size()), ndi, nshr,
                                error.data(), static_cast<int>(error.size()));
    });
    if (!returned) throw Refused(last_library_error());
    if (count < 0) throw Refused(error.data());
    return count;
}

}  // namespace lode::host
