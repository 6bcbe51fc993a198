// Maps from the unit square to the sets that renderers sample; each stands beside its inverse and
// its density.
//
// All of them begin with the concentric map of the square onto the disk [Shirley1997], which keeps
// neighbors together and areas in proportion, so that strata in the square stay strata on the set.
#pragma once

#include <cmath>

#include "photograd/core/real.h"
#include "photograd/core/sincos.h"
#include "photograd/core/vec.h"

namespace photograd {

inline constexpr double pi = 3.14159265358979323846;

/// Uniform on the disk of radius 1, density 1 / pi. With (a, b) = 2 u2 - 1, in the wedge |a| > |b|:
///   r = a,  phi = (pi / 4) (b / a);      in the other: r = b,  phi = pi / 2 - (pi / 4) (a / b).
template <Real R>
Vec2<R> square_to_disk(const Vec2<R>& u2) {
    const R a = R(2) * u2.x - R(1), b = R(2) * u2.y - R(1);
    if (a == R(0) && b == R(0)) return {R(0), R(0)};
    if (a * a > b * b) {
        const SinCos<R> phi = sin_cos_small(R(pi / 4) * (b / a));
        return {a * phi.cos, a * phi.sin};
    }
    const SinCos<R> phi = sin_cos_small(R(pi / 4) * (a / b));
    return {b * phi.sin, b * phi.cos};
}
template <Real R>
Vec2<R> disk_to_square(const Vec2<R>& p) {
    // In the wedge around +-x the signed radius is a; the angle against that axis is (pi / 4) (b /
    // a).
    const R r = std::sqrt(p.x * p.x + p.y * p.y);
    if (r == R(0)) return {R(0.5), R(0.5)};
    const bool along_x = std::abs(p.x) > std::abs(p.y);
    const R major = along_x ? p.x : p.y, minor = along_x ? p.y : p.x;
    const R first = major < R(0) ? -r : r;
    const R second = first * (std::atan2(minor / major, R(1)) / R(pi / 4));
    const R a = along_x ? first : second, b = along_x ? second : first;
    return {R(0.5) * (a + R(1)), R(0.5) * (b + R(1))};
}

/// Density cos(theta) / pi around +Z: the disk, lifted onto the hemisphere above it [Malley1988].
template <Real R>
Vec3<R> square_to_cosine_hemisphere(const Vec2<R>& u2) {
    const Vec2<R> p = square_to_disk(u2);
    const R rest = R(1) - (p.x * p.x + p.y * p.y);
    return {p.x, p.y, rest > R(0) ? sqrt(rest) : R(0)};
}
template <Real R>
Vec2<R> cosine_hemisphere_to_square(const Vec3<R>& w) {
    return disk_to_square(Vec2<R>(w.x, w.y));
}
template <class R>
R cosine_hemisphere_pdf(const Vec3<R>& w) {
    return w.z > R(0) ? w.z * R(1 / pi) : R(0);
}

/// Uniform on the cap z >= 1 - height of the unit sphere, density 1 / (2 pi height); height 2 is
/// the whole sphere. A point at radius r of the disk goes to z = 1 - height r^2 (Archimedes: equal
/// areas), which scales its x and y by sin(theta) / r = sqrt(height (2 - height r^2)); nothing
/// cancels for small caps.
template <Real R>
Vec3<R> square_to_cap(const Vec2<R>& u2, R height) {
    const Vec2<R> p = square_to_disk(u2);
    const R drop = height * (p.x * p.x + p.y * p.y);
    const R rest = height * (R(2) - drop);
    const R scale = rest > R(0) ? sqrt(rest) : R(0);
    return {p.x * scale, p.y * scale, R(1) - drop};
}
template <Real R>
Vec2<R> cap_to_square(const Vec3<R>& w, R height) {
    const R drop = R(1) - w.z, rest = height * (R(2) - drop);
    const R scale = rest > R(0) ? R(1) / sqrt(rest) : R(0);
    return disk_to_square(Vec2<R>(w.x * scale, w.y * scale));
}

/// Whether w lies in the cap of this height around `axis`. |w - axis|^2 = 2 (1 - cos) tells apart
/// angles that a float cosine cannot; a hair more than the cap, so that samples on its rim belong
/// to it after rounding.
template <class R>
bool in_cap(const Vec3<R>& w, const Vec3<R>& axis, R height) {
    const Vec3<R> apart = w - axis;
    return dot(apart, apart) <= R(2.0001) * height;
}

}  // namespace photograd
