// The color of a shape at a point: constant, or a linear or radial gradient between stops.
//
//   linear   t = <p - a, d> / <d, d>,  d = b - a          geometry (a_x, a_y, b_x, b_y)
//   radial   t = |p - c| / r                              geometry (c_x, c_y, r, unused)
//
// Between the stops k and k + 1, s = (t - o_k) / (o_{k+1} - o_k) blends their colors, red, green,
// blue and alpha, none multiplied by another. Outside of all stops it is the color of the nearest.
// Where b = a or r = 0 it is that of the last, with no derivative [SVG 1.1, Sect. 13.2].
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "photograd/core/vec.h"

namespace photograd {

enum class PaintKind : std::uint8_t { solid, linear, radial };

struct Paint {
    PaintKind kind;
    const double* geometry;           // (4,)
    std::span<const double> offsets;  // (K,) that do not fall
    const double* colors;             // (K, 4)
};

/// Where between the stops a point lies: between stop and stop + 1 if `blends`, else at stop.
struct StopBlend {
    std::size_t stop;
    double share;
    bool blends;
    double distance;  // of a radial gradient, from its center
};

inline StopBlend find_stops(const Paint& paint, Vec2<double> p) {
    const double* a = paint.geometry;
    const std::size_t last = paint.offsets.size() - 1;
    double t = 0, distance = 0;
    if (paint.kind == PaintKind::solid) return {0, 0, false, 0};
    if (paint.kind == PaintKind::linear) {
        const double dx = a[2] - a[0], dy = a[3] - a[1], square = dx * dx + dy * dy;
        if (!(square > 0)) return {last, 0, false, 0};
        t = ((p.x - a[0]) * dx + (p.y - a[1]) * dy) / square;
    } else {
        if (!(a[2] > 0)) return {last, 0, false, 0};
        const double dx = p.x - a[0], dy = p.y - a[1];
        distance = std::sqrt(dx * dx + dy * dy);
        t = distance / a[2];
    }
    if (t < paint.offsets[0]) return {0, 0, false, distance};
    if (t >= paint.offsets[last]) return {last, 0, false, distance};
    std::size_t k = 0;
    while (paint.offsets[k + 1] <= t) ++k;
    return {k, (t - paint.offsets[k]) / (paint.offsets[k + 1] - paint.offsets[k]), true, distance};
}

/// Red, green, blue and alpha at p.
inline std::array<double, 4> paint_color(const Paint& paint, Vec2<double> p) {
    const StopBlend at = find_stops(paint, p);
    std::array<double, 4> color;
    for (std::size_t i = 0; i < 4; ++i) {
        const double here = paint.colors[4 * at.stop + i];
        color[i] =
            at.blends ? (1 - at.share) * here + at.share * paint.colors[4 * at.stop + 4 + i] : here;
    }
    return color;
}

/// Adds to d_geometry (4,), d_offsets (K,) and d_colors (K, 4).
inline void paint_color_backward(const Paint& paint, Vec2<double> p,
                                 const std::array<double, 4>& d_color, double* d_geometry,
                                 double* d_offsets, double* d_colors) {
    const StopBlend at = find_stops(paint, p);
    double d_share = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t here = 4 * at.stop + i;
        d_colors[here] += (at.blends ? 1 - at.share : 1) * d_color[i];
        if (!at.blends) continue;
        d_colors[here + 4] += at.share * d_color[i];
        d_share += (paint.colors[here + 4] - paint.colors[here]) * d_color[i];
    }
    if (!at.blends) return;
    const double d_t = d_share / (paint.offsets[at.stop + 1] - paint.offsets[at.stop]);
    d_offsets[at.stop] -= d_t * (1 - at.share);
    d_offsets[at.stop + 1] -= d_t * at.share;
    const double* a = paint.geometry;
    if (paint.kind == PaintKind::linear) {
        // dt/da = (-d - (p - a) + 2 t d) / <d, d>,  dt/db = ((p - a) - 2 t d) / <d, d>
        const double d[2] = {a[2] - a[0], a[3] - a[1]}, from[2] = {p.x - a[0], p.y - a[1]};
        const double square = d[0] * d[0] + d[1] * d[1];
        const double t = (from[0] * d[0] + from[1] * d[1]) / square;
        for (std::size_t i = 0; i < 2; ++i) {
            const double d_end = d_t * (from[i] - 2 * t * d[i]) / square;
            d_geometry[i] -= d_end + d_t * d[i] / square;
            d_geometry[2 + i] += d_end;
        }
        return;
    }
    if (at.distance > 0) {
        const double along = d_t / (at.distance * a[2]);
        d_geometry[0] -= along * (p.x - a[0]);
        d_geometry[1] -= along * (p.y - a[1]);
    }
    d_geometry[2] -= d_t * at.distance / (a[2] * a[2]);
}

}  // namespace photograd
