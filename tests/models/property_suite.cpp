#include "property_suite.hpp"

#include <Eigen/Geometry>
#include <cctype>
#include <cmath>
#include <limits>
#include <ostream>
#include <string_view>

namespace lode::test {

std::string Case::material() const { return std::string(model->keyword) + "-" + sample->label; }
std::string Case::name() const { return std::string(model->keyword) + "/" + sample->label + "/" + short_name(kind); }
Numbers Case::props() const { return {sample->constants, sample->constants + sample->constant_count}; }
UmatPoint Case::point() const {
    UmatPoint point(material(), kind, props());
    point.temperature(temperature());
    const int needed = static_cast<int>(point.state().size());
    for (int i = needed; i < model->state_count; ++i) {
        Numbers state = point.state();
        state.push_back(model->state[i].initial);
        point.state(state);
    }
    point.step({.dtime = 0.0});
    return point;
}
UmatPoint Case::frugal_point() const {
    UmatPoint point(material(), kind, props());
    point.temperature(temperature()).step({.dtime = 0.0});
    return point;
}

const char* short_name(AnalysisKind kind) {
    static constexpr const char* names[] = {"solid",    "plane_strain", "plane_stress",
                                            "uniaxial", "cohesive_2d",  "cohesive_3d"};
    return names[static_cast<int>(kind)];
}

void PrintTo(const Case& c, std::ostream* out) { *out << c.name(); }

std::string case_name(const testing::TestParamInfo<Case>& info) {
    std::string name = info.param.name();
    for (char& c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    return name;
}

namespace {

Case make_case(const lode_model& model, const lode_sample& sample, AnalysisKind kind) {
    Case c{&model, &sample, kind};
    const UmatPoint point = c.point();
    const Answer virgin = point.evaluate({.dtime = 0.0});
    c.stiffness = virgin.tangent.cwiseAbs().maxCoeff();
    if (!c.is_cohesive()) {
        const Numbers strain = scaled(Numbers(static_cast<std::size_t>(point.size()), 0.25), sample.strain_scale);
        const Matrix3d f = advanced(Matrix3d::Identity(), {strain}, kind);
        const Answer stretched = point.evaluate({.dfgrd1 = f});
        c.reads_deformation = distance(stretched.stress, virgin.stress) > 0.0;
        const Load strained{.dstran = strain};
        c.reads_field =
            distance(UmatPoint(point).fields({0.3}).evaluate(strained).stress, point.evaluate(strained).stress) > 0.0;
    }
    return c;
}

std::vector<Case> make_cases() {
    std::vector<Case> cases;
    for (int m = 0; m < lode_model_count(); ++m) {
        const lode_model& model = *lode_model_at(m);
        for (int s = 0; s < model.sample_count; ++s) {
            const std::size_t first = cases.size();
            double stiffness = 0.0;
            for (int k = 0; k < kind_count; ++k) {
                const auto kind = static_cast<AnalysisKind>(k);
                if (!serves(model, kind) || (model.samples[s].kinds & kind_bit(kind)) == 0) continue;
                cases.push_back(make_case(model, model.samples[s], kind));
                stiffness = std::max(stiffness, cases.back().stiffness);
            }
            // A condensed kind is softer, but its rounding errors are those of the solid.
            for (std::size_t i = first; i < cases.size(); ++i) cases[i].stiffness = stiffness;
        }
    }
    return cases;
}

}  // namespace

const std::vector<Case>& all_cases() {
    static const std::vector<Case> cases = make_cases();
    return cases;
}

std::vector<Case> cases_in(unsigned kinds) {
    std::vector<Case> some;
    for (const Case& c : all_cases())
        if ((kind_bit(c.kind) & kinds) != 0) some.push_back(c);
    return some;
}

const Case* find_case(const Case& c, AnalysisKind kind) {
    for (const Case& other : all_cases())
        if (other.sample == c.sample && other.kind == kind) return &other;
    return nullptr;
}

// SplitMix64: any seed is a good one.
Random::Random(const Case& c, std::uint64_t seed) : state_(seed) {
    for (const char letter : c.name()) state_ = (state_ ^ static_cast<unsigned char>(letter)) * 0x100000001B3u;
}
std::uint64_t Random::next() {
    state_ += 0x9E3779B97F4A7C15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}
double Random::uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(next() >> 11) * 0x1p-53);
}
double Random::log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
Numbers Random::direction(std::size_t n) {
    Numbers d(n);
    double square = 0.0;
    while (square < 0.01 || square > 1.0) {
        square = 0.0;
        for (double& x : d) {
            x = uniform(-1.0, 1.0) / std::sqrt(static_cast<double>(n) / 2.0);
            square += x * x;
        }
    }
    return scaled(d, 1.0 / std::sqrt(square));
}
Matrix3d Random::rotation(AnalysisKind kind, double angle) {
    if (lode::is_cohesive(kind) || kind == AnalysisKind::uniaxial) return Matrix3d::Identity();
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
    if (kind == AnalysisKind::solid) {
        const Numbers d = direction(3);
        axis = {d[0], d[1], d[2]};
    }
    return Eigen::AngleAxisd(uniform(-angle, angle), axis).toRotationMatrix();
}

Numbers scaled(const Numbers& v, double factor) {
    Numbers r = v;
    for (double& x : r) x *= factor;
    return r;
}

Matrix3d advanced(const Matrix3d& f, const Step& step, AnalysisKind kind) {
    if (is_cohesive(kind)) return f;
    Matrix3d d = strain_tensor(step.strain, kind);
    if (kind == AnalysisKind::plane_stress) d(2, 2) = -(d(0, 0) + d(1, 1));
    if (kind == AnalysisKind::uniaxial) d(1, 1) = d(2, 2) = -0.5 * d(0, 0);
    Matrix3d exponential = Matrix3d::Identity(), term = Matrix3d::Identity();
    for (int k = 1; k < 60 && term.cwiseAbs().maxCoeff() > 1e-18; ++k) {
        term = term * d / k;
        exponential += term;
    }
    return exponential * step.rotation * f;
}

Load load_of(const UmatPoint& point, const Step& step) {
    return {.dstran = step.strain,
            .dfgrd1 = advanced(point.deformation_gradient(), step, point.kind()),
            .drot = step.rotation};
}

std::vector<Step> random_path(const Case& c, Random& random) {
    const auto n = static_cast<std::size_t>(components(c.kind));
    std::vector<Step> path;
    const auto leg = [&](const Numbers& direction, double length, int steps) {
        for (int i = 0; i < steps; ++i)
            path.push_back({scaled(direction, random.uniform(0.6, 1.4) * length / steps), Matrix3d::Identity()});
    };
    Numbers first = random.direction(n);
    // What a cohesive law is for is opening; closing needs no damage.
    if (c.is_cohesive()) first[0] = std::abs(first[0]);
    const double amplitude = c.scale() * random.uniform(0.8, 1.6);
    leg(first, amplitude, 6);
    leg(first, -0.2 * amplitude, 3);
    leg(first, 0.5 * amplitude, 4);
    leg(random.direction(n), 0.7 * amplitude, 4);
    leg(random.direction(n), 0.3 * amplitude, 2);
    return path;
}

double jacobian(const Case& c, const Numbers& state, const Matrix3d& f) {
    if (!c.has_trait(LODE_FINITE_STRAIN)) return 1.0;
    if (c.kind != AnalysisKind::plane_stress) return f.determinant();
    double thickness = std::numeric_limits<double>::quiet_NaN();
    for (int i = 0; i < c.model->state_count; ++i)
        if (std::string_view(c.model->state[i].name) == "F33M1") thickness = 1.0 + state[static_cast<std::size_t>(i)];
    return f.topLeftCorner<2, 2>().determinant() * thickness;
}
double jacobian(const Case& c, const UmatPoint& point) {
    return jacobian(c, point.state(), point.deformation_gradient());
}

}  // namespace lode::test
