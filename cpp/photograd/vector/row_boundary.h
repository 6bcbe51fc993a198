// The boundary of one shape within one row of pixels, exact under overlaps and self-intersections.
//
// The edges that meet the row are cut at their ends and where they cross, so that in each of the
// strips between two cuts they do not cross. From left to right along the middle of a strip the
// winding number changes by the direction of each edge, and an edge bounds the shape where the fill
// rule gives different answers on its two sides. What is left is a set of edges with no overlap, of
// which sums of signed areas are exact.
//
// Horizontal edges bound no area from the side, but the area changes when they move: they are cut
// at the edges that end on them, and kept for the derivative. One on the border of two rows belongs
// to the lower.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "photograd/vector/contours.h"

namespace photograd {

/// The part of an edge between its parameters t0 < t1 that bounds a shape in a row, from y0 to y1.
/// When the edge from a to b moves by m(t), the area changes by
/// sign * integral of <m(t), (dy, -dx)> dt with (dx, dy) = b - a.
struct BoundaryPiece {
    std::uint32_t edge;
    double t0, t1, y0, y1;  // y0 = y1 for horizontal edges
    double sign;            // +1 or -1
};

/// An edge within a row, looking down.
struct RowEdge {
    std::uint32_t edge;
    int direction;            // +1 down, -1 up
    Vec2<double> top;         // upper end of the whole edge
    double height, slope;     // dy and dx/dy of the whole edge
    double y0, y1;            // within the row
    double x_low, x_high;     // of the whole edge
    std::int64_t last_piece;  // that it has given, -1 for none
    [[nodiscard]] double x_at(double y) const {
        const double x = top.x + (y - top.y) * slope;
        return x < x_low ? x_low : (x > x_high ? x_high : x);
    }
};

/// Finds boundaries; holds buffers that the next call reuses.
class RowBoundary {
public:
    /// The boundary in the row [row, row + 1) of the shape that has the `edges`, which start at the
    /// vertices of these numbers. Writes pieces(), horizontal ones last.
    void find(const Contours& contours, std::span<const std::uint32_t> next,
              std::span<const std::uint32_t> edges, std::int64_t row, FillRule rule);

    [[nodiscard]] std::span<const BoundaryPiece> pieces() const { return pieces_; }

private:
    void take_edges(const Contours& contours, std::span<const std::uint32_t> next,
                    std::span<const std::uint32_t> edges, double row);
    void cut();
    void toggle(FillRule rule, double top, double bottom);
    void add_piece(RowEdge& edge, double top, double bottom, double sign);
    void toggle_horizontal(const Contours& contours, std::span<const std::uint32_t> next,
                           FillRule rule, std::span<const std::uint32_t> level);

    std::vector<RowEdge> edges_;
    std::vector<std::uint32_t> horizontal_;
    std::vector<double> cuts_;
    std::vector<std::pair<double, std::uint32_t>> active_;  // x in the middle of a strip, edges_
    std::vector<BoundaryPiece> pieces_;
};

}  // namespace photograd
