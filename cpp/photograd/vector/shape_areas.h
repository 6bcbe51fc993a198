// The exact area that each shape of a vector drawing covers of each pixel, and its derivative with
// respect to the vertices.
//
// Rows of pixels are independent: a row is one thread's, and an edge's derivative is summed by the
// thread that owns the edge, over its pieces in order. The same bits on any number of threads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "photograd/vector/contours.h"
#include "photograd/vector/row_boundary.h"

namespace photograd {

/// The pixels x0 to x0 + count - 1 of a row that a shape may cover; values from `first`.
struct AreaSpan {
    std::uint32_t shape;
    std::int32_t row, x0, count;
    std::size_t first;
};

class ShapeAreas {
public:
    /// Throws std::length_error where edges and rows, or shapes and pixels, meet more than 2^28
    /// times.
    ShapeAreas(const Contours& contours, int height, int width);

    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] std::size_t shape_count() const { return shape_count_; }
    /// Sorted by row, then by shape; those of row y are row_begin()[y] to row_begin()[y + 1] - 1.
    [[nodiscard]] std::span<const AreaSpan> spans() const { return spans_; }
    [[nodiscard]] std::span<const std::size_t> row_begin() const { return row_begin_; }
    /// Covered areas in [0, 1], span after span.
    [[nodiscard]] std::span<const double> values() const { return values_; }

    /// Adds to d_vertices (V, 2); d_values has the size of values(); the contours are those that
    /// were given to the constructor.
    void backward(const Contours& contours, std::span<const double> d_values,
                  double* d_vertices) const;

private:
    struct StoredPiece {
        std::uint32_t edge, span;
        double t0, t1, sign;
    };
    struct Row;
    void fill_row(const Contours& contours, std::span<const std::uint32_t> next,
                  std::span<const std::uint32_t> shape_of, std::span<const std::uint32_t> edges,
                  int row, Row& out) const;
    void add_area(const BoundaryPiece& piece, Vec2<double> a, Vec2<double> b, int x0,
                  std::span<double> sums) const;

    int height_, width_;
    std::size_t shape_count_;
    std::vector<AreaSpan> spans_;
    std::vector<std::size_t> row_begin_;
    std::vector<double> values_;
    std::vector<StoredPiece> pieces_;
};

}  // namespace photograd
