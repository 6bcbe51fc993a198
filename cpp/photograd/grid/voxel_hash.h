// A hash table from integer voxels to rows of payload arrays, for scenes of unknown extent
// [Niessner2013].
//
// The table says which row of an array (N, C) belongs to a voxel; the arrays are the caller's. Any
// number of threads may call any functions at the same time. The table is cut into shards by the
// upper bits of the hash, each behind a lock of its own; a shard grows by itself. Locks, and no
// atomics: a slot is a key with a row, erasing moves slots, and growing moves all of them, each
// more than one word at once.
//
// Which row a new voxel gets:
//   - single insertions: the row freed last, or else the next new one. Concurrent insertions race
//     for the numbers (never for a voxel: all of them get the same row);
//   - a list: the same, in the order of the list. Each thread owns whole shards and marks the first
//     occurrence of each voxel; rows are numbered along the list afterwards. They do not depend on
//     the number of threads, and distinct voxels get the rows 0, 1, 2, ... of an empty table.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <shared_mutex>
#include <span>
#include <vector>

#include "photograd/grid/probe_table.h"

namespace photograd {

struct VoxelHashStatistics {
    std::int64_t count = 0;      // voxels
    std::int64_t row_limit = 0;  // all rows are smaller: what a payload array must have room for
    std::int64_t slots = 0, bytes = 0;
    std::int64_t longest_probe = 0;  // slots that the longest search for a voxel looks at
    double mean_probe = 0.0;
};

class VoxelHash {
public:
    static constexpr std::int32_t none = ProbeTable::none;

    /// Row of `voxel`, which is given one if it has none. RangeError where coordinates cannot be
    /// packed.
    std::int32_t insert(const Voxel& voxel);
    /// Row of `voxel`, or `none`.
    [[nodiscard]] std::int32_t find(const Voxel& voxel) const;
    /// Erases `voxel`; returns the row that is free now, or `none`.
    std::int32_t erase(const Voxel& voxel);

    /// Batches of voxels (N, 3); nothing has changed if any of them is refused. Not from
    /// inside of a parallel_for, whose threads might pick up another such call while they hold the
    /// locks.
    void insert(std::span<const Voxel> voxels, std::span<std::int32_t> rows);
    void find(std::span<const Voxel> voxels, std::span<std::int32_t> rows) const;
    void erase(std::span<const Voxel> voxels, std::span<std::int32_t> rows);

    /// All voxels and their rows, by ascending row.
    void items(std::vector<Voxel>& voxels, std::vector<std::int32_t>& rows) const;
    [[nodiscard]] VoxelHashStatistics statistics() const;

private:
    static constexpr int shard_bits = 5;
    static constexpr std::size_t shards = 1 << shard_bits;

    struct alignas(64) Shard {
        mutable std::shared_mutex lock;
        ProbeTable table;
    };
    struct Bins;

    static std::size_t shard_of(VoxelKey key) { return hash(key) >> (64 - shard_bits); }
    std::int32_t take_row();
    void give_back(std::int32_t row);
    void insert_new(const Bins& bins, std::span<std::int32_t> rows, std::vector<char>& is_new);
    void number_new(const Bins& bins, std::span<std::int32_t> rows,
                    const std::vector<char>& is_new);

    std::array<Shard, shards> shards_;
    std::mutex row_lock_;
    std::vector<std::int32_t> free_rows_;
    std::int32_t next_row_ = 0;
};

}  // namespace photograd
