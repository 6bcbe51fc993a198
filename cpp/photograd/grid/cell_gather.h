// Gradients of a sparse grid from records of samples. Every brick sums the contributions to its own
// rows, ray by ray in a fixed order, so that a row has the same sum on any number of threads.
//
// The contributions of a ray to a voxel are summed first, over the samples along the ray, and then
// multiplied by the harmonics of the ray's direction (ops/sh_blend.h).
#pragma once

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "photograd/grid/cell_table.h"
#include "photograd/ops/cell_blend.h"

namespace photograd {

/// Parameter gradients of a sparse_sh field, added to.
template <class R>
struct SparseShGradients {
    R* d_density;     // (N,)
    R* d_sh;          // (N, K, 3)
    R* d_background;  // (1 + 3 K,)
};

/// The bricks that hold active corners of the cell at `base`, each once; returns how many.
inline int bricks_of_cell(const BrickTopology& topology, const int* base, std::int32_t* brick) {
    if ((base[0] & 7) < 7 && (base[1] & 7) < 7 && (base[2] & 7) < 7) {
        brick[0] = topology.brick_of(base[0], base[1], base[2]);
        return brick[0] < 0 ? 0 : 1;
    }
    int count = 0;
    for (int n = 0; n < 8; ++n) {
        const std::int32_t found =
            topology.brick_of(base[0] + (n >> 2), base[1] + (n >> 1 & 1), base[2] + (n & 1));
        if (found >= 0 && std::find(brick, brick + count, found) == brick + count)
            brick[count++] = found;
    }
    return count;
}

/// visit(row, trilinear weight) for the corners of a record's cell that a brick owns.
template <class R, class Visit>
void for_own_corners(const BrickTopology& topology, std::int32_t brick, const CellRecord<R>& record,
                     Visit&& visit) {
    const CellPoint<R> at = CellPoint<R>::of(record.q);
    const std::int32_t* rows = topology.rows_of(brick);
    const std::int32_t* origin = topology.origins().data() + 3 * std::int64_t(brick);
    for (int n = 0; n < 8; ++n) {
        const int x = at.base[0] + (n >> 2) - origin[0], y = at.base[1] + (n >> 1 & 1) - origin[1],
                  z = at.base[2] + (n & 1) - origin[2];
        if (((x | y | z) & ~7) != 0) continue;  // another brick's
        const std::int32_t row = rows[(x * 8 + y) * 8 + z];
        if (row >= 0) visit(row, at.weights.corner(n));
    }
}

/// use(brick, first, count) for the runs of one ray's records: each is a longest piece in which
/// every record has corners in `brick`. Coordinates rise or fall along a ray, so that a brick gets
/// one run of a ray.
template <class R, class Use>
void for_brick_runs(const BrickTopology& topology, const CellRecord<R>* records, std::int64_t count,
                    Use&& use) {
    struct Open {
        std::int32_t brick;
        std::int64_t first;
    };
    std::array<Open, 8> open{};  // the bricks of the record before
    std::size_t opened = 0;
    std::int32_t brick[8];
    int base[3], bricks = 0;
    for (std::int64_t r = 0; r < count; ++r) {
        int at[3];
        for (int axis = 0; axis < 3; ++axis) {  // rounded down, without a call
            const R q = records[r].q[axis];
            const int cut = static_cast<int>(q);
            at[axis] = cut - (q < static_cast<R>(cut) ? 1 : 0);
        }
        if (r > 0 && std::equal(at, at + 3, base)) continue;  // the same bricks
        std::copy_n(at, 3, base);
        bricks = bricks_of_cell(topology, base, brick);
        std::size_t kept = 0;
        for (std::size_t i = 0; i < opened; ++i)
            if (std::find(brick, brick + bricks, open[i].brick) != brick + bricks)
                open[kept++] = open[i];
            else
                use(open[i].brick, open[i].first, r - open[i].first);
        opened = kept;
        for (int n = 0; n < bricks; ++n)
            if (std::none_of(open.begin(), open.begin() + kept,
                             [&](const Open& one) { return one.brick == brick[n]; }))
                open[opened++] = {brick[n], r};
    }
    for (std::size_t i = 0; i < opened; ++i)
        use(open[i].brick, open[i].first, count - open[i].first);
}

/// Adds the part of a run of one ray that belongs to a brick; Y3 (3 K) is the basis of its
/// direction.
template <class R>
void gather_run(const BrickTopology& topology, std::int32_t brick, const CellRecord<R>* records,
                std::int64_t count, const R* Y3, int numbers, const SparseShGradients<R>& to) {
    struct Share {
        std::int32_t row;
        R d[4];
    };
    std::vector<Share> shares;
    for (std::int64_t r = 0; r < count; ++r)
        for_own_corners(topology, brick, records[r], [&](std::int32_t row, R w) {
            auto share = std::find_if(shares.begin(), shares.end(),
                                      [&](const Share& one) { return one.row == row; });
            if (share == shares.end()) share = shares.insert(share, Share{row, {}});
            for (int c = 0; c < 4; ++c) share->d[c] = share->d[c] + w * records[r].d[c];
        });
    for (const Share& share : shares) {
        to.d_density[share.row] = to.d_density[share.row] + share.d[3];
        R* d_sh = to.d_sh + std::int64_t(share.row) * numbers;
        for (int j = 0; j < numbers; ++j) d_sh[j] = d_sh[j] + Y3[j] * share.d[j % 3];
    }
}

/// max_weight[row] = max(max_weight[row], trilinear weight times record.d[0]).
template <class R>
void gather_max(const BrickTopology& topology, std::int32_t brick, const CellRecord<R>& record,
                R* max_weight) {
    for_own_corners(topology, brick, record, [&](std::int32_t row, R w) {
        max_weight[row] = std::max(max_weight[row], w * record.d[0]);
    });
}

}  // namespace photograd
