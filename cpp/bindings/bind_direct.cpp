// Scenes of placed meshes, and their direct light with its adjoint.
#include "model_args.h"
#include "module.h"
#include "photograd/render/direct.h"

namespace photograd {
namespace {

using LayoutRow = std::tuple<int, int, int>;  // kind, width, height

std::shared_ptr<Scene> make_scene(const std::shared_ptr<Bvh>& bvh, const std::vector<LayoutRow>& rows) {
    std::vector<AlbedoLayout> layouts;
    for (const auto& [kind, width, height] : rows)
        layouts.push_back({static_cast<AlbedoKind>(kind), 0, width, height});
    return std::make_shared<Scene>(bvh, std::move(layouts));
}

PinholeView view_of(ArrayArgs& args, std::pair<int, int> size, const py::array& intrinsics,
                    const py::array& world_from_camera) {
    const double* k = args.in<double>("intrinsics", intrinsics, "4");
    const double* m = args.in<double>("world_from_camera", world_from_camera, "3 4");
    PinholeView view{size.first, size.second, k[0], k[1], k[2], k[3], {}};
    std::copy_n(m, 12, view.world_from_camera);
    return view;
}

/// sun (7,): radiance, direction, height; sky (9,): zenith, horizon, ground.
template <class R>
DirectLights<R> lights_of(ArrayArgs& args, const py::array& sun, const py::array& sky) {
    DirectLights<R> lights;
    const R* s = args.in<R>("sun", sun, "7");
    const R* d = args.in<R>("sky", sky, "9");
    for_each_scalar(Sun<R>::params, [&](R& x) { x = *s++; }, lights.sun);
    for_each_scalar(Sun<R>::constants, [&](R& x) { x = *s++; }, lights.sun);
    for_each_scalar(Sky<R>::params, [&](R& x) { x = *d++; }, lights.sky);
    return lights;
}

py::tuple render(const Scene& scene, const py::array& colors, const py::array& sun, const py::array& sky,
                 std::pair<int, int> size, const py::array& intrinsics,
                 const py::array& world_from_camera, std::uint32_t samples, std::uint64_t seed) {
    return dispatch_real("render_direct", "colors", colors, [&](auto real) -> py::tuple {
        using R = decltype(real);
        ArrayArgs args("render_direct");
        const R* table = args.in<R>("colors", colors, std::to_string(scene.colors()) + " 3");
        const DirectLights<R> lights = lights_of<R>(args, sun, sky);
        const PinholeView view = view_of(args, size, intrinsics, world_from_camera);
        py::array_t<R> radiance({view.height, view.width, 3}), alpha({view.height, view.width}),
            depth({view.height, view.width});
        const DirectOutputs<R> out{radiance.mutable_data(), alpha.mutable_data(), depth.mutable_data()};
        {
            const py::gil_scoped_release release;
            render_direct(scene, table, lights, view, {samples, seed}, out);
        }
        return py::make_tuple(radiance, alpha, depth);
    });
}

void render_backward(const Scene& scene, const py::array& colors, const py::array& sun,
                     const py::array& sky, std::pair<int, int> size, const py::array& intrinsics,
                     const py::array& world_from_camera, std::uint32_t samples, std::uint64_t seed,
                     const py::array& d_radiance, py::array d_colors, py::array d_sun, py::array d_sky) {
    dispatch_real("render_direct_backward", "colors", colors, [&](auto real) {
        using R = decltype(real);
        ArrayArgs args("render_direct_backward");
        const std::string rows = std::to_string(scene.colors()) + " 3";
        const R* table = args.in<R>("colors", colors, rows);
        const DirectLights<R> lights = lights_of<R>(args, sun, sky);
        const PinholeView view = view_of(args, size, intrinsics, world_from_camera);
        const R* d = args.in<R>("d_radiance", d_radiance,
                                std::to_string(view.height) + " " + std::to_string(view.width) + " 3");
        R* d_table = args.out<R>("d_colors", d_colors, rows);
        R *d_s = args.out<R>("d_sun", d_sun, "3"), *d_k = args.out<R>("d_sky", d_sky, "9");
        DirectLights<R> d_lights{zero_model<Sun<R>, R>(), zero_model<Sky<R>, R>()};
        {
            const py::gil_scoped_release release;
            render_direct_backward(scene, table, lights, view, {samples, seed}, d, d_table, d_lights);
        }
        for_each_scalar([&](R& x) { *d_s++ += x; }, d_lights.sun);
        for_each_scalar([&](R& x) { *d_k++ += x; }, d_lights.sky);
    });
}

}  // namespace

void bind_direct(py::module_& m) {
    py::class_<Scene, std::shared_ptr<Scene>>(m, "Scene", "Placed meshes that know which colours they mix.")
        .def(py::init(&make_scene), py::arg("bvh"), py::arg("layouts"),
             "One (kind, width, height) a mesh; kind 0 constant, 1 vertices, 2 faces, 3 texture.")
        .def_property_readonly("colors", &Scene::colors, "Rows of the table of colours.");
    m.def("render_direct", &render, py::arg("scene"), py::arg("colors"), py::arg("sun"), py::arg("sky"),
          py::arg("size"), py::arg("intrinsics"), py::arg("world_from_camera"), py::arg("samples"),
          py::arg("seed"), "Radiance (H, W, 3) premultiplied, alpha (H, W), depth (H, W).");
    m.def("render_direct_backward", &render_backward, py::arg("scene"), py::arg("colors"), py::arg("sun"),
          py::arg("sky"), py::arg("size"), py::arg("intrinsics"), py::arg("world_from_camera"),
          py::arg("samples"), py::arg("seed"), py::arg("d_radiance"), py::arg("d_colors"),
          py::arg("d_sun"), py::arg("d_sky"), "Adds to d_colors (A, 3), d_sun (3,) and d_sky (9,).");
}

}  // namespace photograd
