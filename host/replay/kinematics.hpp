// Finite kinematics of one material point.
#ifndef LODE_HOST_REPLAY_KINEMATICS_HPP
#define LODE_HOST_REPLAY_KINEMATICS_HPP

#include "analysis.hpp"

namespace lode::host {

// F = R U = V R.
struct Polar {
    Matrix3 rotation, right_stretch, left_stretch;
};
Polar polar(const Matrix3& F);

Matrix3 exponential(const Matrix3& symmetric);
// Derivative of the exponential at `symmetric` in a symmetric direction.
Matrix3 exponential_derivative(const Matrix3& symmetric, const Matrix3& direction);
Matrix3 logarithm(const Matrix3& symmetric_positive);
Matrix3 rotation_about(const Eigen::Vector3d& axis, double angle);

// Strain and rotation over an increment, from the mid-increment velocity gradient
// G = (F1 - F0) (1/2 (F0 + F1))^-1: the strain is sym G, the rotation (1 - W/2)^-1 (1 + W/2) with W = skw G
// (Hughes and Winget). A motion without spin (G symmetric) has the exact logarithmic increment ln(F1 F0^-1) instead,
// which sym G equals to second order.
struct MotionIncrement {
    Matrix3 strain, spin, rotation;
};
MotionIncrement motion_increment(const Matrix3& F0, const Matrix3& F1);

}  // namespace lode::host

#endif
