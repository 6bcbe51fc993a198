// Derivative pictures (render/path/tangent.h).
#include "camera_args.h"
#include "module.h"
#include "photograd/render/path/tangent.h"
#include "scene_calls.h"

namespace photograd {
namespace {

void trace_tangent(const SceneRows& rows, const py::array& v_parameters,
                   const py::array& v_emission, const LightTuples& v_lights,
                   const Arrays& v_textures, const MediumTuples& v_media,
                   const py::tuple& camera_numbers, const Options& given, std::uint32_t first,
                   std::uint32_t count, py::array radiance, py::array squares, py::array d_radiance,
                   py::array d_squares) {
    ArrayArgs args("trace_paths_tangent");
    const SceneNumbers<double> at(args, rows);
    const SceneNumbers<double> along(args, {rows.geometry, rows.models, v_parameters, v_emission,
                                            v_lights, v_textures, v_media});
    for (std::size_t i = 0; i < at.lights.size(); ++i)
        if (at.lights[i].model.index() != along.lights[i].model.index())
            args.range("v_lights", "the same kinds as lights", "others");
    check_phases<double>(args, "v_media", at.media, along.media);
    const ThinLens camera = thin_lens(camera_numbers);
    const PathSums picture = path_sums(args, camera, radiance, squares);
    const PathSums tangent = path_sums(args, camera, d_radiance, d_squares, "d_");
    const PathOptions options = options_of(args, given);
    check_samples(args, first, count);
    const py::gil_scoped_release release;
    trace_paths_tangent(at.scene, along.scene, camera, options, {first, count}, picture, tangent);
}

}  // namespace

void bind_path_tangent(py::module_& m) {
    with_scene_names([&](auto... scene) {
        m.def(
            "trace_paths_tangent", of_scene(&trace_tangent), scene..., py::arg("v_parameters"),
            py::arg("v_emission"), py::arg("v_lights"), py::arg("v_textures"), py::arg("v_media"),
            py::arg("camera"), py::arg("options"), py::arg("first"), py::arg("count"),
            py::arg("radiance"), py::arg("squares"), py::arg("d_radiance"), py::arg("d_squares"),
            "As trace_paths, and adds to d_radiance (H, W, 3) and d_squares how the samples change "
            "along v,\nwhich has the shapes of what it moves. float64.");
    });
}

}  // namespace photograd
