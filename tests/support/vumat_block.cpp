#include "vumat_block.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "guarded_memory.hpp"

namespace lode::test {
namespace {

// The kind that the arrays have the layout of.
AnalysisKind layout_of(AnalysisKind kind) {
    return kind == AnalysisKind::plane_stress ? AnalysisKind::plane_strain : kind;
}

// Column of VUMAT's arrays with component `i` of the UMAT order.
int column_of(AnalysisKind kind, int i) {
    if (kind == AnalysisKind::plane_stress && i == 2) return 3;
    if (kind == AnalysisKind::solid && i >= 4) return i == 4 ? 5 : 4;
    return i;
}

std::string explicit_name(const std::string& name, AnalysisKind kind) {
    if (kind != AnalysisKind::plane_stress) return name;
    const std::size_t dash = name.find('-');
    return name.substr(0, dash) + "-PS" + (dash == std::string::npos ? "" : name.substr(dash));
}

}  // namespace

VumatBlock::VumatBlock(std::string material_name, AnalysisKind kind, Numbers props)
    : VumatBlock(UmatPoint(std::move(material_name), kind, std::move(props))) {}

VumatBlock::VumatBlock(const UmatPoint& prototype)
    : name_(explicit_name(prototype.name(), prototype.kind())),
      kind_(prototype.kind()),
      props_(prototype.props()),
      initial_state_(prototype.state()) {}

VumatPoint VumatBlock::fresh_point() const {
    VumatPoint point;
    point.stress.assign(static_cast<std::size_t>(components(kind_)), 0.0);
    point.state = initial_state_;
    return point;
}

HostMessages VumatBlock::run() { return call<double>(&vumat_); }
HostMessages VumatBlock::run_with(VumatFunctionOf<double> vumat) { return call<double>(vumat); }
HostMessages VumatBlock::run_with(VumatFunctionOf<float> vumat) { return call<float>(vumat); }

template <class Real>
HostMessages VumatBlock::call(VumatFunctionOf<Real> vumat) {
    const std::size_t block = points.size(), nstatev = initial_state_.size();
    const std::size_t nfield = block > 0 ? points.front().fields_old.size() : 0;
    const AnalysisKind layout = layout_of(kind_);
    const auto columns = static_cast<std::size_t>(components(layout));
    const int normals = normal_components(kind_), shears = shear_components(layout);
    const auto full_columns = columns + static_cast<std::size_t>(shears);  // of F, which is not symmetric
    const auto size = static_cast<std::size_t>(components(kind_));

    std::vector<Real> strain(columns * block, Real{0}), stress = strain, stretch_new(strain), stretch_old(strain);
    std::vector<Real> state(nstatev * block), field_old(nfield * block), field_new(nfield * block);
    std::vector<Real> f_old(full_columns * block, Real{0}), f_new(f_old), spin(block * 3, Real{0});
    std::vector<Real> density(block), celent(block), temp_old(block), temp_new(block), intern(block), inelas(block);
    std::vector<Real> coords(3 * block, Real{0});
    const auto at = [block](std::vector<Real>& a, std::size_t column, std::size_t p) -> Real& {
        return a[column * block + p];
    };
    for (std::size_t p = 0; p < block; ++p) {
        const VumatPoint& point = points[p];
        for (std::size_t i = 0; i < size; ++i) {
            const auto column = static_cast<std::size_t>(column_of(kind_, static_cast<int>(i)));
            const bool is_shear = static_cast<int>(i) >= normals;
            const double e = point.strain_increment.empty() ? 0.0 : point.strain_increment[i];
            at(strain, column, p) = static_cast<Real>(is_shear ? 0.5 * e : e);
            at(stress, column, p) = static_cast<Real>(point.stress[i]);
        }
        if (!is_cohesive(kind_)) {
            const Numbers u = to_components(point.stretch, layout, 1.0);
            for (std::size_t i = 0; i < columns; ++i) {
                const auto column = static_cast<std::size_t>(column_of(layout, static_cast<int>(i)));
                at(stretch_new, column, p) = at(f_new, column, p) = static_cast<Real>(u[i]);
                at(stretch_old, column, p) = at(f_old, column, p) = Real(i < 3 ? 1 : 0);
            }
            // 21, 32, 13 follow the symmetric part
            if (shears >= 1) at(f_new, columns, p) = static_cast<Real>(point.stretch(1, 0));
            if (shears == 3) at(f_new, columns + 1, p) = static_cast<Real>(point.stretch(2, 1));
            if (shears == 3) at(f_new, columns + 2, p) = static_cast<Real>(point.stretch(0, 2));
        }
        for (std::size_t i = 0; i < nstatev; ++i) at(state, i, p) = static_cast<Real>(point.state[i]);
        for (std::size_t i = 0; i < nfield; ++i) {
            at(field_old, i, p) = static_cast<Real>(point.fields_old[i]);
            at(field_new, i, p) = static_cast<Real>(point.fields_new[i]);
        }
        density[p] = static_cast<Real>(point.density);
        celent[p] = static_cast<Real>(point.celent);
        temp_old[p] = static_cast<Real>(point.temperature_old);
        temp_new[p] = static_cast<Real>(point.temperature_new);
        intern[p] = static_cast<Real>(point.internal_energy);
        inelas[p] = static_cast<Real>(point.inelastic_energy);
    }

    const std::size_t numbers = block * (12 * columns + 2 * nstatev + 2 * nfield + 32) + props_.size() + 1024;
    GuardedMemory<Real> reals(numbers);
    GuardedMemory<int> integers(256);
    const auto number = [&](const char* name, std::size_t value) {
        return integers.input(name, static_cast<int>(value));
    };
    Real* const strain_inc = reals.output("strainInc", strain);
    Real* const stress_new = reals.output("stressNew", columns * block);
    Real* const state_new = reals.output("stateNew", nstatev * block);
    Real* const intern_new = reals.output("enerInternNew", block);
    Real* const inelas_new = reals.output("enerInelasNew", block);
    const auto cmname = std::make_unique<char[]>(80);
    std::fill_n(cmname.get(), 80, ' ');
    std::copy_n(name_.data(), std::min<std::size_t>(name_.size(), 80), cmname.get());

    clear_captured_messages();
    vumat(number("nblock", block), number("ndir", columns - static_cast<std::size_t>(shears)),
          number("nshr", static_cast<std::size_t>(shears)), number("nstatev", nstatev), number("nfieldv", nfield),
          number("nprops", props_.size()), number("lanneal", 0), reals.input("stepTime", static_cast<Real>(step_time)),
          reals.input("totalTime", static_cast<Real>(total_time)), reals.input("dt", static_cast<Real>(dtime)),
          cmname.get(), reals.input("coordMp", coords), reals.input("charLength", celent), reals.input("props", props_),
          reals.input("density", density), strain_inc, reals.input("relSpinInc", spin),
          reals.input("tempOld", temp_old), reals.input("stretchOld", stretch_old), reals.input("defgradOld", f_old),
          reals.input("fieldOld", field_old), reals.input("stressOld", stress), reals.input("stateOld", state),
          reals.input("enerInternOld", intern), reals.input("enerInelasOld", inelas), reals.input("tempNew", temp_new),
          reals.input("stretchNew", stretch_new), reals.input("defgradNew", f_new), reals.input("fieldNew", field_new),
          stress_new, state_new, intern_new, inelas_new, LODE_CMNAME_LENGTH);
    if (const std::string where = reals.damage() + integers.damage(); !where.empty())
        ADD_FAILURE() << name_ << ": VUMAT wrote" << where;
    HostMessages messages = std::move(captured_messages());

    // In plane stress the library returns the thickness strain in the column of component 33; all others are inputs.
    for (std::size_t i = 0; i < columns * block; ++i)
        if (!(kind_ == AnalysisKind::plane_stress && i / block == 2))
            if (std::memcmp(&strain_inc[i], &strain[i], sizeof(Real)) != 0) {
                ADD_FAILURE() << name_ << ": VUMAT wrote in strainInc, column " << i / block + 1;
                break;
            }
    if (messages.stops > 0) return messages;
    for (std::size_t p = 0; p < block; ++p) {
        VumatPoint& point = points[p];
        for (std::size_t i = 0; i < size; ++i) {
            const auto column = static_cast<std::size_t>(column_of(kind_, static_cast<int>(i)));
            point.stress[i] = static_cast<double>(stress_new[column * block + p]);
        }
        for (std::size_t i = 0; i < nstatev; ++i) point.state[i] = static_cast<double>(state_new[i * block + p]);
        point.internal_energy = static_cast<double>(intern_new[p]);
        point.inelastic_energy = static_cast<double>(inelas_new[p]);
        if (kind_ == AnalysisKind::plane_stress) {
            point.thickness_strain_increment = static_cast<double>(strain_inc[2 * block + p]);
            if (stress_new[2 * block + p] != Real{0}) ADD_FAILURE() << name_ << ": stress 33 of plane stress is not 0";
        }
    }
    return messages;
}

}  // namespace lode::test
