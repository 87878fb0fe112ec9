// A function given by points, straight in between and constant outside: the vertical shifts b_T(T) and b_c(c).
#pragma once

#include <vector>

#include "lode/material/properties.hpp"
#include "lode/numerics/scalar.hpp"

namespace lode {

class PiecewiseLinear {
  public:
    PiecewiseLinear() = default;
    // `count` pairs from PROPS(first) on. Throws BadProperty where the arguments do not increase.
    PiecewiseLinear(const Properties& p, int count, int first) : largest_(count > 0 ? p[first + 1] : 1.0) {
        start_ = largest_;
        for (int i = 1; i < count; ++i) {
            const int at = first + 2 * i;
            const double from = p[at - 2], to = p[at], rise = p[at + 1] - p[at - 1];
            if (!(to > from)) p.refuse(at, "> " + format_number(from) + ", the one before it");
            segments_.push_back({from, to - from, rise / (to - from)});
            largest_ = std::max(largest_, p[at + 1]);
        }
    }
    bool is_constant() const { return segments_.empty(); }
    double largest() const { return largest_; }
    // False if it is 1 everywhere.
    bool is_not_one() const { return !is_constant() || largest_ != 1.0; }

    template <class Real>
    LODE_INLINE Real operator()(const Real& x) const {
        Real y(start_);
        for (const Segment& s : segments_) y = y + s.slope * max(min(x - s.from, Real(s.width)), Real(0.0));
        return y;
    }

  private:
    struct Segment {
        double from, width, slope;
    };
    std::vector<Segment> segments_;
    double start_ = 1.0, largest_ = 1.0;
};

}  // namespace lode
