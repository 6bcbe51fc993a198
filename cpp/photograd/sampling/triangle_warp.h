// Uniform points of a triangle, and what a density over area becomes over solid angle.
#pragma once

#include "photograd/core/real.h"
#include "photograd/core/vec.h"

namespace photograd {

/// Weights (u, v) of the second and third corner, uniform over the triangle. The square is folded
/// onto the half of itself along its diagonal by sliding points parallel to it [Heitz2019], which
/// tears nothing apart.
template <Real R>
Vec2<R> square_to_triangle(const Vec2<R>& u2) {
    if (u2.y > u2.x) return {R(0.5) * u2.x, u2.y - R(0.5) * u2.x};
    return {u2.x - R(0.5) * u2.y, R(0.5) * u2.y};
}

/// A small area dA at the distance r whose normal makes an angle with the line of sight fills the
/// solid angle dA cos / r^2. So a density over area is multiplied by r^2 / cos.
template <class R>
R solid_angle_density(R area_density, R distance_squared, R cosine) {
    return area_density * distance_squared / cosine;
}

}  // namespace photograd
