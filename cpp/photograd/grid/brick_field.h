// Values on a brick topology: many trilinear lookups, and their adjoint.
//
//   out[n] = sum over the 8 corners of the cell of point n of weight (value row, or background)
//
//   d_values[row]  += weight d_out[n]       for each corner that has a row
//   d_background   += weight d_out[n]       for each corner that has none
//   d_points[n]    += the slopes of ops/cell_blend.h (one index step is one voxel)
//
// Topology is held constant. The adjoint is computed by owners: pairs (brick, point) are sorted by
// brick, and the task of a brick adds to the rows of that brick alone, in the order of the points.
// A row is thus summed in the order of a plain loop, bit for bit, on any number of threads.
#pragma once

#include <algorithm>
#include <vector>

#include "photograd/core/real.h"
#include "photograd/core/scatter.h"
#include "photograd/grid/brick_topology.h"
#include "photograd/ops/cell_blend.h"

namespace photograd {

template <Real R>
struct BrickField {
    const BrickTopology* topology;
    const R* values;      // (N, C)
    const R* background;  // (C,)
    int channels;
};

/// Points in index space: voxel i has its value at i.
template <Real R>
struct PointBatch {
    const R* points;  // (P, 3), finite and within +-2^30
    std::int64_t count;
};

namespace detail {

inline constexpr std::int64_t points_per_task = 4096;

template <Real R>
struct BrickCell {
    CellPoint<R> at;
    std::int32_t brick[8], row[8];

    BrickCell(const BrickTopology& topology, const R* point) : at(CellPoint<R>::of(point)) {
        topology.cell(at.base[0], at.base[1], at.base[2], brick, row);
    }
    void corners(const BrickField<R>& field, const R** corner) const {
        for (int n = 0; n < 8; ++n)
            corner[n] = row[n] < 0 ? field.background
                                   : field.values + std::int64_t(row[n]) * field.channels;
    }
};

template <class Use>
void in_tasks(std::int64_t count, Use&& use) {
    parallel_for((count + points_per_task - 1) / points_per_task, [&](std::int64_t task) {
        use(task, task * points_per_task, std::min(count, (task + 1) * points_per_task));
    });
}

/// The pairs (brick, point) of all corners that have a row, sorted by brick and then by point.
template <Real R>
void bin_points(const BrickTopology& topology, const PointBatch<R>& batch, OwnerBins& bins,
                std::vector<std::uint32_t>& point) {
    const std::int64_t tasks = (batch.count + points_per_task - 1) / points_per_task;
    std::vector<std::vector<std::uint32_t>> owners(static_cast<std::size_t>(tasks)),
        points(owners.size());
    in_tasks(batch.count, [&](std::int64_t task, std::int64_t first, std::int64_t last) {
        const auto t = static_cast<std::size_t>(task);
        for (std::int64_t p = first; p < last; ++p) {
            const BrickCell<R> cell(topology, batch.points + 3 * p);
            for (int n = 0; n < 8; ++n) {
                const bool repeated = std::find(cell.brick, cell.brick + n, cell.brick[n]) !=
                                      cell.brick + n;  // a brick gets a point once
                if (cell.brick[n] < 0 || repeated) continue;
                owners[t].push_back(static_cast<std::uint32_t>(cell.brick[n]));
                points[t].push_back(static_cast<std::uint32_t>(p));
            }
        }
    });
    std::vector<std::uint32_t> owner;
    for (std::size_t t = 0; t < owners.size(); ++t) {
        owner.insert(owner.end(), owners[t].begin(), owners[t].end());
        point.insert(point.end(), points[t].begin(), points[t].end());
    }
    bin_by_owner(owner, topology.bricks(), bins);
}

}  // namespace detail

/// out (P, C).
template <Real R>
void sample_bricks(const BrickField<R>& field, const PointBatch<R>& batch, R* out) {
    detail::in_tasks(batch.count, [&](std::int64_t, std::int64_t first, std::int64_t last) {
        for (std::int64_t p = first; p < last; ++p) {
            const detail::BrickCell<R> cell(*field.topology, batch.points + 3 * p);
            const R* corner[8];
            cell.corners(field, corner);
            cell_blend(corner, cell.at.weights, field.channels, out + p * field.channels);
        }
    });
}

/// Adds to d_values (N, C), d_background (C,) and d_points (P, 3), from d_out (P, C).
template <Real R>
void sample_bricks_backward(const BrickField<R>& field, const PointBatch<R>& batch, const R* d_out,
                            R* d_values, R* d_background, R* d_points) {
    const int channels = field.channels;
    OwnerBins bins;
    std::vector<std::uint32_t> point;
    detail::bin_points(*field.topology, batch, bins, point);
    parallel_for(field.topology->bricks(), [&](std::int64_t brick) {
        const auto b = static_cast<std::size_t>(brick);
        for (std::uint32_t j = bins.begin[b]; j < bins.begin[b + 1]; ++j) {
            const std::int64_t p = point[bins.order[j]];
            const detail::BrickCell<R> cell(*field.topology, batch.points + 3 * p);
            for (int n = 0; n < 8; ++n)
                if (cell.brick[n] == brick && cell.row[n] >= 0)
                    cell_blend_backward(n, cell.at.weights, channels, d_out + p * channels,
                                        d_values + std::int64_t(cell.row[n]) * channels);
        }
    });
    const std::int64_t tasks =
        (batch.count + detail::points_per_task - 1) / detail::points_per_task;
    const std::span<R> total(d_background, static_cast<std::size_t>(channels));
    sum_partials(tasks, total, [&](std::int64_t task, std::span<double> d_missing) {
        const std::int64_t last = std::min(batch.count, (task + 1) * detail::points_per_task);
        for (std::int64_t p = task * detail::points_per_task; p < last; ++p) {
            const detail::BrickCell<R> cell(*field.topology, batch.points + 3 * p);
            const R* corner[8];
            cell.corners(field, corner);
            cell_blend_fraction_backward(corner, cell.at.weights, channels, d_out + p * channels,
                                         d_points + 3 * p);
            for (int n = 0; n < 8; ++n)
                for (int c = 0; c < channels && cell.row[n] < 0; ++c)
                    d_missing[static_cast<std::size_t>(c)] +=
                        double(cell.at.weights.corner(n)) * double(d_out[p * channels + c]);
        }
    });
}

}  // namespace photograd
