// The kinds of analysis and the stress and strain components of each, in UMAT order.
#ifndef LODE_HOST_REPLAY_ANALYSIS_HPP
#define LODE_HOST_REPLAY_ANALYSIS_HPP

#include <Eigen/Dense>
#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

namespace lode::host {

enum class Kind { solid, plane_strain, axisymmetric, plane_stress, uniaxial, cohesive_2d, cohesive_3d };
enum class Entry { umat, vumat };
// Of the arrays of VUMAT: liblode-sp.so and other libraries for single-precision hosts take float.
enum class Precision { double_, single };

// Stress or strain in Voigt form, shear strains engineering; at most six entries, no allocation.
using Components = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1>;
using Tangent = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;
using Matrix3 = Eigen::Matrix3d;

struct KindName {
    Kind kind;
    std::string_view name;
};
inline constexpr std::array<KindName, 7> kind_names{{{Kind::solid, "3d"},
                                                     {Kind::plane_strain, "plane_strain"},
                                                     {Kind::axisymmetric, "axisymmetric"},
                                                     {Kind::plane_stress, "plane_stress"},
                                                     {Kind::uniaxial, "1d"},
                                                     {Kind::cohesive_2d, "cohesive_2d"},
                                                     {Kind::cohesive_3d, "cohesive_3d"}}};
std::string_view name_of(Kind kind);

inline bool is_cohesive(Kind kind) { return kind == Kind::cohesive_2d || kind == Kind::cohesive_3d; }

// What NDI, NSHR and the components are in a kind.
class Layout {
  public:
    explicit Layout(Kind kind);

    Kind kind() const { return kind_; }
    bool cohesive() const { return is_cohesive(kind_); }
    int ndi() const { return ndi_; }
    int nshr() const { return nshr_; }
    int size() const { return ndi_ + nshr_; }
    // "11", "12", ... or "n", "s1", "s2".
    std::string_view name(int i) const { return names_[static_cast<std::size_t>(i)]; }
    std::span<const std::string_view> names() const { return names_.first(static_cast<std::size_t>(size())); }
    // Also takes "21" for "12" and so on.
    std::optional<int> find(std::string_view name) const;
    // Row and column in the 3 x 3 tensor; solids only.
    std::pair<int, int> position(int i) const { return positions_[static_cast<std::size_t>(i)]; }

    Matrix3 strain_tensor(const Components& strain) const;
    Components strain_components(const Matrix3& tensor) const;
    Matrix3 stress_tensor(const Components& stress) const;
    Components stress_components(const Matrix3& tensor) const;

    // "strain" and "stress", or "separation_" and "traction_": what precedes a component's name in a column.
    std::string_view strain_prefix() const { return cohesive() ? "separation_" : "strain"; }
    std::string_view stress_prefix() const { return cohesive() ? "traction_" : "stress"; }

  private:
    Kind kind_;
    int ndi_, nshr_;
    std::span<const std::string_view> names_;
    std::span<const std::pair<int, int>> positions_;
};

}  // namespace lode::host

#endif
