// A table from keys to rows with linear probing [Knuth1998, Sec. 6.4]: not for several threads at a
// time.
//
// A key stands in the first free slot from that of its hash on. At most half of the slots are in
// use: at that load a search looks at 1.5 slots on average for a key that is there, (1 + 1 / (1 -
// load)) / 2, and at 2.5 for one that is not, (1 + 1 / (1 - load)^2) / 2. Erasing leaves no
// tombstone: keys behind the hole move up, so every key can still be reached from its first slot
// without crossing a free one.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "photograd/grid/voxel_key.h"

namespace photograd {

class ProbeTable {
public:
    static constexpr std::int32_t none = -1;

    struct Slot {
        VoxelKey key = no_key;
        std::int32_t row = none;
    };

    /// Row of `key`, or `none`.
    [[nodiscard]] std::int32_t find(VoxelKey key) const {
        return slots_.empty() ? none : slots_[position(key)].row;
    }

    /// The row of `key`; a new key has `none`, until it is given one. Valid until the next change.
    /// A key that is there already is found without any allocation.
    std::int32_t& insert(VoxelKey key) {
        if (!slots_.empty()) {
            Slot& slot = slots_[position(key)];
            if (slot.key == key) return slot.row;
        }
        if (2 * (count_ + 1) > slots_.size()) grow();
        Slot& slot = slots_[position(key)];
        slot.key = key;
        ++count_;
        return slot.row;
    }

    /// Takes `key` out and returns its row, or `none`.
    std::int32_t erase(VoxelKey key) {
        if (slots_.empty()) return none;
        std::size_t hole = position(key);
        const std::int32_t row = slots_[hole].row;
        if (slots_[hole].key == no_key) return none;
        for (std::size_t at = next(hole); slots_[at].key != no_key; at = next(at)) {
            // The key at `at` may fill the hole unless its own first slot lies cyclically in (hole,
            // at].
            const std::size_t home = first(slots_[at].key);
            if (((at - home) & mask()) < ((at - hole) & mask())) continue;
            slots_[hole] = slots_[at];
            hole = at;
        }
        slots_[hole] = {};
        --count_;
        return row;
    }

    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] const std::vector<Slot>& slots() const { return slots_; }
    /// Slots that a search for the key in slot `at` looks at.
    [[nodiscard]] std::size_t probes(std::size_t at) const {
        return ((at - first(slots_[at].key)) & mask()) + 1;
    }

private:
    [[nodiscard]] std::size_t mask() const { return slots_.size() - 1; }
    [[nodiscard]] std::size_t next(std::size_t at) const { return (at + 1) & mask(); }
    [[nodiscard]] std::size_t first(VoxelKey key) const { return hash(key) & mask(); }
    /// Slot that holds `key`, or the free one where it would go; there always is one.
    [[nodiscard]] std::size_t position(VoxelKey key) const {
        std::size_t at = first(key);
        while (slots_[at].key != key && slots_[at].key != no_key) at = next(at);
        return at;
    }
    void grow() {
        std::vector<Slot> old(std::max<std::size_t>(16, 2 * slots_.size()));
        old.swap(slots_);
        for (const Slot& slot : old)
            if (slot.key != no_key) slots_[position(slot.key)] = slot;
    }

    std::vector<Slot> slots_;  // a power of two, or none at all
    std::size_t count_ = 0;
};

}  // namespace photograd
