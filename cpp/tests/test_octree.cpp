#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "photograd/core/random.h"
#include "photograd/grid/octree_batch.h"
#include "photograd/grid/octree_build.h"

using namespace photograd;

namespace {

double number(std::uint32_t row, std::uint32_t dimension, std::uint64_t seed = 7) {
    return uniform<double>({.seed = seed, .pixel = row}, dimension);
}

/// A ball of radius 0.35 with smooth scattering, in a box of `shape` cells; empty outside.
std::vector<Coefficients<float>> ball(const Cell<3>& shape) {
    std::vector<Coefficients<float>> values;
    for (int i = 0; i < shape[0]; ++i)
        for (int j = 0; j < shape[1]; ++j)
            for (int k = 0; k < shape[2]; ++k) {
                const double x = (i + 0.5) / shape[0] - 0.5, y = (j + 0.5) / shape[1] - 0.5,
                             z = (k + 0.5) / shape[2] - 0.5;
                const bool inside = x * x + y * y + z * z < 0.35 * 0.35;
                values.push_back(
                    {inside ? 2.0f : 0.0f, inside ? static_cast<float>(3.0 + x * y) : 0.0f});
            }
    return values;
}

/// Leaves by trying every aligned cube, largest first: what "collapses" means, without a tree.
std::int64_t brute_force_leaves(const std::vector<Coefficients<float>>& values,
                                const Cell<3>& shape, int side, float tolerance) {
    std::vector<char> taken(static_cast<std::size_t>(side) * side * side, 0);
    std::int64_t count = 0;
    for (int s = side; s >= 1; s /= 2)
        for (int i = 0; i < side; i += s)
            for (int j = 0; j < side; j += s)
                for (int k = 0; k < side; k += s) {
                    if (taken[static_cast<std::size_t>((i * side + j) * side + k)]) continue;
                    Coefficients<float> low{1e30f, 1e30f}, high{-1e30f, -1e30f};
                    for (int x = i; x < i + s; ++x)
                        for (int y = j; y < j + s; ++y)
                            for (int z = k; z < k + s; ++z) {
                                const bool in = x < shape[0] && y < shape[1] && z < shape[2];
                                const auto at =
                                    static_cast<std::size_t>((x * shape[1] + y) * shape[2] + z);
                                for (std::size_t c = 0; c < 2; ++c) {
                                    const float v = in ? values[at][c] : 0.0f;
                                    low[c] = std::min(low[c], v);
                                    high[c] = std::max(high[c], v);
                                }
                            }
                    if (high[0] - low[0] > tolerance || high[1] - low[1] > tolerance) continue;
                    ++count;
                    for (int x = i; x < i + s; ++x)
                        for (int y = j; y < j + s; ++y)
                            for (int z = k; z < k + s; ++z)
                                taken[static_cast<std::size_t>((x * side + y) * side + z)] = 1;
                }
    return count;
}

}  // namespace

TEST_CASE("a quadtree worked by hand") {
    // Rows are x. The quarter x < 4, y < 4 is empty but for the cell (3, 3); the quarter x >= 4,
    // y < 4 is full; of the two with y >= 4 the first is empty and the second is full where x < 6.
    std::vector<Occupancy> cells(64, Occupancy{0});
    for (std::size_t x = 0; x < 8; ++x)
        for (std::size_t y = 0; y < 8; ++y)
            if ((x == 3 && y == 3) || (x >= 4 && y < 4) || (x >= 4 && x < 6))
                cells[x * 8 + y] = Occupancy{1};
    const Quadtree<Occupancy> q = tree_from_dense<Occupancy, 2>(cells.data(), {8, 8}, {0}, 0.0);
    const TreeStatistics s = q.tree.statistics();
    // Level 1: two whole quarters. Level 2: 3 of the first, 4 of the last. Level 3: 4 cells.
    CHECK(s.leaves_per_level == std::vector<std::int64_t>{0, 2, 7, 4});
    CHECK(s.leaves == 13);
    CHECK(s.nodes == 13 + 4);  // root, two quarters, one block of 2 x 2
    CHECK(s.bytes == 17 * 4);
    // Along the Z curve, x fastest: three empties, the 2 x 2 block, the full quarter, and so on.
    std::vector<int> values;
    for (const Occupancy& leaf : q.leaves) values.push_back(leaf[0]);
    CHECK(values == std::vector<int>{0, 0, 0, 0, 0, 0, 1, 1, 0, 1, 0, 1, 0});
    // Along y = 3.5 from the left: an empty block of 2, two cells, then the full quarter.
    const double origin[2] = {-1.0, 3.5}, direction[2] = {1.0, 0.0};
    std::vector<double> steps;
    q.tree.traverse(origin, direction, 0.0, 100.0, [&](std::int32_t leaf, double t0, double t1) {
        steps.insert(steps.end(), {double(leaf), t0, t1});
        return true;
    });
    CHECK(steps == std::vector<double>{2, 1, 3, 5, 3, 4, 6, 4, 5, 7, 5, 9});
}

TEST_CASE("point queries equal the dense array at a million points") {
    const Cell<3> shape = {61, 48, 64};
    const auto values = ball(shape);
    const auto octree = tree_from_dense<Coefficients<float>, 3>(values.data(), shape, {0, 0}, 0.0);
    CHECK(octree.tree.leaf_count() < 64 * 64 * 64 / 3);
    int wrong = 0, full = 0;
    for (std::uint32_t row = 0; row < 1'000'000; ++row) {
        double point[3];
        for (std::uint32_t a = 0; a < 3; ++a) point[a] = 66.0 * number(row, a) - 1.0;
        // Every fourth point lies on faces of cells, where the upper one counts.
        for (double& x : point)
            if (row % 4 == 0) x = std::floor(x);
        Coefficients<float> expected{0, 0};
        int cell[3];
        for (int a = 0; a < 3; ++a) cell[a] = static_cast<int>(std::floor(point[a]));
        if (cell[0] >= 0 && cell[1] >= 0 && cell[2] >= 0 && cell[0] < shape[0] &&
            cell[1] < shape[1] && cell[2] < shape[2])
            expected = values[static_cast<std::size_t>((cell[0] * shape[1] + cell[1]) * shape[2] +
                                                       cell[2])];
        wrong += octree.at(point, {0, 0}) != expected;
        full += expected[0] > 0.0f;
    }
    CHECK(wrong == 0);
    CHECK(full > 100'000);
}

TEST_CASE("leaves are as many as a search through all aligned cubes finds") {
    const Cell<3> shape = {29, 32, 17};
    const auto values = ball(shape);
    for (const float tolerance : {0.0f, 0.01f, 0.05f, 4.0f}) {
        const auto octree =
            tree_from_dense<Coefficients<float>, 3>(values.data(), shape, {0, 0}, tolerance);
        CHECK(octree.tree.leaf_count() == brute_force_leaves(values, shape, 32, tolerance));
    }
}

TEST_CASE("no cell moves by more than the tolerance, and the integral stays") {
    const Cell<3> shape = {32, 32, 32};
    const auto values = ball(shape);
    const double tolerance = 0.03;
    const auto octree =
        tree_from_dense<Coefficients<float>, 3>(values.data(), shape, {0, 0}, tolerance);
    double worst = 0.0, dense_sum = 0.0, tree_sum = 0.0;
    octree.tree.for_each_leaf([&](std::int32_t leaf, const LeafBox<3>& box) {
        const Coefficients<float>& held = octree.leaves[static_cast<std::size_t>(leaf)];
        for (int x = box.lower[0]; x < box.lower[0] + box.side; ++x)
            for (int y = box.lower[1]; y < box.lower[1] + box.side; ++y)
                for (int z = box.lower[2]; z < box.lower[2] + box.side; ++z) {
                    const auto& cell = values[static_cast<std::size_t>((x * 32 + y) * 32 + z)];
                    for (std::size_t c = 0; c < 2; ++c)
                        worst = std::max(worst, std::abs(double(held[c]) - double(cell[c])));
                    dense_sum += double(cell[1]);
                    tree_sum += double(held[1]);
                }
    });
    CHECK(worst > 0.005);  // something did collapse
    CHECK(worst <= tolerance);
    // The means are rounded to float once: relative error below 2^-24 each.
    CHECK(std::abs(tree_sum - dense_sum) < 6e-8 * dense_sum);
}

TEST_CASE("a function that knows where it is uniform gives the tree of its samples") {
    const auto inside = [](double x, double y, double z) { return x * x + 2 * y * y + z < 150.0; };
    std::vector<Occupancy> cells;
    for (int x = 0; x < 16; ++x)
        for (int y = 0; y < 16; ++y)
            for (int z = 0; z < 16; ++z)
                cells.push_back({static_cast<std::uint8_t>(inside(x + 0.5, y + 0.5, z + 0.5))});
    const auto dense = tree_from_dense<Occupancy, 3>(cells.data(), {16, 16, 16}, {0}, 0.0);
    int asked = 0;
    // Monotone in every coordinate: the cells of two opposite corners decide for the whole cube.
    const auto sparse = tree_from_function<Occupancy, 3>(
        4, [&](const Cell<3>& lower, int side) -> std::optional<Occupancy> {
            ++asked;
            const bool low = inside(lower[0] + 0.5, lower[1] + 0.5, lower[2] + 0.5),
                       high = inside(lower[0] + side - 0.5, lower[1] + side - 0.5,
                                     lower[2] + side - 0.5);
            if (low != high) return std::nullopt;
            return Occupancy{static_cast<std::uint8_t>(low)};
        });
    CHECK(sparse.leaves == dense.leaves);
    CHECK(sparse.tree.statistics().leaves_per_level == dense.tree.statistics().leaves_per_level);
    CHECK(asked == sparse.tree.statistics().nodes);
    CHECK(asked < 4096 / 2);
    const auto undecided = [](const Cell<3>&, int) { return std::optional<Occupancy>(); };
    CHECK_THROWS_AS((tree_from_function<Occupancy, 3>(2, undecided)), Error);
}

TEST_CASE("trees of one cell, and refusals") {
    const Radiance<double> one{0.1, 0.2, 0.3};
    const auto single = tree_from_dense<Radiance<double>, 3>(&one, {1, 1, 1}, {}, 0.0);
    const float point[3] = {0.5f, 0.0f, 0.999f}, beside[3] = {0.5f, 1.0f, 0.5f};
    CHECK(single.tree.statistics().nodes == 1);
    CHECK(single.at(point, {}) == one);
    CHECK(single.tree.locate(beside) == SpatialTree<3>::outside);
    CHECK_THROWS_AS(SpatialTree<3>(21), Error);
    CHECK_THROWS_AS((tree_from_dense<Radiance<double>, 3>(&one, {1, 0, 1}, {}, 0.0)), Error);
    CHECK_THROWS_AS((tree_from_dense<Radiance<double>, 3>(&one, {1, 1, 1}, {}, -1.0)), Error);
    const Occupancy full{1};
    CHECK_THROWS_AS((tree_from_dense<Occupancy, 3>(&full, {1, 1, 1}, {0}, 0.5)), Error);
}
