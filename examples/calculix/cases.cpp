#include "cases.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "picture.hpp"

namespace ccx {
namespace {

// Materials of the library and, where CalculiX has the same, of its own. MPa, mm.
const UserMaterial iso_elastic{"ISO_ELASTIC-STEEL", {210000, 0.3}, 4};
const UserMaterial ortho_elastic{"ORTHO_ELASTIC-SPRUCE", {12000, 900, 500, 0.4, 0.5, 0.6, 800, 700, 60}, 13};
constexpr double young = 210000, poisson = 0.3, yield_stress = 250, hardening = 2000;
const UserMaterial iso_plastic{"ISO_PLASTIC-STEEL", {young, poisson, yield_stress, 1, hardening}, 4};
const Material own_elastic = native_material("STEEL", "*ELASTIC\n210000, 0.3\n");
const Material own_ortho =
    native_material("SPRUCE", "*ELASTIC, TYPE=ENGINEERING CONSTANTS\n12000, 900, 500, 0.4, 0.5, 0.6, 800, 700\n60\n");
const Material own_plastic = native_material("STEEL", "*ELASTIC\n210000, 0.3\n*PLASTIC\n250, 0\n2250, 1\n");

struct Twin {
    const UserMaterial& user;
    const Material& own;
    const char* card;
};
const Twin twins[] = {{iso_elastic, own_elastic, "*ELASTIC"},
                      {ortho_elastic, own_ortho, "*ELASTIC, TYPE=ENGINEERING CONSTANTS"},
                      {iso_plastic, own_plastic, "*PLASTIC"}};

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text.substr(0, text.find('-'));
}

std::string counts(const Results& ours, const Results& own) {
    return std::to_string(ours.iterations) + " (" + std::to_string(own.iterations) + ")";
}

const std::string everything = "*NODE PRINT, NSET=NALL\nU, RF\n*EL PRINT, ELSET=EALL\nS\n";

std::string fixed(const std::string& set, int first, int last, double value = 0.0) {
    return "*BOUNDARY\n" + set + ", " + std::to_string(first) + ", " + std::to_string(last) + ", " + number(value) +
           "\n";
}

bool near(double a, double b) { return std::abs(a - b) < 1e-9; }

// Displacements, reactions and stresses of two runs of one structure, and no more iterations than CalculiX needs
// itself.
void compare_runs(Report& report, const std::string& what, const std::string& reference, const Results& ours,
                  const Results& own, double tolerance) {
    report.push_back({what + ", displacement", reference,
                      deviation(ours.last("displacements/NALL"), own.last("displacements/NALL"), 1), tolerance,
                      counts(ours, own)});
    report.push_back({what + ", reaction", reference, deviation(ours.last("forces/NALL"), own.last("forces/NALL"), 1),
                      tolerance, ""});
    report.push_back({what + ", stress", reference, deviation(ours.last("stresses/EALL"), own.last("stresses/EALL"), 2),
                      tolerance, ""});
}

void same_iterations(Report& report, const std::string& what, const Results& ours, const Results& own) {
    report.push_back({what + ", Newton iterations", "at most one more than its own",
                      static_cast<double>(ours.iterations), own.iterations + 1.0, counts(ours, own)});
}

// ---------------------------------------------------------------------------------------------------- beams

// A cantilever of 8 x 2 x 2 elements; its end is pushed down by prescribed displacements.
std::string beam(const Material& material, double deflection, const StepOptions& options) {
    const Mesh mesh = make_box("C3D20R", {8, 2, 2}, {80, 10, 10});
    return mesh_cards(mesh) + node_set("ROOT", mesh.nodes_where([](auto& x) { return near(x[0], 0); })) +
           node_set("TIP", mesh.nodes_where([](auto& x) { return near(x[0], 80); })) + section("EALL", material) +
           fixed("ROOT", 1, 3) + step(options, fixed("TIP", 2, 2, -deflection) + everything);
}

void beams(const Host& host, Report& report) {
    for (const Twin& twin : twins) {
        const std::string name = "beam_" + lower(twin.user.name);
        const bool plastic = &twin.user == &iso_plastic;
        const double deflection = plastic ? 2.0 : 0.1;
        StepOptions options;
        if (plastic) options.first = options.largest = 0.2;
        const Results ours = host.run(name, beam(user_material(twin.user), deflection, options));
        const Results own = host.run(name + "_own", beam(twin.own, deflection, options));
        compare_runs(report, twin.user.name, twin.card, ours, own, 1e-8);
        same_iterations(report, twin.user.name, ours, own);
    }
}

// ---------------------------------------------------------------------------------------------------- notched plate

const Index plate_cells{12, 8, 1};
constexpr double plate_width = 10, plate_height = 14;

Mesh notched_plate_mesh() { return make_notched_plate(plate_cells, plate_width, plate_height, 4, 1); }

std::string notched_plate(const Material& material, double pull, const StepOptions& options,
                          const std::string& extra = "") {
    const Mesh mesh = notched_plate_mesh();
    const double radius = 4;
    return mesh_cards(mesh) + node_set("LEFT", mesh.nodes_where([](auto& x) { return near(x[0], 0); })) +
           node_set("LIGAMENT",
                    mesh.nodes_where([=](auto& x) { return near(x[1], 0) && x[0] < plate_width - radius + 1e-6; })) +
           node_set("MIDDLE", mesh.nodes_where([](auto& x) { return near(x[2], 0); })) +
           node_set("TOP", mesh.nodes_where([](auto& x) { return near(x[1], plate_height); })) +
           section("EALL", material) + fixed("LEFT", 1, 1) + fixed("LIGAMENT", 2, 2) + fixed("MIDDLE", 3, 3) +
           step(options, fixed("TOP", 2, 2, pull) + everything + extra);
}

StepOptions plate_steps() { return {.first = 0.1, .smallest = 1e-4, .largest = 0.1}; }
const std::string plate_states = "*EL PRINT, ELSET=EALL\nSDV\n";

void notched_plates(const Host& host, Report& report) {
    for (const Twin& twin : twins) {
        const std::string name = "plate_" + lower(twin.user.name);
        const bool plastic = &twin.user == &iso_plastic;
        const double pull = plastic ? 0.1 : 0.01;
        const StepOptions options = plastic ? plate_steps() : StepOptions{};
        const Results ours = host.run(name, notched_plate(user_material(twin.user), pull, options, plate_states));
        const Results own = host.run(
            name + "_own", notched_plate(twin.own, pull, options, plastic ? "*EL PRINT, ELSET=EALL\nPEEQ\n" : ""));
        compare_runs(report, twin.user.name, twin.card, ours, own, 1e-8);
        same_iterations(report, twin.user.name, ours, own);
        if (!plastic) continue;
        std::vector<Numbers> strain = ours.last("internal state variables/EALL");
        for (Numbers& row : strain) row.resize(3);  // EQPS is the first
        report.push_back({twin.user.name + ", plastic strain", "PEEQ of *PLASTIC",
                          deviation(strain, own.last("equivalent plastic strain/EALL"), 2), 1e-8, ""});
        draw_plastic_strain(host.output(), notched_plate_mesh(), strain);
    }
}

// ---------------------------------------------------------------------------------------------------- finite strain

constexpr double rubber_shear = 1.0;

// The cantilever bends by half its length.
std::string rubber_beam(const Material& material) {
    const StepOptions options{.first = 0.1, .smallest = 1e-4, .largest = 0.1, .nonlinear_geometry = true};
    return beam(material, 40, options);
}

void rubber_beams(const Host& host, Report& report) {
    const auto own_card = [](double shear, double bulk) {
        return native_material("RUBBER",
                               "*HYPERELASTIC, NEO HOOKE\n" + number(shear / 2) + ", " + number(2 / bulk) + "\n");
    };
    {
        // G1/2 (I1bar - 3) + K/2 (J - 1)^2 is CalculiX's law itself.
        const double bulk = 20;
        const UserMaterial rubber{"MOONEY_RIVLIN-RUBBER", {rubber_shear, bulk, 0, 1}, 2};
        const Results ours = host.run("beam_mooney_rivlin", rubber_beam(user_material(rubber, finite_strain)));
        const Results own = host.run("beam_mooney_rivlin_own", rubber_beam(own_card(rubber_shear, bulk)));
        compare_runs(report, rubber.name, "*HYPERELASTIC, NEO HOOKE", ours, own, 1e-6);
    }
    {
        // NEO_HOOKEAN is the same law but for terms of the volume change: G (I1 - I1bar)/2 - G ln J, lambda for K.
        const double bulk = 1000, e = 9 * bulk * rubber_shear / (3 * bulk + rubber_shear);
        const UserMaterial rubber{"NEO_HOOKEAN-RUBBER", {e, e / (2 * rubber_shear) - 1, 1}, 2};
        const Results ours = host.run("beam_neo_hookean", rubber_beam(user_material(rubber, finite_strain)));
        const Results own = host.run("beam_neo_hookean_own", rubber_beam(own_card(rubber_shear, bulk)));
        report.push_back({rubber.name + ", displacement", "*HYPERELASTIC, K/G = 1000",
                          deviation(ours.last("displacements/NALL"), own.last("displacements/NALL"), 1), 3e-3,
                          counts(ours, own)});
        report.push_back({rubber.name + ", reaction", "*HYPERELASTIC, K/G = 1000",
                          deviation(ours.last("forces/NALL"), own.last("forces/NALL"), 1), 3e-3, ""});
    }
}

// A bar of two elements pulled along 1 to `stretch`, free to contract.
std::string bar(const Material& material, double stretch, const StepOptions& options, const std::string& output) {
    const Mesh mesh = make_box("C3D8", {2, 1, 1}, {2, 1, 1});
    std::string text = mesh_cards(mesh);
    const char* symmetry[] = {"X0", "Y0", "Z0"};
    for (std::size_t i = 0; i < 3; ++i)
        text += node_set(symmetry[i], mesh.nodes_where([i](auto& x) { return near(x[i], 0); }));
    text += node_set("PULL", mesh.nodes_where([](auto& x) { return near(x[0], 2); })) + section("EALL", material);
    for (int i = 0; i < 3; ++i) text += fixed(symmetry[i], i + 1, i + 1);
    return text + step(options, fixed("PULL", 1, 1, 2 * (stretch - 1)) + output);
}

double total_force(const Results& results) { return results.last("total force/PULL").front().at(0); }
double largest_stress(const Results& results) { return results.last("stresses/EALL").front().at(2); }
double relative(double value, double reference) { return std::abs(value / reference - 1.0); }

const std::string bar_output = "*NODE PRINT, NSET=PULL, TOTALS=ONLY\nRF\n*EL PRINT, ELSET=EALL\nS\n";

void finite_strain_bars(const Host& host, Report& report) {
    const StepOptions options{
        .first = 0.05, .smallest = 1e-4, .largest = 0.05, .nonlinear_geometry = true, .tolerance = 1e-10};
    {
        // Isotropic hardening in the logarithmic strain, uniaxial stress.
        const double stretch = 1.05, strain = std::log(stretch);
        const double slope = young * hardening / (young + hardening);
        const double stress = yield_stress + slope * (strain - yield_stress / young);
        const double lateral = -poisson * stress / young - 0.5 * (strain - stress / young);
        const Results run =
            host.run("bar_iso_plastic", bar(user_material(iso_plastic, finite_strain), stretch, options, bar_output));
        const char* reference = "closed form, logarithmic strain";
        const std::string newton = std::to_string(run.iterations);
        report.push_back(
            {"ISO_PLASTIC, 5 % tension, stress", reference, relative(largest_stress(run), stress), 1e-8, newton});
        report.push_back({"ISO_PLASTIC, 5 % tension, force", reference,
                          relative(total_force(run), stress * std::exp(2 * lateral)), 1e-8, ""});
    }
    {
        // sigma = (G (l^2 - 1) + U'(J) J)/J along, G (b^2 - 1) + U'(J) J = 0 across, U' = lambda (J - 1).
        // In Pa and m: CalculiX takes residual forces below 1e-6 for zero.
        const double e = 3e6, nu = 0.4, g = e / (2 * (1 + nu)), lame = e * nu / ((1 + nu) * (1 - 2 * nu)),
                     stretch = 1.8;
        const auto across = [&](double b) {
            const double j = stretch * b * b;
            return g * (b * b - 1) + lame * (j - 1) * j;
        };
        double low = 0.5, high = 1.0;
        for (int i = 0; i < 200; ++i) (across(0.5 * (low + high)) > 0 ? high : low) = 0.5 * (low + high);
        const double b = 0.5 * (low + high), j = stretch * b * b;
        const double stress = (g * (stretch * stretch - 1) + lame * (j - 1) * j) / j;
        const Results run = host.run(
            "bar_neo_hookean",
            bar(user_material({"NEO_HOOKEAN-RUBBER", {e, nu, 1}, 2}, finite_strain), stretch, options, bar_output));
        const char* reference = "closed form, stretch 1.8";
        report.push_back({"NEO_HOOKEAN, stress", reference, relative(largest_stress(run), stress), 1e-8,
                          std::to_string(run.iterations)});
        report.push_back({"NEO_HOOKEAN, force", reference, relative(total_force(run), stress * b * b), 1e-8, ""});
    }
}

// A block whose surface follows x = F X; the node in its middle is free. One step a state of F.
using Gradient = std::array<std::array<double, 3>, 3>;

std::string affine_block(const Material& material, const std::vector<Gradient>& states, const std::string& initial,
                         const StepOptions& options, const std::string& output) {
    const Mesh mesh = make_box("C3D8", {2, 2, 2}, {1, 1, 1});
    std::string text = mesh_cards(mesh) + section("EALL", material) + initial;
    for (const Gradient& f : states) {
        std::string boundary = "*BOUNDARY\n";
        for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
            const Position& x = mesh.nodes[n];
            if (std::all_of(x.begin(), x.end(), [](double c) { return near(c, 0.5); })) continue;
            for (std::size_t i = 0; i < 3; ++i) {
                double u = -x[i];
                for (std::size_t k = 0; k < 3; ++k) u += f[i][k] * x[k];
                const std::string direction = ", " + std::to_string(i + 1);
                boundary += std::to_string(n + 1) + direction + direction + ", " + number(u) + "\n";
            }
        }
        text += step(options, boundary + output);
    }
    return text;
}

// Each increment of this length is a step of its own: states in between would not be rigid turns.
constexpr StepOptions one_increment{.first = 1.0, .duration = 1.0, .smallest = 1e-5, .largest = 1.0};

void rotation(const Host& host, Report& report) {
    const double stretch = 1.1, strain = std::log(stretch), quarter = 0.5 * std::acos(-1.0);
    std::vector<Gradient> states{{{{stretch, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
    constexpr int turns = 9;
    for (int i = 1; i <= turns; ++i) {
        const double c = std::cos(quarter * i / turns), s = std::sin(quarter * i / turns);
        states.push_back({{{c * stretch, -s, 0}, {s * stretch, c, 0}, {0, 0, 1}}});
    }
    StepOptions options = one_increment;
    options.nonlinear_geometry = true;
    const double bulk = young / (3 * (1 - 2 * poisson)), shear = young / (2 * (1 + poisson));
    const double flow = yield_stress + hardening * (2 * shear * strain - yield_stress) / (3 * shear + hardening);
    const double along = bulk * strain + 2 * flow / 3, across = bulk * strain - flow / 3;
    const Results run = host.run("rotation", affine_block(user_material(iso_plastic, finite_strain), states, "",
                                                          options, "*EL PRINT, ELSET=EALL\nS\n"));
    const auto& history = run.history("stresses/EALL");
    const auto check = [&](const char* what, const Table& table, const Numbers& stress) {
        Numbers row = table.rows.front();
        Numbers expected{row[0], row[1]};
        expected.insert(expected.end(), stress.begin(), stress.end());
        report.push_back({what, "closed form, logarithmic strain", deviation({row}, {expected}, 2), 1e-9, ""});
    };
    check("ISO_PLASTIC, stretch of 10 %", history.front(), {along, across, across, 0, 0, 0});
    check("the same turned by 90 degrees", history.back(), {across, along, across, 0, 0, 0});
}

// ---------------------------------------------------------------------------------------------------- thick sphere

// f = sqrt(J2) + eta sigma_m - k under internal pressure. In the plastic shell k + eta p varies as r^(-2 eta/m),
// m = 1/sqrt3 + 2 eta/3; outside it is elastic. eta = 0 is Hill's solution.
struct Sphere {
    double inner, front, outer, young, poisson, eta, k;
    double exponent() const { return 2 * eta / m(); }
    double m() const { return 1 / std::sqrt(3.0) + 2 * eta / 3; }
    double cubes() const { return std::pow(outer / front, 3); }
    double front_pressure() const { return k / m() / (1.5 * cubes() / (cubes() - 1) - eta / m()); }
    double pressure() const { return pressure_at(inner); }
    double pressure_at(double r) const {  // r <= front
        if (eta == 0.0) return front_pressure() + 2 * k / m() * std::log(front / r);
        return ((k + eta * front_pressure()) * std::pow(front / r, exponent()) - k) / eta;
    }
    double outer_displacement() const {
        return 1.5 * (1 - poisson) * outer * front_pressure() / (young * (cubes() - 1));
    }
};

void sphere(const Host& host, Report& report, const std::string& name, const UserMaterial& material, const Sphere& s) {
    constexpr int cells = 32;
    const double opening = 0.1;
    const Mesh mesh = make_sphere_column(cells, s.inner, s.outer, opening);
    std::string text = mesh_cards(mesh) + section("EALL", user_material(material));
    // Every ray has its own axes; nodes move along them.
    int rays = 0;
    std::vector<int> outside;
    for (int j = 0; j <= 2; ++j)
        for (int i = 0; i <= 2; ++i) {
            if (i == 1 && j == 1) continue;
            std::vector<int> nodes;
            for (int k = 0; k <= 2 * cells; ++k)
                if (const int n = mesh.node(i, j, k); n != 0) nodes.push_back(n);
            const Position& end = mesh.position(nodes.back());
            outside.push_back(nodes.back());
            const std::string ray = "RAY" + std::to_string(++rays);
            text += node_set(ray, nodes) + "*TRANSFORM, NSET=" + ray + ", TYPE=R\n" + number(end[0]) + ", " +
                    number(end[1]) + ", " + number(end[2]) + ", " + number(-end[1]) + ", " + number(end[0]) + ", 0\n" +
                    fixed(ray, 2, 3);
        }
    text += node_set("OUTSIDE", outside);
    const StepOptions options{.first = 0.1, .smallest = 1e-4, .largest = 0.1, .tolerance = 1e-9};
    text += step(options, "*DLOAD\n1, P1, " + number(s.pressure()) +
                              "\n*NODE PRINT, NSET=OUTSIDE, GLOBAL=YES\nU\n*EL PRINT, ELSET=EALL\nS\n");
    const Results run = host.run(name, text);
    double worst = 0.0;
    for (const Numbers& row : run.last("displacements/OUTSIDE"))
        worst = worse(worst, relative(std::hypot(row[1], row[2], row[3]), s.outer_displacement()));
    const char* reference = s.eta == 0.0 ? "Hill, plastic front at 1.5 a" : "closed form, plastic front at 1.5 a";
    report.push_back(
        {material.name + ", displacement outside", reference, worst, 1e-4, std::to_string(run.iterations)});
    // Radial stress in the plastic shell, at integration points next to the middle ray.
    const double point = 0.5 / std::sqrt(3.0);
    worst = 0.0;
    for (const Numbers& row : run.last("stresses/EALL")) {
        const int ip = static_cast<int>(row[1]) - 1;
        const double sign[3] = {ip % 2 ? 1.0 : -1.0, ip / 2 % 2 ? 1.0 : -1.0, ip / 4 ? 1.0 : -1.0};
        const double r = s.inner + (s.outer - s.inner) * (row[0] - 0.5 + point * sign[2]) / cells;
        if (r > s.front) continue;
        const double longitude = point * sign[0] * opening, latitude = point * sign[1] * opening;
        const double n[3] = {std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
                             std::sin(latitude)};
        const double radial = row[2] * n[0] * n[0] + row[3] * n[1] * n[1] + row[4] * n[2] * n[2] +
                              2 * (row[5] * n[0] * n[1] + row[6] * n[0] * n[2] + row[7] * n[1] * n[2]);
        worst = worse(worst, std::abs(radial + s.pressure_at(r)) / s.pressure());
    }
    report.push_back({material.name + ", radial stress inside", reference, worst, 2e-3, ""});
}

void spheres(const Host& host, Report& report) {
    const double y = yield_stress;
    sphere(host, report, "sphere_iso_plastic", {"ISO_PLASTIC-PERFECT", {young, poisson, y, 0}, 4},
           {1, 1.5, 2, young, poisson, 0, y / std::sqrt(3.0)});
    const double e = 30000, nu = 0.2, eta = 0.3, k = 5;
    sphere(host, report, "sphere_drucker_prager", {"DRUCKER_PRAGER-ASSOCIATED", {e, nu, 0, eta, eta, k}, 4},
           {1, 1.5, 2, e, nu, eta, k});
    sphere(host, report, "sphere_drucker_prager_flow", {"DRUCKER_PRAGER-INCOMPRESSIBLE", {e, nu, 0, eta, 0, k}, 4},
           {1, 1.5, 2, e, nu, eta, k});
}

// ---------------------------------------------------------------------------------------------------- clay

std::string stress_everywhere(int elements, int points, double pressure) {
    std::string text = "*INITIAL CONDITIONS, TYPE=STRESS\n";
    for (int e = 1; e <= elements; ++e)
        for (int p = 1; p <= points; ++p) {
            const std::string s = ", " + number(-pressure);
            text += std::to_string(e) + ", " + std::to_string(p) + s + s + s + ", 0, 0, 0\n";
        }
    return text;
}

// STATEV behind the numbers of element and point.
constexpr std::size_t clay_p = 2 + 10, clay_q = 2 + 11;

// These columns of the last line of a CSV file.
Numbers last_row(const std::string& table, const std::vector<std::string>& columns) {
    const auto cells = [](const std::string& line) {
        std::vector<std::string> found;
        std::istringstream text(line);
        for (std::string cell; std::getline(text, cell, ',');) found.push_back(cell);
        return found;
    };
    const auto names = cells(table.substr(0, table.find('\n')));
    const auto values = cells(table.substr(table.find_last_of('\n', table.size() - 2) + 1));
    Numbers row;
    for (const std::string& column : columns)
        for (std::size_t i = 0; i < names.size(); ++i)
            if (names[i] == column) row.push_back(std::stod(values.at(i)));
    if (row.size() != columns.size()) throw std::runtime_error("a column is missing");
    return row;
}

void clay(const Host& host, Report& report) {
    const std::string clay_output = "*EL PRINT, ELSET=EALL\nS, SDV\n";
    const UserMaterial normal{"CAM_CLAY-CLAY", {100, 0.02, 0.1, 1.2, 3000, 0, 100}, 13};
    {
        // Constant volume, ten increments: the numbers of the model's page, verification case 3.
        StepOptions options{.first = 0.1, .smallest = 1e-3, .largest = 0.1};
        const Results run = host.run("clay_undrained",
                                     affine_block(user_material(normal), {{{{0.98, 0, 0}, {0, 1.01, 0}, {0, 0, 1.01}}}},
                                                  stress_everywhere(8, 8, 100), options, clay_output));
        const Numbers state = run.last("internal state variables/EALL").front();
        const char* reference = "CAM_CLAY page, case 3";
        report.push_back({"CAM_CLAY undrained triaxial, p", reference, relative(state[clay_p], 67.25246717486), 1e-9,
                          std::to_string(run.iterations)});
        report.push_back(
            {"CAM_CLAY undrained triaxial, q", reference, relative(state[clay_q], 64.6615635145), 1e-9, ""});
    }
    {
        // Drained: the confining pressure stays. 100 kPa in, 20 % axial compression.
        const Mesh mesh = make_box("C3D8", {1, 1, 1}, {1, 1, 1});
        std::string text = mesh_cards(mesh) + section("EALL", user_material(normal)) + stress_everywhere(1, 8, 100);
        const char* symmetry[] = {"X0", "Y0", "Z0"};
        for (std::size_t i = 0; i < 3; ++i)
            text += node_set(symmetry[i], mesh.nodes_where([i](auto& x) { return near(x[i], 0); })) +
                    fixed(symmetry[i], static_cast<int>(i) + 1, static_cast<int>(i) + 1);
        text += node_set("PLATEN", mesh.nodes_where([](auto& x) { return near(x[0], 1); }));
        text += step(one_increment, "*DLOAD\n1, P4, 100\n1, P5, 100\n1, P2, 100\n");
        const StepOptions options{.first = 0.01, .smallest = 1e-4, .largest = 0.01};
        text += step(options, fixed("PLATEN", 1, 1, -0.2) + clay_output);
        const Results run = host.run("clay_drained", text);
        const Numbers state = run.last("internal state variables/EALL").front();
        write_text(host.output() / "clay_drained.toml",
                   "[material]\nname = \"CAM_CLAY-CLAY\"\nconstants = [100, 0.02, 0.1, 1.2, 3000, 0, 100]\n"
                   "initial_stress = { 11 = -100, 22 = -100, 33 = -100 }\n"
                   "[[step]]\nincrements = 100\nstrain = { 11 = -0.2 }\nrelative = true\n"
                   "[output]\ncolumns = [\"pressure\", \"mises\"]\n");
        if (host.lode("clay_drained_replay", "replay clay_drained.toml --quiet --output clay_replay") != 0)
            throw std::runtime_error("lode replay failed: clay_drained_replay.log");
        const std::string table = read_text(host.output() / "clay_replay" / "clay_drained.csv");
        const Numbers replayed = last_row(table, {"pressure", "mises"});
        const char* reference = "lode replay, the same increments";
        report.push_back({"CAM_CLAY drained triaxial, p", reference, relative(state[clay_p], replayed[0]), 1e-6,
                          std::to_string(run.iterations)});
        report.push_back({"CAM_CLAY drained triaxial, q", reference, relative(state[clay_q], replayed[1]), 1e-6, ""});
        report.push_back({"CAM_CLAY drained triaxial, q - 3 (p - 100)", "the path of a drained test",
                          std::abs(state[clay_q] - 3 * (state[clay_p] - 100)) / 100, 1e-6, ""});
    }
}

// ---------------------------------------------------------------------------------------------------- softening bar

// A bar of `cells` elements breaks in one of them, which is 1 % weaker. The work done is the toughness times the area.
void softening_bar(const Host& host, Report& report) {
    const double length = 100, side = 10, strength = 3, toughness = 0.1, e = 30000;
    std::vector<double> peaks;
    for (const int cells : {5, 15, 45}) {
        const double h = length / cells;
        const auto concrete = [&](const char* label, double sigc) {
            return user_material({std::string("ISO_SOFTENING-") + label,
                                  {e, 0.0, sigc, 0, 1, toughness, 1, toughness, 0, 1, 1, 0, 0, 0, 0, 0.01, 0, 0, 0, h},
                                  26});
        };
        const Mesh mesh = make_box("C3D8", {cells, 1, 1}, {length, side, side});
        const int weak = cells / 2 + 1;
        std::vector<int> sound;
        for (int i = 1; i <= cells; ++i)
            if (i != weak) sound.push_back(i);
        std::string text = mesh_cards(mesh) + element_set("WEAK", {weak}) + element_set("SOUND", sound) +
                           section("WEAK", concrete("WEAK", 0.99 * strength)) +
                           section("SOUND", concrete("SOUND", strength));
        const char* symmetry[] = {"X0", "Y0", "Z0"};
        for (std::size_t i = 0; i < 3; ++i)
            text += node_set(symmetry[i], mesh.nodes_where([i](auto& x) { return near(x[i], 0); })) +
                    fixed(symmetry[i], static_cast<int>(i) + 1, static_cast<int>(i) + 1);
        text += node_set("PULL", mesh.nodes_where([&](auto& x) { return near(x[0], length); }));
        const double opening = 0.08;
        const StepOptions options{.first = 0.01, .smallest = 1e-4, .largest = 0.01};
        text += step(options, fixed("PULL", 1, 1, opening) +
                                  "*NODE PRINT, NSET=PULL, TOTALS=ONLY\nRF\n*EL PRINT, ELSET=WEAK\nSDV\n");
        const Results run = host.run("softening_bar_" + std::to_string(cells), text);
        double work = 0.0, force = 0.0, time = 0.0, peak = 0.0;
        for (const Table& table : run.history("total force/PULL")) {
            const double now = table.rows.front()[0];
            work += 0.5 * (force + now) * (table.time - time) * opening;
            force = now, time = table.time, peak = std::max(peak, now);
        }
        peaks.push_back(peak);
        const std::string what = "ISO_SOFTENING, " + std::to_string(cells) + " elements, ";
        report.push_back({what + "work", "GIC x area", relative(work, toughness * side * side), 2e-3,
                          std::to_string(run.iterations)});
        // STATEV(17) is the energy dissipated per volume.
        double dissipated = 0.0;
        const auto& points = run.last("internal state variables/WEAK");
        for (const Numbers& row : points) dissipated += row[2 + 16] / static_cast<double>(points.size());
        report.push_back({what + "dissipation", "GIC x area", relative(dissipated * h, toughness), 1e-9, ""});
    }
    const auto [low, high] = std::minmax_element(peaks.begin(), peaks.end());
    report.push_back({"ISO_SOFTENING, peak loads of the meshes", "each other", *high / *low - 1, 1e-8, ""});
}

// ---------------------------------------------------------------------------------------------------- time and heat

void relaxation(const Host& host, Report& report) {
    // Simple shear at constant rate for 0.5 s, then held.
    const double g0 = 300, shear = 0.02, ramp = 0.5, hold = 9.5;
    const double moduli[] = {200, 150, 100}, times[] = {0.1, 1, 10};
    const UserMaterial polymer{"VISCOELASTIC-POLYMER", {2000, g0, 3, 0, 200, 0.1, 150, 1, 100, 10}, 29};
    StepOptions options{.first = 0.05, .duration = ramp, .smallest = 1e-3, .largest = 0.05};
    const Gradient sheared{{{1, shear, 0}, {0, 1, 0}, {0, 0, 1}}};
    const std::string output = "*EL PRINT, ELSET=EALL\nS\n";
    std::string text = affine_block(user_material(polymer), {sheared}, "", options, output);
    options.first = options.largest = 0.5, options.duration = hold;
    text += step(options, output);
    const Results run = host.run("relaxation", text);
    double worst = 0.0;
    for (const Table& table : run.history("stresses/EALL")) {
        const double t = table.time, loaded = std::min(t, ramp);
        double stress = g0 * shear * loaded / ramp;
        for (int k = 0; k < 3; ++k)
            stress += moduli[k] * shear * times[k] / ramp * (std::exp(loaded / times[k]) - 1) * std::exp(-t / times[k]);
        worst = worse(worst, relative(table.rows.front()[5], stress));
    }
    report.push_back({"VISCOELASTIC, ramp and hold, all " + std::to_string(run.increments) + " increments",
                      "closed form of the Prony series", worst, 1e-6, std::to_string(run.iterations)});
}

// DTEMP is 0 in CalculiX: thermal strain comes from *EXPANSION.
void heating(const Host& host, Report& report) {
    const double expansion = 1.2e-5, rise = 100;
    Material steel = user_material(iso_elastic);
    steel.card += "*EXPANSION, ZERO=20\n" + number(expansion) + "\n";
    const std::string text =
        affine_block(steel, {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}}, "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nNALL, 20\n",
                     one_increment, "*TEMPERATURE\nNALL, " + number(20 + rise) + "\n*EL PRINT, ELSET=EALL\nS\n");
    const Results run = host.run("heating", text);
    const double stress = -young * expansion * rise / (1 - 2 * poisson);
    const Numbers row = run.last("stresses/EALL").front();
    report.push_back({"ISO_ELASTIC with *EXPANSION, constrained", "-E alpha dT/(1 - 2 nu)",
                      deviation({row}, {{row[0], row[1], stress, stress, stress, 0, 0, 0}}, 2), 1e-10, ""});
}

// ---------------------------------------------------------------------------------------------------- the interface

std::string plastic_beam(const Material& material) {
    return beam(material, 2, {.first = 0.2, .smallest = 1e-5, .largest = 0.2});
}

void found_at_run_time(const Host& host, Report& report) {
    const Results linked = host.run("route_a", plastic_beam(user_material(iso_plastic)));
    const Results loaded =
        host.run("route_b", plastic_beam(user_material(iso_plastic, at_run_time)), {.at_run_time = true});
    compare_runs(report, "library found by @ABAQUS_LODE_UMAT@", "linked library", loaded, linked, 1e-12);
}

void threads(const Host& host, Report& report) {
    const std::string text = notched_plate(user_material(iso_plastic), 0.1, plate_steps(), plate_states);
    const Results serial = host.run("serial", text), threaded = host.run("threaded", text, {.threads = 2});
    compare_runs(report, "notched plate, 2 threads", "1 thread", threaded, serial, 1e-11);
    report.push_back(
        {"notched plate, 2 threads, STATEV", "1 thread",
         deviation(threaded.last("internal state variables/EALL"), serial.last("internal state variables/EALL"), 2),
         1e-9, counts(threaded, serial)});
}

// CAM_CLAY refuses strain increments above 0.5 and asks for a quarter. At constant volume every increment, however
// long, ends on the curve p = p0 (M^2/(M^2 + (q/p)^2))^(1 - kappa/lambda), and large ones near the critical state.
void cut_back(const Host& host, Report& report) {
    const double kappa = 0.02, lambda = 0.1, slope = 1.2, p0 = 100;
    const UserMaterial normal{"CAM_CLAY-CLAY", {p0, kappa, lambda, slope, 3000, 0, p0}, 13};
    const double strain = 0.6;
    const Results run =
        host.run("cut_back", affine_block(user_material(normal),
                                          {{{{1 - strain, 0, 0}, {0, 1 + strain / 2, 0}, {0, 0, 1 + strain / 2}}}},
                                          stress_everywhere(8, 8, p0), one_increment, "*EL PRINT, ELSET=EALL\nSDV\n"));
    report.push_back({"CAM_CLAY, increments cut through PNEWDT", "at least one", run.cuts > 0 ? 0.0 : 1.0, 0.0,
                      std::to_string(run.cuts) + " cuts"});
    const Numbers state = run.last("internal state variables/EALL").front();
    const double p = state[clay_p], q = state[clay_q];
    report.push_back({"CAM_CLAY, after that, p", "undrained path in closed form",
                      relative(p, p0 * std::pow(slope * slope / (slope * slope + q * q / p / p), 1 - kappa / lambda)),
                      1e-9, std::to_string(run.iterations)});
    report.push_back({"CAM_CLAY, after that, q", "critical state",
                      relative(q, slope * p0 * std::pow(2, kappa / lambda - 1)), 0.01, ""});
}

void bad_constants(const Host& host, Report& report) {
    const UserMaterial bad{"ISO_PLASTIC-STEEL", {young, 0.7, yield_stress, 1, hardening}, 4};
    const Results run = host.run("bad_constants", plastic_beam(user_material(bad)), {.may_fail = true});
    const bool ended = run.status != 0 && run.status < 128;
    const bool named = run.log.find("ISO_PLASTIC-STEEL") != std::string::npos &&
                       run.log.find("NU") != std::string::npos && run.log.find("0.7") != std::string::npos;
    report.push_back({"NU = 0.7: CalculiX ends", "an exit status, no signal", ended ? 0.0 : 1.0, 0.0, ""});
    report.push_back({"NU = 0.7: message", "names material, constant, value", named ? 0.0 : 1.0, 0.0, ""});
    // Softening without an element length, which CalculiX does not give.
    const UserMaterial softening{"ISO_SOFTENING-CONCRETE", {30000, 0.2, 3, 0, 1, 0.1, 1, 0.1}, 26};
    const Results unknown = host.run("unknown_length", plastic_beam(user_material(softening)), {.may_fail = true});
    const bool says = unknown.log.find("element length") != std::string::npos;
    report.push_back({"softening without HFIX is refused", "a message, no signal",
                      unknown.status != 0 && unknown.status < 128 && says ? 0.0 : 1.0, 0.0, ""});
}

void recording(const Host& host, Report& report) {
    const fs::path file = host.output() / "beam.rec";
    fs::remove(file);
    host.run("recorded", plastic_beam(user_material(iso_plastic)),
             {.threads = 2, .environment = "LODE_RECORD=beam.rec"});
    const int status = host.lode("rerun", "rerun beam.rec");
    report.push_back({"recording of the plastic beam, lode rerun", "every number, bit for bit",
                      static_cast<double>(status), 0.0, ""});
}

}  // namespace

const std::vector<Case> cases = {
    {"beams", "cantilever, three materials", beams},
    {"notched_plates", "notched plate, three materials", notched_plates},
    {"rubber_beams", "cantilever of rubber, large deflection", rubber_beams},
    {"finite_strain_bars", "bars at finite strain", finite_strain_bars},
    {"rotation", "stretch, then a quarter turn", rotation},
    {"spheres", "thick-walled sphere under pressure", spheres},
    {"clay", "triaxial tests on clay", clay},
    {"softening_bar", "breaking bar, three meshes", softening_bar},
    {"relaxation", "viscoelastic relaxation", relaxation},
    {"heating", "thermal stress", heating},
    {"found_at_run_time", "library found at run time", found_at_run_time},
    {"threads", "threads", threads},
    {"cut_back", "an increment that is cut", cut_back},
    {"bad_constants", "constants that are refused", bad_constants},
    {"recording", "recording of the calls", recording},
};

}  // namespace ccx
