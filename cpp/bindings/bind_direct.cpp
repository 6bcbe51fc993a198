// Direct light: the renderer and its adjoint on arrays.
#include <pybind11/stl.h>

#include <cmath>

#include "camera_args.h"
#include "module.h"
#include "photograd/render/direct.h"

namespace photograd {
namespace {

/// (kind, first entry, width, height) of each mesh, as Python hands them over.
using Layouts = std::vector<std::tuple<int, std::int64_t, int, int>>;

std::vector<AlbedoLayout> layouts_of(const ArrayArgs& args, const Bvh& bvh, const Layouts& given,
                                     std::int64_t entries) {
    if (given.size() != bvh.meshes().size())
        args.range("layouts", std::to_string(bvh.meshes().size()) + ", one a mesh",
                   std::to_string(given.size()));
    std::vector<AlbedoLayout> layouts;
    for (std::size_t i = 0; i < given.size(); ++i) {
        const auto [kind, first, width, height] = given[i];
        layouts.push_back({static_cast<AlbedoKind>(kind), first, width, height});
        const std::int64_t count = layouts[i].count(bvh.meshes()[i]);
        if (kind < 0 || kind > 2 || first < 0 || width < 1 || height < 1 || count < 1 ||
            count > entries || first > entries - count)
            args.range("layouts", "places within the " + std::to_string(entries) + " colours",
                       "entry " + std::to_string(first) + " of mesh " + std::to_string(i));
    }
    return layouts;
}

/// Rows of the colors, and a look at the number of samples.
template <class R>
std::int64_t entries_of(ArrayArgs& args, const py::array& albedo, int spp) {
    args.in<R>("albedo", albedo, "A 3");
    if (spp < 1) args.range("spp", "at least 1 sample", std::to_string(spp));
    return args.size("A");
}

template <class R>
Vec3<R> row(const R* lights, int i) {
    return {lights[3 * i], lights[3 * i + 1], lights[3 * i + 2]};
}

/// lights (4, 3): radiance of the sun, zenith, horizon, ground.
template <class R>
DirectScene<R> direct_scene(ArrayArgs& args, const Bvh& bvh, std::span<const AlbedoLayout> layouts,
                            const py::array& albedo, const py::array& lights,
                            const std::array<double, 3>& sun_direction, double sun_radius) {
    const R* values = args.in<R>("albedo", albedo, "A 3");
    const R* light = args.in<R>("lights", lights, "4 3");
    for (const double x : sun_direction)
        if (!(std::abs(x) <= world_limit))
            args.range("sun_direction", "finite numbers", number_text(x));
    if (!(sun_radius >= 0 && sun_radius <= pi))
        args.range("sun_radius", "an angle from 0 to pi", number_text(sun_radius));
    const double half = std::sin(0.5 * sun_radius);
    Sun<R> sun{row(light, 0),
               {R(sun_direction[0]), R(sun_direction[1]), R(sun_direction[2])},
               R(2 * half * half)};
    return {&bvh,           layouts, values,
            args.size("A"), sun,     {row(light, 1), row(light, 2), row(light, 3)}};
}

py::tuple direct(const Bvh& bvh, const Layouts& given, const py::array& albedo,
                 const py::array& lights, const std::array<double, 3>& sun_direction,
                 double sun_radius, const py::tuple& camera_numbers, int spp, std::uint64_t seed) {
    return dispatch_real("render_direct", "albedo", albedo, [&](auto real) -> py::tuple {
        using R = decltype(real);
        ArrayArgs args("render_direct");
        const Pinhole camera = pinhole(camera_numbers);
        const auto layouts = layouts_of(args, bvh, given, entries_of<R>(args, albedo, spp));
        const DirectScene<R> scene =
            direct_scene<R>(args, bvh, layouts, albedo, lights, sun_direction, sun_radius);
        py::array_t<R> radiance({camera.height, camera.width, 3}),
            alpha({camera.height, camera.width}), depth({camera.height, camera.width});
        const DirectImage<R> image{radiance.mutable_data(), alpha.mutable_data(),
                                   depth.mutable_data()};
        {
            const py::gil_scoped_release release;
            render_direct(scene, camera, {spp, seed}, image);
        }
        return py::make_tuple(radiance, alpha, depth);
    });
}

void direct_backward(const Bvh& bvh, const Layouts& given, const py::array& albedo,
                     const py::array& lights, const std::array<double, 3>& sun_direction,
                     double sun_radius, const py::tuple& camera_numbers, int spp,
                     std::uint64_t seed, const py::array& d_radiance, py::array d_albedo,
                     py::array d_lights) {
    dispatch_real("render_direct_backward", "albedo", albedo, [&](auto real) {
        using R = decltype(real);
        ArrayArgs args("render_direct_backward");
        const Pinhole camera = pinhole(camera_numbers);
        const auto layouts = layouts_of(args, bvh, given, entries_of<R>(args, albedo, spp));
        const DirectScene<R> scene =
            direct_scene<R>(args, bvh, layouts, albedo, lights, sun_direction, sun_radius);
        const R* d = args.in<R>("d_radiance", d_radiance, "H W 3");
        if (args.size("H") != camera.height || args.size("W") != camera.width)
            args.range("d_radiance", "the size of the camera's image", "another");
        R* d_values = args.out<R>("d_albedo", d_albedo, "A 3");
        R* d_light = args.out<R>("d_lights", d_lights, "4 3");
        Sun<R> d_sun{Vec3<R>(R(0))};
        Sky<R> d_sky{Vec3<R>(R(0)), Vec3<R>(R(0)), Vec3<R>(R(0))};
        {
            const py::gil_scoped_release release;
            render_direct_backward(scene, camera, {spp, seed}, d, d_values, d_sun, d_sky);
        }
        const Vec3<R> parts[4] = {d_sun.radiance, d_sky.zenith, d_sky.horizon, d_sky.ground};
        for (int i = 0; i < 4; ++i)
            for (int c = 0; c < 3; ++c) d_light[3 * i + c] += parts[i][c];
    });
}

}  // namespace

void bind_direct(py::module_& m) {
    m.def("render_direct", &direct, py::arg("bvh"), py::arg("layouts"), py::arg("albedo"),
          py::arg("lights"), py::arg("sun_direction"), py::arg("sun_radius"), py::arg("camera"),
          py::arg("spp"), py::arg("seed"),
          "Radiance (H, W, 3) premultiplied, alpha (H, W), depth (H, W).");
    m.def("render_direct_backward", &direct_backward, py::arg("bvh"), py::arg("layouts"),
          py::arg("albedo"), py::arg("lights"), py::arg("sun_direction"), py::arg("sun_radius"),
          py::arg("camera"), py::arg("spp"), py::arg("seed"), py::arg("d_radiance"),
          py::arg("d_albedo"), py::arg("d_lights"), "Adds to d_albedo (A, 3) and d_lights (4, 3).");
}

}  // namespace photograd
