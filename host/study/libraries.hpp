// The library that is studied, and its twin for single-precision hosts where there is one.
#ifndef LODE_HOST_STUDY_LIBRARIES_HPP
#define LODE_HOST_STUDY_LIBRARIES_HPP

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../library.hpp"

namespace lode::host {

class Libraries {
  public:
    // `request` as for Library. The twin is liblode-sp.so beside a liblode.so, unless it is named.
    explicit Libraries(const std::string& request = {}, const std::string& single = {});

    const Library& main() const { return main_; }
    // Null if there is none.
    const Library* single() const { return single_ ? &*single_ : nullptr; }

  private:
    Library main_;
    std::optional<Library> single_;
};

// "ISO_PLASTIC" or "ISO_PLASTIC-STEEL": the samples meant, with their models. Throws Failure (usage) with what there
// is.
std::vector<std::pair<const lode_model*, const lode_sample*>> samples_named(const Library& library,
                                                                            const std::string& name);
std::vector<std::pair<const lode_model*, const lode_sample*>> all_samples(const Library& library);

}  // namespace lode::host

#endif
