// Validated materials, made once and found again at every call. Reading takes no lock; entries live as long as the
// library, in a table of bounded size.
#pragma once

#include <array>
#include <atomic>
#include <string>
#include <string_view>
#include <vector>

#include "lode/material/model_entry.hpp"

namespace lode {

// CMNAME taken apart (conventions page): up to 80 characters, blank padded or NUL terminated; what follows the last '@'
// counts if it begins with one; case is folded.
struct MaterialName {
    std::string full, keyword, label;
};
MaterialName parse_material_name(const char* cmname);

class Material {
  public:
    Material(const char* cmname, const double* props, int nprops);  // throws BadProperty
    ~Material();
    Material(const Material&) = delete;
    Material& operator=(const Material&) = delete;

    bool matches(const char* cmname, const double* props, int nprops) const;

    const ModelEntry* entry = nullptr;
    const void* object = nullptr;
    std::array<int, kind_count> required_state{};  // 0 for kinds that are not served
    std::string name;                              // as messages show it
    bool labelled_plane_stress = false;            // label PS or PS-*
    std::string warnings;                          // from the constructor of the model
    std::atomic<bool> has_warned{false};

    std::size_t hash = 0;
    const Material* next = nullptr;

  private:
    std::array<char, 81> cmname_{};
    std::vector<double> props_;
};

// The material of this call. Made and validated when it is new: then `is_new` is set and warnings may be due. Throws
// BadProperty.
Material& find_material(const char* cmname, const double* props, int nprops, bool& is_new);

}  // namespace lode
