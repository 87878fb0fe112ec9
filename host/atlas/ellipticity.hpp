// Loss of ellipticity: the least determinant of the acoustic tensor over all directions, along a path.
#ifndef LODE_HOST_ATLAS_ELLIPTICITY_HPP
#define LODE_HOST_ATLAS_ELLIPTICITY_HPP

#include <optional>
#include <string>
#include <vector>

#include "../library.hpp"
#include "../replay/scenario.hpp"
#include "sheet.hpp"

namespace lode::host {

// Q_ik = n_j A_ijkl n_l with A from DDSDDE. `jaumann`: DDSDDE is the Jaumann rate of Kirchhoff stress over J, and the
// stress enters A. Plane kinds: directions in the plane.
class AcousticTensor {
  public:
    AcousticTensor(const Layout& layout, const Tangent& tangent, const Components& stress, bool jaumann);
    double determinant(const Eigen::Vector3d& n) const;
    bool plane() const { return plane_; }

  private:
    double moduli_[3][3][3][3];
    bool plane_;
};

struct LeastDeterminant {
    double ratio = 0;  // to the determinant of `elastic` in the same direction
    Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
};
LeastDeterminant least_determinant(const AcousticTensor& tensor, const AcousticTensor& elastic);

struct EllipticityPoint {
    double time = 0;
    LeastDeterminant least;
};
struct Ellipticity {
    std::vector<EllipticityPoint> points;
    std::optional<EllipticityPoint> lost;  // the first point where the ratio is negative
    std::string failure;                   // why the path ended early
};
// The scenario has not been resolved; UMAT is called.
Ellipticity ellipticity_along(Scenario scenario, const Library& library);

Sheet ellipticity_sheet(const std::vector<std::pair<std::string, Ellipticity>>& paths, const std::string& stem,
                        const std::string& title);

}  // namespace lode::host

#endif
