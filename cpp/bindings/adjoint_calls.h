// Derivatives of path traced pictures: for what a loss says of one (render/path.h), and for a loss of squares by two
// with paths of their own (render/path_pairs.h).
#pragma once

#include "camera_args.h"
#include "derivative_arrays.h"
#include "photograd/render/path_pairs.h"
#include "scene_calls.h"

namespace photograd {

using OptionalArrays = std::vector<std::optional<py::array>>;

/// What these functions take alike, checked.
template <class R>
struct Adjoint {
    SceneNumbers<R> numbers;
    DerivativeArrays<R> out;
    ThinLens camera;
    PathOptions options;
    const std::uint32_t* counts;

    Adjoint(ArrayArgs& args, const SceneRows& rows, const py::tuple& camera_numbers,
            const Options& given, std::uint32_t spp, const std::optional<py::array>& own_counts,
            const DerivativeRows& d)
        : numbers(args, rows),
          out(args, rows, numbers, d),
          camera(thin_lens(camera_numbers)),
          options(options_of(args, given)),
          counts(sample_counts(args, spp, own_counts, camera)) {}
};

inline void trace_backward(const SceneRows& rows, const py::tuple& camera, const Options& given,
                           std::uint32_t spp, const std::optional<py::array>& counts,
                           const py::array& d_image, py::array d_parameters, py::array d_emission,
                           Arrays d_lights, Arrays d_textures, Arrays d_media,
                           OptionalArrays d_densities) {
    dispatch_real("trace_paths_backward", "parameters", rows.parameters, [&](auto real) {
        using R = decltype(real);
        ArrayArgs args("trace_paths_backward");
        const Adjoint<R> of(args, rows, camera, given, spp, counts,
                            {d_parameters, d_emission, d_lights, d_textures, d_media, d_densities});
        const double* d = args.in<double>("d_image", d_image, picture_axes(of.camera) + " 3");
        const py::gil_scoped_release release;
        trace_paths_backward(of.numbers.scene, of.camera, of.options, spp, of.counts, d,
                             of.out.spans());
    });
}

inline void trace_pairs(const SceneRows& rows, const py::tuple& camera, const Options& given,
                        std::uint64_t other_seed, std::uint32_t spp,
                        const std::optional<py::array>& counts, const py::array& target,
                        const py::array& weight, py::array pictures, py::array d_parameters,
                        py::array d_emission, Arrays d_lights, Arrays d_textures, Arrays d_media,
                        OptionalArrays d_densities) {
    dispatch_real("trace_pairs_backward", "parameters", rows.parameters, [&](auto real) {
        using R = decltype(real);
        ArrayArgs args("trace_pairs_backward");
        const Adjoint<R> of(args, rows, camera, given, spp, counts,
                            {d_parameters, d_emission, d_lights, d_textures, d_media, d_densities});
        const std::string axes = picture_axes(of.camera) + " 3";
        const SquaredError loss{args.in<double>("target", target, axes),
                                args.in<double>("weight", weight, axes)};
        double* both = args.out<double>("pictures", pictures, "2 " + axes);
        const py::gil_scoped_release release;
        trace_pairs_backward(of.numbers.scene, of.camera, of.options, {of.options.seed, other_seed},
                             spp, of.counts, loss, of.out.spans(), both);
    });
}

template <class Define>
void with_derivative_names(Define&& define) {
    define(py::arg("d_parameters"), py::arg("d_emission"), py::arg("d_lights"),
           py::arg("d_textures"), py::arg("d_media"), py::arg("d_densities"));
}

inline void bind_adjoints(py::module_& m) {
    with_scene_names([&](auto... scene) {
        with_derivative_names([&](auto... d) {
            m.def("trace_paths_backward", of_scene(&trace_backward), scene..., py::arg("camera"),
                  py::arg("options"), py::arg("spp"), py::arg("counts"), py::arg("d_image"), d...,
                  "Adds to d_parameters (P,), d_emission (S, 3), d_lights, an array like the first "
                  "of each light, d_textures, d_media (rows) and d_densities (grids or None) for "
                  "dL/d(mean radiance). counts (H, W) uint32, or None: spp samples of each pixel.");
            m.def("trace_pairs_backward", of_scene(&trace_pairs), scene..., py::arg("camera"),
                  py::arg("options"), py::arg("other_seed"), py::arg("spp"), py::arg("counts"),
                  py::arg("target"), py::arg("weight"), py::arg("pictures"), d...,
                  "As trace_paths_backward, for the loss sum weight (mean radiance - target)^2, "
                  "both (H, W, 3) float64, by two\npictures with paths of their own, of the seed "
                  "in options and of other_seed, written to pictures\n(2, H, W, 3) float64.");
        });
    });
}

}  // namespace photograd
