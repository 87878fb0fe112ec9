// A material point for tests: the library under test, called as an implicit host calls it.
//
//     UmatPoint point("ISO_ELASTIC-STEEL", AnalysisKind::solid, {200000.0, 0.3});
//     point.step({.dstran = {1e-3, 0, 0, 5e-4, 0, 0}, .dtemp = 40.0});
//     EXPECT_NEAR(point.stress()[0], 269.2, 0.1);
//
// Every array lies between guard zones and every input is compared after the call; what the library touched by mistake
// is a test failure.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "entry_points.hpp"
#include "host_messages.hpp"
#include "lode/material/kind.hpp"
#include "needs.hpp"

namespace lode::test {

using Eigen::Matrix3d;
using Numbers = std::vector<double>;

// The loading of one increment. What is not given does not change.
struct Load {
    Numbers dstran = {};  // engineering shears; empty: zeros
    double dtime = 1.0;
    double dtemp = 0.0;
    Numbers dpred = {};                    // empty: zeros
    std::optional<Matrix3d> dfgrd1 = {};   // F at the end; without it F stays
    Matrix3d drot = Matrix3d::Identity();  // STRESS is rotated by the host before the call, as the convention has it
    double pnewdt = 1.0;                   // on entry
    bool observe = false;                  // by lode_umat_observed instead of umat_
};

// What came back.
struct Answer {
    Numbers stress, state, ddsddt, drplde;
    Eigen::MatrixXd tangent;  // DDSDDE
    double sse = 0.0, spd = 0.0, scd = 0.0, rpl = 0.0, drpldt = 0.0, pnewdt = 0.0;
    bool cut = false;                // PNEWDT was written: a smaller increment is wanted
    lode_observation observation{};  // if it was asked for
    HostMessages messages;           // errors, warnings and calls of XIT during the call

    bool done() const { return !cut && messages.stops == 0; }
    std::string first_error() const { return messages.errors.empty() ? "" : messages.errors.front(); }
};

class UmatPoint {
  public:
    // STATEV gets the length the material asks for and the initial values of the model's description.
    UmatPoint(std::string material_name, AnalysisKind kind, Numbers props);

    UmatPoint& nstatv(int count);
    UmatPoint& state(Numbers values);
    UmatPoint& stress(Numbers values);
    UmatPoint& temperature(double value);
    UmatPoint& fields(Numbers values);  // PREDEF
    UmatPoint& celent(double value);
    UmatPoint& deformation_gradient(const Matrix3d& f);
    UmatPoint& time(double step, double total);
    UmatPoint& layout(int ndi, int nshr);              // for kinds that do not exist
    UmatPoint& raw_name(std::string cmname);           // exactly these bytes, neither padded nor cut
    UmatPoint& entry_point(lode_umat_function* umat);  // another umat_, e.g. from dlsym

    // Calls UMAT; the point stays where it is.
    Answer evaluate(const Load& load) const;
    // Calls UMAT and accepts the answer, unless it is a refusal or a request for a smaller increment.
    Answer step(const Load& load);
    // As `step`, with a test failure where the increment was not done.
    Answer advance(const Load& load);

    AnalysisKind kind() const { return kind_; }
    int size() const { return ndi_ + nshr_; }
    int normals() const { return ndi_; }
    const std::string& name() const { return name_; }
    const Numbers& props() const { return props_; }
    const Numbers& stress() const { return stress_; }
    const Numbers& state() const { return state_; }
    double state(int index) const { return state_.at(static_cast<std::size_t>(index) - 1); }  // 1-based
    const Numbers& strain() const { return strain_; }                                         // sum of DSTRAN
    const Matrix3d& deformation_gradient() const { return f_; }
    const Numbers& fields() const { return fields_; }
    double temperature() const { return temperature_; }
    double celent() const { return celent_; }
    double total_time() const { return total_time_; }
    double sse() const { return sse_; }
    double spd() const { return spd_; }
    double scd() const { return scd_; }

  private:
    std::string name_;
    AnalysisKind kind_;
    int ndi_, nshr_;
    Numbers props_, stress_, state_, strain_, fields_ = {0.0};
    Matrix3d f_ = Matrix3d::Identity();
    double temperature_ = 0.0, celent_ = 1.0, step_time_ = 0.0, total_time_ = 0.0;
    double sse_ = 0.0, spd_ = 0.0, scd_ = 0.0;
    int increment_ = 0;
    std::optional<std::string> raw_name_;
    lode_umat_function* entry_ = &umat_;
};

// Voigt components <-> tensor. `shear_factor` is 1 for stress; 1/2 for engineering shears, 2 on the way back.
Matrix3d to_tensor(const Numbers& components, AnalysisKind kind, double shear_factor);
Numbers to_components(const Matrix3d& tensor, AnalysisKind kind, double shear_factor);
inline Matrix3d stress_tensor(const Numbers& s, AnalysisKind kind) { return to_tensor(s, kind, 1.0); }
inline Matrix3d strain_tensor(const Numbers& e, AnalysisKind kind) { return to_tensor(e, kind, 0.5); }
Numbers rotated_stress(const Numbers& s, AnalysisKind kind, const Matrix3d& q);
Numbers rotated_strain(const Numbers& e, AnalysisKind kind, const Matrix3d& q);

// The model of the library under test with this keyword (the text before the first '-'), or null.
const lode_model* find_model(const std::string& material_name);
#define LODE_NEEDS(keyword) LODE_NEEDS_PRESENT(::lode::test::find_model(keyword) != nullptr, keyword)

// "bit for bit the same", also for NaN.
bool identical(const Numbers& a, const Numbers& b);
double largest(const Numbers& a);                     // largest magnitude
double distance(const Numbers& a, const Numbers& b);  // largest difference

}  // namespace lode::test
