// Arrays that belong together: a tuple in Python, one argument here.
#pragma once

#include <array>
#include <vector>

#include "array_args.h"
#include "pybind.h"

namespace photograd {

template <std::size_t N>
using Arrays = std::array<py::array, N>;

/// Fresh color (*shape, 3), opacity or transmittance (*shape), depth (*shape), filled without the
/// GIL by fill(Outputs{color, ..., depth}).
template <class R, class Outputs, class Fill>
py::tuple filled_image(const std::vector<py::ssize_t>& shape, Fill&& fill) {
    std::vector<py::ssize_t> color_shape = shape;
    color_shape.push_back(3);
    py::array_t<R> color(color_shape), opacity(shape), depth(shape);
    const Outputs out{color.mutable_data(), opacity.mutable_data(), depth.mutable_data()};
    {
        const py::gil_scoped_release release;
        fill(out);
    }
    return py::make_tuple(color, opacity, depth);
}

/// (*axes, 3), (*axes) and (*axes), as a renderer has left them.
template <class R, class Outputs>
Outputs image_from(ArrayArgs& args, Arrays<3>& image, const char* second, const std::string& axes) {
    return {args.out<R>("color", image[0], axes + " 3"), args.out<R>(second, image[1], axes),
            args.out<R>("depth", image[2], axes)};
}

/// The cotangents of such an image.
template <class R, class Cotangents>
Cotangents cotangents_from(ArrayArgs& args, const Arrays<3>& d_image, const char* second,
                           const std::string& axes) {
    return {args.in<R>("d_color", d_image[0], axes + " 3"), args.in<R>(second, d_image[1], axes),
            args.in<R>("d_depth", d_image[2], axes)};
}

/// The degree of the axis K of spherical-harmonic coefficients, which an array has named.
inline int degree_of(const ArrayArgs& args) {
    switch (args.size("K")) {
        case 1: return 0;
        case 4: return 1;
        case 9: return 2;
        case 16: return 3;
        default:
            args.range("sh", "1, 4, 9 or 16 coefficients (degree 0 to 3)",
                       std::to_string(args.size("K")));
    }
}

}  // namespace photograd
