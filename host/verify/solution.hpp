// A material under a manufactured motion: F(t), what drives the free expansion, and the stress in closed form.
#ifndef LODE_HOST_VERIFY_SOLUTION_HPP
#define LODE_HOST_VERIFY_SOLUTION_HPP

#include <memory>
#include <string>
#include <vector>

#include "../replay/analysis.hpp"
#include "motion.hpp"

namespace lode::host {

class ManufacturedSolution {
  public:
    virtual ~ManufacturedSolution() = default;

    const ManufacturedMotion& motion() const { return motion_; }
    // Deformation gradient; under the drive `strain` 1 + the small strain, with gamma = F12.
    Matrix3 gradient(double t) const;
    Matrix3 small_strain(double t) const;
    // Change of temperature or field that expands freely to `residual`.
    double residual_change(double t) const { return residual_change_of(motion_.residual(t).value); }

    virtual Matrix3 stress(double t) const = 0;
    // J sigma:D, per reference volume and time.
    double stress_power(double t) const;
    // Acceleration of the particles that were at X = (1, 1, 1): the body force per mass, since the stress is uniform.
    Eigen::Vector3d body_force(double t) const;
    // Columns: Cauchy traction on the faces whose normals were e1, e2, e3.
    Matrix3 tractions(double t) const;

    // Order of the integration error in the increments; 0: exact whatever their number.
    int order() const { return order_; }
    // The energies that the material reports add up to the stress power.
    bool has_energy() const { return has_energy_; }
    // As `order`, of the energies. VUMAT has them per mass: where the volume changes, first order, since the density
    // that a material is given is that of the middle of the increment; else the trapezoidal rule over the stress power.
    int energy_order(Entry entry) const {
        if (entry == Entry::umat) return order_;
        return motion_.drive == Drive::gradient ? 1 : 2;
    }
    // Stretch of direction 2 (free_tension).
    virtual Taylor lateral(double /*t*/) const { return 1; }

  protected:
    ManufacturedSolution(const ManufacturedMotion& motion, double expansion, int order, bool has_energy)
        : motion_(motion), expansion_(expansion), order_(order), has_energy_(has_energy) {}
    double residual_change_of(double stretch) const;

    ManufacturedMotion motion_;
    double expansion_;  // coefficient of the cause
    int order_;
    bool has_energy_;
};

// The solution for a material name such as "NEO_HOOKEAN-RUBBER" and its constants. Throws BadDeck, beginning with the
// motion's location, where there is no closed form.
std::shared_ptr<const ManufacturedSolution> manufactured_solution(const std::string& material,
                                                                  const std::vector<double>& constants,
                                                                  const ManufacturedMotion& motion, Kind kind,
                                                                  Entry entry);

}  // namespace lode::host

#endif
