// What every model promises, checked for every model of the registry, every sample of its description and every kind
// the sample serves. Adding a model adds its tests: nothing here knows a model by name, and exceptions follow from the
// description's traits or from what the model is seen to read.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "umat_point.hpp"

namespace lode::test {

// One material of the registry in one kind.
struct Case {
    const lode_model* model = nullptr;
    const lode_sample* sample = nullptr;
    AnalysisKind kind = AnalysisKind::solid;
    bool reads_deformation = false;  // STRESS answers to DFGRD1 (some laws do by option, without the trait)
    bool reads_field = false;        // STRESS answers to the value of PREDEF(1), not only to its change
    double stiffness = 0.0;          // largest entry of the virgin DDSDDE, in any kind of the sample

    bool has_trait(unsigned trait) const { return (model->traits & trait) != 0; }
    bool is_cohesive() const { return lode::is_cohesive(kind); }
    // A law of the deformation gradient that is not derived from an energy.
    bool is_total_law() const { return reads_deformation && !has_trait(LODE_FINITE_STRAIN); }
    double scale() const { return sample->strain_scale; }
    // The stress of an elastic increment of the sample's strain: what rounding errors are measured against.
    double stress_scale() const { return stiffness * scale(); }
    // TEMP at the start: equations of state mean absolute temperatures.
    double temperature() const { return has_trait(LODE_EQUATION_OF_STATE) ? 300.0 : 0.0; }
    std::string material() const;  // e.g. "ISO_PLASTIC-STEEL"
    std::string name() const;      // e.g. "ISO_PLASTIC/STEEL/solid"
    Numbers props() const;
    // After a first call with a zero increment, in which some laws set themselves up. NSTATV is what the description
    // lists, so that optional entries are kept as well, or just what the material needs.
    UmatPoint point() const;
    UmatPoint frugal_point() const;
};
const std::vector<Case>& all_cases();
std::vector<Case> cases_in(unsigned kinds);
void PrintTo(const Case& c, std::ostream* out);
std::string case_name(const testing::TestParamInfo<Case>& info);
const char* short_name(AnalysisKind kind);
// The case of the same material in another kind, or null.
const Case* find_case(const Case& c, AnalysisKind kind);

#define LODE_FOR_ALL_CASES(Suite) INSTANTIATE_TEST_SUITE_P(Registry, Suite, testing::ValuesIn(all_cases()), case_name)

// Reproducible everywhere: the generator is the standard's, the distributions are ours.
class Random {
  public:
    Random(const Case& c, std::uint64_t seed);  // the same seed gives each case a sequence of its own
    double uniform(double low, double high);
    double log_uniform(double low, double high);
    bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
    // A unit vector of `n` components.
    Numbers direction(std::size_t n);
    // A rotation by up to `angle` that the kind can have: any in 3D, about axis 3 in the plane kinds.
    Matrix3d rotation(AnalysisKind kind, double angle);

  private:
    std::uint64_t next();
    std::uint64_t state_;
};

// One increment: the host's frame turns by `rotation`, then the strain follows, in the axes of the end.
struct Step {
    Numbers strain;
    Matrix3d rotation = Matrix3d::Identity();
};
// F at the end of the increment: exp(strain) rotation F. The components that the kind does not have are a guess.
Matrix3d advanced(const Matrix3d& f, const Step& step, AnalysisKind kind);
// The increment for laws of either kind: DSTRAN, DROT and DFGRD1 agree.
Load load_of(const UmatPoint& point, const Step& step);
// Loads beyond the scale in one random direction, unloads, then goes on in others.
std::vector<Step> random_path(const Case& c, Random& random);
Numbers scaled(const Numbers& v, double factor);

// det F, with the thickness stretch of plane stress from STATEV; 1 for laws of small strain.
double jacobian(const Case& c, const UmatPoint& point);
double jacobian(const Case& c, const Numbers& state, const Matrix3d& f);

}  // namespace lode::test
