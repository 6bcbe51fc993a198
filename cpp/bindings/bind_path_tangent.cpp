// Derivative pictures (render/path_tangent.h).
#include "bind_particles.h"
#include "camera_args.h"
#include "path_args.h"
#include "photograd/render/path_tangent.h"

namespace photograd {
namespace {

void trace(const PathGeometry& geometry, const std::vector<std::string>& models,
           const py::array& parameters, const py::array& emission, const LightTuples& lights,
           const std::vector<py::array>& textures, const std::vector<MediumTuple>& media,
           const py::array& v_parameters, const py::array& v_emission, const LightTuples& v_lights,
           const std::vector<py::array>& v_textures, const std::vector<MediumTuple>& v_media,
           const py::tuple& camera_numbers, const Options& given, std::uint32_t first,
           std::uint32_t count, py::array radiance, py::array squares, py::array d_radiance,
           py::array d_squares) {
    ArrayArgs args("trace_paths_tangent");
    const SceneNumbers<double> at(args, geometry, models, parameters, std::nullopt, emission,
                                  lights, textures, std::nullopt, media);
    const SceneNumbers<double> along(args, geometry, models, v_parameters, std::nullopt, v_emission,
                                     v_lights, v_textures, std::nullopt, v_media);
    for (std::size_t i = 0; i < at.lights.size(); ++i)
        if (at.lights[i].model.index() != along.lights[i].model.index())
            args.range("v_lights", "the same kinds as lights", "others");
    for (std::size_t m = 0; m < at.media.size(); ++m)
        if (at.media[m].phase.has_value() != along.media[m].phase.has_value() ||
            (at.media[m].phase &&
             at.media[m].phase->model.index() != along.media[m].phase->model.index()))
            args.range("v_media", "the same phase functions as media", "others");
    const ThinLens camera = thin_lens(camera_numbers);
    const PathSums picture = path_sums(args, camera, radiance, squares);
    const PathSums tangent = path_sums(args, camera, d_radiance, d_squares, "d_");
    const PathOptions options = options_of(args, given);
    const py::gil_scoped_release release;
    trace_paths_tangent(at.scene, along.scene, camera, options, {first, count}, picture, tangent);
}

}  // namespace

void bind_path_tangent(py::module_& m) {
    m.def("trace_paths_tangent", &trace, py::arg("geometry"), py::arg("models"),
          py::arg("parameters"), py::arg("emission"), py::arg("lights"), py::arg("textures"),
          py::arg("media"), py::arg("v_parameters"), py::arg("v_emission"), py::arg("v_lights"),
          py::arg("v_textures"), py::arg("v_media"), py::arg("camera"), py::arg("options"),
          py::arg("first"), py::arg("count"), py::arg("radiance"), py::arg("squares"),
          py::arg("d_radiance"), py::arg("d_squares"),
          "As trace_paths, and adds to d_radiance (H, W, 3) and d_squares how the samples change "
          "along v,\nwhich has the shapes of what it moves. float64.");
}

}  // namespace photograd
