// Cameras as Python hands them over: (width, height, fx, fy, cx, cy, rows of world_from_camera),
// and for a lens its radius and the distance of the plane in focus behind them; while it moves,
// also by how far and how it turns.
#pragma once

#include <algorithm>

#include "array_args.h"
#include "photograd/camera/thin_lens.h"
#include "pybind.h"

namespace photograd {

/// Entries of a camera's tuple, which has 7, 9 or 11 of them.
class CameraNumbers {
public:
    explicit CameraNumbers(const py::tuple& numbers) : numbers_(numbers) {
        const std::size_t size = numbers.size();
        if (size != 7 && size != 9 && size != 11)
            fail(ErrorKind::shape, "camera", "numbers", "7, 9 or 11 of them", std::to_string(size));
    }
    [[nodiscard]] std::size_t size() const { return numbers_.size(); }
    template <class T>
    [[nodiscard]] T at(std::size_t slot, const char* name) const {
        return entry_as<T>("camera", name, "numbers", numbers_[slot]);
    }
    /// A number, or an array of them, all within `world_limit`.
    template <class T = double>
    [[nodiscard]] T within(std::size_t slot, const char* name) const {
        const T value = at<T>(slot, name);
        const auto check = [&](double x) {
            if (!(std::abs(x) <= world_limit))
                fail(ErrorKind::range, "camera", name,
                     "numbers up to " + number_text(world_limit) + " in size", number_text(x));
        };
        if constexpr (std::is_arithmetic_v<T>)
            check(value);
        else
            for (const double x : value) check(x);
        return value;
    }

private:
    const py::tuple& numbers_;
};

inline Pinhole pinhole_of(const CameraNumbers& numbers) {
    constexpr std::int64_t most_pixels = 1 << 28;
    Pinhole camera{};
    camera.width = numbers.at<int>(0, "width");
    camera.height = numbers.at<int>(1, "height");
    if (camera.width < 1 || camera.height < 1 ||
        std::int64_t{camera.width} * camera.height > most_pixels)
        fail(ErrorKind::range, "camera", "width, height", "1 to 2^28 pixels",
             std::to_string(camera.width) + " x " + std::to_string(camera.height));
    camera.fx = numbers.within(2, "fx");
    camera.fy = numbers.within(3, "fy");
    if (!(camera.fx > 0) || !(camera.fy > 0))
        fail(ErrorKind::range, "camera", "fx, fy", "focal lengths above 0 pixels",
             number_text(camera.fx) + " and " + number_text(camera.fy));
    camera.cx = numbers.within(4, "cx");
    camera.cy = numbers.within(5, "cy");
    using Rows = std::array<std::array<double, 4>, 3>;
    const Rows pose = numbers.at<Rows>(6, "world_from_camera");
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 4; ++k) {
            if (!(std::abs(pose[i][k]) <= world_limit))
                fail(ErrorKind::range, "camera", "world_from_camera",
                     "numbers up to " + number_text(world_limit) + " in size",
                     number_text(pose[i][k]));
            camera.world_from_camera[i][k] = pose[i][k];
        }
    return camera;
}

inline Pinhole pinhole(const py::tuple& numbers) { return pinhole_of(CameraNumbers(numbers)); }

inline ThinLens thin_lens(const py::tuple& tuple) {
    const CameraNumbers numbers(tuple);
    const Pinhole without_lens = pinhole_of(numbers);
    if (numbers.size() == 7)
        fail(ErrorKind::shape, "camera", "numbers", "9 or 11 of them", "7, without a lens");
    const double radius = numbers.within(7, "lens"), focus = numbers.within(8, "lens");
    if (!(radius >= 0) || !(focus > 0))
        fail(ErrorKind::range, "camera", "lens", "a radius of at least 0 and a focus above 0 m",
             std::to_string(radius) + " and " + std::to_string(focus));
    ThinLens camera{without_lens, radius, focus, {}};
    if (numbers.size() < 11) return camera;
    const auto shift = numbers.within<std::array<double, 3>>(9, "shift");
    const auto turn = numbers.within<std::array<double, 3>>(10, "turn");
    camera.motion = {{shift[0], shift[1], shift[2]}, {turn[0], turn[1], turn[2]}, true};
    return camera;
}

}  // namespace photograd
