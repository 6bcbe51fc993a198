// Cameras as Python hands them over: (width, height, fx, fy, cx, cy, rows of world_from_camera), and for a lens its
// radius and the distance of the plane in focus behind them; while it moves, also by how far and how it turns.
#pragma once

#include <pybind11/stl.h>

#include <algorithm>

#include "array_args.h"
#include "photograd/camera/thin_lens.h"

namespace photograd {

inline Pinhole pinhole(const py::tuple& numbers) {
    Pinhole camera{};
    camera.width = numbers[0].cast<int>();
    camera.height = numbers[1].cast<int>();
    camera.fx = numbers[2].cast<double>();
    camera.fy = numbers[3].cast<double>();
    camera.cx = numbers[4].cast<double>();
    camera.cy = numbers[5].cast<double>();
    const auto pose = numbers[6].cast<std::array<std::array<double, 4>, 3>>();
    for (std::size_t i = 0; i < 3; ++i)
        std::copy(pose[i].begin(), pose[i].end(), camera.world_from_camera[i]);
    return camera;
}

inline ThinLens thin_lens(const py::tuple& numbers) {
    const double radius = numbers[7].cast<double>(), focus = numbers[8].cast<double>();
    if (!(radius >= 0) || !(focus > 0))
        fail(ErrorKind::range, "camera", "lens", "a radius of at least 0 and a focus above 0 m",
             std::to_string(radius) + " and " + std::to_string(focus));
    ThinLens camera{pinhole(numbers), radius, focus, {}};
    if (numbers.size() < 11) return camera;
    const auto shift = numbers[9].cast<std::array<double, 3>>();
    const auto turn = numbers[10].cast<std::array<double, 3>>();
    camera.motion = {{shift[0], shift[1], shift[2]}, {turn[0], turn[1], turn[2]}, true};
    return camera;
}

}  // namespace photograd
