#include "umat_point.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "guarded_memory.hpp"

namespace lode::test {
namespace {

constexpr std::size_t cmname_length = 80;

// CMNAME in a heap block of its very length: there is no byte behind it for the library to read.
class MaterialNameArgument {
  public:
    MaterialNameArgument(const std::string& name, const std::optional<std::string>& raw) {
        const std::size_t length = raw ? raw->size() : cmname_length;
        bytes_ = std::make_unique<char[]>(length);
        std::fill_n(bytes_.get(), length, ' ');
        const std::string& text = raw ? *raw : name;
        std::copy_n(text.data(), std::min(text.size(), length), bytes_.get());
    }
    const char* get() const { return bytes_.get(); }

  private:
    std::unique_ptr<char[]> bytes_;
};

std::span<const double> column_major(const Matrix3d& a) { return {a.data(), 9}; }

}  // namespace

UmatPoint::UmatPoint(std::string material_name, AnalysisKind kind, Numbers props)
    : name_(std::move(material_name)),
      kind_(kind),
      ndi_(normal_components(kind)),
      nshr_(shear_components(kind)),
      props_(std::move(props)) {
    layout(ndi_, nshr_);
    const lode_model* model = find_model(name_);
    int count =
        lode_required_state(name_.c_str(), props_.data(), static_cast<int>(props_.size()), ndi_, nshr_, nullptr, 0);
    if (count < 0) count = model != nullptr ? model->state_count : 0;
    nstatv(count);
    for (int i = 0; model != nullptr && i < std::min(count, model->state_count); ++i)
        state_[static_cast<std::size_t>(i)] = model->state[i].initial;
}

UmatPoint& UmatPoint::nstatv(int count) {
    state_.resize(static_cast<std::size_t>(count));
    return *this;
}
UmatPoint& UmatPoint::state(Numbers values) {
    state_ = std::move(values);
    return *this;
}
UmatPoint& UmatPoint::stress(Numbers values) {
    stress_ = std::move(values);
    return *this;
}
UmatPoint& UmatPoint::temperature(double value) {
    temperature_ = value;
    return *this;
}
UmatPoint& UmatPoint::fields(Numbers values) {
    fields_ = std::move(values);
    return *this;
}
UmatPoint& UmatPoint::celent(double value) {
    celent_ = value;
    return *this;
}
UmatPoint& UmatPoint::deformation_gradient(const Matrix3d& f) {
    f_ = f;
    return *this;
}
UmatPoint& UmatPoint::time(double step, double total) {
    step_time_ = step;
    total_time_ = total;
    return *this;
}
UmatPoint& UmatPoint::layout(int ndi, int nshr) {
    ndi_ = ndi;
    nshr_ = nshr;
    stress_.assign(static_cast<std::size_t>(size()), 0.0);
    strain_ = stress_;
    return *this;
}
UmatPoint& UmatPoint::raw_name(std::string cmname) {
    raw_name_ = std::move(cmname);
    return *this;
}
UmatPoint& UmatPoint::entry_point(lode_umat_function* umat) {
    entry_ = umat;
    return *this;
}

Answer UmatPoint::evaluate(const Load& load) const {
    const auto n = static_cast<std::size_t>(size());
    thread_local GuardedMemory<double> reals(4096);
    thread_local GuardedMemory<int> integers(512);
    reals.reset();
    integers.reset();

    // A host that works in the unrotated frame (CalculiX, known by its PNEWDT) does not turn the stress.
    const bool turn = load.pnewdt > 0.0 && ndi_ > 1 && load.drot != Matrix3d::Identity();
    double* const stress = reals.output("STRESS", turn ? rotated_stress(stress_, kind_, load.drot) : stress_);
    double* const statev = reals.output("STATEV", state_);
    double* const ddsdde = reals.output("DDSDDE", n * n);
    double* const sse = reals.output("SSE", Numbers{sse_});
    double* const spd = reals.output("SPD", Numbers{spd_});
    double* const scd = reals.output("SCD", Numbers{scd_});
    double* const rpl = reals.output("RPL", 1);
    double* const ddsddt = reals.output("DDSDDT", n);
    double* const drplde = reals.output("DRPLDE", n);
    double* const drpldt = reals.output("DRPLDT", 1);
    double* const pnewdt = reals.output("PNEWDT", Numbers{load.pnewdt});
    const Numbers dstran = load.dstran.empty() ? Numbers(n, 0.0) : load.dstran;
    if (dstran.size() != n) throw std::invalid_argument("DSTRAN needs " + std::to_string(n) + " components");
    Numbers dpred = load.dpred;
    dpred.resize(fields_.size());
    const Numbers stress_in(stress, stress + n);
    const MaterialNameArgument cmname(name_, raw_name_);
    const auto number = [&](const char* name, int value) { return integers.input(name, value); };

    clear_captured_messages();
    lode_observation observation{};
    const auto call = [&](auto* entry, auto... first) {
        entry(first..., stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt,
              reals.input("STRAN", strain_), reals.input("DSTRAN", dstran),
              reals.input("TIME", Numbers{step_time_, total_time_}), reals.input("DTIME", load.dtime),
              reals.input("TEMP", temperature_), reals.input("DTEMP", load.dtemp), reals.input("PREDEF", fields_),
              reals.input("DPRED", dpred), cmname.get(), number("NDI", ndi_), number("NSHR", nshr_),
              number("NTENS", size()), number("NSTATV", static_cast<int>(state_.size())), reals.input("PROPS", props_),
              number("NPROPS", static_cast<int>(props_.size())), reals.input("COORDS", Numbers{0.1, 0.2, 0.3}),
              reals.input("DROT", column_major(load.drot)), pnewdt, reals.input("CELENT", celent_),
              reals.input("DFGRD0", column_major(f_)), reals.input("DFGRD1", column_major(load.dfgrd1.value_or(f_))),
              number("NOEL", 1), number("NPT", 1), number("LAYER", 1), number("KSPT", 1), number("KSTEP", 1),
              number("KINC", increment_ + 1), LODE_CMNAME_LENGTH);
    };
    if (load.observe) call(&lode_umat_observed, &observation);
    else call(entry_);

    if (const std::string where = reals.damage() + integers.damage(); !where.empty())
        ADD_FAILURE() << name_ << ": UMAT wrote" << where;

    Answer answer;
    answer.stress.assign(stress, stress + n);
    answer.state.assign(statev, statev + state_.size());
    answer.ddsddt.assign(ddsddt, ddsddt + n);
    answer.drplde.assign(drplde, drplde + n);
    answer.tangent = Eigen::Map<Eigen::MatrixXd>(ddsdde, size(), size());
    answer.sse = *sse;
    answer.spd = *spd;
    answer.scd = *scd;
    answer.rpl = *rpl;
    answer.drpldt = *drpldt;
    answer.pnewdt = *pnewdt;
    answer.observation = observation;
    answer.cut = std::memcmp(pnewdt, &load.pnewdt, sizeof *pnewdt) != 0;
    answer.messages = std::move(captured_messages());
    if (!answer.done()) {
        if (!identical(answer.stress, stress_in)) ADD_FAILURE() << name_ << ": STRESS changed though not done";
        if (!identical(answer.state, state_)) ADD_FAILURE() << name_ << ": STATEV changed though not done";
    }
    return answer;
}

Answer UmatPoint::step(const Load& load) {
    Answer answer = evaluate(load);
    if (!answer.done()) return answer;
    ++increment_;
    stress_ = answer.stress;
    state_ = answer.state;
    for (std::size_t i = 0; i < load.dstran.size(); ++i) strain_[i] += load.dstran[i];
    for (std::size_t i = 0; i < std::min(load.dpred.size(), fields_.size()); ++i) fields_[i] += load.dpred[i];
    f_ = load.dfgrd1.value_or(f_);
    temperature_ += load.dtemp;
    step_time_ += load.dtime;
    total_time_ += load.dtime;
    sse_ = answer.sse;
    spd_ = answer.spd;
    scd_ = answer.scd;
    return answer;
}

Answer UmatPoint::advance(const Load& load) {
    Answer answer = step(load);
    if (!answer.done())
        ADD_FAILURE() << name_ << ": increment refused (PNEWDT = " << answer.pnewdt << ") " << answer.first_error();
    return answer;
}

Matrix3d to_tensor(const Numbers& components, AnalysisKind kind, double shear_factor) {
    const auto n = static_cast<std::size_t>(normal_components(kind));
    Matrix3d t = Matrix3d::Zero();
    for (std::size_t i = 0; i < n; ++i) t(static_cast<int>(i), static_cast<int>(i)) = components[i];
    const int shears = shear_components(kind);
    if (shears >= 1) t(0, 1) = t(1, 0) = shear_factor * components[n];
    if (shears >= 2) t(0, 2) = t(2, 0) = shear_factor * components[n + 1];
    if (shears == 3) t(1, 2) = t(2, 1) = shear_factor * components[n + 2];
    return t;
}

Numbers to_components(const Matrix3d& tensor, AnalysisKind kind, double shear_factor) {
    Numbers c;
    for (int i = 0; i < normal_components(kind); ++i) c.push_back(tensor(i, i));
    const int shears = shear_components(kind);
    if (shears >= 1) c.push_back(shear_factor * tensor(0, 1));
    if (shears >= 2) c.push_back(shear_factor * tensor(0, 2));
    if (shears == 3) c.push_back(shear_factor * tensor(1, 2));
    return c;
}

Numbers rotated_stress(const Numbers& s, AnalysisKind kind, const Matrix3d& q) {
    return to_components(q * stress_tensor(s, kind) * q.transpose(), kind, 1.0);
}
Numbers rotated_strain(const Numbers& e, AnalysisKind kind, const Matrix3d& q) {
    return to_components(q * strain_tensor(e, kind) * q.transpose(), kind, 2.0);
}

const lode_model* find_model(const std::string& material_name) {
    const std::string keyword = material_name.substr(0, material_name.find('-'));
    for (int i = 0; i < lode_model_count(); ++i)
        if (keyword == lode_model_at(i)->keyword) return lode_model_at(i);
    return nullptr;
}

bool identical(const Numbers& a, const Numbers& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}
double largest(const Numbers& a) {
    double m = 0.0;
    for (const double x : a) m = std::max(m, std::abs(x));
    return m;
}
double distance(const Numbers& a, const Numbers& b) {
    double m = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double difference = std::abs(a[i] - b.at(i));
        if (std::isnan(difference)) return difference;
        m = std::max(m, difference);
    }
    return m;
}

}  // namespace lode::test
