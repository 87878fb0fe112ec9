// Numbers to compare with: a computation of the same equations made independently of this program (cutting plane
// instead of backward Euler, other order of additions), whose curves and patterns have been compared with what the
// dissertation says of its figures. h in mm, angles in degrees, elongations in units of 1e-5 m.
#pragma once

#include <array>
#include <span>

#include "scene.hpp"

namespace mpm::reference {

inline constexpr std::array<double, 9> elongations{1, 1.5, 1.9, 2.1, 3, 5, 7, 9, 10.5};
struct LoadRow {
    double h, angle;
    std::array<double, 9> load;  // N
};
std::span<const LoadRow> loads();

struct AngleRow {
    double h, angle, peak, end, work, fracture;
    int failed;
    double opening, width, tilt;
};
std::span<const AngleRow> angles();

struct FreeRow {  // searched normals, h = 10 mm: work, mean and standard deviation of normal - angle
    double angle, work, mean, deviation;
};
std::span<const FreeRow> free_normals();

struct WorkRow {
    double h, angle;
    Filling filling;
    int criterion;
    double work;
};
std::span<const WorkRow> works();

struct PatternRow {
    WeakPattern pattern;
    double h, peak, work;
};
std::span<const PatternRow> patterns();

struct FieldRow {
    double h, angle;
    Filling filling;
    double elongation, mean, deviation, least, most, nt, tt;
};
std::span<const FieldRow> fields();

struct ExcessRow {  // P/(W D E* elongation/L) - 1 in percent, all points elastic, h = 20, 10, 5 mm
    double angle;
    Filling filling;
    std::array<double, 3> percent;
};
std::span<const ExcessRow> excesses();

// Table 5.2 of the dissertation: slope of the logarithm of the error in load over that of 1/h.
struct SlopeRow {
    double angle, slope;
};
std::span<const SlopeRow> slopes();

}  // namespace mpm::reference
