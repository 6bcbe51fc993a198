#include <doctest/doctest.h>

#include <numeric>

#include "photograd/core/scatter.h"

using namespace photograd;

TEST_CASE("bin_by_owner keeps the order of contributions within each owner") {
    const std::vector<std::uint32_t> owner{3, 0, 3, 1, 0, 3};
    std::vector<std::uint32_t> items(owner.size());
    std::iota(items.begin(), items.end(), 0u);
    OwnerBins bins;
    bin_by_owner(items, 4, [&](std::uint32_t i) { return owner[i]; }, bins);
    CHECK(bins.begin == std::vector<std::uint32_t>{0, 2, 3, 3, 6});
    CHECK(bins.order == std::vector<std::uint32_t>{1, 4, 3, 0, 2, 5});
}

TEST_CASE("bin_by_owner on threads gives what it gives on one") {
    // More than two pieces of 2^16, an owner without contributions, and more owners than a piece
    // is long.
    for (const int owners : {1, 7, 100000}) {
        std::vector<std::uint32_t> owner(150000), items(owner.size());
        for (std::size_t i = 0; i < owner.size(); ++i) {
            const auto k = static_cast<std::uint32_t>(i * 2654435761u >> 7);
            owner[i] = owners == 1 ? 0 : k % static_cast<std::uint32_t>(owners - 1);
        }
        std::iota(items.begin(), items.end(), 0u);
        OwnerBins serial, threaded;
        bin_by_owner(items, owners, [&](std::uint32_t i) { return owner[i]; }, serial);
        bin_by_owner(owner, owners, threaded);
        CHECK(threaded.begin == serial.begin);
        CHECK(threaded.order == serial.order);
    }
}

TEST_CASE("bin_by_owner of nothing has an empty bin for every owner") {
    OwnerBins bins;
    bin_by_owner({}, 3, [](std::uint32_t) { return 0u; }, bins);
    CHECK(bins.begin == std::vector<std::uint32_t>{0, 0, 0, 0});
    CHECK(bins.order.empty());
}

TEST_CASE("sum_partials adds to its target, and any number of threads gives the same bits") {
    const auto run = [](int threads) {
        set_thread_count(threads);
        std::vector<float> total{1.0f, -2.0f};
        sum_partials<float>(64, total, [](std::int64_t chunk, std::span<double> partial) {
            partial[0] += 1.0 / static_cast<double>(chunk + 1);
            partial[1] += 0.1 * static_cast<double>(chunk);
        });
        set_thread_count(0);
        return total;
    };
    const std::vector<float> one = run(1);
    CHECK(one[0] == doctest::Approx(1.0 + 4.7438909));
    CHECK(one[1] == doctest::Approx(-2.0 + 201.6));
    CHECK(run(2) == one);
    CHECK(run(4) == one);
}

TEST_CASE("parallel_for visits every index once and lets exceptions through") {
    std::vector<int> visits(1000, 0);
    parallel_for(1000, [&](std::int64_t i) { ++visits[static_cast<std::size_t>(i)]; });
    CHECK(visits == std::vector<int>(1000, 1));
    CHECK_THROWS_AS(parallel_for(10,
                                 [](std::int64_t i) {
                                     if (i == 7) throw 5;
                                 }),
                    int);
}
