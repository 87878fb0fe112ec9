#include "theory.hpp"

#include <algorithm>

namespace mpm {

double crack_load(double elongation, double G) {
    const double u = 2.0 * G / bar::tau_nf;
    const double crack = bar::W * bar::D * bar::E_star * (elongation - u) / (bar::L - bar::E_star * u / bar::tau_nf);
    return elongation >= u ? 0.0 : std::min(elastic_stiffness * elongation, crack);
}

double crack_work(double elongation, double G) {
    const double u = 2.0 * G / bar::tau_nf, first = bar::tau_nf * bar::L / bar::E_star;
    if (elongation <= first) return 0.5 * crack_load(elongation, G) * elongation;
    if (elongation >= u) return bar::W * bar::D * G;
    const double peak = bar::W * bar::D * bar::tau_nf;
    return 0.5 * peak * first + 0.5 * (peak + crack_load(elongation, G)) * (elongation - first);
}

namespace {

// Stress of a column of points at strain e.
double column(double e, double strength, double L_c) {
    const double u = 2.0 * bar::G_f / strength;
    if (bar::E_star * e <= strength) return bar::E_star * e;
    return e >= u / L_c ? 0.0 : bar::E_star * (u / L_c - e) / (bar::E_star * u / (strength * L_c) - 1.0);
}

struct CellState {
    double stress, elongation;
};
// Both columns have the strain of their cell.
CellState cell(double e, double h, double L_c) {
    const double stress = 0.5 * (column(e, bar::tau_nf, L_c) + column(e, bar::weakness * bar::tau_nf, L_c));
    return {stress, (bar::L - h) * stress / bar::E_star + h * e};
}

}  // namespace

double discrete_load(double elongation, double h, double L_c) {
    // The elongation grows with the strain of the cell: the bar is shorter than where it would snap back.
    double low = 0.0, high = elongation / h;
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        (cell(middle, h, L_c).elongation < elongation ? low : high) = middle;
    }
    return bar::W * bar::D * cell(low, h, L_c).stress;
}

Peak discrete_peak(double h, double L_c) {
    // A corner: either column reaches its strength.
    Peak peak{0.0, 0.0};
    for (const double strength : {bar::weakness * bar::tau_nf, bar::tau_nf}) {
        const CellState at = cell(strength / bar::E_star, h, L_c);
        if (const double load = bar::W * bar::D * at.stress; load > peak.load) peak = {at.elongation, load};
    }
    return peak;
}

}  // namespace mpm
