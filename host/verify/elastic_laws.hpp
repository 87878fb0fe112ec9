// Closed-form Cauchy stresses of the elastic laws under stretch along the axes and under simple shear, with the free
// expansion `lr` = exp(alpha dT) (Nairn, chapter 11; sections 9.6-9.8).
#ifndef LODE_HOST_VERIFY_ELASTIC_LAWS_HPP
#define LODE_HOST_VERIFY_ELASTIC_LAWS_HPP

#include <array>
#include <optional>

#include "../replay/analysis.hpp"
#include "taylor.hpp"

namespace lode::host {

using Stretches = std::array<Taylor, 3>;

struct LameConstants {
    double lambda = 0, shear = 0;
    static LameConstants from_young_poisson(double young, double poisson);
};

// U'(J) of the dilatational energies: 0 k/2 (J - 1/J), 1 k (J - 1), 2 k ln(J)/J.
struct Dilatation {
    int option = 0;
    double modulus = 0;
    Taylor derivative(const Taylor& volume) const;
};

class ElasticLaw {
  public:
    virtual ~ElasticLaw() = default;
    // Principal stresses under F = diag(a).
    virtual Stretches stress(const Stretches& a, const Taylor& lr) const = 0;
    // Stress under F = I + g e1 e2.
    virtual Matrix3 shear_stress(double g, double lr) const = 0;
    // Lateral stretch of free tension, where there is a formula for it.
    virtual std::optional<Taylor> free_lateral_stretch(const Taylor& /*a*/, const Taylor& /*lr*/) const { return {}; }
    // SSE is a stored energy, whose change is the stress power.
    virtual bool has_energy() const { return true; }
};

// F22 of the plane strain tension with stress22 = 0: the formula, or Newton's method in a bracket around 1. NaN if
// there is none.
Taylor lateral_stretch(const ElasticLaw& law, const Taylor& a, const Taylor& lr);
// The same without the formula.
Taylor solved_lateral_stretch(const ElasticLaw& law, const Taylor& a, const Taylor& lr);

// C (V - I - er I) with er = ln lr (11.13), objective in V.
class LowStrain : public ElasticLaw {
  public:
    explicit LowStrain(const LameConstants& c) : c_(c) {}
    Stretches stress(const Stretches& a, const Taylor& lr) const override;
    Matrix3 shear_stress(double g, double lr) const override;
    std::optional<Taylor> free_lateral_stretch(const Taylor& a, const Taylor& lr) const override;
    bool has_energy() const override { return false; }

  protected:
    Stretches of_strain(const Stretches& strain, const Taylor& lr) const;
    LameConstants c_;
};

// The same of the small strain F - I: shear alone gives stress12 = G g.
class SmallStrain : public LowStrain {
  public:
    using LowStrain::LowStrain;
    Matrix3 shear_stress(double g, double lr) const override;
    bool has_energy() const override { return true; }
};

// C (ln a - er): increments of logarithmic strain. In shear what the host's rate makes of it: Jaumann (implicit hosts)
// or Green-Naghdi (explicit hosts).
class LogarithmicIncrements : public LowStrain {
  public:
    LogarithmicIncrements(const LameConstants& c, bool green_naghdi) : LowStrain(c), green_naghdi_(green_naghdi) {}
    Stretches stress(const Stretches& a, const Taylor& lr) const override;
    Matrix3 shear_stress(double g, double lr) const override;
    std::optional<Taylor> free_lateral_stretch(const Taylor& a, const Taylor& lr) const override;

  private:
    bool green_naghdi_;
};

// [G1 dev(bb) + G2 dev(tr(bb) bb - bb^2)]/Js + U' I, bb = b*/Js^(2/3).
class MooneyRivlinLaw : public ElasticLaw {
  public:
    MooneyRivlinLaw(double G1, double G2, const Dilatation& u) : G1_(G1), G2_(G2), u_(u) {}
    Stretches stress(const Stretches& a, const Taylor& lr) const override;
    Matrix3 shear_stress(double g, double lr) const override;

  private:
    double G1_, G2_;
    Dilatation u_;
};

// G (b* - I)/Js + U' I.
class NeoHookeanLaw : public ElasticLaw {
  public:
    NeoHookeanLaw(const LameConstants& c, int option) : c_(c), u_{option, c.lambda} {}
    Stretches stress(const Stretches& a, const Taylor& lr) const override;
    Matrix3 shear_stress(double g, double lr) const override;
    std::optional<Taylor> free_lateral_stretch(const Taylor& a, const Taylor& lr) const override;

  private:
    LameConstants c_;
    Dilatation u_;
};

// 2G/Js (V*^2 - V*) + U' I.
class CorotatedLaw : public ElasticLaw {
  public:
    CorotatedLaw(const LameConstants& c, int option) : c_(c), u_{option, c.lambda} {}
    Stretches stress(const Stretches& a, const Taylor& lr) const override;
    Matrix3 shear_stress(double g, double lr) const override;
    std::optional<Taylor> free_lateral_stretch(const Taylor& a, const Taylor& lr) const override;

  private:
    LameConstants c_;
    Dilatation u_;
};

}  // namespace lode::host

#endif
