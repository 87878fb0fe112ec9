// A block of material points for tests: the library under test, called as an explicit host calls it. Components are
// given and returned in UMAT order with engineering shears, so that results compare with those of a UmatPoint; the
// block turns them into VUMAT's order and tensor shears. Plane stress is asked for by the label PS, in (3,1) layout.
#pragma once

#include "umat_point.hpp"

namespace lode::test {

struct VumatPoint {
    Numbers stress, state;                    // old in, new out
    Numbers strain_increment;                 // of this increment; empty: zeros
    Matrix3d stretch = Matrix3d::Identity();  // U at the end
    double temperature_old = 0.0, temperature_new = 0.0;
    Numbers fields_old = {0.0}, fields_new = {0.0};
    double celent = 1.0, density = 1.0;
    double internal_energy = 0.0, inelastic_energy = 0.0;  // per unit mass; old in, new out
    double thickness_strain_increment = 0.0;               // out, plane stress
};

class VumatBlock {
  public:
    VumatBlock(std::string material_name, AnalysisKind kind, Numbers props);
    // Of the prototype's material, with as many state variables.
    explicit VumatBlock(const UmatPoint& prototype);

    // A point in the initial state, as UmatPoint makes it.
    VumatPoint fresh_point() const;
    std::vector<VumatPoint> points;
    double dtime = 1.0, step_time = 1.0, total_time = 1.0;  // times at the end of the increment

    // Calls VUMAT for all points. They are updated unless the call was refused; the messages come back.
    HostMessages run();
    HostMessages run_with(VumatFunctionOf<double> vumat);
    HostMessages run_with(VumatFunctionOf<float> vumat);

  private:
    template <class Real>
    HostMessages call(VumatFunctionOf<Real> vumat);

    std::string name_;
    AnalysisKind kind_;
    Numbers props_;
    Numbers initial_state_;
};

}  // namespace lode::test
