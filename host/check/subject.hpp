// The material that is checked, in one kind, and the states that it is checked in.
#ifndef LODE_HOST_CHECK_SUBJECT_HPP
#define LODE_HOST_CHECK_SUBJECT_HPP

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "../library.hpp"
#include "../replay/analysis.hpp"
#include "umat_call.hpp"

namespace lode::host {

struct Subject {
    const Library* library = nullptr;
    std::string name;  // CMNAME
    Numbers constants;
    Kind kind = Kind::solid;
    int state_variables = 0;
    Numbers initial_state;  // leading entries
    std::optional<Components> initial_stress;
    double element_length = 1, temperature = 0;
    double scale = 0;      // a strain (cohesive: a separation) at which the material is inelastic; 0: found
    bool elastic = false;  // claimed: stress is a function of strain, energy is recovered
    bool unsymmetric = false;
    const lode_model* model = nullptr;       // if the library describes it
    const RecordedCall* recorded = nullptr;  // check at exactly this call

    // Found in the material's first answers.
    double stiffness = 0;         // largest change of a stress component for a strain from the start
    bool reads_gradient = false;  // STRESS follows DFGRD1
    bool rate_dependent = false;

    bool has_trait(unsigned trait) const { return model != nullptr && (model->traits & trait) != 0; }
    bool cohesive() const { return is_cohesive(kind); }
    // A law of the deformation gradient that is not derived from an energy.
    bool total_law() const { return model != nullptr && reads_gradient && !has_trait(LODE_FINITE_STRAIN); }
    double stress_scale() const { return stiffness * scale; }
};

// The same sequence everywhere.
class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    double uniform(double low, double high);
    bool chance(double probability) { return uniform(0, 1) < probability; }
    Components direction(int n);
    // A rotation by up to `angle` that the kind can have: any in 3D, about axis 3 in the plane kinds.
    Matrix3 rotation(Kind kind, double angle);

  private:
    std::uint64_t state_;
};

struct PathStep {
    Components strain;  // in the axes of the end
    Matrix3 rotation = Matrix3::Identity();
    double dtime = 1;
};

// What a host keeps of a point between increments.
struct CheckedState {
    Components stress, stran;
    Numbers statev;
    double sse = 0, spd = 0, scd = 0;
    Matrix3 F = Matrix3::Identity();
    double time = 0, temperature = 0;
    Numbers fields{0.0};
    int kinc = 1;
};

struct Situation {
    std::string label;
    UmatCall call;
    UmatAnswer answer;
    bool inelastic = false;  // dissipates
};

// A material under test. Every call may end this process: to be used in a child.
class Bench {
  public:
    explicit Bench(const Subject& subject);

    const Subject& subject() const { return subject_; }
    const Layout& layout() const { return layout_; }
    UmatAnswer call(const UmatCall& call, const Surroundings& around = {}) { return umat_(call, around); }

    // The state before anything happens; that of the recorded call, if there is one.
    CheckedState start();
    UmatCall call_for(const CheckedState& state, const PathStep& step) const;
    // Where a host goes after an answer.
    CheckedState after(const UmatCall& call, const UmatAnswer& answer) const;
    // Makes the increment; false if the material cannot.
    bool advance(CheckedState& state, const PathStep& step);

    // Loads, unloads, turns and goes on elsewhere, beyond the scale. Calls that the material can do.
    std::vector<Situation> situations();
    // The path behind them.
    std::vector<PathStep> path(Random& random) const;

    Matrix3 moved(const Matrix3& F, const PathStep& step) const;
    Components turned_stress(const Components& stress, const Matrix3& rotation) const;
    Components turned_strain(const Components& strain, const Matrix3& rotation) const;
    double largest_strain(const UmatCall& call) const { return call.dstran.cwiseAbs().maxCoeff(); }
    // det F, with the thickness stretch of plane stress from STATEV where the description names it; 1 for laws of
    // DSTRAN.
    double jacobian(const Numbers& statev, const Matrix3& F) const;
    // Whether frames of reference mean something in the kind.
    bool can_turn() const { return !layout_.cohesive() && layout_.kind() != Kind::uniaxial; }

  private:
    std::vector<Situation> recorded_situations();

    Subject subject_;
    Layout layout_;
    UmatCaller umat_;
};

// Runs the material for the first time: finds the scale, if it is not given, and what it reads. Call in a child.
struct FirstLook {
    double scale = 0, stiffness = 0;
    bool reads_gradient = false, rate_dependent = false;
    int elastic = 0, inelastic = 0;  // situations
    std::string refusal;             // the library ended the analysis at the first call, with this message
};
FirstLook first_look(const Subject& subject);

// "increment 5 (loading)" and so on, for messages.
std::string where(const Situation& situation);

}  // namespace lode::host

#endif
