// One lookup between the levels of a mip map; mip_sample.h has the formulas, and does it for many
// points.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include "photograd/core/exp.h"
#include "photograd/texture/image.h"

namespace photograd {

/// log2 x for x >= 1, by our own logarithm: a library's may differ between processors in the last
/// bit.
inline double log2_above_one(double x) {
    int exponent = 0;
    const double mantissa =
        std::frexp(smaller(x, std::numeric_limits<double>::max()), &exponent);  // in [1/2, 1)
    return exponent - 1 + log1p_unit(2 * mantissa - 1) / std::numbers::ln2;
}

/// max(log2 rho, 0) by rho^2: of a footprint of at most a texel, a point for example, level 0 is
/// wanted.
inline double level_of_squared(double longest) {
    return longest > 1 ? 0.5 * log2_above_one(longest) : 0.0;
}

/// Two neighboring levels, `first` and `second`, the same one where there is but one.
template <class R>
struct LevelPair {
    int first, second;
    R t;
    bool clamped;

    static LevelPair of(R level, int levels) {
        const R last = R(levels - 1);
        const R inside = smaller(last, larger(R(0), level));
        const int first = larger(smaller(to_int(inside), levels - 2), 0);
        return {first, smaller(first + 1, levels - 1), inside - R(first),
                !(level >= R(0) && level < last)};
    }
    /// Weight of level k in the value.
    [[nodiscard]] R weight(int k) const {
        return (k == first ? R(1) - t : R(0)) + (k == second ? t : R(0));
    }
    [[nodiscard]] bool holds(int k) const { return k == first || k == second; }
};

}  // namespace photograd
