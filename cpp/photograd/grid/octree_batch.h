// Batched queries of a tree: the leaf of each point, and the leaves along each ray.
//
// The visits of a batch are compressed rows: those of ray r are [ray_offset[r], ray_offset[r + 1]).
// They are counted first and written afterwards, so the result does not depend on threads.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "photograd/core/parallel.h"
#include "photograd/grid/octree.h"

namespace photograd {

/// Rows of leaves and the interval (t0, t1) of the ray in each.
template <class R>
struct LeafVisits {
    std::vector<std::int64_t> ray_offset;
    std::vector<std::int32_t> leaf;
    std::vector<R> t0, t1;
};

namespace detail {

inline constexpr std::int64_t rows_at_once = 4096;

/// Calls body(row) for all rows, a fixed number of them in a piece.
template <class Body>
void for_rows(std::int64_t rows, Body&& body) {
    parallel_for((rows + rows_at_once - 1) / rows_at_once, [&](std::int64_t piece) {
        const std::int64_t end = std::min(rows, (piece + 1) * rows_at_once);
        for (std::int64_t row = piece * rows_at_once; row < end; ++row) body(row);
    });
}

}  // namespace detail

/// leaf (N,) of points (N, D) in cells; `SpatialTree::outside` beyond the root.
template <class R, int D>
void locate_batch(const SpatialTree<D>& tree, const R* points, std::int64_t count,
                  std::int32_t* leaf) {
    detail::for_rows(count, [&](std::int64_t i) { leaf[i] = tree.locate(points + i * D); });
}

/// Rays with origins and directions (N, D) in cells, limited to [t_min, t_max] (N,).
template <class R, int D>
LeafVisits<R> traverse_batch(const SpatialTree<D>& tree, const R* origins, const R* directions,
                             const R* t_min, const R* t_max, std::int64_t count) {
    LeafVisits<R> out;
    out.ray_offset.assign(static_cast<std::size_t>(count) + 1, 0);
    std::int64_t* const offset = out.ray_offset.data();
    detail::for_rows(count, [&](std::int64_t i) {
        std::int64_t visits = 0;
        tree.traverse(origins + i * D, directions + i * D, t_min[i], t_max[i],
                      [&](std::int32_t, R, R) { return ++visits > 0; });
        offset[i + 1] = visits;
    });
    for (std::int64_t i = 0; i < count; ++i) offset[i + 1] += offset[i];
    const auto total = static_cast<std::size_t>(offset[count]);
    out.leaf.resize(total);
    out.t0.resize(total);
    out.t1.resize(total);
    detail::for_rows(count, [&](std::int64_t i) {
        auto at = static_cast<std::size_t>(offset[i]);
        tree.traverse(origins + i * D, directions + i * D, t_min[i], t_max[i],
                      [&](std::int32_t leaf, R t0, R t1) {
                          out.leaf[at] = leaf;
                          out.t0[at] = t0;
                          out.t1[at++] = t1;
                          return true;
                      });
    });
    return out;
}

}  // namespace photograd
