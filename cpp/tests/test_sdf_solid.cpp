#include <doctest/doctest.h>

#include <cmath>

#include "photograd/core/random.h"
#include "photograd/geometry/sdf_layout.h"
#include "photograd/geometry/sdf_solid.h"

using namespace photograd;

namespace {

struct BodyOfAll {
    std::vector<SdfNode> nodes;
    std::vector<double> numbers;

    std::int32_t add(SdfKind kind, std::vector<double> own, std::int32_t first = -1,
                     std::int32_t second = -1) {
        nodes.push_back({kind, first, second, static_cast<std::int32_t>(numbers.size())});
        numbers.insert(numbers.end(), own.begin(), own.end());
        return static_cast<std::int32_t>(nodes.size()) - 1;
    }
    /// One body with every kind in it, placed and scaled more than once.
    BodyOfAll() {
        using enum SdfKind;
        const auto ring = add(scale, {1.3}, add(torus, {0.5, 0.15}));
        const auto turned = add(place, {0.8, 0.2, -0.4, 0.3, 0.1, 0.3, 0.0}, ring);
        const auto block = add(round, {0.05}, add(box, {0.5, 0.4, 0.3}));
        const auto rod =
            add(place, {0.5, 0.6, -0.3, 0.2, 0.3, 0.3, 0.2}, add(capsule, {0.4, 0.12}));
        const auto cut = add(subtract, {}, block, rod);
        const auto grown = add(smooth_unite, {0.2}, turned, cut);
        const auto shrunk =
            add(scale, {0.8}, add(place, {1, 0.1, 0.2, 0.3, 0.2, 0.1, -0.2}, grown));
        const auto base =
            add(intersect, {}, add(sphere, {1.4}), add(plane, {0.1, 1.0, 0.2, -0.35}));
        add(unite, {}, shrunk, base);
    }
};

Vec3<double> point(std::uint32_t number, double reach) {
    const Philox4 words = random_block({7, 0, number, 0}, 0);
    Vec3<double> p;
    for (int k = 0; k < 3; ++k)
        p[k] = reach * (2 * uniform_from<double>(words[static_cast<std::size_t>(k)]) - 1);
    return p;
}

}  // namespace

TEST_CASE("the list of steps says what the tree says, and so do its slopes") {
    const BodyOfAll all;
    const Sdf tree(all.nodes);
    const SdfSolid solid(tree, all.numbers.data());
    std::vector<double> unused(all.numbers.size());
    int inside = 0;
    for (std::uint32_t i = 0; i < 4000; ++i) {
        const Vec3<double> p = point(i, 1.6);
        const double f = tree.distance(all.numbers.data(), p);
        CHECK(std::abs(solid.distance(p) - f) < 1e-14);
        inside += f < 0;
        Vec3<double> g(0);
        tree.backward(all.numbers.data(), p, 1.0, g, unused.data());
        CHECK(length(solid.gradient(p) - g) < 1e-13);
    }
    CHECK(inside > 400);
    CHECK(inside < 3600);
}

TEST_CASE("the gradient is what dual numbers say") {
    const BodyOfAll all;
    SdfReach reach;
    const auto steps = lay_out(Sdf(all.nodes), all.numbers.data(), reach);
    for (std::uint32_t i = 0; i < 2000; ++i) {
        const Vec3<double> p = point(i, 1.6), g = steps_gradient(steps, p);
        for (int k = 0; k < 3; ++k) {
            Vec3<Dual<double>> q;
            for (int j = 0; j < 3; ++j) q[j] = Dual<double>{p[j], j == k ? 1.0 : 0.0};
            CHECK(std::abs(steps_distance<Dual<double>>(steps, q).tangent - g[k]) < 1e-12);
        }
    }
}

TEST_CASE("the box holds all of the body") {
    const BodyOfAll all;
    const SdfSolid solid(Sdf(all.nodes), all.numbers.data());
    Vec3<double> lo(1e9), hi(-1e9);
    for (std::uint32_t i = 0; i < 40000; ++i) {
        const Vec3<double> p = point(i, 2.0);
        if (solid.distance(p) > 0) continue;
        for (int k = 0; k < 3; ++k) {
            lo[k] = std::min(lo[k], p[k]);
            hi[k] = std::max(hi[k], p[k]);
            CHECK(p[k] >= double(solid.bounds().lo[k]));
            CHECK(p[k] <= double(solid.bounds().hi[k]));
        }
    }
    // Of the ball that reaches 1.4 m down and to all sides, the box is tight.
    CHECK(double(solid.bounds().lo.y) == doctest::Approx(-1.4).epsilon(1e-5));
    CHECK(double(solid.bounds().hi.x) < 1.6);
    CHECK(lo.y < -1.35);
    CHECK(hi.x > 1.2);
}

TEST_CASE("a ray marches to the surface from either side, and its hit is polished") {
    const BodyOfAll all;
    const SdfSolid solid(Sdf(all.nodes), all.numbers.data());
    int hits = 0;
    for (std::uint32_t i = 0; i < 4000; ++i) {
        const Vec3<double> from = point(i, 1.6);
        const Ray<double> ray{from, normalize(point(i + 100000, 1.0))};
        const double t = solid.march(ray, 0, 10);
        if (!(t < 10)) continue;
        ++hits;
        const double before = solid.distance(from);
        for (int k = 0; k < 50; ++k)  // free up to there
            CHECK(solid.distance(ray.at(t * k / 50)) * before > 0);
        const SdfPoint p = solid.point(ray, t);
        CHECK(std::abs(solid.distance(p.position)) < 1e-14);
        CHECK(length(p.position - ray.at(p.t)) < 1e-14);
        CHECK(length(p.normal - normalize(solid.gradient(p.position))) < 1e-14);
        CHECK(length(p.position - ray.at(t)) < 1e-3);
        CHECK(std::abs(length(p.normal) - 1) < 1e-14);
    }
    CHECK(hits > 1000);
}

TEST_CASE("bodies without an end or without an inside are refused") {
    using enum SdfKind;
    const std::vector<double> level{0, 1, 0, 0.3};
    CHECK_THROWS_WITH(SdfSolid(Sdf({{plane, -1, -1, 0}}), level.data()),
                      doctest::Contains("an end on all sides"));
    const Sdf none(
        {{sphere, -1, -1, 0}, {place, 0, -1, 1}, {sphere, -1, -1, 8}, {intersect, 1, 2, 9}});
    const std::vector<double> numbers{0.5, 1, 0, 0, 0, 3, 0, 0, 0.5};
    CHECK_THROWS_WITH(SdfSolid(none, numbers.data()), doctest::Contains("nothing is left"));
    std::vector<SdfNode> deep{{sphere, -1, -1, 0}};
    std::vector<double> radii(SdfStep::deepest + 1, 1.0);
    for (std::int32_t i = 1; i <= SdfStep::deepest; ++i) deep.push_back({sphere, -1, -1, i});
    for (std::int32_t i = SdfStep::deepest; i-- > 0;)
        deep.push_back(
            {unite, i, static_cast<std::int32_t>(deep.size()) - 1, SdfStep::deepest + 1});
    CHECK_THROWS_WITH(SdfSolid(Sdf(deep), radii.data()), doctest::Contains("within one another"));
}
