// A rectangle as a part of the sphere around a viewer: its solid angle, and points that are uniform
// over it [Urena2013].
//
// The viewer sits at the origin, the rectangle at depth z < 0 with x in [x0, x1] and y in [y0, y1].
// Projected onto the sphere, its sides are arcs of great circles, and a polygon of four arcs has
// the area of its angles minus 2 pi:
//
//   solid angle = g00 + g01 + g10 + g11 - 2 pi,
//       g at the corner (x, y) = angle of the point (+-x y, -z r)
//
// with r = |(x, y, z)|, + for the corners (x1, y0) and (x0, y1) and - for the other two. Written
// so, no angle near 0 comes from a cosine near 1. Angles add up where complex numbers multiply, so
// the four need one arc tangent, not four, and lengths of the factors do not matter:
//
//   g = arg(+-x y - i z r)
#pragma once

#include "photograd/core/atan.h"
#include "photograd/core/sincos.h"
#include "photograd/core/vec.h"
#include "photograd/sampling/warp.h"

namespace photograd {

/// An angle, as that of a complex number.
struct Turn {
    double re, im;

    /// The angles add up.
    friend Turn operator*(const Turn& a, const Turn& b) {
        return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
    }
    /// Whether the angle, in [0, 2 pi), is above 3 pi / 2.
    [[nodiscard]] bool nearly_full() const { return re > 0 && im < 0; }
};

/// Perpendicular edges: their directions and lengths, and the normal.
struct RectangleAxes {
    Vec3<double> x, y, z;
    double width, height;

    RectangleAxes(const Vec3<double>& edge_x, const Vec3<double>& edge_y)
        : width(length(edge_x)), height(length(edge_y)) {
        x = edge_x * (1 / width);
        y = edge_y * (1 / height);
        z = cross(x, y);
    }
};

struct SphericalRectangle {
    /// `corner` as seen from the viewer. Solid angles are what four angles have beyond 2 pi, which
    /// leaves an error of 1e-15: numbers below 1e-6 lose digits that matter.
    SphericalRectangle(const Vec3<double>& corner, const RectangleAxes& axes)
        : x(axes.x), y(axes.y), z(axes.z) {
        if (dot(corner, z) > 0) z = -z;  // the rectangle lies on the side of -z
        x0 = dot(corner, x);
        y0 = dot(corner, y);
        depth = dot(corner, z);
        x1 = x0 + axes.width;
        y1 = y0 + axes.height;
        far_side = corner_turn(x0, y1, 1) * corner_turn(x0, y0, -1);
        const Turn near_side = corner_turn(x1, y0, 1) * corner_turn(x1, y1, -1);
        // Solid angles above pi come out negative, and so may those near 0, by rounding. The latter
        // look like those above 3/2 pi; only there, both sides have angles above 3/2 pi.
        const Turn all = far_side * near_side;
        solid_angle = polar_angle(all.im, all.re);
        const bool full = far_side.nearly_full() && near_side.nearly_full();
        if (solid_angle < 0 && (all.re < 0 || full)) solid_angle += 2 * pi;
    }

    /// A point of the rectangle, uniform as seen from the origin.
    ///
    /// The part of the rectangle left of x has a solid angle too: its two new angles are acos(-c
    /// b0) and acos(-c b1) with b0 = -y0 / sqrt(y0^2 + z^2), b1 = y1 / sqrt(y1^2 + z^2), c = x /
    /// sqrt(x^2 + z^2). Where they add up to `sum`,
    ///   c f = sqrt(1 - b0^2 c^2),   f = (b0 cos(sum) - b1) / sin(sum).
    /// With C + i S the product whose angle is -sum, of the length (x0^2 + z^2) sqrt((y0^2 + z^2)
    /// (y1^2 + z^2)), this is
    ///   x = +-z S sqrt((y0^2 + z^2) / (G^2 - z^2 S^2)),
    ///       G = y0 C + y1 (x0^2 + z^2) (y0^2 + z^2).
    /// Up the line at x, the solid angle of its points below y grows as y / sqrt(d^2 + y^2), d^2 =
    /// x^2 + z^2.
    [[nodiscard]] Vec3<double> sample(const Vec2<double>& u2) const {
        const double z2 = depth * depth, y02 = y0 * y0 + z2;
        // -sum = far_side - part, where part = u solid_angle in [0, 2 pi]; sin and cos change sign
        // with pi.
        const SinCos<double> part = sin_cos(u2.x * solid_angle - pi);
        const Turn back = far_side * Turn{-part.cos, part.sin};
        const double G = y0 * back.re + y1 * (x0 * x0 + z2) * y02, S = depth * back.im;
        const double rest = (G - S) * (G + S);
        double at_x = rest > 0 ? std::abs(S) * sqrt(y02 / rest) : 1e300;
        at_x = larger(x0, smaller(x1, G * S < 0 ? at_x : -at_x));
        const double d2 = at_x * at_x + depth * depth;
        const double low = y0 / sqrt(d2 + y0 * y0), high = y1 / sqrt(d2 + y1 * y1);
        const double h = low + u2.y * (high - low);
        double at_y = h * sqrt(d2 / (1 - h * h));
        at_y = larger(y0, smaller(y1, at_y));
        return x * at_x + y * at_y + z * depth;
    }

    Vec3<double> x, y, z;
    double x0, x1, y0, y1, depth;
    Turn far_side;  // both angles at x0
    double solid_angle;

private:
    [[nodiscard]] Turn corner_turn(double cx, double cy, double sign) const {
        return {sign * cx * cy, -depth * sqrt(cx * cx + cy * cy + depth * depth)};
    }
};

}  // namespace photograd
