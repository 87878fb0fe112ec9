#include "solution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "../replay/kinematics.hpp"
#include "../status.hpp"
#include "../text.hpp"
#include "elastic_laws.hpp"

namespace lode::host {
namespace {

constexpr std::array<std::string_view, 7> keywords{"ISO_ELASTIC", "MOONEY_RIVLIN", "NEO_HOOKEAN", "COROT_NEO_HOOKEAN",
                                                   "DISNEY_SNOW", "VISCOELASTIC",  "VISCO_HYPER"};

// Constants by their place on the model's reference page, from 1, with the defaults of what is left out.
class Constants {
  public:
    explicit Constants(const std::vector<double>& values) : values_(values) {}
    double at(std::size_t i, double missing = 0) const { return i <= values_.size() ? values_[i - 1] : missing; }
    int code(std::size_t i, int missing = 0) const { return static_cast<int>(at(i, missing)); }
    bool finite() const {
        return std::all_of(values_.begin(), values_.end(), [](double x) { return std::abs(x) < 1e300; });
    }
    bool any(std::size_t first, std::size_t last) const {
        for (std::size_t i = first; i <= last; ++i)
            if (at(i) != 0) return true;
        return false;
    }

  private:
    const std::vector<double>& values_;
};

// Sum of modulus exp(-t/time) over the terms, on top of the long-time modulus.
struct Relaxation {
    struct Term {
        double modulus, time;
    };
    double steady = 0;
    std::vector<Term> terms;

    double modulus(double t) const {
        return std::accumulate(terms.begin(), terms.end(), steady,
                               [t](double sum, const Term& k) { return sum + k.modulus * std::exp(-t / k.time); });
    }
    // Response to the strain t.
    double ramp(double t) const {
        return std::accumulate(terms.begin(), terms.end(), steady * t, [t](double sum, const Term& k) {
            return sum - k.modulus * k.time * std::expm1(-t / k.time);
        });
    }
    // Response to the strain sin(w t).
    double sine(double w, double t) const {
        double sum = steady * std::sin(w * t);
        for (const auto& [modulus, time] : terms) {
            const double x = w * time;
            sum += modulus * x / (1 + x * x) * (std::cos(w * t) + x * std::sin(w * t) - std::exp(-t / time));
        }
        return sum;
    }
};

class ElasticSolution final : public ManufacturedSolution {
  public:
    ElasticSolution(const ManufacturedMotion& motion, double expansion, int order, std::unique_ptr<ElasticLaw> law)
        : ManufacturedSolution(motion, expansion, order,
                               law->has_energy() && !motion.expands() && motion.motion != Motion::held_shear),
          law_(std::move(law)) {}

    Taylor lateral(double t) const override {
        return motion_.motion == Motion::free_tension ? lateral_stretch(*law_, motion_.amount(t), motion_.residual(t))
                                                      : Taylor(1);
    }
    Matrix3 stress(double t) const override {
        const Taylor amount = motion_.amount(t), lr = motion_.residual(t);
        if (motion_.is_shear()) return law_->shear_stress(amount.value, lr.value);
        const Stretches s = law_->stress({amount, lateral(t), 1}, lr);
        return Eigen::Vector3d(s[0].value, s[1].value, s[2].value).asDiagonal();
    }

  private:
    std::unique_ptr<ElasticLaw> law_;
};

// sigma = int (K - 2/3 G) tr(deps) I + 2 G deps under small strain: linear ramps and sines.
class ViscoelasticSolution final : public ManufacturedSolution {
  public:
    ViscoelasticSolution(const ManufacturedMotion& motion, int order, Relaxation bulk, Relaxation shear)
        : ManufacturedSolution(motion, 0, order, true), bulk_(std::move(bulk)), shear_(std::move(shear)) {}

    Matrix3 stress(double t) const override {
        const double k = response(bulk_, t), g = response(shear_, t);
        Matrix3 stress = Matrix3::Zero();
        if (motion_.is_shear()) stress(0, 1) = stress(1, 0) = g;
        else stress.diagonal() << k + 4 * g / 3, k - 2 * g / 3, k - 2 * g / 3;
        return stress;
    }

  private:
    double response(const Relaxation& modulus, double t) const {
        const double size = motion_.is_shear() ? motion_.shear : motion_.stretch - 1;
        return motion_.is_sinusoidal() ? size * modulus.sine(motion_.angular_frequency, t)
                                       : size / motion_.duration * modulus.ramp(t);
    }
    Relaxation bulk_, shear_;
};

// The stress of sudden shear, all of it deviatoric, relaxes with g(t).
class HeldShearSolution final : public ManufacturedSolution {
  public:
    HeldShearSolution(const ManufacturedMotion& motion, const MooneyRivlinLaw& law, Relaxation share)
        : ManufacturedSolution(motion, 0, 0, false),
          instantaneous_(law.shear_stress(motion.shear, 1)),
          share_(std::move(share)) {}

    Matrix3 stress(double t) const override {
        return t > 0 ? (share_.modulus(t) * instantaneous_).eval() : Matrix3::Zero();
    }

  private:
    Matrix3 instantaneous_;
    Relaxation share_;
};

class Maker {
  public:
    Maker(const ManufacturedMotion& motion, const std::vector<double>& constants, std::string keyword, Entry entry)
        : motion_(motion), c_(constants), keyword_(std::move(keyword)), entry_(entry) {}

    std::shared_ptr<const ManufacturedSolution> make() const {
        if (!c_.finite()) refuse("a constant is not a number");
        if (keyword_ == "ISO_ELASTIC") return iso_elastic();
        if (keyword_ == "MOONEY_RIVLIN") return mooney_rivlin();
        if (keyword_ == "NEO_HOOKEAN") return elastic(4, 5, std::make_unique<NeoHookeanLaw>(lame(), c_.code(3)));
        if (keyword_ == "COROT_NEO_HOOKEAN")
            return elastic(4, 5, std::make_unique<CorotatedLaw>(lame(), c_.code(3, 1)));
        if (keyword_ == "DISNEY_SNOW") return disney_snow();
        if (keyword_ == "VISCOELASTIC") return viscoelastic();
        if (keyword_ == "VISCO_HYPER") return visco_hyper();
        refuse(fmt::format("there is no closed form for {}; there are for {}", keyword_, joined(keywords)));
    }

  private:
    [[noreturn]] void refuse(const std::string& why) const { throw BadDeck(motion_.location + ": " + why); }
    [[noreturn]] void refuse_motion(const std::string& legal) const {
        refuse(fmt::format("there is no closed form for {} under {} with drive = \"{}\"; there are for {}", keyword_,
                           motion_.name(), motion_.drive == Drive::gradient ? "gradient" : "strain", legal));
    }
    LameConstants lame() const { return LameConstants::from_young_poisson(c_.at(1), c_.at(2)); }

    void needs_gradient() const {
        if (motion_.drive == Drive::strain)
            refuse_motion("all motions with drive = \"gradient\": this material reads the deformation gradient");
    }
    std::shared_ptr<const ManufacturedSolution> elastic(std::size_t thermal, std::size_t moisture,
                                                        std::unique_ptr<ElasticLaw> law) const {
        needs_gradient();
        return finished(thermal, moisture, 0, std::move(law));
    }
    std::shared_ptr<const ManufacturedSolution> finished(std::size_t thermal, std::size_t moisture, int order,
                                                         std::unique_ptr<ElasticLaw> law) const {
        const bool heats = motion_.cause == ResidualCause::temperature;
        const double expansion = c_.at(heats ? thermal : moisture);
        if (motion_.expands() && expansion == 0)
            refuse(fmt::format("residual_stretch = {} needs a {} of the material: PROPS({}) is 0",
                               motion_.residual_stretch, heats ? "thermal expansion" : "expansion per unit of field 1",
                               heats ? thermal : moisture));
        return std::make_shared<ElasticSolution>(motion_, expansion, order, std::move(law));
    }

    std::shared_ptr<const ManufacturedSolution> iso_elastic() const {
        if (c_.any(6, 6)) refuse("there is no closed form for ISO_ELASTIC with OOP, PROPS(6)");
        const bool total = c_.code(5) != 0;
        if (motion_.drive == Drive::strain) {
            if (total)
                refuse_motion("the drive \"gradient\": with KIN = 1, 2 this material reads the deformation gradient");
            if (motion_.motion == Motion::held_shear || motion_.expands())
                refuse_motion("motions without a jump and without expansion");
            return finished(3, 4, 0, std::make_unique<SmallStrain>(lame()));
        }
        if (total) return finished(3, 4, 0, std::make_unique<LowStrain>(lame()));
        if (motion_.motion == Motion::held_shear)
            refuse_motion("the other motions: with KIN = 0 the stress after a jump depends on how the host turns it");
        // Implicit hosts turn the stress by Hughes and Winget's rotation and add increments of the middle: first order.
        const bool explicit_host = entry_ == Entry::vumat;
        const int order = !motion_.is_shear() ? 0 : explicit_host ? 2 : 1;
        return finished(3, 4, order, std::make_unique<LogarithmicIncrements>(lame(), explicit_host));
    }

    std::shared_ptr<const ManufacturedSolution> mooney_rivlin() const {
        return elastic(5, 6, std::make_unique<MooneyRivlinLaw>(c_.at(1), c_.at(3), Dilatation{c_.code(4), c_.at(2)}));
    }

    std::shared_ptr<const ManufacturedSolution> disney_snow() const {
        std::unique_ptr<ElasticLaw> law;
        if (c_.code(6) == 0) law = std::make_unique<CorotatedLaw>(lame(), c_.code(7, 1));
        else law = std::make_unique<NeoHookeanLaw>(lame(), c_.code(7, 1));
        auto solution = elastic(8, 9, std::move(law));
        // The closed form is elastic: no principal stretch of V/lr may reach the limits.
        const double least = 1 - c_.at(3, 0.025), most = 1 + c_.at(4, 0.0075);
        constexpr int samples = 1000;
        for (int i = 1; i <= samples; ++i) {
            const double t = motion_.duration * i / samples;
            const Matrix3 V = polar(solution->gradient(t)).left_stretch / motion_.residual(t).value;
            const auto stretches = Eigen::SelfAdjointEigenSolver<Matrix3>(V, Eigen::EigenvaluesOnly).eigenvalues();
            if (stretches[0] < least || stretches[2] > most)
                refuse(
                    fmt::format("the closed form for DISNEY_SNOW is that of its elastic range, stretches {} to {} "
                                "(1 - THC, 1 + THS); this motion has {:.6g} at t = {:.6g}",
                                least, most, stretches[0] < least ? stretches[0] : stretches[2], t));
        }
        return solution;
    }

    int terms(std::size_t i) const {
        if (!(c_.at(i) >= 0 && c_.at(i) <= 30)) refuse(fmt::format("PROPS({}) has to be a number of terms, 0..30", i));
        return c_.code(i);
    }
    // Pairs of modulus and time from place `first` on.
    Relaxation series(double steady, std::size_t first, int count) const {
        Relaxation r{steady, {}};
        for (int k = 0; k < count; ++k, first += 2) r.terms.push_back({c_.at(first), c_.at(first + 1)});
        return r;
    }

    std::shared_ptr<const ManufacturedSolution> viscoelastic() const {
        const int shear_terms = terms(3), bulk_terms = terms(4);
        const auto after = 5 + 2 * static_cast<std::size_t>(shear_terms),
                   rest = after + 2 * static_cast<std::size_t>(bulk_terms);
        const int recursion = c_.code(rest + 2);
        // PLAW, TSHIFT, CSHIFT, TAUMS, C5, NBT, NBC.
        if (c_.any(rest + 3, rest + 4) || c_.any(rest + 8, rest + 8) || c_.any(rest + 12, rest + 13) ||
            c_.any(rest + 15, rest + 16))
            refuse("there is no closed form for VISCOELASTIC with a pressure law, a shift or mechanosorption");
        const bool tension =
            motion_.motion == Motion::constrained_tension || motion_.motion == Motion::sinusoidal_tension;
        const bool shear = motion_.motion == Motion::linear_shear || motion_.motion == Motion::sinusoidal_shear;
        if (motion_.drive == Drive::gradient || motion_.expands() || !(tension || shear))
            refuse_motion(
                "constrained_tension, sinusoidal_tension, linear_shear, sinusoidal_shear with drive = \"strain\" and "
                "without expansion");
        // METH: constant rate, midpoint, trapezoid, explicit.
        constexpr std::array<int, 4> orders{2, 2, 2, 1};
        const bool exact = recursion == 0 && !motion_.is_sinusoidal();
        return std::make_shared<ViscoelasticSolution>(
            motion_, exact ? 0 : orders.at(static_cast<std::size_t>(std::clamp(recursion, 0, 3))),
            series(c_.at(1), after, bulk_terms), series(c_.at(2), 5, shear_terms));
    }

    std::shared_ptr<const ManufacturedSolution> visco_hyper() const {
        const int count = terms(4);
        const auto rest = 5 + 2 * static_cast<std::size_t>(count);  // ALPHA, BETA, UJ, METH, TSHIFT, ...
        MooneyRivlinLaw law(c_.at(1), c_.at(3), {c_.code(rest + 2), c_.at(2)});
        if (count == 0) return elastic(rest, rest + 1, std::make_unique<MooneyRivlinLaw>(law));
        if (c_.any(rest + 4, rest + 4) || c_.any(rest + 8, rest + 8) || c_.any(rest + 12, rest + 13))
            refuse("there is no closed form for VISCO_HYPER with a shift or mechanosorption");
        if (motion_.drive == Drive::strain || motion_.expands() || motion_.motion != Motion::held_shear)
            refuse_motion("held_shear with drive = \"gradient\" without expansion, and for all motions with NG = 0");
        Relaxation share = series(1, 5, count);
        for (const auto& term : share.terms) share.steady -= term.modulus;
        return std::make_shared<HeldShearSolution>(motion_, law, std::move(share));
    }

    const ManufacturedMotion& motion_;
    Constants c_;
    std::string keyword_;
    Entry entry_;
};

}  // namespace

double ManufacturedSolution::residual_change_of(double stretch) const {
    return motion_.expands() ? std::log(stretch) / expansion_ : 0;
}

Matrix3 ManufacturedSolution::gradient(double t) const {
    Matrix3 F = Matrix3::Identity();
    const double amount = motion_.amount(t).value;
    if (motion_.is_shear()) F(0, 1) = amount;
    else F.diagonal() << amount, lateral(t).value, 1;
    return F;
}

Matrix3 ManufacturedSolution::small_strain(double t) const {
    const Matrix3 h = gradient(t) - Matrix3::Identity();
    return 0.5 * (h + h.transpose());
}

double ManufacturedSolution::stress_power(double t) const {
    const Taylor amount = motion_.amount(t);
    const Matrix3 sigma = stress(t);
    if (motion_.is_shear()) return sigma(0, 1) * amount.first;
    const double rate = sigma(0, 0) * amount.first;
    // J/a; stress22 does no work where direction 2 moves.
    return motion_.drive == Drive::gradient ? lateral(t).value * rate : rate;
}

Eigen::Vector3d ManufacturedSolution::body_force(double t) const {
    return {motion_.amount(t).second, lateral(t).second, 0};
}

Matrix3 ManufacturedSolution::tractions(double t) const {
    // Normals n = F^-T N/|F^-T N|; under small strain they stay.
    Matrix3 normals = Matrix3::Identity();
    if (motion_.drive == Drive::gradient) normals = gradient(t).inverse().transpose().colwise().normalized();
    return stress(t) * normals;
}

std::shared_ptr<const ManufacturedSolution> manufactured_solution(const std::string& material,
                                                                  const std::vector<double>& constants,
                                                                  const ManufacturedMotion& motion, Kind kind,
                                                                  Entry entry) {
    const auto refuse = [&](const std::string& why) { throw BadDeck(motion.location + ": " + why); };
    if (kind != Kind::solid && kind != Kind::plane_strain && kind != Kind::axisymmetric)
        refuse(fmt::format("there are no manufactured motions in {}; there are in 3d, plane_strain, axisymmetric",
                           name_of(kind)));
    const std::string name = motion.law ? *motion.law : material;
    const std::vector<double>& values = motion.law ? motion.law_constants : constants;
    auto solution = Maker(motion, values, upper(name.substr(0, name.find('-'))), entry).make();
    if (motion.motion == Motion::free_tension)
        for (const double share : {0.01, 0.25, 0.5, 0.75, 1.0})
            if (!std::isfinite(solution->lateral(share * motion.duration).value))
                refuse(fmt::format("no lateral stretch frees direction 2 of stress at t = {:.6g}",
                                   share * motion.duration));
    return solution;
}

}  // namespace lode::host
