// What goes into a constitutive update (Increment) and what comes out of it (Point, Tangent), for one material point
// or, with a batch as number type, for as many as the batch has lanes. Both read host memory in place: nothing is
// loaded that the model does not ask for.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "lode/material/kind.hpp"
#include "lode/numerics/scalar.hpp"
#include "lode/numerics/solve_counter.hpp"
#include "lode/tensor/matrix3.hpp"
#include "lode/tensor/voigt.hpp"

namespace lode {

// DTIME with its reciprocal (0 if DTIME is 0): the division is done once for a whole block.
struct TimeIncrement {
    double value = 0.0, inverse = 0.0;

    TimeIncrement() = default;
    LODE_INLINE TimeIncrement(double dt) : value(dt), inverse(dt > 0.0 ? 1.0 / dt : 0.0) {}
    LODE_INLINE operator double() const { return value; }
};

// The loading of one increment.
template <AnalysisKind kind, class Real>
struct Increment {
    using S = Storage<Real>;

    Strain<kind, Real> strain_increment;  // DSTRAN, engineering shears; cohesive: separation / thickness
    TimeIncrement time_increment;         // DTIME
    double time_end = 0.0;                // total time at the end of the increment

    // Where the rest is found. UMAT: temperature, field at the start and their changes; VUMAT: old and new values,
    // one column of `stride` points each.
    const S* temperature_source[2] = {};
    const S* field_source[2] = {};
    const S* deformation_source = nullptr;  // UMAT: DFGRD1 column by column; VUMAT: stretchNew
    const S* element_length_source = nullptr;
    const double* rotation_source = nullptr;  // DROT column by column; null where the frame turns with the material
    std::ptrdiff_t stride = 1;
    int field_count = std::numeric_limits<int>::max();  // VUMAT: nfieldv; UMAT: not known

    LODE_INLINE Real temperature_increment() const { return change(temperature_source, 0); }
    LODE_INLINE Real temperature_start() const { return load<Real>(temperature_source[0]); }
    LODE_INLINE Real temperature_end() const { return end(temperature_source, 0); }
    // Field variable `number` (1-based); 0 where an explicit host has not so many.
    LODE_INLINE Real field_increment(int number) const {
        return has_field(number) ? change(field_source, number - 1) : Real(0.0);
    }
    LODE_INLINE Real field_end(int number) const {
        return has_field(number) ? end(field_source, number - 1) : Real(0.0);
    }
    LODE_INLINE Real field_start(int number) const {
        return has_field(number) ? load<Real>(field_source[0] + (number - 1) * stride) : Real(0.0);
    }
    LODE_INLINE Real element_length() const { return load<Real>(element_length_source); }

    // DFGRD1. In a VUMAT the stretch U takes its place: sigma(U) is the corotational stress (page 50, 1.7).
    LODE_INLINE Matrix3<Real> deformation_gradient() const {
        Matrix3<Real> f;
        if constexpr (is_batch<Real>) {
            const auto u = [&](int c) { return load<Real>(deformation_source + c * stride); };
            for (int i = 0; i < 3; ++i) f(i, i) = u(i);
            f(0, 1) = f(1, 0) = u(3);
            if constexpr (kind == AnalysisKind::solid) {
                f(1, 2) = f(2, 1) = u(4);
                f(0, 2) = f(2, 0) = u(5);
            } else {
                f(1, 2) = f(2, 1) = f(0, 2) = f(2, 0) = Real(0.0);
            }
        } else {
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) f(i, j) = deformation_source[i + 3 * j];
        }
        return f;
    }

    LODE_INLINE bool has_rotation() const { return rotation_source != nullptr; }
    // True if there is one and it is not the identity. In integers, so that there is one branch.
    LODE_INLINE bool turns() const {
        if (!has_rotation()) return false;
        const auto bits = [this](int i) { return std::bit_cast<std::uint64_t>(rotation_source[i]); };
        constexpr auto one = std::bit_cast<std::uint64_t>(1.0);
        const std::uint64_t off = bits(1) | bits(2) | bits(3) | bits(5) | bits(6) | bits(7);  // -0 counts as 0
        return ((bits(0) ^ one) | (bits(4) ^ one) | (bits(8) ^ one) | (off << 1)) != 0;
    }
    // DROT; ask only if there is one.
    LODE_INLINE Matrix3<Real> rotation() const {
        Matrix3<Real> r;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) r(i, j) = Real(rotation_source[i + 3 * j]);
        return r;
    }

  private:
    LODE_INLINE bool has_field(int number) const { return !is_batch<Real> || number <= field_count; }
    LODE_INLINE Real change(const S* const source[2], int column) const {
        if constexpr (is_batch<Real>)
            return load<Real>(source[1] + column * stride) - load<Real>(source[0] + column * stride);
        else return source[1][column];
    }
    LODE_INLINE Real end(const S* const source[2], int column) const {
        if constexpr (is_batch<Real>) return load<Real>(source[1] + column * stride);
        else return source[0][column] + source[1][column];
    }
};

// STATEV by the page's 1-based index. UMAT: old and new are the same memory, so an update reads all it needs before it
// sets anything, and sets nothing once it has failed.
template <class Real>
class State {
  public:
    using S = Storage<Real>;
    State() = default;
    LODE_INLINE State(const S* old_values, S* new_values, std::ptrdiff_t stride, int count)
        : old_(old_values), new_(new_values), stride_(stride), count_(count) {}

    LODE_INLINE Real operator[](int index) const { return load<Real>(old_ + (index - 1) * stride_); }
    LODE_INLINE void set(int index, const Real& value) { store<Real>(new_ + (index - 1) * stride_, value); }
    // Leaves an entry as it was.
    LODE_INLINE void keep([[maybe_unused]] int index) {
        if constexpr (is_batch<Real>) set(index, (*this)[index]);
    }
    // Entries the host provides (NSTATV).
    LODE_INLINE int count() const { return count_; }
    LODE_INLINE bool has(int index) const { return index <= count_; }

  private:
    const S* old_ = nullptr;
    S* new_ = nullptr;
    std::ptrdiff_t stride_ = 1;
    int count_ = 0;
};

// The material point. Energies are per current volume (cohesive: as the page says).
template <AnalysisKind kind, class Real>
struct Point {
    Stress<kind, Real> stress;  // in: start of the increment, in the frame of its end; out: end
    State<Real> state;
    Real elastic_energy = Real(0.0);                  // out: at the end (SSE)
    Real plastic_dissipation = Real(0.0);             // out: of this increment (added to SPD)
    Real viscous_dissipation = Real(0.0);             // out: of this increment (added to SCD)
    Real thickness_strain_increment = Real(0.0);      // out, plane stress
    bool wants_thickness_strain = false;              // some models pay for it
    [[no_unique_address]] SolveCounter<Real> solves;  // every solve reports here

    // The increment cannot be done in the lanes of `where`: nothing has been written. UMAT asks for `smaller` times the
    // increment, VUMAT stops with `reason`.
    LODE_INLINE void fail(const Mask<Real>& where, const char* reason, double smaller = 0.25) {
        failed = where;
        failure = reason;
        time_step_ratio = smaller;
    }
    // What the host passed makes no sense for this material, whatever the increment: the analysis ends with
    // "<what> = <value> must be <allowed> <limit>". A limit of 0 is not printed.
    LODE_INLINE void refuse(const Mask<Real>& where, const char* what, const Real& value, const char* allowed,
                            const Real& limit = Real(0.0)) {
        fail(where, what);
        refused_value = value;
        refused_limit = limit;
        refusal = allowed;
    }
    // Something the user should know once, though the update goes on.
    LODE_INLINE void warn(const char* message) { warning = message; }

    Mask<Real> failed = Mask<Real>(false);
    const char* failure = nullptr;
    const char* warning = nullptr;
    double time_step_ratio = 1.0;
    const char* refusal = nullptr;
    Real refused_value = Real(0.0), refused_limit = Real(0.0);
};

// DDSDDE and its thermal companions, written in place. Column-major as in Fortran: (i, j) = d stress_i / d strain_j.
template <AnalysisKind kind>
struct Tangent {
    static constexpr int n = components(kind);
    double* stiffness = nullptr;         // DDSDDE
    double* thermal_stress = nullptr;    // DDSDDT, n entries, zero on entry
    double* heat_rate_strain = nullptr;  // DRPLDE, n entries, zero on entry
    double heat_rate = 0.0;              // RPL
    double heat_rate_temperature = 0.0;  // DRPLDT

    LODE_INLINE double& operator()(int i, int j) { return stiffness[i + n * j]; }
    LODE_INLINE double operator()(int i, int j) const { return stiffness[i + n * j]; }
};

// Passed instead of a Tangent by callers that need none and shall not pay for it.
struct NoTangent {};
template <class T>
inline constexpr bool wants_tangent = !std::is_same_v<T, NoTangent>;

}  // namespace lode
