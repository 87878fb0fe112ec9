// One material point that is led by hand, increment by increment.
#ifndef LODE_HOST_STUDY_MATERIAL_POINT_HPP
#define LODE_HOST_STUDY_MATERIAL_POINT_HPP

#include <memory>

#include "../library.hpp"
#include "../replay/material.hpp"
#include "../replay/solver.hpp"

namespace lode::host {

class MaterialPoint {
  public:
    // Kind, interface and material of the scenario count, its steps do not. Throws Refused and NotLoaded.
    MaterialPoint(const Scenario& scenario, const Library& library);

    const Layout& layout() const { return layout_; }
    const PointState& state() const { return state_; }

    // What the material answers to a strain increment, engineering shears, in a time increment. The point stays where
    // it is. Throws Refused if the library ends the analysis.
    Response respond(const Components& dstrain, double dtime = 1);
    // The same, and the point goes there. False, with the point where it was, if the material asks for less or answers
    // with something that is not a number.
    bool advance(const Components& dstrain, double dtime = 1);
    // As many equal increments as are asked for; false if one of them fails.
    bool advance_in(int increments, const Components& dstrain, double dtime = 1);

    // The tangent of a zero increment. Needs UMAT.
    Tangent tangent(double dtime = 1);
    // Mean time of a call, from so many.
    double nanoseconds(const Components& dstrain, int calls);

    void set_state(const PointState& state) { state_ = state; }
    // Answers say from now on what their solution took, where the library can.
    void observe() { material_->observe(); }

  private:
    Increment increment_for(const Components& dstrain, double dtime) const;

    Scenario scenario_;
    Layout layout_;
    std::unique_ptr<Material> material_;
    Solver solver_;
    PointState state_;
    int number_ = 1;
};

// Zero but for one component.
Components unit_strain(const Layout& layout, int component, double value = 1);
// Norm of a stress as a tensor: shears count twice. Of a traction: its length.
double stress_norm(const Layout& layout, const Components& stress);
// Of engineering strains: shears count half.
double strain_norm(const Layout& layout, const Components& strain);

// The part of `direction` that is still free of dissipation, by bisection; none up to `largest` times the direction.
std::optional<double> elastic_limit(const Scenario& scenario, const Library& library, const Components& direction,
                                    double largest);

}  // namespace lode::host

#endif
