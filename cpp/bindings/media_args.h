// Media of a scene as Python gives them: where they are, once, and their numbers, for each
// rendering.
//
//   (name of the phase function or "", parameters (P,), densities (X, Y, Z) or None, sigma_maj)
#pragma once

#include <optional>
#include <tuple>

#include "array_args.h"
#include "photograd/scene/path_scene.h"
#include "pybind.h"

namespace photograd {

using MediumTuple = std::tuple<std::string, py::array, std::optional<py::array>, double>;
/// (X, Y, Z) and box_from_world (3, 4), or None.
using GridTransforms = std::vector<std::optional<std::tuple<std::array<int, 3>, py::array>>>;

inline constexpr double most_mean_free_paths = 1e6;

/// At least the longest way through the box of a grid, meters: the diagonal of a cube, through the
/// inverse of the matrix, by its cofactors.
inline double longest_way(const DensityLayout& layout) {
    const Affine box_from_world{layout.box_from_world};
    const auto row = [&](std::size_t i) {
        const double* m = box_from_world.m.data() + 4 * i;
        return Vec3<double>(m[0], m[1], m[2]);
    };
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3<double> column = cross(row((i + 1) % 3), row((i + 2) % 3));
        sum += dot(column, column);
    }
    return std::sqrt(3 * sum) / std::abs(box_from_world.determinant());
}

inline void set_media(PathGeometry& geometry, const py::array& interior, const py::array& boundary,
                      std::int32_t world, const GridTransforms& grids) {
    ArrayArgs args("PathTracer");
    const std::string axes = std::to_string(geometry.shape_count());
    const std::int32_t* inside = args.in<std::int32_t>("interior", interior, axes);
    const bool* is_boundary = args.in<bool>("boundary", boundary, axes);
    MediaGeometry out;
    const auto count = static_cast<std::int32_t>(grids.size());
    for (std::size_t s = 0; s < geometry.shape_count(); ++s) {
        if (inside[s] < MediaGeometry::unchanged || inside[s] >= count)
            args.range("interior", "numbers of media, -1 or -2", std::to_string(inside[s]));
        out.interior.push_back(inside[s]);
        out.boundary.push_back(is_boundary[s]);
    }
    if (world < MediaGeometry::vacuum || world >= count)
        args.range("world", "the number of a medium or -1", std::to_string(world));
    out.world = world;
    for (const auto& transform : grids) {
        DensityLayout layout;
        if (transform) {
            const auto& [shape, matrix] = *transform;
            if (shape[0] < 2 || shape[1] < 2 || shape[2] < 2)
                args.range("density", "at least two voxels along each axis", "fewer");
            layout.shape = {shape[0], shape[1], shape[2]};
            ArrayArgs own("PathTracer");
            std::copy_n(own.within<double>("box_from_world", matrix, "3 4", world_limit), 12,
                        layout.box_from_world.begin());
            if (!(longest_way(layout) <= world_limit))
                args.range("box_from_world", "a matrix that can be inverted", "another");
        }
        out.grids.push_back(layout);
    }
    geometry.media = std::move(out);
}

inline std::string axes_of(const GridShape& shape) {
    return std::to_string(shape.x) + " " + std::to_string(shape.y) + " " + std::to_string(shape.z);
}

template <class R>
std::vector<Medium<R>> media_of(const PathGeometry& geometry,
                                const std::vector<MediumTuple>& rows) {
    const auto& grids = geometry.media.grids;
    ArrayArgs args("trace_paths");
    if (rows.size() != grids.size())
        args.range("media", std::to_string(grids.size()) + ", as when the scene was built",
                   std::to_string(rows.size()));
    std::vector<Medium<R>> out;
    for (std::size_t m = 0; m < rows.size(); ++m) {
        const auto& [phase, row, density, sigma_maj] = rows[m];
        Medium<R> medium;
        if (!phase.empty()) medium.phase = AnyPhase<R>::named(phase);
        ArrayArgs own("trace_paths");
        const R* next =
            own.within<R>("media", row, std::to_string(medium.parameter_count()), world_limit);
        medium.for_each([&](R& x) { x = *next++; });
        if (density.has_value() == grids[m].empty())
            args.range("media", "densities for media with a grid alone", "others");
        if (density) {
            // Every null collision is a step of a path: at some density they never end.
            const double paths = sigma_maj * longest_way(grids[m]);
            if (!(sigma_maj >= 0 && paths <= most_mean_free_paths))
                args.range("sigma_maj",
                           "at most " + number_text(most_mean_free_paths) +
                               " mean free paths across the box of the densities",
                           number_text(paths), "lower the densities or sigma_t");
            medium.density = own.in<R>("density", *density, axes_of(grids[m].shape));
            medium.sigma_maj = R(sigma_maj);
        }
        out.push_back(medium);
    }
    return out;
}

/// Refuses media that do not scatter by the same kinds of phase functions as others.
template <class R>
void check_phases(const ArrayArgs& args, const char* name, std::span<const Medium<R>> media,
                  std::span<const Medium<R>> others) {
    const auto kind = [](const Medium<R>& m) { return m.phase ? m.phase->model.index() + 1 : 0; };
    for (std::size_t i = 0; i < others.size(); ++i)
        if (kind(media[i]) != kind(others[i]))
            args.range(name, "the same phase functions as media", "others");
}

}  // namespace photograd
