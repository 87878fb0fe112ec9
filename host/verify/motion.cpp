#include "motion.hpp"

#include <cmath>

namespace lode::host {

Taylor ManufacturedMotion::amount(double t) const {
    const double rest = is_shear() ? 0 : 1, change = is_shear() ? shear : stretch - 1;
    const double rate = change / duration, w = angular_frequency;
    switch (motion) {
        case Motion::linear_acceleration: {
            const double half = rate / duration;
            return {rest + half * t * t, 2 * half * t, 2 * half};
        }
        case Motion::sinusoidal_tension:
        case Motion::sinusoidal_shear: {
            const double sine = change * std::sin(w * t), cosine = change * std::cos(w * t);
            return {rest + sine, w * cosine, -w * w * sine};
        }
        case Motion::held_shear:
            return t > 0 ? Taylor(change) : Taylor(0);
        case Motion::constrained_tension:
        case Motion::free_tension:
        case Motion::linear_shear:
            break;
    }
    return {t == duration ? rest + change : rest + rate * t, rate, 0};
}

Taylor ManufacturedMotion::residual(double t) const {
    const double rate = (residual_stretch - 1) / duration;
    return {t == duration ? residual_stretch : 1 + rate * t, rate, 0};
}

}  // namespace lode::host
