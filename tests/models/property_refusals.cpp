// What cannot be used is refused by name, and nothing has changed after a refusal (UmatPoint compares STRESS and STATEV
// after every call that was not done).
#include <cfloat>
#include <cmath>
#include <limits>

#include "lode/material/property_places.hpp"
#include "property_suite.hpp"

namespace lode::test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

std::string value_text(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.12g", x);
    return text;
}

void expect_refusal(const UmatPoint& point, const std::vector<std::string>& words) {
    const Answer answer = point.evaluate({});
    EXPECT_EQ(answer.messages.stops, 1);
    EXPECT_EQ(answer.messages.explicit_calls, 0);
    ASSERT_EQ(answer.messages.errors.size(), 1u);
    for (const std::string& word : words)
        EXPECT_NE(answer.first_error().find(word), std::string::npos)
            << "no '" << word << "' in: " << answer.first_error();
    EXPECT_TRUE(answer.tangent.array().isNaN().all()) << "DDSDDE was written";
    EXPECT_EQ(answer.pnewdt, 1.0);
}

// All parameters of the sample written out, the missing ones by their defaults.
Numbers complete_props(const Case& c) {
    Numbers props = c.props();
    const auto places = property_places(*c.model, c.sample->constants, c.sample->constant_count);
    for (std::size_t i = props.size(); i < places.size(); ++i) {
        const lode_parameter& p = *places[i].parameter;
        props.push_back((p.flags & LODE_ZERO_IS_DEFAULT) != 0 ? 0.0 : p.default_value);
    }
    return props;
}

Numbers illegal_values(const lode_parameter& p) {
    Numbers values = {nan, infinity, -infinity};
    const auto add = [&](double x) {
        if (!(x == 0.0 && (p.flags & LODE_ZERO_IS_DEFAULT) != 0)) values.push_back(x);
    };
    if (std::isfinite(p.lower)) {
        add(p.lower - 1.0 - 0.1 * std::abs(p.lower));
        if ((p.flags & LODE_LOWER_OPEN) != 0) add(p.lower);
    }
    if (std::isfinite(p.upper)) {
        add(p.upper + 1.0 + 0.1 * std::abs(p.upper));
        if ((p.flags & LODE_UPPER_OPEN) != 0) add(p.upper);
    }
    if ((p.flags & LODE_INTEGER) != 0) add((std::isfinite(p.lower) ? p.lower : 0.0) + 0.5);
    return values;
}

class Refusals : public testing::TestWithParam<Case> {};

TEST_P(Refusals, EveryIllegalConstant) {
    const Case& c = GetParam();
    const Numbers legal = complete_props(c);
    const int nstatv = static_cast<int>(c.frugal_point().state().size());
    ASSERT_TRUE(UmatPoint(c.material(), c.kind, legal).temperature(c.temperature()).evaluate({}).done())
        << "the sample with all defaults written out";
    const auto places = property_places(*c.model, legal.data(), static_cast<int>(legal.size()));
    for (std::size_t i = 0; i < places.size(); ++i) {
        const lode_parameter& p = *places[i].parameter;
        for (const double value : illegal_values(p)) {
            SCOPED_TRACE(std::string(p.symbol) + " = " + value_text(value));
            Numbers props = legal;
            props[i] = value;
            UmatPoint point(c.material(), c.kind, props);
            expect_refusal(point.nstatv(nstatv), {c.material(), std::string("(") + p.symbol + ",",
                                                  "PROPS(" + std::to_string(i + 1) + ") = " + value_text(value)});
        }
    }
}

TEST_P(Refusals, TooFewConstants) {
    const Case& c = GetParam();
    const int nstatv = static_cast<int>(c.frugal_point().state().size());
    for (int count = 0; count < c.model->required_count; ++count) {
        Numbers props = c.props();
        props.resize(static_cast<std::size_t>(count));
        UmatPoint point(c.material(), c.kind, props);
        expect_refusal(point.nstatv(nstatv), {c.material(), "NPROPS = " + std::to_string(count),
                                              std::string(c.model->parameters[count].symbol) + ","});
    }
}

TEST_P(Refusals, TooFewStateVariables) {
    const Case& c = GetParam();
    UmatPoint point = c.frugal_point();
    const auto needed = static_cast<int>(point.state().size());
    if (needed > 0)
        expect_refusal(point.nstatv(needed - 1),
                       {c.material(), "NSTATV = " + std::to_string(needed - 1), std::to_string(needed)});
}

TEST_P(Refusals, KindsThatAreNotServed) {
    const Case& c = GetParam();
    for (int k = 0; k < kind_count; ++k) {
        const auto kind = static_cast<AnalysisKind>(k);
        if (serves(*c.model, kind)) continue;
        UmatPoint point(c.material(), kind, c.props());
        expect_refusal(point.nstatv(64), {c.material(), c.model->keyword, kind_name(kind)});
    }
    for (const auto& [ndi, nshr] : {std::pair{3, 2}, std::pair{2, 0}, std::pair{2, 3}, std::pair{1, 3}}) {
        UmatPoint point(c.material(), c.kind, c.props());
        expect_refusal(point.nstatv(64).layout(ndi, nshr),
                       {c.material(), "(" + std::to_string(ndi) + "," + std::to_string(nshr) + ")"});
    }
}

TEST_P(Refusals, UnknownKeyword) {
    const Case& c = GetParam();
    UmatPoint point(std::string(c.model->keyword) + "X-LABEL", c.kind, c.props());
    expect_refusal(point.nstatv(64), {std::string(c.model->keyword) + "X", c.model->keyword});
}

// The API answers as the entry point does.
TEST_P(Refusals, RequiredStateGivesTheSameReasons) {
    const Case& c = GetParam();
    char error[512] = "";
    EXPECT_EQ(lode_required_state("NO_SUCH_MODEL", nullptr, 0, 3, 3, error, sizeof error), -1);
    EXPECT_NE(std::string(error).find("NO_SUCH_MODEL"), std::string::npos);
    EXPECT_EQ(lode_required_state(c.material().c_str(), nullptr, 0, 3, 3, error, sizeof error), -1);
    EXPECT_NE(std::string(error).find(c.material()), std::string::npos);
    EXPECT_EQ(lode_required_state(c.material().c_str(), c.sample->constants, c.sample->constant_count, 3, 2, error, 8),
              -1);
    EXPECT_LT(std::string(error).size(), 8u);
}

// Increments that cannot be done ask for smaller ones; STRESS and STATEV stay bit for bit.
class CutBack : public testing::TestWithParam<Case> {
  protected:
    // A point in the middle of its life.
    static UmatPoint loaded_point(const Case& c) {
        Random random(c, 17);
        UmatPoint point = c.point();
        for (const Step& step : random_path(c, random)) point.step(load_of(point, step));
        return point;
    }
    static void expect_cut(const UmatPoint& point, const Load& load) {
        const Answer answer = point.evaluate(load);
        EXPECT_TRUE(answer.cut);
        EXPECT_GT(answer.pnewdt, 0.0);
        EXPECT_LT(answer.pnewdt, 1.0);
        EXPECT_EQ(answer.messages.stops, 0);
    }
};

TEST_P(CutBack, NonFiniteInput) {
    const Case& c = GetParam();
    const UmatPoint point = loaded_point(c);
    const auto n = static_cast<std::size_t>(point.size());
    for (const double bad : {nan, infinity, -infinity})
        for (std::size_t i = 0; i < n; ++i) {
            Numbers dstran(n, 0.1 * c.scale());
            dstran[i] = bad;
            expect_cut(point, {.dstran = dstran});
            UmatPoint stressed = point;
            Numbers stress = point.stress();
            stress[i] = bad;
            expect_cut(stressed.stress(stress), {.dstran = Numbers(n, 0.1 * c.scale())});
        }
    expect_cut(point, {.dtime = nan});
    // A material without thermal expansion may ignore the temperature.
    const Answer hot = point.evaluate({.dtemp = nan});
    EXPECT_TRUE(hot.cut ||
                (std::isfinite(distance(hot.stress, hot.stress)) && std::isfinite(distance(hot.state, hot.state))))
        << "DTEMP = NaN went through";
    if (!c.reads_deformation) return;
    const int size = c.kind == AnalysisKind::plane_stress ? 2 : c.kind == AnalysisKind::uniaxial ? 1 : 3;
    for (const double bad : {nan, infinity, -infinity})
        for (int i = 0; i < size; ++i) {
            Matrix3d f = point.deformation_gradient();
            f(i, i) = bad;
            expect_cut(point, {.dfgrd1 = f});
        }
}

TEST_P(CutBack, InvertedElement) {
    const Case& c = GetParam();
    if (!c.reads_deformation) return;
    const UmatPoint point = loaded_point(c);
    for (const double stretch : {0.0, -1e-12, -1.0, -1e6})
        expect_cut(point, {.dfgrd1 = Eigen::Vector3d(stretch, 1.0, 1.0).asDiagonal()});
}

// Whatever the size of the increment, as long as the square of the stress is a number: a finite answer or a request for
// a smaller one, never more.
TEST_P(CutBack, HugeIncrements) {
    const Case& c = GetParam();
    const UmatPoint point = loaded_point(c);
    Random random(c, 23);
    for (double size = 1.0; size < 1e100; size *= 31.0)
        for (int repeat = 0; repeat < 4; ++repeat) {
            const Numbers direction = random.direction(static_cast<std::size_t>(point.size()));
            Load load{.dstran = scaled(direction, size * c.scale())};
            if (c.reads_deformation)
                load.dfgrd1 =
                    Matrix3d::Identity() + strain_tensor(scaled(load.dstran, repeat % 2 == 0 ? 1.0 : -1.0), c.kind);
            const Answer answer = point.evaluate(load);
            EXPECT_EQ(answer.messages.stops, 0) << answer.first_error();
            if (answer.cut) continue;
            EXPECT_TRUE(std::isfinite(largest(answer.stress)) && std::isfinite(distance(answer.stress, answer.stress)))
                << "size " << size;
            EXPECT_TRUE(std::isfinite(distance(answer.state, answer.state))) << "size " << size;
            EXPECT_TRUE(answer.tangent.allFinite()) << "size " << size;
        }
}

// Hosts enter with 1, a huge number or (CalculiX) -1; a smaller request already there stays.
TEST_P(CutBack, TimeStepConvention) {
    const Case& c = GetParam();
    const UmatPoint point = loaded_point(c);
    const auto n = static_cast<std::size_t>(point.size());
    const Numbers impossible(n, nan), small(n, 1e-6 * c.scale());
    for (const double entry : {1.0, DBL_MAX, -1.0}) {
        const Answer refused = point.evaluate({.dstran = impossible, .pnewdt = entry});
        EXPECT_GT(refused.pnewdt, 0.0);
        EXPECT_LT(refused.pnewdt, 1.0);
        EXPECT_EQ(point.evaluate({.dstran = small, .pnewdt = entry}).pnewdt, entry);
    }
    const Answer waiting = point.evaluate({.dstran = impossible, .pnewdt = 1e-3});
    EXPECT_EQ(waiting.pnewdt, 1e-3);
    EXPECT_TRUE(identical(waiting.stress, point.stress()));
    EXPECT_TRUE(identical(waiting.state, point.state()));
}

// Some hosts leave these uninitialised: a material that does not need them answers the same, bit for bit; one that does
// refuses, asks for a smaller increment or answers.
TEST_P(CutBack, UninitialisedOptionalArguments) {
    const Case& c = GetParam();
    const UmatPoint point = loaded_point(c);
    const Load load{.dstran = Numbers(static_cast<std::size_t>(point.size()), 0.05 * c.scale())};
    const Answer normal = point.evaluate(load);
    for (const double celent : {nan, 0.0, -1.0}) {
        const Answer answer = UmatPoint(point).celent(celent).evaluate(load);
        if (!c.has_trait(LODE_USES_CELENT)) {
            EXPECT_TRUE(identical(answer.stress, normal.stress));
        } else if (answer.done()) {
            EXPECT_TRUE(std::isfinite(distance(answer.stress, answer.stress)));
        }
    }
    Load with_nan = load;
    with_nan.dpred = {nan};
    const Answer answer = UmatPoint(point).fields({nan}).evaluate(with_nan);
    EXPECT_TRUE(!answer.done() || identical(answer.stress, normal.stress)) << "PREDEF is read";
}

LODE_FOR_ALL_CASES(Refusals);
LODE_FOR_ALL_CASES(CutBack);

}  // namespace
}  // namespace lode::test
