// Derivatives of path traced pictures: for a cotangent of one (render/path/path.h), and for a
// squared error by two with independent paths (render/path/dual_buffer.h).
#pragma once

#include "camera_args.h"
#include "gradient_arrays.h"
#include "photograd/render/path/dual_buffer.h"
#include "scene_calls.h"

namespace photograd {

/// The checked arguments that these functions share.
template <class R>
struct AdjointCall {
    SceneNumbers<R> numbers;
    std::vector<GradientBlock<R>> blocks;
    ThinLens camera;
    PathOptions options;
    const std::uint32_t* counts;

    AdjointCall(const std::string& function, ArrayArgs& args, const SceneRows& rows,
                const py::tuple& camera_numbers, const Options& given, std::uint32_t spp,
                const std::optional<py::array>& own_counts, GradientArrays& gradient)
        : numbers(args, rows),
          blocks(gradient_blocks_in<R>(function, numbers.scene, gradient)),
          camera(thin_lens(camera_numbers)),
          options(options_of(args, given)),
          counts(sample_counts(args, spp, own_counts, camera)) {}
};

inline void trace_backward(const SceneRows& rows, const py::tuple& camera, const Options& given,
                           std::uint32_t spp, const std::optional<py::array>& counts,
                           const py::array& d_image, GradientArrays gradient) {
    constexpr const char* name = "trace_paths_backward";
    dispatch_real(name, "parameters", rows.parameters, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const AdjointCall<R> of(name, args, rows, camera, given, spp, counts, gradient);
        const double* d = args.in<double>("d_image", d_image, picture_axes(of.camera) + " 3");
        const py::gil_scoped_release release;
        trace_paths_backward<R>(of.numbers.scene, of.camera, of.options, spp, of.counts, d,
                                of.blocks);
    });
}

inline void trace_dual_buffer(const SceneRows& rows, const py::tuple& camera, const Options& given,
                              std::uint64_t other_seed, std::uint32_t spp,
                              const std::optional<py::array>& counts, const py::array& target,
                              const py::array& weight, py::array pictures,
                              GradientArrays gradient) {
    constexpr const char* name = "dual_buffer_backward";
    dispatch_real(name, "parameters", rows.parameters, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const AdjointCall<R> of(name, args, rows, camera, given, spp, counts, gradient);
        const std::string axes = picture_axes(of.camera) + " 3";
        const SquaredError loss{args.in<double>("target", target, axes),
                                args.in<double>("weight", weight, axes)};
        double* both = args.out<double>("pictures", pictures, "2 " + axes);
        const py::gil_scoped_release release;
        dual_buffer_backward<R>(of.numbers.scene, of.camera, of.options,
                                {of.options.seed, other_seed}, spp, of.counts, loss, of.blocks,
                                both);
    });
}

inline void bind_adjoints(py::module_& m) {
    with_scene_names([&](auto... scene) {
        m.def(
            "trace_paths_backward", of_scene(&trace_backward), scene..., py::arg("camera"),
            py::arg("options"), py::arg("spp"), py::arg("counts"), py::arg("d_image"),
            py::arg("gradient"),
            "Adds derivatives for dL/d(mean radiance) to the arrays of gradient, {name: array}: "
            "parameters (P,),\nemission (S, 3), lights.I and textures.I, arrays like those of the "
            "scene, media.I (rows), densities.I\n(X, Y, Z) of media with a grid. counts (H, W) "
            "uint32, or None: spp samples of each pixel.");
        m.def("dual_buffer_backward", of_scene(&trace_dual_buffer), scene..., py::arg("camera"),
              py::arg("options"), py::arg("other_seed"), py::arg("spp"), py::arg("counts"),
              py::arg("target"), py::arg("weight"), py::arg("pictures"), py::arg("gradient"),
              "As trace_paths_backward, for the loss sum weight (mean radiance - target)^2, both "
              "(H, W, 3) float64,\nby two pictures with independent paths, of the seed in options "
              "and of other_seed, written to\npictures (2, H, W, 3) float64.");
    });
}

}  // namespace photograd
