// Material points in states worth measuring, and the drivers that call UMAT and VUMAT on them as a host does.
#pragma once

#include <array>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "abi.hpp"

namespace lode::bench {

struct Layout {
    int ndi, nshr;
    int size() const { return ndi + nshr; }
};

enum class Loading { any, tension, compression };

struct Material {
    std::string name;  // CMNAME
    std::vector<double> constants;
    int state_count = 0;
    std::vector<double> initial_state;
    double strain_scale = 0;
    bool cohesive = false, finite_strain = false;
    Loading loading = Loading::any;
};

// Every point is driven along a random direction to the material's strain scale in `path_increments` increments of one
// time unit in total; the increment that is measured follows in a slightly different direction.
inline constexpr int path_increments = 8;

class UmatPoints {
  public:
    // Throws std::runtime_error if the material refuses or a point cannot be driven.
    UmatPoints(lode_umat_function* umat, const Material& material, Layout layout, int count);

    // Copies STRESS and STATEV of the start of the increment, as every host does, and calls for each point. The copy is
    // part of all numbers, also of those of the baselines. All points are copied before the first call: a call right
    // after its own copy would measure how the processor forwards those stores to the loads of the callee.
    void run();
    // Share of points whose state changes in the increment that is measured.
    double active_share() const { return active_share_; }

  private:
    void call(std::size_t point);

    lode_umat_function* umat_;
    Material material_;
    Layout layout_;
    int count_, ntens_, nstatv_, nprops_;
    std::array<char, LODE_CMNAME_LENGTH> cmname_{};
    std::vector<double> stress_, state_, strain_, strain_increment_, deformation_start_, deformation_end_;
    std::vector<double> work_stress_, work_state_;
    std::array<double, 6> ddsddt_{}, drplde_{};
    std::array<double, 36> ddsdde_{};
    double sse_ = 0, spd_ = 0, scd_ = 0, rpl_ = 0, drpldt_ = 0, pnewdt_ = 1;
    double active_share_ = 0;
};

// Arrays of a block in one piece of memory. Each starts at a cache line of its own place in a page: with power-of-two
// blocks, chance addresses would otherwise decide how often stores and loads collide (4 KiB aliasing), by a factor of
// two.
class Arena {
  public:
    void allocate(const std::vector<std::pair<std::span<double>*, std::size_t>>& arrays);

  private:
    struct Free {
        void operator()(double* p) const { std::free(p); }
    };
    std::unique_ptr<double[], Free> memory_;
};

class VumatBlock {
  public:
    // A block larger than `distinct` repeats that many different points.
    VumatBlock(lode_vumat_function* vumat, const Material& material, Layout layout, int count, int distinct);

    void run();
    double active_share() const { return active_share_; }
    // The same traffic without any material: reads strain increment, stress, state, density and energies, writes
    // stress, state and energies.
    void copy();

  private:
    void allocate(std::size_t points);
    std::array<std::span<double>*, 19> arrays();

    lode_vumat_function* vumat_;
    Material material_;
    Layout layout_;
    int count_, nstatv_, nprops_;
    std::array<char, LODE_CMNAME_LENGTH> cmname_{};
    double active_share_ = 0;
    Arena arena_;
    std::span<double> coord_, length_, density_, strain_increment_, spin_, temperature_, stretch_old_, stretch_new_,
        defgrad_old_, defgrad_new_, field_, stress_old_, stress_new_, state_old_, state_new_, intern_old_, intern_new_,
        inelas_old_, inelas_new_;
};

// The message of a refusal since the last call of this function, or "".
std::string take_error();

}  // namespace lode::bench
