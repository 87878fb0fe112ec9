// What is prescribed at each moment of a step.
#ifndef LODE_HOST_REPLAY_PATH_HPP
#define LODE_HOST_REPLAY_PATH_HPP

#include <array>
#include <optional>
#include <vector>

#include "analysis.hpp"
#include "point.hpp"
#include "scenario.hpp"

namespace lode::host {

// The values at one moment: a strain or a stress for every component, or the deformation gradient.
struct Load {
    std::array<Control, 6> control{};
    Components value;
    std::optional<Matrix3> gradient;
    double temperature = 0;
    std::vector<double> fields;
};

// The load before the first step.
Load initial_load(const Scenario& scenario, const PointState& point);

class Path {
  public:
    // A component that the step does not name stays under the control it was, at the value it had.
    Path(const Step& step, const Layout& layout, const PointState& start, const Load& previous);

    Load at(double time) const;
    // Times in (0, step time], ascending, that increments have to end at: corners of the amplitude and the end.
    const std::vector<double>& corners() const { return corners_; }

  private:
    double progress(double time) const;
    Load manufactured_at(double time) const;

    const Step& step_;
    const Layout& layout_;
    Load begin_, end_;
    Matrix3 gradient_begin_, gradient_end_;
    std::vector<double> corners_;
};

}  // namespace lode::host

#endif
