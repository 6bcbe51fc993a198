// Gaussians along rays; photograd.splats.rays is the typed face.
#include <optional>

#include "photograd/render/splat/splat_rays.h"
#include "splat_args.h"

namespace photograd {
namespace {

/// Rays and Gaussians made ready, in the number type of their arrays.
template <class R>
struct PreparedRays {
    RayFrame<R> frame;
    std::int64_t gaussians;
    bool rendered = false;  // the backward pass has room for the crossings that were counted then
};

py::object prepare(const GaussianArrays& gaussians, const RayOptions& options,
                   const py::array& origins, const py::array& directions,
                   const py::array& background) {
    return dispatch_real(
        "splat_rays", "means", gaussians[0], [&](auto real, ArrayArgs& args) -> py::object {
            using R = decltype(real);
            const auto cloud = cloud_of<R>(args, gaussians);
            const R* from = args.within<R>("origins", origins, "R 3", world_limit);
            const R* to = args.within<R>("directions", directions, "R 3", world_limit);
            const R* behind = args.in<R>("background", background, "3");
            const std::int64_t rays = args.size("R");
            if (rays >= std::int64_t{1} << 31)
                args.range("origins", "fewer than 2^31 rays", std::to_string(rays));
            PreparedRays<R> out{{}, cloud.count};
            {
                const py::gil_scoped_release release;
                out.frame.cloud = prepare_ray_cloud(cloud, options);
                std::copy_n(behind, 3, out.frame.background);
                out.frame.origins.assign(from, from + 3 * rays);
                out.frame.directions.assign(to, to + 3 * rays);
                out.frame.crossings.resize(static_cast<std::size_t>(rays));
            }
            return py::cast(std::move(out));
        });
}

template <class R>
py::tuple render(PreparedRays<R>& prepared, const GaussianArrays& gaussians) {
    ArrayArgs args("splat_rays");
    const auto cloud = same_cloud<R>(args, gaussians, prepared.gaussians);
    py::tuple image = filled_image<R, RenderedImage<R>>(
        {static_cast<py::ssize_t>(prepared.frame.rays())},
        [&](const RenderedImage<R>& out) { blend_rays(cloud, prepared.frame, out); });
    prepared.rendered = true;
    return image;
}

template <class R>
void backward(const PreparedRays<R>& prepared, const GaussianArrays& gaussians, Arrays<3> image,
              const Arrays<3>& d_image, GaussianArrays d_gaussians, py::array d_background,
              std::optional<Arrays<2>> d_rays) {
    ArrayArgs args("splat_rays_backward");
    const auto cloud = same_cloud<R>(args, gaussians, prepared.gaussians);
    if (!prepared.rendered)
        args.range("self", "rays that were rendered", "prepared ones", "call render first");
    const std::string axes = std::to_string(prepared.frame.rays());
    const auto out = image_from<R, RenderedImage<R>>(args, image, "opacity", axes);
    const auto d_out = cotangents_from<R, ImageCotangents<R>>(args, d_image, "d_opacity", axes);
    RayGradients<R> gradients{gradients_of<R>(args, d_gaussians),
                              args.out<R>("d_background", d_background, "3"), nullptr, nullptr};
    if (d_rays) {
        gradients.origins = args.out<R>("d_origins", (*d_rays)[0], axes + " 3");
        gradients.directions = args.out<R>("d_directions", (*d_rays)[1], axes + " 3");
    }
    const py::gil_scoped_release release;
    blend_rays_backward(cloud, prepared.frame, out, d_out, gradients);
}

template <class R>
void bind_prepared(py::module_& m, const char* name) {
    using P = PreparedRays<R>;
    py::class_<P>(m, name, "Rays, and Gaussians in a tree of boxes.")
        .def("render", &render<R>, py::arg("gaussians"),
             "Color (R, 3), opacity (R,), depth (R,); the Gaussians are those prepared.")
        .def("backward", &backward<R>, py::arg("gaussians"), py::arg("image"), py::arg("d_image"),
             py::arg("d_gaussians"), py::arg("d_background"), py::arg("d_rays") = py::none(),
             "Adds to d_gaussians, d_background and, where given, d_rays: d_origins, d_directions.")
        .def_property_readonly(
            "crossings",
            [](const P& p) {
                const auto& counts = p.frame.crossings;
                return py::array_t<std::uint32_t>(static_cast<py::ssize_t>(counts.size()),
                                                  counts.data());
            },
            "How many Gaussians each ray blended, (R,) uint32, a copy.");
}

}  // namespace

void bind_splat_rays(py::module_& m) {
    py::class_<RayOptions>(m, "RayOptions", "Policies of casting rays at Gaussians.")
        .def(py::init([](double alpha_min, double alpha_max, double stop, double t_min) {
                 const std::pair<const char*, double> numbers[] = {
                     {"alpha_min", alpha_min}, {"alpha_max", alpha_max}, {"stop", stop}};
                 for (const auto& [name, x] : numbers)
                     if (!(x >= 0 && x <= 1))
                         fail(ErrorKind::range, "RayOptions", name, "0 to 1", number_text(x));
                 if (!std::isfinite(t_min))
                     fail(ErrorKind::range, "RayOptions", "t_min", "a finite distance",
                          number_text(t_min));
                 return RayOptions{alpha_min, alpha_max, stop, t_min};
             }),
             py::arg("alpha_min"), py::arg("alpha_max"), py::arg("stop"), py::arg("t_min"));
    bind_prepared<float>(m, "PreparedRays32");
    bind_prepared<double>(m, "PreparedRays64");
    m.def("prepare_splat_rays", &prepare, py::arg("gaussians"), py::arg("options"),
          py::arg("origins"), py::arg("directions"), py::arg("background"),
          "Whitens and boxes the Gaussians; PreparedRays32 or PreparedRays64.");
}

}  // namespace photograd
