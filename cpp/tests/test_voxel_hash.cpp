#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <unordered_map>
#include <vector>

#include "photograd/core/errors.h"
#include "photograd/core/parallel.h"
#include "photograd/core/random.h"
#include "photograd/grid/voxel_hash.h"

using namespace photograd;

namespace {

std::uint32_t word(std::uint32_t row, std::uint32_t dimension) {
    return random_block({.seed = 11, .pixel = row}, 0)[dimension];
}

/// A voxel of a box of 64 x 64 x 64 around the origin.
Voxel near_origin(std::uint32_t row) {
    const std::uint32_t w = word(row, 0);
    return {static_cast<std::int32_t>(w % 64) - 32, static_cast<std::int32_t>(w / 64 % 64) - 32,
            static_cast<std::int32_t>(w / 4096 % 64) - 32};
}

/// x with x ^ x >> shift = y.
constexpr std::uint64_t undo_shift(std::uint64_t y, int shift) {
    std::uint64_t x = y;
    for (int known = shift; known < 64; known += shift) x = y ^ x >> shift;
    return x;
}
/// 1 / odd modulo 2^64 by Newton's iteration, which doubles the right bits.
constexpr std::uint64_t inverse(std::uint64_t odd) {
    std::uint64_t x = odd;
    for (int step = 0; step < 6; ++step) x *= 2 - odd * x;
    return x;
}
constexpr VoxelKey key_of_hash(std::uint64_t h) {
    h = undo_shift(h, 31) * inverse(0x94D049BB133111EBull);
    h = undo_shift(h, 27) * inverse(0xBF58476D1CE4E5B9ull);
    return undo_shift(h, 30);
}

}  // namespace

TEST_CASE("keys hold 21 bits of each coordinate, and only those") {
    const std::int32_t most = (1 << 20) - 1, least = -(1 << 20);
    for (const Voxel& v : {Voxel{0, 0, 0}, Voxel{most, most, most}, Voxel{least, least, least},
                           Voxel{-1, 5, least}, Voxel{most, -7, 0}}) {
        CHECK(unpack(pack(v)) == v);
        CHECK((pack(v) >> 63) == 0);
        CHECK(key_of_hash(hash(pack(v))) == pack(v));
    }
    CHECK(pack({-1, 0, 0}) < pack({0, -5, 0}));
    VoxelHash table;
    for (int a = 0; a < 3; ++a)
        for (const std::int32_t bad : {most + 1, least - 1, std::numeric_limits<int>::max(),
                                       std::numeric_limits<int>::min()}) {
            Voxel v{};
            v[static_cast<std::size_t>(a)] = bad;
            CHECK_THROWS_AS(table.insert(v), Error);
            CHECK_THROWS_AS((void)table.find(v), Error);
            CHECK_THROWS_AS(table.erase(v), Error);
        }
    CHECK(table.insert(Voxel{most, least, most}) == 0);
}

TEST_CASE("a million random operations agree with std::unordered_map") {
    VoxelHash table;
    std::unordered_map<VoxelKey, std::int32_t> oracle;
    std::vector<char> in_use;
    int wrong = 0, inserted = 0, erased = 0, found = 0;
    for (std::uint32_t step = 0; step < 1'000'000; ++step) {
        const Voxel voxel = near_origin(step);
        const auto known = oracle.find(pack(voxel));
        const std::int32_t expected = known == oracle.end() ? VoxelHash::none : known->second;
        // The share of erasures changes, so that the table fills and empties several times.
        const std::uint32_t kind = word(step, 1) % 8, erasing = step / 125'000 % 2 == 0 ? 2 : 5;
        if (kind < erasing) {
            wrong += table.erase(voxel) != expected;
            if (expected == VoxelHash::none) continue;
            in_use[static_cast<std::size_t>(expected)] = 0;
            oracle.erase(known);
            ++erased;
        } else if (kind == 7) {
            wrong += table.find(voxel) != expected;
            found += expected != VoxelHash::none;
        } else {
            const std::int32_t row = table.insert(voxel);
            if (expected != VoxelHash::none) {
                wrong += row != expected;
                continue;
            }
            if (static_cast<std::size_t>(row) == in_use.size()) in_use.push_back(0);
            REQUIRE(static_cast<std::size_t>(row) < in_use.size());
            wrong += in_use[static_cast<std::size_t>(row)];  // a row has one voxel at a time
            in_use[static_cast<std::size_t>(row)] = 1;
            oracle[pack(voxel)] = row;
            ++inserted;
        }
    }
    CHECK(wrong == 0);
    CHECK(inserted > 200'000);
    CHECK(erased > 150'000);
    CHECK(found > 20'000);
    std::vector<Voxel> voxels;
    std::vector<std::int32_t> rows;
    table.items(voxels, rows);
    REQUIRE(voxels.size() == oracle.size());
    for (std::size_t i = 0; i < voxels.size(); ++i) wrong += oracle.at(pack(voxels[i])) != rows[i];
    CHECK(wrong == 0);
    CHECK(std::is_sorted(rows.begin(), rows.end()));
}

TEST_CASE("voxels on a coarse lattice do not pile up") {
    // Multiples of 64, negative ones among them: the low six bits of every coordinate are equal.
    VoxelHash table;
    std::int32_t row = 0;
    for (int x = -32; x < 32; ++x)
        for (int y = -32; y < 32; ++y)
            for (int z = -16; z < 16; ++z) REQUIRE(table.insert({64 * x, 64 * y, 64 * z}) == row++);
    const VoxelHashStatistics s = table.statistics();
    CHECK(s.count == 64 * 64 * 32);
    CHECK(s.row_limit == s.count);
    CHECK(2 * s.count <= s.slots);
    CHECK(4 * s.count >= s.slots);  // a shard doubles when it is half full
    CHECK(s.bytes == 16 * s.slots);
    // At half load a random hash needs 1.5 on average, and here, with shards just grown, less.
    CHECK(s.mean_probe < 1.55);
}

TEST_CASE("voxels whose hashes all fall into one slot are slow and right") {
    VoxelHash table;
    std::vector<Voxel> voxels;
    for (std::uint64_t i = 1; voxels.size() < 1500; ++i) {
        const VoxelKey key = key_of_hash(std::uint64_t{19} << 59 | i << 24);
        if (key >> 63 == 0) voxels.push_back(unpack(key));
    }
    for (std::size_t i = 0; i < voxels.size(); ++i)
        REQUIRE(table.insert(voxels[i]) == static_cast<std::int32_t>(i));
    CHECK(table.statistics().longest_probe == 1500);
    for (std::size_t i = 0; i < voxels.size(); i += 2)
        REQUIRE(table.erase(voxels[i]) == static_cast<std::int32_t>(i));
    for (std::size_t i = 0; i < voxels.size(); ++i)
        CHECK(table.find(voxels[i]) ==
              (i % 2 == 0 ? VoxelHash::none : static_cast<std::int32_t>(i)));
    CHECK(table.statistics().longest_probe == 750);  // no tombstones
}

TEST_CASE("rows of a list follow the list, whatever the number of threads") {
    std::vector<Voxel> first, second;
    for (std::uint32_t i = 0; i < 100'000; ++i) {
        first.push_back(near_origin(i));
        second.push_back(near_origin(50'000 + i));
    }
    const std::vector<Voxel> gone(first.begin() + 1000, first.begin() + 30'000);
    // The oracle: one voxel at a time.
    VoxelHash one;
    std::vector<std::int32_t> a(first.size()), b(second.size());
    for (std::size_t i = 0; i < first.size(); ++i) a[i] = one.insert(first[i]);
    for (const Voxel& v : gone) one.erase(v);
    for (std::size_t i = 0; i < second.size(); ++i) b[i] = one.insert(second[i]);
    for (const int threads : {1, 2, 5}) {
        set_thread_count(threads);
        VoxelHash table;
        std::vector<std::int32_t> rows(first.size()), found(first.size()), erased(gone.size());
        table.insert(first, rows);
        CHECK(rows == a);
        table.find(first, found);
        CHECK(found == a);
        table.erase(gone, erased);
        table.insert(second, rows);
        CHECK(rows == b);
        CHECK(table.statistics().count == one.statistics().count);
    }
    set_thread_count(0);
}

TEST_CASE("a list with one bad voxel changes nothing") {
    VoxelHash table;
    std::vector<std::int32_t> rows(3);
    const std::vector<Voxel> bad = {{1, 2, 3}, {4, 1 << 20, 6}, {7, 8, 9}};
    CHECK_THROWS_WITH_AS(table.insert(bad, rows),
                         doctest::Contains("1 voxels beyond, the first in row 1: (4, 1048576, 6)"),
                         Error);
    CHECK(table.statistics().count == 0);
    table.insert({}, {});
    CHECK(table.statistics().count == 0);
}
