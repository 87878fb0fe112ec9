#include "elastic_laws.hpp"

#include <cmath>
#include <limits>

namespace lode::host {
namespace {

Taylor square(const Taylor& x) { return x * x; }
Taylor cube(const Taylor& x) { return x * x * x; }
Taylor sum(const Stretches& x) { return x[0] + x[1] + x[2]; }
Taylor product(const Stretches& x) { return x[0] * x[1] * x[2]; }
bool is_one(const Taylor& x) { return x.value == 1 && x.first == 0 && x.second == 0; }

Matrix3 symmetric(double s11, double s22, double s33, double s12) {
    return Matrix3{{s11, s12, 0}, {s12, s22, 0}, {0, 0, s33}};
}
// V of F = I + g e1 e2, and B = V^2.
Matrix3 left_stretch(double g) {
    const double q = std::sqrt(4 + g * g);
    return symmetric((2 + g * g) / q, 2 / q, 1, g / q);
}
Matrix3 left_cauchy_green(double g) { return symmetric(1 + g * g, 1, 1, g); }

}  // namespace

LameConstants LameConstants::from_young_poisson(double young, double poisson) {
    const double shear = young / (2 * (1 + poisson));
    return {2 * shear * poisson / (1 - 2 * poisson), shear};
}

Taylor Dilatation::derivative(const Taylor& J) const {
    if (option == 0) return 0.5 * modulus * (J - 1 / J);
    return option == 1 ? modulus * (J - 1) : modulus * log(J) / J;
}

Taylor solved_lateral_stretch(const ElasticLaw& law, const Taylor& a, const Taylor& lr) {
    const auto stress22 = [&](const Taylor& stretch) { return law.stress({a, stretch, 1}, lr)[1]; };
    const auto at = [&](double stretch) { return law.stress({a.value, Taylor(stretch, 1, 0), 1}, lr.value)[1]; };
    // A sign change next to 1, by steps of 2 %.
    double lower = 1, upper = 1;
    const bool falls = at(1).value > 0;
    for (int i = 0; i < 1000 && (at(falls ? lower : upper).value > 0) == falls; ++i) {
        if (falls) upper = lower, lower /= 1.02;
        else lower = upper, upper *= 1.02;
    }
    if (!(at(lower).value <= 0 && at(upper).value >= 0)) return std::numeric_limits<double>::quiet_NaN();
    double stretch = 0.5 * (lower + upper);
    for (int i = 0; i < 100; ++i) {
        const Taylor residual = at(stretch);
        (residual.value > 0 ? upper : lower) = stretch;
        double next = stretch - residual.value / residual.first;
        if (!(next > lower && next < upper)) next = 0.5 * (lower + upper);
        if (std::abs(next - stretch) <= 1e-16 * stretch) break;
        stretch = next;
    }
    // The derivatives: each correction makes one more of them right.
    const double slope = at(stretch).first;
    Taylor result = stretch;
    for (int i = 0; i < 3; ++i) result = result - stress22(result) / slope;
    return result;
}

Taylor lateral_stretch(const ElasticLaw& law, const Taylor& a, const Taylor& lr) {
    if (const auto formula = law.free_lateral_stretch(a, lr)) return *formula;
    return solved_lateral_stretch(law, a, lr);
}

// --- linear laws -----------------------------------------------------------------------------------------------------

Stretches LowStrain::of_strain(const Stretches& strain, const Taylor& lr) const {
    const Taylor mean = c_.lambda * sum(strain) - (3 * c_.lambda + 2 * c_.shear) * log(lr);
    return {mean + 2 * c_.shear * strain[0], mean + 2 * c_.shear * strain[1], mean + 2 * c_.shear * strain[2]};
}

Stretches LowStrain::stress(const Stretches& a, const Taylor& lr) const {
    return of_strain({a[0] - 1, a[1] - 1, a[2] - 1}, lr);
}

Matrix3 LowStrain::shear_stress(double g, double lr) const {
    const Matrix3 strain = left_stretch(g) - Matrix3::Identity();
    return 2 * c_.shear * strain +
           (c_.lambda * strain.trace() - (3 * c_.lambda + 2 * c_.shear) * std::log(lr)) * Matrix3::Identity();
}

std::optional<Taylor> LowStrain::free_lateral_stretch(const Taylor& a, const Taylor& lr) const {
    const double ratio = c_.lambda / (c_.lambda + 2 * c_.shear);  // nu/(1 - nu)
    return 1 - ratio * (a - 1) + (3 * c_.lambda + 2 * c_.shear) / (c_.lambda + 2 * c_.shear) * log(lr);
}

Matrix3 SmallStrain::shear_stress(double g, double /*lr*/) const { return symmetric(0, 0, 0, c_.shear * g); }

Stretches LogarithmicIncrements::stress(const Stretches& a, const Taylor& lr) const {
    return of_strain({log(a[0]), log(a[1]), log(a[2])}, lr);
}

Matrix3 LogarithmicIncrements::shear_stress(double g, double lr) const {
    const double G = c_.shear, thermal = -(3 * c_.lambda + 2 * G) * std::log(lr);
    double s11 = G * (1 - std::cos(g)), s12 = G * std::sin(g);
    if (green_naghdi_) {
        const double b = std::atan(g / 2), c2 = std::cos(2 * b), s2 = std::sin(2 * b),
                     log_cosine = std::log(std::cos(b));
        s11 = 4 * G * (c2 * log_cosine + b * s2 - std::sin(b) * std::sin(b));
        s12 = 2 * G * (2 * b * c2 - 2 * s2 * log_cosine - c2 * std::tan(b));
    }
    return symmetric(thermal + s11, thermal - s11, thermal, s12);
}

std::optional<Taylor> LogarithmicIncrements::free_lateral_stretch(const Taylor& a, const Taylor& lr) const {
    const double stiffness = c_.lambda + 2 * c_.shear;
    return pow(a, -c_.lambda / stiffness) * pow(lr, (3 * c_.lambda + 2 * c_.shear) / stiffness);
}

// --- hyperelastic laws -----------------------------------------------------------------------------------------------

Stretches MooneyRivlinLaw::stress(const Stretches& a, const Taylor& lr) const {
    const Taylor J = product(a) / cube(lr), scale = 1 / (square(lr) * pow(J, 2.0 / 3));
    const Stretches b{scale * square(a[0]), scale * square(a[1]), scale * square(a[2])};
    const Taylor trace = sum(b);
    Stretches shape;
    for (std::size_t i = 0; i < 3; ++i) shape[i] = G1_ * b[i] + G2_ * (trace * b[i] - square(b[i]));
    const Taylor mean = sum(shape) / 3, u = u_.derivative(J);
    for (Taylor& s : shape) s = (s - mean) / J + u;
    return shape;
}

Matrix3 MooneyRivlinLaw::shear_stress(double g, double lr) const {
    const double expansion = lr * lr * lr, u = u_.derivative(1 / expansion).value, third = g * g / 3;
    return expansion *
               symmetric((2 * G1_ + G2_) * third, -(G1_ + 2 * G2_) * third, (G2_ - G1_) * third, (G1_ + G2_) * g) +
           u * Matrix3::Identity();
}

Stretches NeoHookeanLaw::stress(const Stretches& a, const Taylor& lr) const {
    const Taylor J = product(a) / cube(lr), u = u_.derivative(J);
    const auto principal = [&](const Taylor& stretch) { return c_.shear * (square(stretch / lr) - 1) / J + u; };
    return {principal(a[0]), principal(a[1]), principal(a[2])};
}

Matrix3 NeoHookeanLaw::shear_stress(double g, double lr) const {
    const double expansion = lr * lr * lr, u = u_.derivative(1 / expansion).value;
    const double normal = c_.shear * (lr - expansion) + u;
    return symmetric(normal + c_.shear * lr * g * g, normal, normal, c_.shear * lr * g);
}

std::optional<Taylor> NeoHookeanLaw::free_lateral_stretch(const Taylor& a, const Taylor& lr) const {
    if (u_.option != 0 || !is_one(lr)) return {};
    return sqrt((c_.lambda + 2 * c_.shear) / (c_.lambda * square(a) + 2 * c_.shear));  // (11.64)
}

Stretches CorotatedLaw::stress(const Stretches& a, const Taylor& lr) const {
    const Taylor J = product(a) / cube(lr), u = u_.derivative(J);
    const auto principal = [&](const Taylor& stretch) {
        const Taylor v = stretch / lr;
        return 2 * c_.shear * v * (v - 1) / J + u;
    };
    return {principal(a[0]), principal(a[1]), principal(a[2])};
}

Matrix3 CorotatedLaw::shear_stress(double g, double lr) const {
    const double expansion = lr * lr * lr;
    return 2 * c_.shear * expansion * (left_cauchy_green(g) / (lr * lr) - left_stretch(g) / lr) +
           u_.derivative(1 / expansion).value * Matrix3::Identity();
}

std::optional<Taylor> CorotatedLaw::free_lateral_stretch(const Taylor& a, const Taylor& lr) const {
    if (u_.option != 1 || !is_one(lr)) return {};
    return (2 * c_.shear + c_.lambda * a) / (2 * c_.shear + c_.lambda * square(a));
}

}  // namespace lode::host
