// Several threads at one table. The thread sanitizer (preset tsan) shows races as well.
#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <thread>
#include <vector>

#include "photograd/core/random.h"
#include "photograd/grid/voxel_hash.h"

using namespace photograd;

namespace {

constexpr std::uint32_t threads = 4, rounds = 30'000;

/// Voxels of a box of 32 x 32 x 32, inserted by all threads: most are inserted more than once.
Voxel shared_voxel(std::uint32_t thread, std::uint32_t i) {
    const std::uint32_t w = random_block({.seed = 2, .pixel = i, .sample = thread}, 0)[0];
    return {static_cast<std::int32_t>(w % 32) - 16, static_cast<std::int32_t>(w / 32 % 32) - 16,
            static_cast<std::int32_t>(w / 1024 % 32) - 16};
}

/// Voxels that one thread alone uses.
Voxel own_voxel(std::uint32_t thread, std::uint32_t i) {
    return {static_cast<std::int32_t>(i % 200), 1000 + static_cast<std::int32_t>(i / 200),
            -static_cast<std::int32_t>(thread) - 100};
}

template <class Body>
void in_threads(Body&& body) {
    std::vector<std::thread> pool;
    for (std::uint32_t t = 0; t < threads; ++t) pool.emplace_back([&body, t] { body(t); });
    for (std::thread& t : pool) t.join();
}

/// Every voxel has a row, and no two have the same.
void check_rows(const VoxelHash& table, std::size_t count) {
    std::vector<Voxel> voxels;
    std::vector<std::int32_t> rows;
    table.items(voxels, rows);
    CHECK(voxels.size() == count);
    CHECK(std::set<Voxel>(voxels.begin(), voxels.end()).size() == count);
    CHECK(std::adjacent_find(rows.begin(), rows.end()) == rows.end());
    CHECK(rows.front() >= 0);
}

}  // namespace

TEST_CASE("threads that insert the same voxels lose none and agree on their rows") {
    VoxelHash table;
    std::vector<std::vector<std::int32_t>> rows(threads, std::vector<std::int32_t>(rounds));
    in_threads([&](std::uint32_t t) {
        for (std::uint32_t i = 0; i < rounds; ++i) rows[t][i] = table.insert(shared_voxel(t, i));
    });
    std::set<Voxel> distinct;
    int wrong = 0;
    for (std::uint32_t t = 0; t < threads; ++t)
        for (std::uint32_t i = 0; i < rounds; ++i) {
            distinct.insert(shared_voxel(t, i));
            wrong += table.find(shared_voxel(t, i)) != rows[t][i];
        }
    CHECK(wrong == 0);
    CHECK(distinct.size() > 25'000);
    check_rows(table, distinct.size());
    CHECK(table.statistics().row_limit == static_cast<std::int64_t>(distinct.size()));
}

TEST_CASE("insert, find, erase and growth at the same time") {
    VoxelHash table;
    std::vector<int> wrong(threads, 0);
    in_threads([&](std::uint32_t t) {
        for (std::uint32_t i = 0; i < rounds; ++i) {
            const std::int32_t row = table.insert(own_voxel(t, i));
            table.insert(shared_voxel(t, i));
            (void)table.find(shared_voxel((t + 1) % threads, i));
            wrong[t] += table.find(own_voxel(t, i)) != row;
            // Every second own voxel goes again; others insert and take its row meanwhile.
            if (i % 2 == 1) wrong[t] += table.erase(own_voxel(t, i)) != row;
            if (i >= 2)
                wrong[t] += table.find(own_voxel(t, i - 2)) == VoxelHash::none && i % 2 == 0;
            if (i % 10'000 == 0) (void)table.statistics();
        }
    });
    for (const int count : wrong) CHECK(count == 0);
    std::set<Voxel> expected;
    for (std::uint32_t t = 0; t < threads; ++t)
        for (std::uint32_t i = 0; i < rounds; ++i) {
            expected.insert(shared_voxel(t, i));
            if (i % 2 == 0) expected.insert(own_voxel(t, i));
        }
    for (const Voxel& v : expected) REQUIRE(table.find(v) != VoxelHash::none);
    check_rows(table, expected.size());
}

TEST_CASE("lists and single voxels at the same time") {
    VoxelHash table;
    std::vector<int> wrong(threads, 0);
    in_threads([&](std::uint32_t t) {
        for (std::uint32_t part = 0; part < 6; ++part) {
            std::vector<Voxel> list;
            for (std::uint32_t i = 0; i < 2000; ++i) list.push_back(own_voxel(t, 2000 * part + i));
            std::vector<std::int32_t> rows(list.size()), again(list.size());
            if (t == 0) {
                for (std::size_t i = 0; i < list.size(); ++i) rows[i] = table.insert(list[i]);
            } else {
                table.insert(list, rows);
            }
            table.find(list, again);
            wrong[t] += again != rows;
            if (part % 2 == 1) {
                table.erase(list, again);
                wrong[t] += again != rows;
            }
        }
    });
    for (const int count : wrong) CHECK(count == 0);
    check_rows(table, std::size_t{threads} * 3 * 2000);
}
