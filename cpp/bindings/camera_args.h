// Cameras as Python hands them over: (width, height, fx, fy, cx, cy, rows of world_from_camera).
#pragma once

#include <pybind11/stl.h>

#include <algorithm>

#include "array_args.h"
#include "photograd/camera/pinhole.h"

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

}  // namespace photograd
