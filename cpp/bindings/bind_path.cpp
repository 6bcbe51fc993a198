// Path tracing: pictures, derivatives, single paths.
#include <optional>

#include "adjoint_calls.h"
#include "camera_args.h"
#include "module.h"
#include "path_rows.h"
#include "photograd/render/ambient_occlusion.h"
#include "photograd/render/path/path.h"
#include "photograd/render/reference/trace_reference.h"

namespace photograd {
namespace {

void trace(const SceneRows& rows, const std::optional<py::array>& sampling_parameters,
           const std::optional<Arrays>& sampling_textures,
           const std::optional<MediumTuples>& sampling_media, const py::tuple& camera_numbers,
           const Options& given, std::uint32_t first, std::uint32_t count, py::array radiance,
           py::array squares, std::optional<py::array> hits) {
    dispatch_real("trace_paths", "parameters", rows.parameters, [&](auto real, ArrayArgs& args) {
        const SceneNumbers<decltype(real)> numbers(
            args, rows, {sampling_parameters, sampling_textures, sampling_media});
        check_phases<decltype(real)>(args, "sampling_media", numbers.media, numbers.sampling_media);
        const ThinLens camera = thin_lens(camera_numbers);
        const PathSums sums = path_sums(args, camera, radiance, squares);
        double* counts = hits ? args.out<double>("hits", *hits, picture_axes(camera)) : nullptr;
        const PathOptions options = options_of(args, given);
        check_samples(args, first, count);
        const py::gil_scoped_release release;
        trace_paths(numbers.scene, camera, options, {first, count}, sums, counts);
    });
}

void trace_to_compare(const SceneRows& rows, const py::tuple& camera_numbers, const Options& given,
                      std::uint32_t first, std::uint32_t count, py::array radiance,
                      py::array squares) {
    ArrayArgs args("trace_reference");
    const SceneNumbers<double> numbers(args, rows);
    const ThinLens camera = thin_lens(camera_numbers);
    const PathSums sums = path_sums(args, camera, radiance, squares);
    const PathOptions options = options_of(args, given);
    check_samples(args, first, count);
    const py::gil_scoped_release release;
    trace_reference(numbers.scene, camera, options, {first, count}, sums);
}

void ambient_occlusion(const PathGeometry& geometry, const py::tuple& camera_numbers, double radius,
                       std::uint64_t seed, std::uint32_t first, std::uint32_t count,
                       py::array sums) {
    ArrayArgs args("ambient_occlusion");
    const Pinhole camera = pinhole(camera_numbers);
    double* out = args.out<double>("sums", sums, picture_axes(camera));
    if (!(radius > 0)) args.range("radius", "above 0 m", std::to_string(radius));
    check_samples(args, first, count);
    const py::gil_scoped_release release;
    trace_ambient_occlusion<double>(geometry, camera, radius, seed, {first, count}, out);
}

}  // namespace

void bind_path(py::module_& m) {
    bind_adjoints(m);
    with_scene_names([&](auto... scene) {
        m.def("trace_paths", of_scene(&trace), scene..., py::arg("sampling_parameters"),
              py::arg("sampling_textures"), py::arg("sampling_media"), py::arg("camera"),
              py::arg("options"), py::arg("first"), py::arg("count"), py::arg("radiance"),
              py::arg("squares"), py::arg("hits") = py::none(),
              "Adds samples to radiance (H, W, 3) and squares (H, W, 3), float64. options: "
              "(strategy, heuristic, max_depth, roulette_from, sampler, seed).\nmedia: (phase "
              "function or \"\", parameters (P,), densities (X, Y, Z) or None, sigma_maj). hits: "
              "None, or (H, W) float64,\nto which the number of samples is added that see more "
              "than the background; the others then add nothing.");
        m.def("trace_path", of_scene(&path_rows), scene..., py::arg("camera"), py::arg("options"),
              py::arg("pixel"), py::arg("sample"), "One path, a dictionary a vertex.");
        m.def("trace_reference", of_scene(&trace_to_compare), scene..., py::arg("camera"),
              py::arg("options"), py::arg("first"), py::arg("count"), py::arg("radiance"),
              py::arg("squares"),
              "As trace_paths, by a scalar tracer that is written to be read; float64.");
    });
    m.def("ambient_occlusion", &ambient_occlusion, py::arg("geometry"), py::arg("camera"),
          py::arg("radius"), py::arg("seed"), py::arg("first"), py::arg("count"), py::arg("sums"),
          "Adds the free part of each sample to sums (H, W), float64.");
}

}  // namespace photograd
