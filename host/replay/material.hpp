// The material as the solver sees it: one call of UMAT, or of VUMAT on a block of equal points.
#ifndef LODE_HOST_REPLAY_MATERIAL_HPP
#define LODE_HOST_REPLAY_MATERIAL_HPP

#include <memory>
#include <string>

#include "../library.hpp"
#include "point.hpp"
#include "scenario.hpp"

namespace lode::host {

class Material {
  public:
    virtual ~Material() = default;
    // One call from the state at the start of the increment. Throws Refused if the library ends the analysis.
    virtual Response evaluate(const PointState& start, const Increment& increment) = 0;
    virtual bool has_tangent() const = 0;
    // Called once, before the first increment.
    virtual void probe(const PointState&, const Increment&) {}

    // For measurements: every call is made so many times and counted as one that took the mean time; only the answer
    // of the last one counts. 1 after construction.
    void repeat_calls(int times) { repeats_ = times; }

    // From now on every answer says what its solution took, where the library can. Only UMAT has that.
    virtual void observe() {}

    const CallCount& calls() const { return calls_; }
    // Things worth saying that are no error, e.g. that points of a block disagree.
    const std::vector<std::string>& remarks() const { return remarks_; }

  protected:
    CallCount calls_;
    int repeats_ = 1;
    std::vector<std::string> remarks_;
};

// `scenario` has its STATEV count resolved. Throws NotLoaded if the library lacks the entry point.
std::unique_ptr<Material> make_material(const Scenario& scenario, const Library& library);
std::unique_ptr<Material> make_umat(const Scenario& scenario, const Library& library);
std::unique_ptr<Material> make_vumat(const Scenario& scenario, const Library& library);

}  // namespace lode::host

#endif
