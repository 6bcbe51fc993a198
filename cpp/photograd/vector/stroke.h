// Outlines of strokes: what a pen of some width covers along a polyline, with joins and caps.
//
// The outline goes along one side of the polyline and back along the other. On the outer side of a
// corner the join fills the wedge between the two segments; on the inner side the outline passes
// through the corner itself. So the winding number is the sum of those of rectangles about the
// segments, wedges and caps, which are all of one orientation: the nonzero rule gives their union,
// however often they overlap. Where both segments are longer than what the inner side overlaps, the
// detour through the corner changes nothing, and is left out.
//
// Every vertex of an outline is P + h R with a point P of the polyline, half of the width h, and R
// a function of the directions of the two segments that meet there, as angles:
//
//   d_P += g    d_h += <g, R>    d_angle_in += h <g, dR/dangle_in>    d_angle_out likewise
//   dangle/dQ = -dangle/dP = (-D_y, D_x) / |D|^2 of a segment D = Q - P
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "photograd/core/vec.h"

namespace photograd {

enum class Cap : std::uint8_t { butt, round, square };
enum class Join : std::uint8_t { miter, round, bevel };

struct StrokeStyle {
    double half_width;   // an outline of 0 or less is empty
    double miter_limit;  // the longest miter over the width; beyond it the join is a bevel
    Cap cap;
    Join join;
    bool closed;
    int arc;  // straight pieces that stand for half a circle
};

/// points (N, 2); corner (N,) is 1 at corners of the path and 0 at points on a curve, which are
/// joined by arcs. Points that follow one another at one place count as one.
struct Polyline {
    std::span<const double> points;
    std::span<const std::uint8_t> corner;
};

struct OutlineVertex {
    std::uint32_t point;          // number of P
    std::uint32_t in, out;        // numbers of the segments whose angles R depends on
    Vec2<double> r, d_in, d_out;  // R, and its derivatives with respect to the two angles
};

struct StrokeOutline {
    std::vector<OutlineVertex> vertices;
    std::vector<std::int64_t> contour_ends;  // number of vertices up to the end of each contour
    std::vector<std::uint32_t> segments;     // (M, 2) numbers of the points of each segment
};

/// One contour, two of a closed polyline, none of one without length.
[[nodiscard]] StrokeOutline stroke_outline(const Polyline& line, const StrokeStyle& style);
/// Adds to d_points (N, 2), and returns d_half_width; d_vertices (K, 2) of the outline's vertices.
[[nodiscard]] double stroke_outline_backward(const Polyline& line, const StrokeStyle& style,
                                             const StrokeOutline& outline, const double* d_vertices,
                                             double* d_points);

}  // namespace photograd
