// ISO_PLASTIC: von Mises plasticity with isotropic hardening (page 20, section 3; Nairn, eqs. 2.14-2.81, 2.125). Its
// parts: the hardening laws (hardening_*.hpp), one step of backward Euler (iso_plastic_kernel.hpp), the other methods
// (iso_plastic_methods.hpp), heat (thermal_block.hpp).
#pragma once

#include <variant>

#include "lode/plasticity/iso_plastic_methods.hpp"

namespace lode {

struct IsoPlastic {
    static constexpr const lode_model& description = iso_plastic::description;

    explicit IsoPlastic(const Properties& p) : kernel(make_kernel(p)), required(required_of(p)) {}

    int required_state(AnalysisKind) const { return required; }

    template <AnalysisKind kind>
    void initial_stiffness(const Stress<kind, double>&, const State<double>&, Tangent<kind>& tangent) const {
        std::visit([&](const auto& k) { k.set_initial_stiffness(tangent); }, kernel);
    }

    // Calls f with the kernel that the constants ask for. The most common ones go first; the others have a function of
    // their own, so that each gets all registers.
    template <class F>
    LODE_INLINE void specialise(const F& f) const {
        if (const auto* linear = std::get_if<0>(&kernel)) return f(*linear);
        if (const auto* saturation = std::get_if<1>(&kernel)) return f(*saturation);
        visit_apart<2>(f);
    }

    template <AnalysisKind kind, class Real, class T>
    LODE_INLINE void update(const Increment<kind, Real>& increment, Point<kind, Real>& point, T& tangent) const {
        specialise([&](const auto& k) LODE_INLINE_LAMBDA { k.update(increment, point, tangent); });
    }

  private:
    template <class... Laws>
    using AnyKernel = std::variant<iso_plastic::Kernel<Laws>..., iso_plastic::SteppedKernel>;
    using KernelVariant = iso_plastic::OverLaws<AnyKernel>;

    template <std::size_t i, class F>
    LODE_INLINE void visit_apart(const F& f) const {
        if constexpr (i < std::variant_size_v<KernelVariant>) {
            if (const auto* k = std::get_if<i>(&kernel)) return apart(f, *k);
            visit_apart<i + 1>(f);
        }
    }
    template <class F, class K>
    [[gnu::noinline]] static void apart(const F& f, const K& k) {
        f(k);
    }

    static iso_plastic::LawVariant make_law(const Properties& p, const IsotropicModuli& elastic) {
        using namespace iso_plastic;
        const double S = 3.0 * elastic.shear, E_axial = elastic.young;
        const auto need = [&](int number) { HardeningLaw::require_constants(p, HLAW, H1, number); };
        switch (p.code(HLAW)) {
            case 3:
                need(4);
                return JohnsonCook(p, H1, p[SIGY], p[TREF], S, E_axial);
            case 4:
                need(3);
                return Apart(SteinbergGuinan(p, H1, p[SIGY], p[TREF], p[TABS], elastic));
            case 5:
                need(9);
                return Apart(SteinbergLund(p, H1, p[SIGY], p[TREF], p[TABS], elastic));
            case 7:
                if (p.count() < H15)
                    p.refuse("HLAW = 7 needs NPROPS >= " + std::to_string(H15) +
                             ", NPROPS = " + std::to_string(p.count()));
                return Apart(DislocationHardening(p, H1, H11, p[SIGY], elastic.shear, p[TABS], S, E_axial));
            default:
                return HardeningLaw(p, p[SIGY], HLAW, H1).visit<LawVariant>([&](const auto& curve) {
                    return law_of(curve, elastic);
                });
        }
    }

    static KernelVariant make_kernel(const Properties& p) {
        using namespace iso_plastic;
        const IsotropicModuli elastic = IsotropicModuli::from_young_poisson(p[E], p[NU]);
        const LawVariant law = make_law(p, elastic);
        const AnyLaw any(law);
        if (any.is_softening() && p[LREF] <= 0.0) p.refuse(LREF, "> 0: softening law needs LREF > 0");
        const ThermalBlock thermal(p, TABS, any.is_softening());
        const DislocationHardening* dislocations = any.dislocations();
        const Constants c{
            .elastic = elastic,
            .thermal = thermal,
            .thermal_expansion = p[ALPHA],
            .moisture_expansion = p[BETA],
            .reference_length = p[LREF],
            .needs_absolute_temperature = thermal.is_thermoelastic() || any.is_thermal() ||
                                          (dislocations != nullptr && dislocations->depends_on_temperature())};
        const auto method = static_cast<Method>(p.code(METHOD));
        if (method == Method::backward_euler)
            return std::visit(
                [&](const auto& one) -> KernelVariant {
                    return iso_plastic::Kernel<std::decay_t<decltype(one)>>(c, one);
                },
                law);
        const int hlaw = p.code(HLAW);
        const bool is_curve = hlaw <= 2 || hlaw == 6 || hlaw == 8;
        if (method != Method::substeps && !is_curve)
            p.refuse(METHOD, "0 or 2: METHOD " + std::to_string(p.code(METHOD)) +
                                 " needs HLAW 0, 1, 2, 6 or 8 and a 3D or (3,1) layout");
        if (method == Method::trapezoidal && hlaw != 0) p.refuse(METHOD, "0..4 or 6: METHOD 5 needs HLAW 0");
        return SteppedKernel(c, law, method, p.code(NSUB), p[STOL]);
    }
    static int required_of(const Properties& p) {
        using namespace iso_plastic;
        if (p.code(HLAW) == 7) return FW;
        return p.code(TMODE) >= 2 ? DTAD : YT;
    }

    KernelVariant kernel;
    int required;
};

}  // namespace lode
