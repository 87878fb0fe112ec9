// Motions with a homogeneous deformation gradient F(t) for which stresses are known in closed form (Nairn, chapter 11).
#ifndef LODE_HOST_VERIFY_MOTION_HPP
#define LODE_HOST_VERIFY_MOTION_HPP

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../replay/analysis.hpp"
#include "taylor.hpp"

namespace lode::host {

// Direction 1 is stretched, or sheared over direction 2; the others are held, in free_tension direction 2 is free.
enum class Motion {
    constrained_tension,  // F11 = 1 + (stretch - 1) t/T
    linear_acceleration,  // F11 = 1 + (stretch - 1) (t/T)^2
    sinusoidal_tension,   // F11 = 1 + (stretch - 1) sin(w t)
    free_tension,         // as constrained_tension, F22 such that stress22 = 0
    linear_shear,         // F12 = shear t/T
    sinusoidal_shear,     // F12 = shear sin(w t)
    held_shear            // F12 = shear from the first moment on
};
inline constexpr std::array<std::string_view, 7> motion_names{
    "constrained_tension", "linear_acceleration", "sinusoidal_tension", "free_tension",
    "linear_shear",        "sinusoidal_shear",    "held_shear"};
// What follows the motion: the deformation gradient, or the small strain (11: F11 - 1, 12: F12) without rotation.
enum class Drive { gradient, strain };
enum class ResidualCause { temperature, field };

struct ManufacturedMotion {
    Motion motion = Motion::constrained_tension;
    Drive drive = Drive::gradient;
    double duration = 1;
    double stretch = 1, shear = 0, angular_frequency = 0;
    double residual_stretch = 1;  // of free expansion at the end; it grows linearly from 1
    ResidualCause cause = ResidualCause::temperature;
    std::optional<std::string> law;     // keyword of the closed form, if it is not the material's own
    std::vector<double> law_constants;  // of that
    std::string location;               // in the deck

    std::string_view name() const { return motion_names[static_cast<std::size_t>(motion)]; }
    bool is_shear() const { return motion >= Motion::linear_shear; }
    bool is_sinusoidal() const { return motion == Motion::sinusoidal_tension || motion == Motion::sinusoidal_shear; }
    bool expands() const { return residual_stretch != 1; }

    // F11 or F12 and the stretch of free expansion at time t, with derivatives.
    Taylor amount(double t) const;
    Taylor residual(double t) const;
    // held_shear: when the shear is there. A ramp so short that nothing relaxes in it.
    double jump_time() const { return 1e-12 * duration; }
};

}  // namespace lode::host

#endif
