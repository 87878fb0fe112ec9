#include "scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace mpm {

double Settings::radians() const { return angle * std::numbers::pi / 180.0; }
// Exact for a bar along the grid.
Vec Settings::n() const { return {std::cos(radians()), std::sin(radians())}; }
Vec Settings::t() const { return {-n().y, n().x}; }

int Settings::steps() const {
    const double c = std::sqrt(bar::E_1 / bar::rho);
    return static_cast<int>(std::ceil(end / v_L / (courant * h / c)));
}

std::string Settings::name() const {
    char text[200];
    const char* const start = pattern == WeakPattern::square  ? ", weak square"
                              : pattern == WeakPattern::point ? ", weak point"
                                                              : "";
    std::snprintf(text, sizeof text, "h %g mm, %g degrees%s%s%s%s%s", 1e3 * h, angle,
                  filling == Filling::uniform ? ", uniform" : "", start, cracks ? "" : ", elastic",
                  prescribed_normal ? "" : ", free normals", criterion == 1 ? ", Rankine" : "");
    std::string result = text;
    const Settings usual;
    const auto note = [&](const char* what, double value, double usual_value) {
        if (value == usual_value) return;
        std::snprintf(text, sizeof text, ", %s %g", what, value);
        result += text;
    };
    note("L_c/h", L_c_over_h, usual.L_c_over_h);
    note("v_L", v_L, usual.v_L);
    note("to", end, usual.end);
    note("Courant", courant, usual.courant);
    note("integration", integration, usual.integration);
    return result;
}

std::string Settings::file_name() const {
    std::string result;
    for (const char c : name()) {
        if (c == ',' || c == '/' || c == '_') continue;
        result += c == ' ' ? '_' : c;
    }
    return result;
}

int Grid::locate(Vec x, Vec& place) const {
    const Vec scaled = (1.0 / h) * (x - origin);
    const int column = std::clamp(static_cast<int>(scaled.x), 0, columns - 1),
              row = std::clamp(static_cast<int>(scaled.y), 0, rows - 1);
    place = {scaled.x - column, scaled.y - row};
    return row * columns + column;
}

int Grid::line_near(double x) const { return static_cast<int>(std::lround((x - origin.x) / h)); }

namespace {

// Lines through the corner of the unrotated bar, with room for the bar at any angle and its rigid points.
Grid make_grid(double h) {
    const double reach = 0.5 * std::hypot(bar::L, bar::W) + 2.0 * h;
    const int left = static_cast<int>(std::ceil((reach - 0.5 * bar::L) / h)),
              below = static_cast<int>(std::ceil((reach - 0.5 * bar::W) / h));
    const int columns = static_cast<int>(std::lround(bar::L / h)) + 2 * left,
              rows = static_cast<int>(std::lround(bar::W / h)) + 2 * below;
    return {h, {-0.5 * bar::L - left * h, -0.5 * bar::W - below * h}, columns, rows};
}

Group group_of(const Settings& s, Vec local) {
    const double x = local.x, y = local.y;
    if (!s.cracks || std::abs(x) > bar::decohesive_half) return elastic;
    if (s.pattern == WeakPattern::square)
        return std::max(std::abs(x), std::abs(y)) < bar::weak_square_half ? weak : bulk;
    if (s.pattern == WeakPattern::point) return x > 0.0 && x < 0.5 * s.h && y > 0.0 && y < 0.5 * s.h ? weak : bulk;
    // At 45 degrees uniform points lie just on this bound: they are meant.
    constexpr double rounding = 1.0 + 1e-9;
    if (s.filling == Filling::uniform) return std::abs(x) <= rounding * s.h / (2.0 * std::numbers::sqrt2) ? weak : bulk;
    return x > 0.0 && x < 0.5 * s.h ? weak : bulk;
}

}  // namespace

Scene::Scene(const Settings& s) : settings(s), grid(make_grid(s.h)), point_volume(bar::D * s.h * s.h / 4.0) {
    const double spacing = 0.5 * s.h;
    const Vec n = s.n(), t = s.t();
    std::vector<PlacedPoint> placed;
    const auto place = [&](Vec local, Vec position) {
        // A start without a wave: the velocity of homogeneous stretching.
        const Vec velocity = (s.v_L * (local.x + 0.5 * bar::L) / bar::L) * n;
        placed.push_back({local, position, velocity, group_of(s, local)});
    };
    if (s.filling == Filling::rotated) {
        const int along = static_cast<int>(std::lround(bar::L / spacing)),
                  across = static_cast<int>(std::lround(bar::W / spacing));
        for (int j = 0; j < across; ++j)
            for (int i = 0; i < along; ++i) {
                const Vec local{-0.5 * bar::L + (i + 0.5) * spacing, -0.5 * bar::W + (j + 0.5) * spacing};
                place(local, local.x * n + local.y * t);
            }
    } else {
        for (int j = 0; j < 2 * grid.rows; ++j)
            for (int i = 0; i < 2 * grid.columns; ++i) {
                const Vec position = grid.origin + Vec{(i + 0.5) * spacing, (j + 0.5) * spacing};
                const Vec local{dot(position, n), dot(position, t)};
                if (std::abs(local.x) < 0.5 * bar::L && std::abs(local.y) < 0.5 * bar::W) place(local, position);
            }
    }
    for (int group = 0; group < group_count; ++group) {
        group_first[static_cast<std::size_t>(group)] = static_cast<int>(points.size());
        std::copy_if(placed.begin(), placed.end(), std::back_inserter(points),
                     [&](const PlacedPoint& p) { return p.group == group; });
    }
    group_first[group_count] = static_cast<int>(points.size());

    // Just outside of the ends: on them, the end cells would be rigid and their points without stress (figure 5.6).
    for (const double side : {-1.0, 1.0}) {
        const Vec velocity = side > 0.0 ? s.v_L * n : Vec{};
        const double x = side * (0.5 * bar::L + 0.25 * s.h);
        const auto hold = [&](double y) { rigid.push_back({x * n + y * t, velocity}); };
        const int across = static_cast<int>(std::lround(bar::W / spacing));
        for (int j = 0; j < across; ++j) hold(-0.5 * bar::W + (j + 0.5) * spacing);
        if (s.angle != 0.0) hold(-0.5 * bar::W), hold(0.5 * bar::W);
    }
}

}  // namespace mpm
