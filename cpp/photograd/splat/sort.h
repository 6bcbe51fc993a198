// Stage 2: splats by depth, nearest first. A stable radix sort, so that equal depths keep the order
// of their rows, whatever else is in the list.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace photograd {

/// `rows`, all with depth > 0, sorted by depth[row]. The bits of positive IEEE numbers, read as
/// integers, are in the order of the numbers.
template <class R>
std::vector<std::uint32_t> sort_by_depth(std::vector<std::uint32_t> rows, const R* depth) {
    using Key = std::conditional_t<sizeof(R) == 4, std::uint32_t, std::uint64_t>;
    constexpr int digit_bits = 11, digits = 1 << digit_bits;
    std::vector<Key> key(rows.size()), next_key(rows.size());
    std::vector<std::uint32_t> next(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) key[i] = std::bit_cast<Key>(depth[rows[i]]);
    for (unsigned shift = 0; shift < 8 * sizeof(Key); shift += digit_bits) {
        const auto digit = [&](Key k) { return static_cast<std::size_t>((k >> shift) % digits); };
        std::array<std::uint32_t, digits> next_slot{};
        for (const Key k : key) ++next_slot[digit(k)];
        std::uint32_t sum = 0;
        for (std::uint32_t& p : next_slot) {
            const std::uint32_t count = p;
            p = sum;
            sum += count;
        }
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const std::uint32_t to = next_slot[digit(key[i])]++;
            next[to] = rows[i];
            next_key[to] = key[i];
        }
        rows.swap(next);
        key.swap(next_key);
    }
    return rows;
}

}  // namespace photograd
