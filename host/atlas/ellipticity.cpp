#include "ellipticity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../plot/gnuplot.hpp"
#include "../replay/driver.hpp"
#include "../study/material_point.hpp"

namespace lode::host {
namespace {

using Eigen::Vector3d;
constexpr int grid = 24;           // directions over a quarter turn
constexpr int refinements = 40;    // of the best direction, by a shrinking pattern
constexpr double marginal = 1e-9;  // of the elastic determinant: perfect plasticity is marginal, not lost

Vector3d direction(double azimuth, double elevation) {
    return {std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation), std::sin(elevation)};
}

}  // namespace

AcousticTensor::AcousticTensor(const Layout& layout, const Tangent& tangent, const Components& stress, bool jaumann)
    : plane_(layout.kind() != Kind::solid) {
    const Matrix3 s = layout.stress_tensor(stress);
    int place[3][3];
    for (auto& row : place)
        for (int& entry : row) entry = -1;
    for (int i = 0; i < layout.size(); ++i) {
        const auto [row, column] = layout.position(i);
        place[row][column] = place[column][row] = i;
    }
    const auto delta = [](int i, int j) { return i == j ? 1.0 : 0.0; };
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k)
                for (int l = 0; l < 3; ++l) {
                    const int row = place[i][j], column = place[k][l];
                    double value = row >= 0 && column >= 0 ? tangent(row, column) : 0;
                    // Truesdell moduli from Jaumann ones, and the rate of the nominal stress.
                    if (jaumann)
                        value += delta(i, k) * s(j, l) - 0.5 * (delta(i, k) * s(j, l) + delta(i, l) * s(j, k) +
                                                                s(i, k) * delta(j, l) + s(i, l) * delta(j, k));
                    moduli_[i][j][k][l] = value;
                }
}

double AcousticTensor::determinant(const Vector3d& n) const {
    const int size = plane_ ? 2 : 3;
    Matrix3 q = Matrix3::Identity();
    for (int i = 0; i < size; ++i)
        for (int k = 0; k < size; ++k) {
            double sum = 0;
            for (int j = 0; j < size; ++j)
                for (int l = 0; l < size; ++l) sum += n[j] * moduli_[i][j][k][l] * n[l];
            q(i, k) = sum;
        }
    return q.determinant();
}

LeastDeterminant least_determinant(const AcousticTensor& tensor, const AcousticTensor& elastic) {
    const auto ratio = [&](double azimuth, double elevation) {
        const Vector3d n = direction(azimuth, elevation);
        return tensor.determinant(n) / elastic.determinant(n);
    };
    const double step = 0.5 * std::numbers::pi / grid;
    double best = HUGE_VAL, azimuth = 0, elevation = 0;
    for (int i = 0; i < 2 * grid; ++i)
        for (int j = tensor.plane() ? 0 : -grid; j <= (tensor.plane() ? 0 : grid); ++j)
            if (const double value = ratio(i * step, j * step); value < best) {
                best = value;
                azimuth = i * step;
                elevation = j * step;
            }
    double width = step;
    for (int i = 0; i < refinements; ++i) {
        bool better = false;
        for (int a = -1; a <= 1; ++a)
            for (int e = tensor.plane() ? 0 : -1; e <= (tensor.plane() ? 0 : 1); ++e)
                if (const double value = ratio(azimuth + a * width, elevation + e * width); value < best) {
                    best = value;
                    azimuth += a * width;
                    elevation += e * width;
                    better = true;
                }
        if (!better) width *= 0.5;
    }
    Vector3d n = direction(azimuth, elevation);
    if (n[0] < 0 || (n[0] == 0 && n[1] < 0)) n = -n;
    return {best, n};
}

Ellipticity ellipticity_along(Scenario scenario, const Library& library) {
    scenario.analysis.entry = Entry::umat;
    Ellipticity result;
    const Tangent initial = MaterialPoint(scenario, library).tangent();
    resolve(scenario, library);
    const Layout layout(scenario.analysis.kind);
    const bool jaumann = scenario.material.reads_gradient;
    const AcousticTensor elastic(layout, initial, Components::Zero(layout.size()), jaumann);
    const Outcome outcome = drive(scenario, library, [&](const Record& r) {
        if (r.response == nullptr) return;
        const AcousticTensor tensor(layout, r.response->tangent, r.point.stress, jaumann);
        const EllipticityPoint point{r.point.total_time, least_determinant(tensor, elastic)};
        result.points.push_back(point);
        if (!result.lost && !(point.least.ratio > -marginal)) result.lost = point;
    });
    if (outcome.status != Status::success) result.failure = outcome.message;
    return result;
}

Sheet ellipticity_sheet(const std::vector<std::pair<std::string, Ellipticity>>& paths, const std::string& stem,
                        const std::string& title) {
    Sheet sheet{stem, title + "\n", Table({"path", "time", "least_determinant", "n1", "n2", "n3"}), "", "plot"};
    std::string data;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        const auto& [name, result] = paths[i];
        data += fmt::format("$p{} << EOD\n", i);
        double least = HUGE_VAL;
        for (const EllipticityPoint& p : result.points) {
            const auto& n = p.least.direction;
            sheet.table.add({name, p.time, p.least.ratio, n[0], n[1], n[2]});
            data += fmt::format("{} {}\n", p.time, p.least.ratio);
            least = std::min(least, p.least.ratio);
        }
        data += "EOD\n";
        if (result.lost) {
            const auto& n = result.lost->least.direction;
            sheet.text += fmt::format("  {}: lost at time {:.4g}, normal ({:.4f}, {:.4f}, {:.4f})\n", name,
                                      result.lost->time, n[0], n[1], n[2]);
        } else {
            sheet.text += fmt::format("  {}: {}, least determinant {:.3g} of the elastic one\n", name,
                                      least > marginal ? "kept" : "at its limit", least);
        }
        if (!result.failure.empty()) sheet.text += fmt::format("    ended early: {}\n", result.failure);
        if (result.points.empty()) continue;
        sheet.plot += fmt::format("{} $p{} using 1:2 with lines lw 1.6 lc rgb '{}' title {}",
                                  sheet.plot == "plot" ? "" : ",", i, curve_colour(i), single_quoted(name));
    }
    sheet.plot += ", 0 with lines lw 1 dt 2 lc rgb '#606060' title 'ellipticity is lost'";
    sheet.setup = figure_setup(title, "time along the path", "least det of the acoustic tensor / elastic") + data +
                  "set key outside right top Left reverse noenhanced\n";
    return sheet;
}

}  // namespace lode::host
