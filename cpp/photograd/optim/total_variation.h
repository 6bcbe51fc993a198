// Squared total variation of values on the active voxels of a sparse grid, and its adjoint.
//
//   value = 1 / (N C) sum over pairs of active neighbors a, b and channels of (v_b - v_a)^2
//   d_v_a += d_value 2 / (N C) sum over active neighbors b of (v_a - v_b)
//
// Neighbors are the six voxels that share a face; a pair counts once. Where a neighbor is not
// active there is no difference: nothing is known about it. N is the number of active voxels.
#pragma once

#include <algorithm>

#include "photograd/core/parallel.h"
#include "photograd/core/real.h"
#include "photograd/grid/brick_topology.h"

namespace photograd {

namespace detail {

/// visit(row, neighbor's row, axis, +1 or -1) for all active voxels of a brick and their neighbors.
template <class Visit>
void for_neighbors(const BrickTopology& topology, std::int32_t brick, Visit&& visit) {
    const std::int32_t* rows = topology.rows_of(brick);
    const std::int32_t* origin = topology.origins().data() + 3 * std::int64_t(brick);
    std::int32_t beyond[3][2];  // the bricks behind the six faces
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            int at[3] = {origin[0], origin[1], origin[2]};
            at[axis] += side ? 8 : -8;
            beyond[axis][side] = topology.brick_of(at[0], at[1], at[2]);
        }
    constexpr int stride[3] = {64, 8, 1};
    for (int v = 0; v < BrickTopology::voxels_per_brick; ++v) {
        if (rows[v] < 0) continue;
        for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 2; ++side) {
                const int local = v / stride[axis] & 7, step = side ? 1 : -1;
                std::int32_t other = no_row;
                if (((local + step) & ~7) == 0)
                    other = rows[v + step * stride[axis]];
                else if (beyond[axis][side] >= 0)
                    other = topology.rows_of(beyond[axis][side])[v - 7 * step * stride[axis]];
                if (other >= 0) visit(rows[v], other, axis, step);
            }
    }
}

}  // namespace detail

/// values (N, C).
template <Real R>
double total_variation(const BrickTopology& topology, const R* values, int channels) {
    std::vector<double> part(static_cast<std::size_t>(topology.bricks()), 0.0);
    parallel_for(topology.bricks(), [&](std::int64_t brick) {
        double total = 0.0;
        detail::for_neighbors(topology, static_cast<std::int32_t>(brick),
                              [&](std::int32_t row, std::int32_t other, int, int step) {
                                  if (step < 0) return;
                                  const R *a = values + std::int64_t(row) * channels,
                                          *b = values + std::int64_t(other) * channels;
                                  for (int c = 0; c < channels; ++c)
                                      total += double(b[c] - a[c]) * double(b[c] - a[c]);
                              });
        part[static_cast<std::size_t>(brick)] = total;
    });
    double total = 0.0;
    for (const double one : part) total += one;
    return total / (double(topology.voxels()) * channels);
}
/// Adds to the rows of d_values (N, C) that belong to bricks first .. last - 1, and to no others.
template <Real R>
void total_variation_backward(const BrickTopology& topology, const R* values, int channels,
                              double d_value, std::int64_t first, std::int64_t last, R* d_values) {
    const R factor = static_cast<R>(2.0 * d_value / (double(topology.voxels()) * channels));
    parallel_for(last - first, [&](std::int64_t i) {
        detail::for_neighbors(topology, static_cast<std::int32_t>(first + i),
                              [&](std::int32_t row, std::int32_t other, int, int) {
                                  const R *a = values + std::int64_t(row) * channels,
                                          *b = values + std::int64_t(other) * channels;
                                  R* d = d_values + std::int64_t(row) * channels;
                                  for (int c = 0; c < channels; ++c) d[c] += factor * (a[c] - b[c]);
                              });
    });
}

}  // namespace photograd
