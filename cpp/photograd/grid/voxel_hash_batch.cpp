// Lists of voxels: one thread owns a whole shard, so no order between threads can matter.
#include <algorithm>
#include <string>

#include "photograd/core/errors.h"
#include "photograd/core/parallel.h"
#include "photograd/grid/voxel_hash.h"

namespace photograd {
namespace {

constexpr std::size_t rows_at_once = 1 << 14;

std::vector<VoxelKey> checked_keys(const char* function, std::span<const Voxel> voxels) {
    std::int64_t bad = 0;
    std::size_t first = voxels.size();
    std::vector<VoxelKey> keys(voxels.size());
    for (std::size_t i = 0; i < voxels.size(); ++i) {
        const Voxel& v = voxels[i];
        if (packable(v[0]) && packable(v[1]) && packable(v[2])) {
            keys[i] = pack(v);
        } else if (++bad == 1) {
            first = i;
        }
    }
    if (bad > 0) {
        const Voxel& v = voxels[first];
        fail(ErrorKind::range, function, "voxels", "coordinates from -2^20 to 2^20 - 1",
             std::to_string(bad) + " voxels beyond, the first in row " + std::to_string(first) +
                 ": (" + std::to_string(v[0]) + ", " + std::to_string(v[1]) + ", " +
                 std::to_string(v[2]) + ")",
             "shift the origin or use larger voxels");
    }
    return keys;
}

/// All locks of an array of shards, taken in one order.
template <class Lock, class Shards>
std::vector<Lock> lock_all(Shards& shards) {
    std::vector<Lock> locks;
    locks.reserve(shards.size());
    for (auto& shard : shards) locks.emplace_back(shard.lock);
    return locks;
}

}  // namespace

/// The list sorted by shard, in the order of the list within each (a counting sort).
struct VoxelHash::Bins {
    std::vector<VoxelKey> keys;
    std::array<std::size_t, shards + 1> start{};
    std::vector<std::uint32_t> order;  // rows of the list; those of shard s begin at start[s]

    Bins(const char* function, std::span<const Voxel> voxels) {
        if (voxels.size() >= std::size_t{1} << 31)
            fail(ErrorKind::range, function, "voxels", "fewer than 2^31 rows",
                 std::to_string(voxels.size()), "pass them in parts");
        keys = checked_keys(function, voxels);
        order.resize(keys.size());
        for (const VoxelKey key : keys) ++start[shard_of(key) + 1];
        for (std::size_t s = 0; s < shards; ++s) start[s + 1] += start[s];
        std::array<std::size_t, shards + 1> at = start;
        for (std::size_t i = 0; i < keys.size(); ++i)
            order[at[shard_of(keys[i])]++] = static_cast<std::uint32_t>(i);
    }

    /// Calls body(shard, i) for the rows i of each shard in the order of the list.
    template <class Body>
    void for_each(Body&& body) const {
        parallel_for(shards, [&](std::int64_t s) {
            const auto shard = static_cast<std::size_t>(s);
            for (std::size_t k = start[shard]; k < start[shard + 1]; ++k) body(shard, order[k]);
        });
    }
};

void VoxelHash::insert(std::span<const Voxel> voxels, std::span<std::int32_t> rows) {
    const Bins bins("VoxelHash.insert", voxels);
    const auto locks = lock_all<std::unique_lock<std::shared_mutex>>(shards_);
    std::vector<char> is_new(voxels.size(), 0);
    try {
        insert_new(bins, rows, is_new);
        number_new(bins, rows, is_new);
    } catch (...) {
        // Out of memory or of rows: new voxels are taken out again, rows already given are free.
        for (std::size_t i = 0; i < is_new.size(); ++i)
            if (is_new[i]) {
                shards_[shard_of(bins.keys[i])].table.erase(bins.keys[i]);
                if (rows[i] != none) give_back(rows[i]);
            }
        throw;
    }
}

/// Inserts new keys without a row, and marks the first occurrence of each in the list.
void VoxelHash::insert_new(const Bins& bins, std::span<std::int32_t> rows,
                           std::vector<char>& is_new) {
    bins.for_each([&](std::size_t shard, std::uint32_t i) {
        ProbeTable& table = shards_[shard].table;
        const std::size_t before = table.count();
        rows[i] = table.insert(bins.keys[i]);
        is_new[i] = table.count() > before;
    });
}

/// Gives rows to the marked entries along the list, then to the repetitions of each voxel.
void VoxelHash::number_new(const Bins& bins, std::span<std::int32_t> rows,
                           const std::vector<char>& is_new) {
    for (std::size_t i = 0; i < is_new.size(); ++i)
        if (is_new[i]) rows[i] = take_row();
    bins.for_each([&](std::size_t shard, std::uint32_t i) {
        std::int32_t& row = shards_[shard].table.insert(bins.keys[i]);
        if (is_new[i]) row = rows[i];
        rows[i] = row;
    });
}

void VoxelHash::find(std::span<const Voxel> voxels, std::span<std::int32_t> rows) const {
    const std::vector<VoxelKey> keys = checked_keys("VoxelHash.find", voxels);
    const auto locks = lock_all<std::shared_lock<std::shared_mutex>>(shards_);
    const std::size_t pieces = (keys.size() + rows_at_once - 1) / rows_at_once;
    parallel_for(static_cast<std::int64_t>(pieces), [&](std::int64_t piece) {
        const std::size_t begin = static_cast<std::size_t>(piece) * rows_at_once;
        for (std::size_t i = begin; i < std::min(keys.size(), begin + rows_at_once); ++i)
            rows[i] = shards_[shard_of(keys[i])].table.find(keys[i]);
    });
}

void VoxelHash::erase(std::span<const Voxel> voxels, std::span<std::int32_t> rows) {
    const Bins bins("VoxelHash.erase", voxels);
    const auto locks = lock_all<std::unique_lock<std::shared_mutex>>(shards_);
    {
        const std::lock_guard guard(row_lock_);
        free_rows_.reserve(free_rows_.size() + voxels.size());
    }
    bins.for_each([&](std::size_t shard, std::uint32_t i) {
        rows[i] = shards_[shard].table.erase(bins.keys[i]);
    });
    for (const std::int32_t row : rows)
        if (row != none) give_back(row);
}

}  // namespace photograd
