// A rectangle as a part of the sphere around a viewer: its solid angle, and points that are uniform over it [Urena2013].
//
// The viewer sits at the origin, the rectangle at depth z < 0 with x in [x0, x1] and y in [y0, y1]. Projected onto the
// sphere, its sides are arcs of great circles, and a polygon of four arcs has the area of its angles minus 2 pi:
//
//   solid angle = g00 + g01 + g10 + g11 - 2 pi,      g at the corner (x, y) = atan2(-z r, +-x y),  r = |(x, y, z)|
//
// with + for the corners (x1, y0) and (x0, y1) and - for the other two. Written so, no angle near 0 comes from a cosine
// near 1.
#pragma once

#include "photograd/core/atan.h"
#include "photograd/core/sincos.h"
#include "photograd/core/vec.h"
#include "photograd/sampling/warp.h"

namespace photograd {

struct SphericalRectangle {
    /// Perpendicular edges; `corner` as seen from the viewer. Solid angles are differences of angles near pi / 2, which
    /// leaves an error of 1e-15: numbers below 1e-6 lose digits that matter.
    SphericalRectangle(const Vec3<double>& corner, const Vec3<double>& edge_x,
                       const Vec3<double>& edge_y) {
        const double width = length(edge_x), height = length(edge_y);
        x = edge_x * (1 / width);
        y = edge_y * (1 / height);
        z = cross(x, y);
        if (dot(corner, z) > 0) z = -z;  // the rectangle lies on the side of -z
        x0 = dot(corner, x);
        y0 = dot(corner, y);
        depth = dot(corner, z);
        x1 = x0 + width;
        y1 = y0 + height;
        far_side = angle(x0, y1, 1) + angle(x0, y0, -1);
        solid_angle = (angle(x1, y0, 1) + angle(x1, y1, -1) + far_side) - 2 * pi;
    }

    /// A point of the rectangle, uniform as seen from the origin.
    ///
    /// The part of the rectangle left of x has a solid angle too: its two new angles are acos(-c b0) and acos(-c b1) with
    /// b0 = -y0 / sqrt(y0^2 + z^2), b1 = y1 / sqrt(y1^2 + z^2), c = x / sqrt(x^2 + z^2). Where they add up to `sum`,
    ///   c f = sqrt(1 - b0^2 c^2),   f = (b0 cos(sum) - b1) / sin(sum),   so   c = sign(f) / sqrt(f^2 + b0^2).
    /// Up the line at x, the solid angle of its points below y grows as y / sqrt(d^2 + y^2), d^2 = x^2 + z^2.
    [[nodiscard]] Vec3<double> sample(const Vec2<double>& u2) const {
        const double b0 = -y0 / sqrt(y0 * y0 + depth * depth),
                     b1 = y1 / sqrt(y1 * y1 + depth * depth);
        // sum lies in [0, 2 pi]; sin and cos change sign with pi.
        const SinCos<double> turn = sin_cos(u2.x * solid_angle + (pi - far_side));
        const double f = (b0 * -turn.cos - b1) / -turn.sin;
        const double c = (f > 0 ? 1 : -1) / sqrt(f * f + b0 * b0);
        const double rest = 1 - c * c;
        double at_x = rest > 0 ? -c * depth / sqrt(rest) : c * 1e300;
        at_x = larger(x0, smaller(x1, at_x));
        const double d2 = at_x * at_x + depth * depth;
        const double low = y0 / sqrt(d2 + y0 * y0), high = y1 / sqrt(d2 + y1 * y1);
        const double h = low + u2.y * (high - low);
        double at_y = h * sqrt(d2 / (1 - h * h));
        at_y = larger(y0, smaller(y1, at_y));
        return x * at_x + y * at_y + z * depth;
    }

    Vec3<double> x, y, z;
    double x0, x1, y0, y1, depth;
    double far_side;  // angles at the two corners of x0
    double solid_angle;

private:
    [[nodiscard]] double angle(double cx, double cy, double sign) const {
        return polar_angle(-depth * sqrt(cx * cx + cy * cy + depth * depth), sign * cx * cy);
    }
};

}  // namespace photograd
