// atan2 with the same bits on every processor (libm picks its variant by processor).
#pragma once

#include "photograd/core/dual.h"

namespace photograd {

/// atan t for |t| <= tan(pi / 8) as t + t^3 q(t^2), with a Chebyshev interpolant q whose error is
/// below 4e-17. Even and odd terms are summed apart: two short chains instead of one long one.
template <class R>
R atan_small(R t) {
    const R y = t * t, z = y * y;
    constexpr double even[] = {-0.019176887104237526, -0.05085449737521250, -0.06664511447372731,
                               -0.09090904578123874,  -0.14285714284666543, -0.33333333333333330};
    constexpr double odd[] = {0.03923165828348216, 0.05858148912722139, 0.07692183190825432,
                              0.11111111015256361, 0.19999999999995521};
    R sum = R(even[0]), between = R(odd[0]);
    for (int n = 1; n < 6; ++n) sum = sum * z + R(even[n]);
    for (int n = 1; n < 5; ++n) between = between * z + R(odd[n]);
    return t + t * (y * (sum + y * between));
}

/// The angle from the x axis to the point (x, y), in [-pi, pi]; 0 for the origin.
///
/// With lo and hi the smaller and larger of |x| and |y|, atan(lo / hi) is small up to pi / 8, and
/// from there on pi / 4 + atan((lo - hi) / (lo + hi)).
template <class R>
R polar_angle(R y, R x) {
    constexpr double half_turn = 3.14159265358979323846, tan_eighth = 0.41421356237309505;
    const R up = y < R(0) ? -y : y, right = x < R(0) ? -x : x;
    if (!(up > R(0)) && !(right > R(0))) return R(0);
    const bool steep = up > right;
    const R lo = steep ? right : up, hi = steep ? up : right;
    const bool far = lo > R(tan_eighth) * hi;
    const R t = (far ? lo - hi : lo) / (far ? lo + hi : hi);
    R angle = R(far ? half_turn / 4 : 0.0) + atan_small(t);
    if (steep) angle = R(half_turn / 2) - angle;
    if (x < R(0)) angle = R(half_turn) - angle;
    return y < R(0) ? -angle : angle;
}

}  // namespace photograd
