// Painter's order: each shape over those before it, in premultiplied colors [Porter1984].
//
//   a = coverage opacity alpha,   C' = (1 - a) C + a (red, green, blue, 1)
//
// The paint is taken at the center of each pixel. Backward, with g = d_C':
//
//   d_a = <g, (red, green, blue, 1) - C>    d_(red, green, blue) = a g    d_C = (1 - a) g
#pragma once

#include "photograd/vector/paint.h"
#include "photograd/vector/shape_areas.h"

namespace photograd {

/// How shapes are painted; shape s has the stops stop_begin[s] to stop_begin[s + 1] - 1, at least
/// one.
struct PaintTable {
    std::span<const std::uint8_t> kind;        // (S,) PaintKind
    std::span<const std::int64_t> stop_begin;  // (S + 1,)
    const double* opacity;                     // (S,)
    const double* geometry;                    // (S, 4)
    const double* offsets;                     // (K,)
    const double* colors;                      // (K, 4)
    const double* background;                  // (4,) premultiplied

    [[nodiscard]] std::size_t stop_count(std::size_t shape) const {
        return static_cast<std::size_t>(stop_begin[shape + 1] - stop_begin[shape]);
    }
    [[nodiscard]] Paint paint(std::size_t shape) const {
        const auto first = static_cast<std::size_t>(stop_begin[shape]);
        return {static_cast<PaintKind>(kind[shape]),
                geometry + 4 * shape,
                {offsets + first, stop_count(shape)},
                colors + 4 * first};
    }
};

/// Gradients of the arrays of a PaintTable, which are added to.
struct PaintGradients {
    double *opacity, *geometry, *offsets, *colors, *background;
};

/// Writes out (H, W, 4).
void composite(const ShapeAreas& coverage, const PaintTable& paints, double* out);
/// Writes d_values, of the coverage, and adds to the gradients of paints.
void composite_backward(const ShapeAreas& coverage, const PaintTable& paints, const double* d_out,
                        std::span<double> d_values, const PaintGradients& gradients);

}  // namespace photograd
