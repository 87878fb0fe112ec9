// A loaded material library: umat_, vumat_ and, if it has them, the lode_* functions of its catalogue.
#ifndef LODE_HOST_LIBRARY_HPP
#define LODE_HOST_LIBRARY_HPP

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "lode/entry_points.h"
#include "lode/lode.h"

namespace lode::host {

inline constexpr std::size_t material_name_length = LODE_CMNAME_LENGTH;

using UmatFunction = lode_umat_function*;
// Real: double, or float in a library for single-precision hosts.
template <class Real>
using VumatOf = std::conditional_t<std::is_same_v<Real, float>, lode_vumat_sp_function, lode_vumat_function>*;
using VumatFunction = VumatOf<double>;

// The name in 80 characters, blank padded, upper case as Abaqus has it.
std::string padded_material_name(const std::string& name);

// What calls have cost, without the time of the measurement itself.
struct CallCount {
    std::int64_t calls = 0;
    std::int64_t points = 0;  // calls times points in a block
    double nanoseconds = 0;   // of all calls but the first, which may read in the material
    double first_nanoseconds = 0;
};

class Library {
  public:
    // `request` as on the command line: a path, a file name for the loader, or empty for the default library
    // (LODE_LIBRARY, else the liblode.so that belongs to this program). Throws NotLoaded.
    explicit Library(const std::string& request = {});

    const std::string& path() const { return path_; }
    UmatFunction umat() const { return umat_; }
    VumatFunction vumat() const { return vumat_; }
    // umat() that says what the solution took, or null: a library of others cannot say.
    lode_umat_observed_function* observed_umat() const { return observed_umat_; }
    bool has_catalogue() const { return model_count_ != nullptr && model_at_ != nullptr; }
    std::vector<const lode_model*> models() const;
    // The model that a material name such as "ISO_PLASTIC-STEEL" selects, or null.
    const lode_model* model_of(const std::string& material_name) const;
    // Entries of STATEV, none if the library cannot say. Throws Refused with the library's own message.
    std::optional<int> required_state(const std::string& name, const std::vector<double>& constants, int ndi,
                                      int nshr) const;
    std::string version() const { return version_ != nullptr ? version_() : ""; }
    std::string instruction_set() const { return instruction_set_ != nullptr ? instruction_set_() : ""; }

  private:
    std::shared_ptr<void> handle_;
    std::string path_;
    UmatFunction umat_ = nullptr;
    VumatFunction vumat_ = nullptr;
    lode_umat_observed_function* observed_umat_ = nullptr;
    decltype(&lode_model_count) model_count_ = nullptr;
    decltype(&lode_model_at) model_at_ = nullptr;
    decltype(&lode_required_state) required_state_ = nullptr;
    decltype(&lode_version) version_ = nullptr;
    decltype(&lode_instruction_set) instruction_set_ = nullptr;
};

}  // namespace lode::host

#endif
