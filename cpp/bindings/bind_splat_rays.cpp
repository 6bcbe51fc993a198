// Gaussians along rays; photograd.splat_rays is the typed face.
#include <algorithm>

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

py::object prepare(const py::array& means, const py::array& log_scales, const py::array& quats,
                   const py::array& opacity_logits, const py::array& sh, const RayOptions& options,
                   const py::array& origins, const py::array& directions,
                   const py::array& background) {
    return dispatch_real("splat_rays", "means", means, [&](auto real) -> py::object {
        using R = decltype(real);
        ArrayArgs args("splat_rays");
        const auto cloud = cloud_of<R>(args, means, log_scales, quats, opacity_logits, sh);
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
GaussianCloud<R> same_cloud(ArrayArgs& args, const PreparedRays<R>& prepared,
                            const py::array& means, const py::array& log_scales,
                            const py::array& quats, const py::array& opacity_logits,
                            const py::array& sh) {
    const auto cloud = cloud_of<R>(args, means, log_scales, quats, opacity_logits, sh);
    if (cloud.count != prepared.gaussians)
        args.range("means", std::to_string(prepared.gaussians) + " rows, as were prepared",
                   std::to_string(cloud.count));
    return cloud;
}

template <class R>
py::tuple render(PreparedRays<R>& prepared, const py::array& means, const py::array& log_scales,
                 const py::array& quats, const py::array& opacity_logits, const py::array& sh) {
    ArrayArgs args("splat_rays");
    const auto cloud = same_cloud(args, prepared, means, log_scales, quats, opacity_logits, sh);
    const auto rays = static_cast<py::ssize_t>(prepared.frame.rays());
    py::array_t<R> color({rays, py::ssize_t{3}}), opacity(rays), depth(rays);
    const RayPicture<R> out{color.mutable_data(), opacity.mutable_data(), depth.mutable_data()};
    {
        const py::gil_scoped_release release;
        blend_rays(cloud, prepared.frame, out);
    }
    prepared.rendered = true;
    return py::make_tuple(color, opacity, depth);
}

template <class R>
void backward(const PreparedRays<R>& prepared, const py::array& means, const py::array& log_scales,
              const py::array& quats, const py::array& opacity_logits, const py::array& sh,
              py::array color, py::array opacity, py::array depth, const py::array& d_color,
              const py::array& d_opacity, const py::array& d_depth, py::array d_means,
              py::array d_log_scales, py::array d_quats, py::array d_opacity_logits, py::array d_sh,
              py::array d_background, py::object d_origins, py::object d_directions) {
    ArrayArgs args("splat_rays_backward");
    const auto cloud = same_cloud(args, prepared, means, log_scales, quats, opacity_logits, sh);
    if (!prepared.rendered)
        args.range("self", "rays that were rendered", "prepared ones", "call render first");
    const std::string rays = std::to_string(prepared.frame.rays());
    const RayPicture<R> picture{args.out<R>("color", color, rays + " 3"),
                                args.out<R>("opacity", opacity, rays),
                                args.out<R>("depth", depth, rays)};
    const RayPictureAdjoint<R> adjoint{args.in<R>("d_color", d_color, rays + " 3"),
                                       args.in<R>("d_opacity", d_opacity, rays),
                                       args.in<R>("d_depth", d_depth, rays)};
    RayGradients<R> out{
        {args.out<R>("d_means", d_means, "N 3"), args.out<R>("d_log_scales", d_log_scales, "N 3"),
         args.out<R>("d_quats", d_quats, "N 4"),
         args.out<R>("d_opacity_logits", d_opacity_logits, "N"), args.out<R>("d_sh", d_sh, "N K 3"),
         nullptr, nullptr},
        args.out<R>("d_background", d_background, "3"),
        nullptr,
        nullptr};
    if (!d_origins.is_none() && !d_directions.is_none()) {
        auto from = d_origins.cast<py::array>(), to = d_directions.cast<py::array>();
        out.origins = args.out<R>("d_origins", from, rays + " 3");
        out.directions = args.out<R>("d_directions", to, rays + " 3");
    }
    const py::gil_scoped_release release;
    blend_rays_backward(cloud, prepared.frame, picture, adjoint, out);
}

template <class R>
void bind_prepared(py::module_& m, const char* name) {
    using P = PreparedRays<R>;
    py::class_<P>(m, name, "Rays, and Gaussians in a tree of boxes.")
        .def("render", &render<R>, py::arg("means"), py::arg("log_scales"), py::arg("quats"),
             py::arg("opacity_logits"), py::arg("sh"),
             "Colour (R, 3), opacity (R,), depth (R,); the Gaussians are those prepared.")
        .def("backward", &backward<R>, py::arg("means"), py::arg("log_scales"), py::arg("quats"),
             py::arg("opacity_logits"), py::arg("sh"), py::arg("color"), py::arg("opacity"),
             py::arg("depth"), py::arg("d_color"), py::arg("d_opacity"), py::arg("d_depth"),
             py::arg("d_means"), py::arg("d_log_scales"), py::arg("d_quats"),
             py::arg("d_opacity_logits"), py::arg("d_sh"), py::arg("d_background"),
             py::arg("d_origins"), py::arg("d_directions"),
             "Adds to the arrays named d_*; those of the rays may both be None.")
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
    m.def("prepare_splat_rays", &prepare, py::arg("means"), py::arg("log_scales"), py::arg("quats"),
          py::arg("opacity_logits"), py::arg("sh"), py::arg("options"), py::arg("origins"),
          py::arg("directions"), py::arg("background"),
          "Whitens and boxes the Gaussians; PreparedRays32 or PreparedRays64.");
}

}  // namespace photograd
