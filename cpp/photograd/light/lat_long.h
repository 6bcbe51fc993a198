// A picture of all directions: longitude along its columns, the angle to the zenith down its rows.
//
//   w = (-sin(theta) sin(phi), cos(theta), sin(theta) cos(phi))
//   u = 1/2 + phi / (2 pi),  v = theta / pi
//
// The picture is twice as wide as high. Its middle shows +Z, its left and right edges -Z, its upper
// edge the zenith +Y. It is seen from inside: with +Y up, what is to the right of +Z is -X. All in
// double, since float cannot tell apart points between the texels of a large picture.
#pragma once

#include "photograd/core/atan.h"
#include "photograd/core/sincos.h"
#include "photograd/sampling/warp.h"

namespace photograd {

/// (u, v) in [0, 1] of a direction.
inline Vec2<double> lat_long_from_direction(const Vec3<double>& w) {
    const double theta = polar_angle(sqrt(w.x * w.x + w.z * w.z), w.y);
    return {0.5 + polar_angle(-w.x, w.z) / (2 * pi), theta / pi};
}

/// A direction's place in the picture, with its height beside the angle: what lookup and density
/// ask.
struct LatLong {
    double u, v, drop;
};

/// The direction at u whose height is w.y = 1 - drop; drop in [0, 2] keeps its digits at the
/// zenith.
inline Vec3<double> direction_from_lat_long(double u, double drop) {
    const SinCos<double> phi = sin_cos(2 * pi * (u - 0.5));
    const double sin_theta = sqrt(larger(0.0, drop * (2 - drop)));
    return {-sin_theta * phi.sin, 1 - drop, sin_theta * phi.cos};
}

/// 1 - w.y without cancellation at the zenith, for a direction of about unit length.
inline double drop_of(const Vec3<double>& w) {
    const double side = w.x * w.x + w.z * w.z, norm = sqrt(side + w.y * w.y);
    return w.y > 0 ? side / (norm * (norm + w.y)) : 1 - w.y / norm;
}

inline LatLong lat_long_of(const Vec3<double>& w) {
    const Vec2<double> uv = lat_long_from_direction(w);
    return {uv.x, uv.y, drop_of(w)};
}

/// Two neighboring rows or columns of texels, and how far from the first to the second.
struct TexelPair {
    int first, second;
    double fraction;
};

/// Columns go around: the last is the first's neighbor.
inline TexelPair columns_at(double u, int width) {
    const double q = smaller(width - 0.5, larger(-0.5, u * width - 0.5));  // a NaN becomes -0.5
    const int base = q < 0 ? -1 : static_cast<int>(q);
    return {base < 0 ? width - 1 : base, base + 1 < width ? base + 1 : 0, q - base};
}

/// Rows end at the poles, where the outermost row continues.
inline TexelPair rows_at(double v, int height) {
    const double inside = smaller(height - 1.0, larger(0.0, v * height - 0.5));
    const int base = static_cast<int>(inside);
    return {base, base + 1 < height ? base + 1 : base, inside - base};
}

}  // namespace photograd
