#include "photograd/grid/voxel_hash.h"

#include <algorithm>
#include <limits>
#include <string>

#include "photograd/core/errors.h"

namespace photograd {
namespace {

VoxelKey checked_key(const char* function, const Voxel& voxel) {
    for (const std::int32_t coordinate : voxel)
        if (!packable(coordinate))
            fail(ErrorKind::range, function, "voxel", "coordinates from -2^20 to 2^20 - 1",
                 std::to_string(coordinate), "shift the origin or use larger voxels");
    return pack(voxel);
}

}  // namespace

std::int32_t VoxelHash::insert(const Voxel& voxel) {
    const VoxelKey key = checked_key("VoxelHash.insert", voxel);
    Shard& shard = shards_[shard_of(key)];
    const std::lock_guard guard(shard.lock);
    std::int32_t& row = shard.table.insert(key);
    if (row == none) {
        try {
            row = take_row();
        } catch (...) {
            shard.table.erase(key);
            throw;
        }
    }
    return row;
}

std::int32_t VoxelHash::find(const Voxel& voxel) const {
    const VoxelKey key = checked_key("VoxelHash.find", voxel);
    const Shard& shard = shards_[shard_of(key)];
    const std::shared_lock guard(shard.lock);
    return shard.table.find(key);
}

std::int32_t VoxelHash::erase(const Voxel& voxel) {
    const VoxelKey key = checked_key("VoxelHash.erase", voxel);
    Shard& shard = shards_[shard_of(key)];
    const std::lock_guard guard(shard.lock);
    const std::int32_t row = shard.table.erase(key);
    if (row != none) give_back(row);
    return row;
}

std::int32_t VoxelHash::take_row() {
    const std::lock_guard guard(row_lock_);
    if (!free_rows_.empty()) {
        const std::int32_t row = free_rows_.back();
        free_rows_.pop_back();
        return row;
    }
    if (next_row_ == std::numeric_limits<std::int32_t>::max())
        fail(ErrorKind::range, "VoxelHash.insert", "voxels", "fewer than 2^31 - 1 rows", "more");
    return next_row_++;
}

void VoxelHash::give_back(std::int32_t row) {
    const std::lock_guard guard(row_lock_);
    free_rows_.push_back(row);
}

void VoxelHash::items(std::vector<Voxel>& voxels, std::vector<std::int32_t>& rows) const {
    std::vector<ProbeTable::Slot> found;
    for (const Shard& shard : shards_) {
        const std::shared_lock guard(shard.lock);
        for (const ProbeTable::Slot& slot : shard.table.slots())
            if (slot.key != no_key) found.push_back(slot);
    }
    std::sort(found.begin(), found.end(),
              [](const auto& a, const auto& b) { return a.row < b.row; });
    voxels.clear();
    rows.clear();
    for (const ProbeTable::Slot& slot : found) {
        voxels.push_back(unpack(slot.key));
        rows.push_back(slot.row);
    }
}

VoxelHashStatistics VoxelHash::statistics() const {
    VoxelHashStatistics out;
    std::int64_t probes = 0;
    for (const Shard& shard : shards_) {
        const std::shared_lock guard(shard.lock);
        const ProbeTable& table = shard.table;
        out.count += static_cast<std::int64_t>(table.count());
        out.slots += static_cast<std::int64_t>(table.slots().size());
        for (std::size_t at = 0; at < table.slots().size(); ++at) {
            if (table.slots()[at].key == no_key) continue;
            out.row_limit = std::max<std::int64_t>(out.row_limit, table.slots()[at].row + 1);
            const auto length = static_cast<std::int64_t>(table.probes(at));
            out.longest_probe = std::max(out.longest_probe, length);
            probes += length;
        }
    }
    out.bytes = out.slots * static_cast<std::int64_t>(sizeof(ProbeTable::Slot));
    out.mean_probe =
        out.count > 0 ? static_cast<double>(probes) / static_cast<double>(out.count) : 0;
    return out;
}

}  // namespace photograd
