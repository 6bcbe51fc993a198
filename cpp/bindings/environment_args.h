// An environment map from its arrays.
#pragma once

#include "array_args.h"
#include "photograd/light/environment.h"

namespace photograd {

/// Of texels that `args` has read with the axes "H W 3".
template <class R>
int height_of(const ArrayArgs& args, const char* name, const py::array& texels) {
    constexpr std::int64_t tallest = 1 << 14;
    const std::int64_t h = args.size("H"), w = args.size("W");
    if (h < 1 || h > tallest || w != 2 * h)
        fail(ErrorKind::shape, "environment", name,
             "shape (H, 2 H, 3), H at most " + std::to_string(tallest),
             "(" + std::to_string(h) + ", " + std::to_string(w) + ", " +
                 std::to_string(texels.shape(2)) + ")",
             "a map of all directions is twice as wide as high");
    return static_cast<int>(h);
}

template <class R>
Mat3<R> rotation_in(ArrayArgs& args, const py::array& world_from_map) {
    const R* m = args.in<R>("world_from_map", world_from_map, "3 3");
    Mat3<R> rotation;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) rotation[column][row] = m[3 * row + column];
    return rotation;
}

template <class R>
Environment<R> environment_in(ArrayArgs& args, const EnvironmentSampler& sampler,
                              const py::array& texels, const py::array& world_from_map) {
    const R* data = args.in<R>("texels", texels, "H W 3");
    const int height = height_of<R>(args, "texels", texels);
    return {data, height, rotation_in<R>(args, world_from_map), &sampler};
}

}  // namespace photograd
