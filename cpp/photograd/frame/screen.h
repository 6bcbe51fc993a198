// What a frame shows, in the coordinates of its camera: depths and normals, for passes that look
// around each pixel.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "photograd/core/real.h"
#include "photograd/core/vec.h"

namespace photograd {

/// inverse_depth (H, W), 0 where nothing is seen, and unit normals (H, W, 3), both of the camera;
/// fx, fy, cx, cy in pixels.
template <class R>
struct ScreenFrame {
    std::int64_t height, width;
    R fx, fy, cx, cy;
    const R *inverse_depth, *normals;

    /// The point at depth 1 behind the point (x, y) of the picture, in pixels.
    [[nodiscard]] Vec3<R> ray(R x, R y) const { return {(x - cx) / fx, (y - cy) / fy, R(1)}; }
    /// The surface in the center of pixel i, which shows one.
    [[nodiscard]] Vec3<R> point(std::int64_t i) const {
        return ray(R(i % width) + R(0.5), R(i / width) + R(0.5)) * (R(1) / inverse_depth[i]);
    }
    [[nodiscard]] Vec3<R> normal(std::int64_t i) const {
        return {normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]};
    }
};

/// 1 / depth between the centers of pixels, clamped to the frame, and its slopes. Bilinear, which
/// is exact on planes.
template <class R>
struct InverseDepth {
    R value, by_x, by_y;

    static InverseDepth at(const ScreenFrame<R>& frame, R x, R y) {
        const R fx = std::clamp(x - R(0.5), R(0), R(frame.width - 1));
        const R fy = std::clamp(y - R(0.5), R(0), R(frame.height - 1));
        // What is no number, of depths out of R's range, stays inside as well.
        const auto lower = [](R f, std::int64_t size) {
            return std::clamp<std::int64_t>(static_cast<std::int64_t>(f), 0,
                                            std::max<std::int64_t>(size - 2, 0));
        };
        const std::int64_t x0 = lower(fx, frame.width), y0 = lower(fy, frame.height);
        const std::int64_t x1 = std::min(x0 + 1, frame.width - 1);
        const std::int64_t y1 = std::min(y0 + 1, frame.height - 1);
        const R tx = fx - R(x0), ty = fy - R(y0);
        const auto w = [&](std::int64_t row, std::int64_t column) {
            return frame.inverse_depth[row * frame.width + column];
        };
        const R top = w(y0, x0) + tx * (w(y0, x1) - w(y0, x0));
        const R bottom = w(y1, x0) + tx * (w(y1, x1) - w(y1, x0));
        const R along = (R(1) - ty) * (w(y0, x1) - w(y0, x0)) + ty * (w(y1, x1) - w(y1, x0));
        const bool inside_x = fx == x - R(0.5), inside_y = fy == y - R(0.5);
        return {top + ty * (bottom - top), inside_x ? along : R(0), inside_y ? bottom - top : R(0)};
    }
};

/// A number from 0 to 15 for each pixel: those of a square of 4 x 4 differ, and neighbors are far
/// apart.
inline int turn_of_pixel(std::int64_t x, std::int64_t y) {
    constexpr std::array<int, 16> order = {0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};
    return order[static_cast<std::size_t>(4 * (y % 4) + x % 4)];
}

}  // namespace photograd
