// A loaded material library: umat_, vumat_ and, if it has them, the lode_* functions of its catalogue.
#ifndef LODE_HOST_LIBRARY_HPP
#define LODE_HOST_LIBRARY_HPP

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lode/lode.h"

namespace lode::host {

using CharacterLength = std::size_t;  // of CMNAME, by value after the last argument
inline constexpr CharacterLength material_name_length = 80;

extern "C" {
using UmatFunction = void (*)(double* stress, double* statev, double* ddsdde, double* sse, double* spd, double* scd,
                              double* rpl, double* ddsddt, double* drplde, double* drpldt, const double* stran,
                              const double* dstran, const double* time, const double* dtime, const double* temp,
                              const double* dtemp, const double* predef, const double* dpred, const char* cmname,
                              const int* ndi, const int* nshr, const int* ntens, const int* nstatv, const double* props,
                              const int* nprops, const double* coords, const double* drot, double* pnewdt,
                              const double* celent, const double* dfgrd0, const double* dfgrd1, const int* noel,
                              const int* npt, const int* layer, const int* kspt, const int* jstep, const int* kinc,
                              CharacterLength);
}
// Real: double, or float in a library for single-precision hosts.
template <class Real>
using VumatOf = void (*)(const int* nblock, const int* ndir, const int* nshr, const int* nstatev, const int* nfieldv,
                         const int* nprops, const int* lanneal, const Real* step_time, const Real* total_time,
                         const Real* dt, const char* cmname, const Real* coord_mp, const Real* char_length,
                         const Real* props, const Real* density, Real* strain_inc, const Real* rel_spin_inc,
                         const Real* temp_old, const Real* stretch_old, const Real* defgrad_old, const Real* field_old,
                         const Real* stress_old, const Real* state_old, const Real* ener_intern_old,
                         const Real* ener_inelas_old, const Real* temp_new, const Real* stretch_new,
                         const Real* defgrad_new, const Real* field_new, Real* stress_new, Real* state_new,
                         Real* ener_intern_new, Real* ener_inelas_new, CharacterLength);
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
    decltype(&lode_model_count) model_count_ = nullptr;
    decltype(&lode_model_at) model_at_ = nullptr;
    decltype(&lode_required_state) required_state_ = nullptr;
    decltype(&lode_version) version_ = nullptr;
    decltype(&lode_instruction_set) instruction_set_ = nullptr;
};

}  // namespace lode::host

#endif
