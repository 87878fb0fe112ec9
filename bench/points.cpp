#include "points.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <mutex>
#include <new>
#include <random>
#include <stdexcept>
#include <utility>

namespace lode::bench {
namespace {

using Eigen::Matrix3d;

constexpr double time_increment = 1.0 / path_increments;
// The one field variable: a moisture content, a phase of fracture or a small pressure.
constexpr double field_value = 0.2;

std::string last_error;
std::mutex error_guard;

void remember(const char* text, std::size_t length) {
    const std::lock_guard lock(error_guard);
    last_error.assign(text, length);
}

std::array<char, LODE_CMNAME_LENGTH> padded(const std::string& name) {
    std::array<char, LODE_CMNAME_LENGTH> text;
    text.fill(' ');
    std::copy_n(name.begin(), std::min(name.size(), text.size()), text.begin());
    return text;
}

// The displacement gradient (cohesive: the separation in the first row) of a point along its path.
class Path {
  public:
    Path(const Material& material, Layout layout, bool symmetric, std::mt19937& random)
        : direction_(draw(material, layout, symmetric, random)) {
        const Matrix3d turned = direction_ + 0.3 * draw(material, layout, symmetric, random);
        last_ = turned / path_increments;
    }
    Matrix3d at(int increment) const {
        const double part = static_cast<double>(std::min(increment, path_increments)) / path_increments;
        Matrix3d h = part * direction_;
        if (increment > path_increments) h += last_;
        return h;
    }

  private:
    static Matrix3d draw(const Material& material, Layout layout, bool symmetric, std::mt19937& random) {
        std::uniform_real_distribution<double> uniform(-1.0, 1.0);
        Matrix3d a = Matrix3d::NullaryExpr([&] { return uniform(random); });
        if (symmetric) a = (0.5 * (a + a.transpose())).eval();
        if (material.cohesive) {
            a.row(0) = a.row(0).cwiseAbs();
            a.bottomRows(2).setZero();
            if (layout.nshr == 1) a(0, 2) = 0.0;
            return material.strain_scale * a / a.norm();
        }
        if (layout.nshr < 3) {
            a.row(2).setZero();
            a.col(2).setZero();
        }
        if (layout.nshr == 0) {
            const double axial = a(0, 0);
            a.setZero();
            a(0, 0) = axial;
        }
        if (material.loading != Loading::any && (a.trace() > 0) != (material.loading == Loading::tension)) a = -a;
        return material.strain_scale * a / (0.5 * (a + a.transpose())).norm();
    }

    Matrix3d direction_, last_;
};

Matrix3d deformation(const Material& material, const Path& path, int increment) {
    if (material.cohesive) return Matrix3d::Identity();
    return Matrix3d::Identity() + path.at(increment);
}

// Strain increment with tensor shears: midpoint rate of deformation.
Matrix3d strain_increment(const Material& material, const Path& path, int increment) {
    const Matrix3d dh = path.at(increment + 1) - path.at(increment);
    if (material.cohesive) return dh;
    const Matrix3d middle = Matrix3d::Identity() + 0.5 * (path.at(increment + 1) + path.at(increment));
    const Matrix3d l = dh * middle.inverse();
    return 0.5 * (l + l.transpose());
}

double component(const Matrix3d& e, Layout layout, int i, bool cohesive, const int (&shears)[3][2]) {
    if (cohesive) return e(0, i);
    if (i < layout.ndi) return e(i, i);
    const auto& s = shears[i - layout.ndi];
    return e(s[0], s[1]);
}

constexpr int standard_shears[3][2] = {{0, 1}, {0, 2}, {1, 2}};
constexpr int explicit_shears[3][2] = {{0, 1}, {1, 2}, {2, 0}};

}  // namespace

std::string take_error() {
    const std::lock_guard lock(error_guard);
    return std::exchange(last_error, {});
}

UmatPoints::UmatPoints(lode_umat_function* umat, const Material& material, Layout layout, int count)
    : umat_(umat),
      material_(material),
      layout_(layout),
      count_(count),
      ntens_(layout.size()),
      nstatv_(std::max(material.state_count, 1)),
      nprops_(static_cast<int>(material.constants.size())),
      cmname_(padded(material.name)) {
    const auto points = static_cast<std::size_t>(count), n = static_cast<std::size_t>(ntens_);
    const auto states = static_cast<std::size_t>(nstatv_);
    stress_.assign(points * n, 0.0);
    state_.assign(points * states, 0.0);
    strain_.assign(points * n, 0.0);
    strain_increment_.assign(points * n, 0.0);
    deformation_start_.assign(points * 9, 0.0);
    deformation_end_.assign(points * 9, 0.0);
    work_stress_ = stress_;
    work_state_ = state_;

    std::mt19937 random(20240917);
    take_error();
    std::size_t active = 0;
    for (std::size_t p = 0; p < points; ++p) {
        double* const stress = &stress_[p * n];
        double* const state = &state_[p * states];
        double* const new_stress = &work_stress_[p * n];
        double* const new_state = &work_state_[p * states];
        bool driven = false;
        // A direction that the model cannot follow in these increments is replaced.
        for (int attempt = 0; attempt < 50 && !driven; ++attempt) {
            const Path path(material, layout, false, random);
            std::fill_n(stress, n, 0.0);
            std::fill_n(state, states, 0.0);
            std::copy(material.initial_state.begin(), material.initial_state.end(), state);
            std::fill_n(&strain_[p * n], n, 0.0);
            driven = true;
            for (int increment = 0; increment <= path_increments && driven; ++increment) {
                const Matrix3d e = strain_increment(material, path, increment);
                for (int i = 0; i < ntens_; ++i)
                    strain_increment_[p * n + static_cast<std::size_t>(i)] =
                        component(e, layout, i, material.cohesive, standard_shears) *
                        (i < layout.ndi || material.cohesive ? 1.0 : 2.0);
                Eigen::Map<Matrix3d>{&deformation_start_[p * 9]} = deformation(material, path, increment);
                Eigen::Map<Matrix3d>{&deformation_end_[p * 9]} = deformation(material, path, increment + 1);
                std::copy_n(stress, n, new_stress);
                std::copy_n(state, states, new_state);
                call(p);
                if (const std::string error = take_error(); !error.empty()) throw std::runtime_error(error);
                driven = pnewdt_ >= 1.0;
                for (std::size_t i = 0; i < n; ++i) driven = driven && std::isfinite(new_stress[i]);
                if (!driven || increment == path_increments) continue;
                std::copy_n(new_stress, n, stress);
                std::copy_n(new_state, states, state);
                for (std::size_t i = 0; i < n; ++i) strain_[p * n + i] += strain_increment_[p * n + i];
            }
        }
        if (!driven) throw std::runtime_error("asks for smaller increments on every path tried");
        if (!std::equal(state, state + states, new_state)) ++active;
    }
    active_share_ = static_cast<double>(active) / static_cast<double>(points);
}

inline void UmatPoints::call(std::size_t point) {
    static constexpr double time[2] = {1.0, 1.0}, dtime = time_increment, temp = 293.15, dtemp = 0.0, celent = 1.0;
    static constexpr double field[1] = {field_value}, no_change[1] = {0.0}, coords[3] = {0.0, 0.0, 0.0};
    static constexpr double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    static constexpr int one = 1, jstep[4] = {1, 1, 0, 0};
    const auto n = static_cast<std::size_t>(ntens_);
    sse_ = spd_ = scd_ = 0.0;
    pnewdt_ = 1.0;
    umat_(&work_stress_[point * n], &work_state_[point * static_cast<std::size_t>(nstatv_)], ddsdde_.data(), &sse_,
          &spd_, &scd_, &rpl_, ddsddt_.data(), drplde_.data(), &drpldt_, &strain_[point * n],
          &strain_increment_[point * n], time, &dtime, &temp, &dtemp, field, no_change, cmname_.data(), &layout_.ndi,
          &layout_.nshr, &ntens_, &nstatv_, material_.constants.data(), &nprops_, coords, identity, &pnewdt_, &celent,
          &deformation_start_[point * 9], &deformation_end_[point * 9], &one, &one, &one, &one, jstep, &one,
          cmname_.size());
}

void UmatPoints::run() {
    std::memcpy(work_stress_.data(), stress_.data(), stress_.size() * sizeof(double));
    std::memcpy(work_state_.data(), state_.data(), state_.size() * sizeof(double));
    for (std::size_t p = 0; p < static_cast<std::size_t>(count_); ++p) call(p);
}

void Arena::allocate(const std::vector<std::pair<std::span<double>*, std::size_t>>& arrays) {
    constexpr std::size_t page = 4096 / sizeof(double), stagger = 5 * 64 / sizeof(double);
    const auto whole_pages = [](std::size_t n) { return (n + page - 1) / page * page; };
    std::size_t total = 0;
    for (const auto& [array, size] : arrays) total += whole_pages(size + page);
    memory_.reset(static_cast<double*>(std::aligned_alloc(page * sizeof(double), total * sizeof(double))));
    if (!memory_) throw std::bad_alloc();
    std::fill_n(memory_.get(), total, 0.0);
    std::size_t start = 0, index = 0;
    for (const auto& [array, size] : arrays) {
        *array = {memory_.get() + start + index * stagger % page, size};
        start += whole_pages(size + page);
        ++index;
    }
}

VumatBlock::VumatBlock(lode_vumat_function* vumat, const Material& material, Layout layout, int count, int distinct)
    : vumat_(vumat),
      material_(material),
      layout_(layout),
      count_(std::min(count, distinct)),
      nstatv_(std::max(material.state_count, 1)),
      nprops_(static_cast<int>(material.constants.size())),
      cmname_(padded(material.name)) {
    const auto points = static_cast<std::size_t>(count_);
    allocate(points);
    for (auto* v : {&length_, &density_}) std::fill(v->begin(), v->end(), 1.0);
    std::fill(temperature_.begin(), temperature_.end(), 293.15);
    std::fill(field_.begin(), field_.end(), field_value);
    for (std::size_t j = 0; j < material.initial_state.size(); ++j)
        std::fill_n(&state_new_[j * points], points, material.initial_state[j]);

    std::mt19937 random(20240917);
    std::vector<Path> paths;
    for (std::size_t p = 0; p < points; ++p) paths.emplace_back(material, layout, true, random);
    take_error();
    for (int increment = 0; increment <= path_increments; ++increment) {
        std::ranges::copy(stress_new_, stress_old_.begin());
        std::ranges::copy(state_new_, state_old_.begin());
        std::ranges::copy(intern_new_, intern_old_.begin());
        std::ranges::copy(inelas_new_, inelas_old_.begin());
        for (std::size_t p = 0; p < points; ++p) {
            const Matrix3d e = strain_increment(material, paths[p], increment);
            const Matrix3d f0 = deformation(material, paths[p], increment);
            const Matrix3d f1 = deformation(material, paths[p], increment + 1);
            for (int i = 0; i < layout.size(); ++i) {
                const std::size_t at = p + points * static_cast<std::size_t>(i);
                const double tensor_shear = material.cohesive && i > 0 ? 0.5 : 1.0;
                strain_increment_[at] = tensor_shear * component(e, layout, i, material.cohesive, explicit_shears);
                stretch_old_[at] = defgrad_old_[at] = component(f0, layout, i, false, explicit_shears);
                stretch_new_[at] = defgrad_new_[at] = component(f1, layout, i, false, explicit_shears);
            }
            for (int i = 0; i < layout.nshr; ++i) {  // F is symmetric: 21, 32, 13 repeat 12, 23, 31
                const std::size_t at = p + points * static_cast<std::size_t>(layout.size() + i);
                const std::size_t from = p + points * static_cast<std::size_t>(layout.ndi + i);
                defgrad_old_[at] = defgrad_old_[from];
                defgrad_new_[at] = defgrad_new_[from];
            }
        }
        run();
        if (const std::string error = take_error(); !error.empty()) throw std::runtime_error(error);
    }

    std::size_t active = 0;
    for (std::size_t p = 0; p < points; ++p)
        for (std::size_t i = p; i < state_new_.size(); i += points)
            if (state_new_[i] != state_old_[i]) {
                ++active;
                break;
            }
    active_share_ = static_cast<double>(active) / static_cast<double>(points);

    if (count > count_) {
        const auto repeated = static_cast<std::size_t>(count);
        const Arena small = std::move(arena_);
        std::array<std::span<double>, 19> source;
        std::ranges::transform(arrays(), source.begin(), [](const auto* v) { return *v; });
        allocate(repeated);
        const auto targets = arrays();
        for (std::size_t a = 0; a < source.size(); ++a) {
            const std::span<double> from = source[a], to = *targets[a];
            for (std::size_t c = 0; c < from.size() / points; ++c)
                for (std::size_t p = 0; p < repeated; ++p) to[c * repeated + p] = from[c * points + p % points];
        }
        count_ = count;
    }
}

std::array<std::span<double>*, 19> VumatBlock::arrays() {
    return {&coord_,       &length_,      &density_,     &strain_increment_, &spin_,
            &temperature_, &stretch_old_, &stretch_new_, &defgrad_old_,      &defgrad_new_,
            &field_,       &stress_old_,  &stress_new_,  &state_old_,        &state_new_,
            &intern_old_,  &intern_new_,  &inelas_old_,  &inelas_new_};
}

void VumatBlock::allocate(std::size_t points) {
    const std::size_t n = static_cast<std::size_t>(layout_.size()), shears = static_cast<std::size_t>(layout_.nshr);
    const std::size_t states = static_cast<std::size_t>(nstatv_);
    const std::size_t columns[] = {3, 1, 1, n,      shears, 1, n, n, n + shears, n + shears,
                                   1, n, n, states, states, 1, 1, 1, 1};
    const auto spans = arrays();
    std::vector<std::pair<std::span<double>*, std::size_t>> wanted;
    for (std::size_t i = 0; i < spans.size(); ++i) wanted.emplace_back(spans[i], columns[i] * points);
    arena_.allocate(wanted);
}

void VumatBlock::run() {
    static constexpr double step_time = 1.0, total_time = 1.0, dt = time_increment;
    static constexpr int fields = 1, no_anneal = 0;
    vumat_(&count_, &layout_.ndi, &layout_.nshr, &nstatv_, &fields, &nprops_, &no_anneal, &step_time, &total_time, &dt,
           cmname_.data(), coord_.data(), length_.data(), material_.constants.data(), density_.data(),
           strain_increment_.data(), spin_.data(), temperature_.data(), stretch_old_.data(), defgrad_old_.data(),
           field_.data(), stress_old_.data(), state_old_.data(), intern_old_.data(), inelas_old_.data(),
           temperature_.data(), stretch_new_.data(), defgrad_new_.data(), field_.data(), stress_new_.data(),
           state_new_.data(), intern_new_.data(), inelas_new_.data(), cmname_.size());
}

void VumatBlock::copy() {
    const auto n = stress_new_.size();
    double* const stress_new = stress_new_.data();
    const double* const stress_old = stress_old_.data();
    const double* const increment = material_.finite_strain ? stretch_new_.data() : strain_increment_.data();
    for (std::size_t i = 0; i < n; ++i) stress_new[i] = stress_old[i] + increment[i];
    std::copy(state_old_.begin(), state_old_.end(), state_new_.begin());
    double* const intern_new = intern_new_.data();
    const double* const intern_old = intern_old_.data();
    const double* const density = density_.data();
    for (std::size_t i = 0; i < intern_new_.size(); ++i) intern_new[i] = intern_old[i] + density[i];
    std::copy(inelas_old_.begin(), inelas_old_.end(), inelas_new_.begin());
}

}  // namespace lode::bench

// The host's side of errors: remember the message (not a warning), and return from XIT so that the refused case can be
// reported.
extern "C" {
void stdb_abqerr_(const int* severity, const char* text, const int*, const double*, const char*, std::size_t length,
                  std::size_t) {
    if (*severity <= -2) lode::bench::remember(text, length);
}
void xplb_abqerr_(const int* severity, const char* text, const int*, const double*, const char*, std::size_t length,
                  std::size_t) {
    if (*severity <= -2) lode::bench::remember(text, length);
}
void xit_() {}
void xplb_exit_() {}
}
