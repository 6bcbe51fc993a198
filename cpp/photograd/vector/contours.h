// Closed polygons that bound the shapes of a vector drawing, in pixels, y downwards.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "photograd/core/vec.h"

namespace photograd {

enum class FillRule : std::uint8_t { nonzero, even_odd };

/// Whether a point around which the contours wind `winding` times belongs to the shape.
inline bool is_inside(FillRule rule, int winding) {
    return rule == FillRule::nonzero ? winding != 0 : (winding & 1) != 0;
}

/// Contour c has the vertices contour_begin[c] to contour_begin[c + 1] - 1; the edge from the last
/// to the first closes it; shape s has the contours shape_begin[s] to shape_begin[s + 1] - 1.
struct Contours {
    std::span<const double> vertices;             // (V, 2)
    std::span<const std::int64_t> contour_begin;  // (C + 1,)
    std::span<const std::int64_t> shape_begin;    // (S + 1,)
    std::span<const std::uint8_t> rule;           // (S,) FillRule

    [[nodiscard]] Vec2<double> vertex(std::size_t v) const {
        return {vertices[2 * v], vertices[2 * v + 1]};
    }
    [[nodiscard]] std::size_t vertex_count() const { return vertices.size() / 2; }
    [[nodiscard]] std::size_t shape_count() const { return rule.size(); }

    /// (V,) the vertex to which the edge that starts at each vertex leads.
    [[nodiscard]] std::vector<std::uint32_t> next_vertices() const {
        std::vector<std::uint32_t> next(vertex_count());
        for (std::size_t c = 0; c + 1 < contour_begin.size(); ++c) {
            const auto first = static_cast<std::size_t>(contour_begin[c]);
            const auto end = static_cast<std::size_t>(contour_begin[c + 1]);
            for (std::size_t v = first; v < end; ++v)
                next[v] = static_cast<std::uint32_t>(v + 1 < end ? v + 1 : first);
        }
        return next;
    }
};

}  // namespace photograd
