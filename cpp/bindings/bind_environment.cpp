// Environment maps: texels are arrays of the caller; the table by which directions are sampled is
// kept between calls.
#include "environment_args.h"
#include "light_calls.h"
#include "photograd/light/environment_gradient.h"

namespace photograd {
namespace {

std::unique_ptr<EnvironmentSampler> make_sampler(const py::array& texels, double uniform_share) {
    return dispatch_real("EnvironmentSampler", "texels", texels, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const R* data = args.in<R>("texels", texels, "H W 3");
        const int height = height_of<R>(args, "texels", texels);
        const std::span<const R> all(data, static_cast<std::size_t>(texels.size()));
        const py::gil_scoped_release release;
        return std::make_unique<EnvironmentSampler>(all, height, uniform_share);
    });
}

/// rows(real, args, environment, points, w or u2) as a method.
template <class Rows>
auto environment_rows(const char* name, Rows rows) {
    return [=](const EnvironmentSampler& sampler, const py::array& texels,
               const py::array& world_from_map, const py::array& points, const py::array& w) {
        return dispatch_real(name, "texels", texels, [&](auto real, ArrayArgs& args) {
            const auto light =
                environment_in<decltype(real)>(args, sampler, texels, world_from_map);
            return rows(real, args, light, points, w);
        });
    };
}

/// w is enough: an environment is the same from all points.
py::array backward(const EnvironmentSampler& sampler, const py::array& texels,
                   const py::array& world_from_map, const py::array& points, const py::array& w,
                   const py::array& d_radiance, py::array d_texels) {
    return dispatch_real("radiance_backward", "texels", texels, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const Environment<R> light = environment_in<R>(args, sampler, texels, world_from_map);
        args.in<R>("points", points, "N 3");
        const R* in = args.in<R>("w", w, "N 3");
        const R* d = args.in<R>("d_radiance", d_radiance, "N 3");
        R* out = args.out<R>("d_texels", d_texels, "H W 3");
        {
            const py::gil_scoped_release release;
            environment_backward(light, in, d, args.size("N"), out);
        }
        return d_texels;
    });
}

}  // namespace

void bind_environment(py::module_& m) {
    const auto t = py::arg("texels");
    const auto r = py::arg("world_from_map");
    py::class_<EnvironmentSampler>(m, "EnvironmentSampler",
                                   "Samples directions towards the bright parts of a map.")
        .def(py::init(&make_sampler), t, py::arg("uniform_share"),
             "Texels (H, 2 H, 3); uniform_share of the samples go everywhere alike.")
        .def("sample", environment_rows("sample", call_sample_rows), t, r, py::arg("points"),
             py::arg("u2"), "(direction (N, 3), distance (N,), radiance (N, 3), pdf (N,)).")
        .def("radiance", environment_rows("radiance", call_radiance_rows), t, r, py::arg("points"),
             py::arg("w"), "What arrives from w, (N, 3).")
        .def("pdf", environment_rows("pdf", call_pdf_rows), t, r, py::arg("points"), py::arg("w"),
             "Density of `sample` over solid angle, (N,).")
        .def("radiance_backward", &backward, t, r, py::arg("points"), py::arg("w"),
             py::arg("d_radiance"), py::arg("d_texels"),
             "Adds dL/dtexels to d_texels (H, 2 H, 3) and returns it.")
        .def("sample_backward", &backward, t, r, py::arg("points"), py::arg("w"),
             py::arg("d_radiance"), py::arg("d_texels"),
             "The same for the radiance of samples whose directions are w.");
}

}  // namespace photograd
