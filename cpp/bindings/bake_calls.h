// Textures that are baked: which points their texels show, and what is found there.
#pragma once

#include "array_args.h"
#include "photograd/geometry/texel_cover.h"
#include "photograd/render/ambient_occlusion.h"

namespace photograd {

/// (face (H, W), weights (H, W, 2), contested)
inline py::tuple cover_arrays(const py::array& uv, const py::array& faces, std::int64_t height,
                              std::int64_t width) {
    ArrayArgs args("cover_texels");
    const float* coordinates = args.finite<float>("uv", uv, "V 2");
    const std::uint32_t* corners = args.in<std::uint32_t>("faces", faces, "F 3");
    const auto V = static_cast<std::size_t>(args.size("V")),
               F = static_cast<std::size_t>(args.size("F"));
    constexpr std::int64_t largest_side = 1 << 16, most_texels = 1 << 26;
    if (height < 1 || width < 1 || height > largest_side || width > largest_side ||
        height * width > most_texels)
        args.range("shape",
                   "1 to " + std::to_string(largest_side) + " texels along each axis, 2^26 in all",
                   std::to_string(height) + " x " + std::to_string(width));
    for (std::size_t k = 0; k < 3 * F; ++k)
        if (corners[k] >= V)
            args.range("faces", "numbers below " + std::to_string(V), std::to_string(corners[k]));
    TexelCover found;
    {
        const py::gil_scoped_release release;
        found = cover_texels({coordinates, 2 * V}, {corners, 3 * F},
                             {static_cast<int>(height), static_cast<int>(width)});
    }
    py::array_t<std::int32_t> face({height, width});
    py::array_t<double> weights({height, width, std::int64_t(2)});
    std::copy(found.face.begin(), found.face.end(), face.mutable_data());
    std::copy(found.weights.begin(), found.weights.end(), weights.mutable_data());
    return py::make_tuple(face, weights, found.contested);
}

inline void occlusion_arrays(const PathGeometry& geometry, const py::array& points,
                             const py::array& normals, double radius, std::uint64_t seed,
                             std::uint32_t first, std::uint32_t count, py::array sums) {
    ArrayArgs args("point_occlusion");
    const double *x = args.within<double>("points", points, "N 3", world_limit),
                 *n = args.within<double>("normals", normals, "N 3", world_limit);
    double* out = args.out<double>("sums", sums, "N");
    if (!(radius > 0)) args.range("radius", "above 0 m", std::to_string(radius));
    const std::int64_t N = args.size("N");
    check_samples(args, first, count);
    const py::gil_scoped_release release;
    add_point_occlusion(geometry, {x, n, N}, radius, seed, {first, count}, out);
}

inline void bind_bake(py::module_& m) {
    m.def("cover_texels", &cover_arrays, py::arg("uv"), py::arg("faces"), py::arg("height"),
          py::arg("width"),
          "(face (H, W) int32 or -1, weights (H, W, 2) of its second and third corner, number of "
          "texels\ninside of more than one face) of a mesh with coordinates (V, 2) float32 and "
          "faces (F, 3) uint32.");
    m.def("point_occlusion", &occlusion_arrays, py::arg("geometry"), py::arg("points"),
          py::arg("normals"), py::arg("radius"), py::arg("seed"), py::arg("first"),
          py::arg("count"), py::arg("sums"),
          "Adds to sums (N,) how many samples are free at points (N, 3) with unit normals (N, 3), "
          "float64.");
}

}  // namespace photograd
