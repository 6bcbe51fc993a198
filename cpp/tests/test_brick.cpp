#include <doctest/doctest.h>

#include <vector>

#include "photograd/grid/brick.h"

using namespace photograd;

TEST_CASE("bricks of one color never share a voxel") {
    const int shape[3] = {20, 17, 33};
    const BrickLayout layout = BrickLayout::of(shape);
    REQUIRE(layout.count() == 3 * 3 * 5);
    for (int color = 0; color < brick_colors; ++color) {
        std::vector<float> touched(20 * 17 * 33, 0.0f);
        const std::vector<float> halo(brick_halo_voxels, 1.0f);
        for (int brick = 0; brick < layout.count(); ++brick)
            if (layout.color(brick) == color)
                flush_halo<float, 1>(layout, brick, halo.data(), touched.data());
        for (const float count : touched) CHECK(count <= 1.0f);
    }
}

TEST_CASE("every cell has the owner whose halo holds its eight corners") {
    const int shape[3] = {20, 17, 33};
    const BrickLayout layout = BrickLayout::of(shape);
    for (int i = 0; i + 1 < shape[0]; ++i)
        for (int j = 0; j + 1 < shape[1]; ++j)
            for (int k = 0; k + 1 < shape[2]; ++k) {
                int corner[3];
                layout.corner(layout.owner(i, j, k), corner);
                const int at[3] = {i, j, k};
                for (int axis = 0; axis < 3; ++axis) {
                    CHECK(at[axis] >= corner[axis]);
                    CHECK(at[axis] + 1 < corner[axis] + brick_halo_side);
                }
            }
}
