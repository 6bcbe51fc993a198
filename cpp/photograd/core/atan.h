// atan2 with the same bits on every processor (libm picks its variant by processor).
#pragma once

#include "photograd/core/dual.h"

namespace photograd {

/// atan on [0, 1]. Halving the angle twice, tan(a / 2) = tan(a) / (1 + sqrt(1 + tan(a)^2)), leaves
/// at most t = tan(pi / 16) = 0.2, where the series t - t^3 / 3 + t^5 / 5 - ... ends after t^23
/// with a remainder below 1e-18.
template <class R>
R atan_unit(R t) {
    for (int half = 0; half < 2; ++half) t = t / (R(1) + sqrt(R(1) + t * t));
    const R y = -t * t;
    R sum = R(1.0 / 23.0);
    for (int n = 21; n >= 1; n -= 2) sum = sum * y + R(1.0 / n);
    return R(4) * (t * sum);
}

/// The angle from the x axis to the point (x, y), in [-pi, pi]; 0 for the origin.
template <class R>
R polar_angle(R y, R x) {
    constexpr double half_turn = 3.14159265358979323846;
    const R up = y < R(0) ? -y : y, right = x < R(0) ? -x : x;
    if (!(up > R(0)) && !(right > R(0))) return R(0);
    R angle = up > right ? R(half_turn / 2) - atan_unit(right / up) : atan_unit(up / right);
    if (x < R(0)) angle = R(half_turn) - angle;
    return y < R(0) ? -angle : angle;
}

}  // namespace photograd
