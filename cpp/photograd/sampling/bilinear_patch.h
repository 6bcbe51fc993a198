// Points of the unit square with a density that is bilinear between its corners.
//
// Along one axis, density proportional to (1 - x) a + x b has the distribution function
//
//   (a x + (b - a) x^2 / 2) / ((a + b) / 2) = u
//
// whose root, in the form that does not cancel and needs no special case for a = b, is
//
//   x = u (a + b) / (a + sqrt((1 - u) a^2 + u b^2))
//
// In two dimensions first y, by the sums of the rows' ends; then x, between the values at that y.
#pragma once

#include "photograd/core/vec.h"

namespace photograd {

/// x in [0, 1] with density (1 - x) a + x b, over their mean; a and b not negative, not both 0.
template <class R>
R sample_linear(R u, R a, R b) {
    const R x = u * (a + b) / (a + sqrt((R(1) - u) * a * a + u * b * b));
    return smaller(R(1),
                   larger(R(0), x));  // rounding; in this order 0 / 0, where a = u = 0, becomes 0
}

/// Values at the corners: upper left, upper right, lower left, lower right; y points down.
template <class R>
struct BilinearPatch {
    R v00, v01, v10, v11;

    [[nodiscard]] R mean() const { return R(0.25) * ((v00 + v01) + (v10 + v11)); }
    [[nodiscard]] R at(R x, R y) const {
        return (R(1) - y) * ((R(1) - x) * v00 + x * v01) + y * ((R(1) - x) * v10 + x * v11);
    }
    /// A point of density at(x, y) / mean().
    [[nodiscard]] Vec2<R> sample(R u_x, R u_y) const {
        const R y = sample_linear(u_y, v00 + v01, v10 + v11);
        return {sample_linear(u_x, (R(1) - y) * v00 + y * v10, (R(1) - y) * v01 + y * v11), y};
    }
};

}  // namespace photograd
