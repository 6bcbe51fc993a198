#include "photograd/grid/brick_topology.h"

#include <algorithm>
#include <limits>

#include "photograd/core/errors.h"
#include "photograd/core/world_limit.h"

namespace photograd {

BrickTopology::BrickTopology(std::span<const std::int32_t> origins,
                             std::span<const std::uint8_t> active, std::int64_t memory_limit)
    : origins_(origins.begin(), origins.end()) {
    const std::size_t count = origins.size() / 3;
    std::array<std::int64_t, 3> lo{}, hi{};
    for (std::size_t axis = 0; axis < 3 && count > 0; ++axis) {
        lo[axis] = std::numeric_limits<std::int32_t>::max();
        hi[axis] = std::numeric_limits<std::int32_t>::min();
        for (std::size_t b = 0; b < count; ++b) {
            const std::int32_t at = origins[3 * b + axis];
            if (at % side != 0)
                fail(ErrorKind::range, "BrickTopology", "origins", "multiples of 8",
                     std::to_string(at));
            lo[axis] = std::min<std::int64_t>(lo[axis], at >> 3);
            hi[axis] = std::max<std::int64_t>(hi[axis], at >> 3);
        }
        lowest_[axis] = static_cast<int>(lo[axis]);
        extent_[axis] = static_cast<int>(hi[axis] - lo[axis] + 1);
    }
    const double bytes =
        4.0 * extent_[0] * extent_[1] * extent_[2] + 4.0 * voxels_per_brick * count;
    constexpr double max_entries = 1 << 28;
    if (bytes > static_cast<double>(memory_limit) ||
        1.0 * extent_[0] * extent_[1] * extent_[2] > max_entries)
        fail(ErrorKind::range, "BrickTopology", "memory_limit",
             "room for tables of " + number_text(bytes) + " bytes",
             std::to_string(memory_limit) + " bytes, and at most 2^28 bricks in the table",
             "bricks far apart need a large table: crop the grid");
    top_.assign(static_cast<std::size_t>(extent_[0]) * static_cast<std::size_t>(extent_[1]) *
                    static_cast<std::size_t>(extent_[2]),
                no_row);
    rows_.assign(count * voxels_per_brick, no_row);
    for (std::size_t b = 0; b < count; ++b) {
        const std::int32_t* at = origins.data() + 3 * b;
        const std::int64_t slot =
            (std::int64_t((at[0] >> 3) - lowest_[0]) * extent_[1] + (at[1] >> 3) - lowest_[1]) *
                extent_[2] +
            (at[2] >> 3) - lowest_[2];
        std::int32_t& entry = top_[static_cast<std::size_t>(slot)];
        if (entry != no_row)
            fail(ErrorKind::range, "BrickTopology", "origins", "every brick once", "one twice");
        entry = static_cast<std::int32_t>(b);
        for (std::size_t v = b * voxels_per_brick; v < (b + 1) * voxels_per_brick; ++v)
            if (active[v] != 0) rows_[v] = static_cast<std::int32_t>(voxels_++);
    }
}

}  // namespace photograd
