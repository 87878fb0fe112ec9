// Newton's method with line search for small dense systems (up to about 8 unknowns), and the LU factorisation it uses.
// One material point at a time: Real is double or an automatic-differentiation number.
#pragma once

#include <array>

#include "lode/numerics/scalar.hpp"

namespace lode {

template <class Real, int n>
using DenseVector = std::array<Real, static_cast<std::size_t>(n)>;

template <class Real, int n>
struct DenseMatrix {
    std::array<Real, static_cast<std::size_t>(n* n)> m;  // row by row, not set

    constexpr Real& operator()(int i, int j) { return m[static_cast<std::size_t>(n * i + j)]; }
    constexpr const Real& operator()(int i, int j) const { return m[static_cast<std::size_t>(n * i + j)]; }
};

// P A = L U with partial pivoting on rows scaled to a largest entry of 1.
template <class Real, int n>
class LuFactors {
  public:
    explicit LuFactors(const DenseMatrix<Real, n>& a) : lu_(a) {
        DenseVector<double, n> weight;
        for (int i = 0; i < n; ++i) {
            double largest = 0.0;
            for (int j = 0; j < n; ++j) largest = std::max(largest, std::abs(value_of(lu_(i, j))));
            if (!(largest > 0.0) || !(largest < std::numeric_limits<double>::infinity())) return;
            weight[index(i)] = 1.0 / largest;
            row_[index(i)] = i;
        }
        for (int k = 0; k < n; ++k) {
            int pivot = k;
            double best = -1.0;
            for (int i = k; i < n; ++i) {
                const double size = std::abs(value_of(lu_(row(i), k))) * weight[index(row(i))];
                if (size > best) best = size, pivot = i;
            }
            if (!(best > rank_tolerance)) return;
            std::swap(row_[index(k)], row_[index(pivot)]);
            for (int i = k + 1; i < n; ++i) {
                const Real factor = lu_(row(i), k) / lu_(row(k), k);
                lu_(row(i), k) = factor;
                for (int j = k + 1; j < n; ++j) lu_(row(i), j) = lu_(row(i), j) - factor * lu_(row(k), j);
            }
        }
        regular_ = true;
    }

    // False if a pivot vanished to rounding or an entry is not finite; `solve` then means nothing.
    bool regular() const { return regular_; }

    // x of A x = b.
    DenseVector<Real, n> solve(const DenseVector<Real, n>& b) const {
        DenseVector<Real, n> x;
        for (int i = 0; i < n; ++i) {
            Real sum = b[index(row(i))];
            for (int j = 0; j < i; ++j) sum = sum - lu_(row(i), j) * x[index(j)];
            x[index(i)] = sum;
        }
        for (int i = n - 1; i >= 0; --i) {
            Real sum = x[index(i)];
            for (int j = i + 1; j < n; ++j) sum = sum - lu_(row(i), j) * x[index(j)];
            x[index(i)] = sum / lu_(row(i), i);
        }
        return x;
    }

  private:
    static constexpr double rank_tolerance = 4.0 * std::numeric_limits<double>::epsilon();
    static constexpr std::size_t index(int i) { return static_cast<std::size_t>(i); }
    int row(int i) const { return row_[index(i)]; }

    DenseMatrix<Real, n> lu_;
    std::array<int, static_cast<std::size_t>(n)> row_{};
    bool regular_ = false;
};

enum class NewtonStatus { converged, singular, no_descent, iteration_limit, outside_domain };

template <class Real, int n>
struct NewtonResult {
    DenseVector<Real, n> x;
    NewtonStatus status;
    int iterations;   // Newton steps
    double residual;  // largest |r_i| reached
    int safeguards;   // steps halved
    bool converged() const { return status == NewtonStatus::converged; }
};

// Solves r(x) = 0. `system(x, r, jacobian)` fills r_i and dr_i/dx_j and returns false where x is outside its domain
// (then nothing else is read); the start must be inside. The residuals should be scaled alike: convergence is max |r_i|
// <= tolerance. Each step is halved until the sum of squares falls by Armijo's rule (at least 1e-4 of the predicted
// decrease). Derivatives of an automatic-differentiation number follow from the implicit function theorem. Source:
// Nocedal and Wright, Numerical Optimization, 3.1 and 11.2.
template <int n, class Real, class System>
inline NewtonResult<Real, n> solve_dense_newton(const System& system, const DenseVector<Real, n>& start,
                                                double tolerance, int max_iterations = 50) {
    constexpr int halvings = 30;
    const auto largest = [](const DenseVector<double, n>& v) {
        double size = 0.0;
        for (double x : v) size = std::abs(x) <= size ? size : std::abs(x);  // a NaN stays
        return size;
    };
    const auto merit = [](const DenseVector<double, n>& v) {
        double sum = 0.0;
        for (double x : v) sum += x * x;
        return sum;
    };
    const auto evaluate = [&](const DenseVector<double, n>& x, DenseVector<double, n>& r, DenseMatrix<double, n>& j) {
        if constexpr (!is_differentiated<Real>) return system(x, r, j);
        else {
            DenseVector<Real, n> xr, rr;
            DenseMatrix<Real, n> jr;
            for (std::size_t i = 0; i < x.size(); ++i) xr[i] = Real(x[i]);
            if (!system(xr, rr, jr)) return false;
            for (std::size_t i = 0; i < x.size(); ++i) r[i] = value_of(rr[i]);
            for (std::size_t i = 0; i < j.m.size(); ++i) j.m[i] = value_of(jr.m[i]);
            return true;
        }
    };

    DenseVector<double, n> x, r;
    DenseMatrix<double, n> jacobian;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = value_of(start[i]);
    NewtonStatus status = NewtonStatus::iteration_limit;
    int iterations = 0, halved = 0;
    double size = std::numeric_limits<double>::infinity();
    if (!evaluate(x, r, jacobian)) status = NewtonStatus::outside_domain;
    else {
        for (;; ++iterations) {
            size = largest(r);
            if (size <= tolerance) {
                status = NewtonStatus::converged;
                break;
            }
            if (iterations == max_iterations) break;
            const LuFactors<double, n> lu(jacobian);
            if (!lu.regular()) {
                status = NewtonStatus::singular;
                break;
            }
            const DenseVector<double, n> step = lu.solve(r);
            const double old = merit(r);
            double length = 1.0;
            bool accepted = false;
            for (int h = 0; h <= halvings && !accepted; ++h, length *= 0.5) {
                DenseVector<double, n> trial, r_trial;
                for (std::size_t i = 0; i < x.size(); ++i) trial[i] = x[i] - length * step[i];
                if (h > 0) ++halved;
                if (!evaluate(trial, r_trial, jacobian) || !(merit(r_trial) <= (1.0 - 2e-4 * length) * old)) continue;
                x = trial;
                r = r_trial;
                accepted = true;
            }
            if (!accepted) {
                status = NewtonStatus::no_descent;
                break;
            }
        }
    }

    NewtonResult<Real, n> result{{}, status, iterations, size, halved};
    for (std::size_t i = 0; i < x.size(); ++i) result.x[i] = Real(x[i]);
    if constexpr (is_differentiated<Real>) {
        if (status == NewtonStatus::converged) {
            DenseVector<Real, n> rr;
            DenseMatrix<Real, n> jr;
            system(result.x, rr, jr);
            for (std::size_t i = 0; i < x.size(); ++i) rr[i] = rr[i] - Real(value_of(rr[i]));
            for (Real& entry : jr.m) entry = Real(value_of(entry));
            const LuFactors<Real, n> lu(jr);
            if (lu.regular()) {
                const DenseVector<Real, n> dx = lu.solve(rr);
                for (std::size_t i = 0; i < x.size(); ++i) result.x[i] = result.x[i] - dx[i];
            }
        }
    }
    return result;
}

}  // namespace lode
