// A ray visits the leaves, and only the leaves, whose own interval has positive length: against a
// test of every leaf, on rays made to be awkward.
#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "photograd/core/random.h"
#include "photograd/grid/octree_batch.h"
#include "photograd/grid/octree_build.h"

using namespace photograd;

namespace {

template <class R>
struct Visited {
    R t0, t1;
    std::int32_t leaf;
    bool operator==(const Visited&) const = default;
};

template <class R>
struct AwkwardRay {
    R origin[3], direction[3], t_min, t_max;
};

/// Interval of one box by slabs; a ray along a slab is inside if lower <= origin < upper.
template <class R>
bool meets(const AwkwardRay<R>& ray, const LeafBox<3>& box, R& t0, R& t1) {
    t0 = ray.t_min;
    t1 = ray.t_max;
    for (int a = 0; a < 3; ++a) {
        const R lower = R(box.lower[a]), upper = R(box.lower[a] + box.side);
        if (ray.direction[a] == R(0)) {
            if (ray.origin[a] < lower || ray.origin[a] >= upper) return false;
            continue;
        }
        const R u = (lower - ray.origin[a]) / ray.direction[a];
        const R v = (upper - ray.origin[a]) / ray.direction[a];
        t0 = std::max(t0, std::min(u, v));
        t1 = std::min(t1, std::max(u, v));
    }
    return t0 < t1;
}

/// Kinds of rays: anywhere; along one axis; along two; on the lattice of cell corners, where it
/// grazes faces, edges and corners; nearly parallel to an axis; with the interval cut on both
/// sides.
template <class R>
AwkwardRay<R> awkward(std::uint32_t row) {
    const auto u = [&](std::uint32_t d) { return uniform<R>({.seed = 3, .pixel = row}, d); };
    AwkwardRay<R> ray{{}, {}, R(0), std::numeric_limits<R>::infinity()};
    const std::uint32_t kind = row % 6;
    for (std::uint32_t a = 0; a < 3; ++a) {
        ray.origin[a] = R(40) * u(a) - R(4);
        ray.direction[a] = R(2) * u(3 + a) - R(1);
        if (kind == 1 && a != row / 6 % 3) ray.direction[a] = R(0);
        if (kind == 2 && a == row / 6 % 3) ray.direction[a] = row % 4 == 0 ? R(0) : -R(0);
        if (kind == 3 || kind == 1 || (kind == 2 && row % 5 == 0))
            ray.origin[a] = R(static_cast<int>(ray.origin[a]));
        if (kind == 3) ray.direction[a] = R(static_cast<int>(R(3) * u(3 + a)) - 1);
        if (kind == 4 && a != row / 6 % 3) ray.direction[a] *= R(1e-30);
    }
    if (kind == 5) {
        ray.t_min = R(20) * u(6) - R(10);
        ray.t_max = ray.t_min + R(30) * u(7);
    }
    return ray;
}

Octree<Occupancy> hollow_shape() {
    std::vector<Occupancy> cells;
    for (int x = 0; x < 30; ++x)
        for (int y = 0; y < 32; ++y)
            for (int z = 0; z < 27; ++z) {
                const double r =
                    (x - 15.5) * (x - 15.5) + (y - 12) * (y - 12) + (z - 13) * (z - 13);
                cells.push_back({static_cast<std::uint8_t>(r < 144.0 && r > 64.0)});
            }
    return tree_from_dense<Occupancy, 3>(cells.data(), {30, 32, 27}, {0}, 0.0);
}

}  // namespace

TEST_CASE_TEMPLATE("rays visit the leaves that an interval test of all leaves finds", R, float,
                   double) {
    const Octree<Occupancy> octree = hollow_shape();
    std::vector<LeafBox<3>> boxes;
    octree.tree.for_each_leaf([&](std::int32_t leaf, const LeafBox<3>& box) {
        REQUIRE(leaf == static_cast<std::int32_t>(boxes.size()));
        boxes.push_back(box);
    });
    int wrong = 0, met = 0, inside = 0, missed = 0;
    for (std::uint32_t row = 0; row < 6000; ++row) {
        const AwkwardRay<R> ray = awkward<R>(row);
        if (ray.direction[0] == R(0) && ray.direction[1] == R(0) && ray.direction[2] == R(0))
            continue;
        std::vector<Visited<R>> expected, got;
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            R t0, t1;
            if (meets(ray, boxes[i], t0, t1))
                expected.push_back({t0, t1, static_cast<std::int32_t>(i)});
        }
        std::sort(expected.begin(), expected.end(),
                  [](const auto& a, const auto& b) { return a.t0 < b.t0; });
        octree.tree.traverse(ray.origin, ray.direction, ray.t_min, ray.t_max,
                             [&](std::int32_t leaf, R t0, R t1) {
                                 got.push_back({t0, t1, leaf});
                                 return true;
                             });
        wrong += got != expected;  // the same leaves in the same order, intervals equal to the bit
        met += static_cast<int>(got.size());
        inside += octree.tree.locate(ray.origin) >= 0;
        missed += got.empty();
    }
    CHECK(wrong == 0);
    CHECK(met > 20'000);
    CHECK(inside > 1000);
    CHECK(missed > 300);
}

TEST_CASE("the visits of a ray join up and a visit can stop the ray") {
    const Octree<Occupancy> octree = hollow_shape();
    const double origin[3] = {-3.0, 10.25, 40.0}, direction[3] = {0.7, 0.1, -0.6};
    double last = -1.0;
    int visits = 0;
    octree.tree.traverse(origin, direction, 0.0, 1e9, [&](std::int32_t, double t0, double t1) {
        if (visits++ > 0) CHECK(t0 == last);
        last = t1;
        return true;
    });
    CHECK(visits > 5);
    int stopped = 0;
    octree.tree.traverse(origin, direction, 0.0, 1e9,
                         [&](std::int32_t, double, double) { return ++stopped < 3; });
    CHECK(stopped == 3);
}

TEST_CASE("the visits of a batch are the same on any number of threads") {
    const Octree<Occupancy> octree = hollow_shape();
    constexpr std::int64_t count = 20'000;
    std::vector<float> origins, directions, t_min(count, 0.0f), t_max(count, 100.0f);
    for (std::uint32_t i = 0; i < count; ++i)
        for (std::uint32_t a = 0; a < 3; ++a) {
            const RandomKey key{.seed = 5, .pixel = i};
            origins.push_back(32.0f * uniform<float>(key, a));
            directions.push_back(uniform<float>(key, 3 + a) - 0.5f);
        }
    const auto run = [&](int threads) {
        set_thread_count(threads);
        auto out = traverse_batch<float, 3>(octree.tree, origins.data(), directions.data(),
                                            t_min.data(), t_max.data(), count);
        set_thread_count(0);
        return out;
    };
    const LeafVisits<float> one = run(1), four = run(4);
    CHECK(one.leaf.size() > 100'000);
    CHECK(one.ray_offset == four.ray_offset);
    CHECK(one.leaf == four.leaf);
    CHECK(one.t0 == four.t0);
    CHECK(one.t1 == four.t1);
}
