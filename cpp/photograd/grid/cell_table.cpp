#include "photograd/grid/cell_table.h"

#include <algorithm>
#include <cstdlib>
#include <set>
#include <string>

#include "photograd/core/errors.h"
#include "photograd/core/parallel.h"

namespace photograd {
namespace {

constexpr int max_voxels = 1 << 13;             // the table has 2^30 entries then
constexpr std::int32_t max_distance = 1 << 20;  // bricks, where nothing is active at all

/// Rows of the 9^3 voxels from `corner` on; true if there is one.
bool fill_tile(const BrickTopology& topology, const int* corner, std::int32_t* rows) {
    bool any = false;
    for (int i = 0; i < cell_tile_side; ++i)
        for (int j = 0; j < cell_tile_side; ++j)
            for (int k = 0; k < cell_tile_side; ++k) {
                const int at[3] = {corner[0] + i, corner[1] + j, corner[2] + k};
                const std::int32_t brick = topology.brick_of(at[0], at[1], at[2]);
                *rows = brick < 0 ? no_row : topology.row_in(brick, at[0], at[1], at[2]);
                any |= *rows++ >= 0;
            }
    return any;
}

}  // namespace

CellTable::CellTable(const BrickTopology& topology, std::array<int, 3> shape,
                     std::int64_t memory_limit)
    : topology_(topology), shape_(shape) {
    const std::vector<std::int32_t>& origins = topology_.origins();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (shape[axis] < 1 || shape[axis] > max_voxels)
            fail(ErrorKind::range, "CellTable", "shape",
                 "1 to " + std::to_string(max_voxels) + " voxels along each axis",
                 std::to_string(shape[axis]));
        extent_[axis] = (shape[axis] + 7) / 8 + 1;
    }
    const std::size_t entries =
        std::size_t(extent_[0]) * std::size_t(extent_[1]) * std::size_t(extent_[2]);
    std::set<std::size_t>
        occupied;  // a brick's voxels are corners of its own cells and of those before
    for (std::size_t b = 0; b < origins.size(); b += 3)
        for (int n = 0; n < 8; ++n) {
            std::array<int, 3> at{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const int low = origins[b + axis];
                if (low < 0 || low >= shape[axis])
                    fail(ErrorKind::range, "CellTable", "shape", "room for all bricks",
                         "one that begins at voxel " + std::to_string(low));
                at[axis] = low / 8 + 1 - (n >> (2 - axis) & 1);
            }
            occupied.insert((std::size_t(at[0]) * std::size_t(extent_[1]) + std::size_t(at[1])) *
                                std::size_t(extent_[2]) +
                            std::size_t(at[2]));
        }
    const double bytes =
        4.0 * double(entries) + 5.0 * double(occupied.size() + 1) * cell_tile_voxels;
    if (bytes > static_cast<double>(memory_limit))
        fail(ErrorKind::range, "CellTable", "memory_limit",
             "room for " + std::to_string(static_cast<std::int64_t>(bytes)) + " bytes",
             std::to_string(memory_limit) + " bytes");
    top_.assign(entries, -max_distance);
    rows_.assign(cell_tile_voxels, no_row);
    for (const std::size_t entry : occupied) {
        const int z = int(entry) % extent_[2], y = int(entry) / extent_[2] % extent_[1],
                  x = int(entry) / extent_[2] / extent_[1];
        const int corner[3] = {8 * (x - 1), 8 * (y - 1), 8 * (z - 1)};
        std::vector<std::int32_t> tile(cell_tile_voxels);
        if (!fill_tile(topology_, corner, tile.data())) continue;
        top_[entry] = static_cast<std::int32_t>(rows_.size() / cell_tile_voxels);
        rows_.insert(rows_.end(), tile.begin(), tile.end());
    }
    mark_active();
    measure_distances();
}

void CellTable::mark_active() {
    active_.assign(rows_.size(), 0);
    parallel_for(tiles() + 1, [&](std::int64_t tile) {
        for (int i = 0; i < 8; ++i)
            for (int j = 0; j < 8; ++j)
                for (int k = 0; k < 8; ++k) {
                    const auto cell =
                        static_cast<std::size_t>(tile * cell_tile_voxels + offset_in_tile(i, j, k));
                    for (int n = 0; n < 8; ++n)
                        if (rows_[cell + std::size_t(corner_offset(n))] >= 0)
                            active_[cell] |= static_cast<std::uint8_t>(1 << n);
                }
    });
}

// The longest of |dx|, |dy|, |dz| to the nearest tile: the least over y and z of the greater of
// that of a line and the offset, axis by axis. After the first axis d holds the distance within
// each line, after the second that within each plane.
void CellTable::measure_distances() {
    std::vector<std::int32_t> distance(top_.size());
    for (std::size_t i = 0; i < top_.size(); ++i) distance[i] = top_[i] > 0 ? 0 : max_distance;
    const std::int64_t stride[3] = {std::int64_t(extent_[1]) * extent_[2], extent_[2], 1};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::vector<std::int32_t> from = distance;
        parallel_for(static_cast<std::int64_t>(top_.size()), [&](std::int64_t i) {
            const int at = static_cast<int>(i / stride[axis] % extent_[axis]);
            std::int32_t best = max_distance;
            for (int other = 0; other < extent_[axis]; ++other)
                best = std::min(best, std::max(from[std::size_t(i + (other - at) * stride[axis])],
                                               std::abs(other - at)));
            distance[std::size_t(i)] = best;
        });
    }
    for (std::size_t i = 0; i < top_.size(); ++i)
        if (top_[i] <= 0) top_[i] = -distance[i];
}

}  // namespace photograd
