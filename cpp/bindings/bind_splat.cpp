// Gaussian splatting; photograd.splats.splatting is the typed face.
#include "module.h"
#include "photograd/render/splat/splat.h"
#include "splat_args.h"

namespace photograd {
namespace {

py::object prepare(const GaussianArrays& gaussians, const SplatImage& image,
                   const SplatOptions& options, const py::array& camera_from_world,
                   const py::array& background) {
    return dispatch_real(
        "splat", "means", gaussians[0], [&](auto real, ArrayArgs& args) -> py::object {
            using R = decltype(real);
            const auto cloud = cloud_of<R>(args, gaussians);
            const R* view =
                args.within<R>("camera_from_world", camera_from_world, "3 4", world_limit);
            const R* behind = args.in<R>("background", background, "3");
            SplatFrame<R> frame;
            {
                const py::gil_scoped_release release;
                frame = prepare_splats(cloud, image, options, view, behind);
            }
            return py::cast(std::move(frame));
        });
}

template <class R>
py::tuple render(const SplatFrame<R>& frame) {
    const SplatImage& size = frame.view.image;
    return filled_image<R, RenderedImage<R>>(
        {size.height, size.width}, [&](const RenderedImage<R>& out) { blend_splats(frame, out); });
}

template <class R>
void backward(const SplatFrame<R>& frame, const GaussianArrays& gaussians, Arrays<3> image,
              const Arrays<3>& d_image, GaussianArrays d_gaussians, py::array d_view,
              py::array d_background, py::array d_screen) {
    ArrayArgs args("splat_backward");
    const auto cloud =
        same_cloud<R>(args, gaussians, static_cast<std::int64_t>(frame.splats.size()));
    const SplatImage& size = frame.view.image;
    const std::string axes = std::to_string(size.height) + " " + std::to_string(size.width);
    const auto out = image_from<R, RenderedImage<R>>(args, image, "opacity", axes);
    const auto d_out = cotangents_from<R, ImageCotangents<R>>(args, d_image, "d_opacity", axes);
    GaussianGradients<R> gradients = gradients_of<R>(args, d_gaussians);
    gradients.view = args.out<R>("d_camera_from_world", d_view, "3 4");
    gradients.screen = args.out<R>("d_screen", d_screen, "N 2");
    R* d_behind = args.out<R>("d_background", d_background, "3");
    const py::gil_scoped_release release;
    splats_backward(cloud, frame, out, d_out, gradients, d_behind);
}

/// The box of pixels of each Gaussian, (N, 4) int32: x0, x1, y0, y1; empty if it is culled.
template <class R>
py::array_t<std::int32_t> boxes(const SplatFrame<R>& frame) {
    const auto& splats = frame.splats;
    py::array_t<std::int32_t> out({static_cast<py::ssize_t>(splats.size()), py::ssize_t{4}});
    std::int32_t* to = out.mutable_data();
    for (const ScreenSplat<R>& s : splats) {
        *to++ = s.x0;
        *to++ = s.x1;
        *to++ = s.y0;
        *to++ = s.y1;
    }
    return out;
}

template <class R>
void bind_prepared(py::module_& m, const char* name) {
    using P = SplatFrame<R>;
    py::class_<P>(m, name, "Splats of one view, sorted and in tiles.")
        .def("render", &render<R>, "Color (H, W, 3), opacity (H, W), depth (H, W).")
        .def("backward", &backward<R>, py::arg("gaussians"), py::arg("image"), py::arg("d_image"),
             py::arg("d_gaussians"), py::arg("d_camera_from_world"), py::arg("d_background"),
             py::arg("d_screen"),
             "Adds to d_gaussians and what follows; image is what render returned.")
        .def_property_readonly(
            "pairs", [](const P& p) { return static_cast<std::int64_t>(p.lists.pairs.size()); },
            "Number of pairs of splat and tile.")
        .def_property_readonly("boxes", &boxes<R>,
                               "Pixels [x0, x1) x [y0, y1) of each Gaussian, (N, 4) int32.");
}

}  // namespace

void bind_splat(py::module_& m) {
    py::class_<SplatImage>(m, "SplatImage", "Size and focal lengths of a picture, in pixels.")
        .def(py::init([](int width, int height, double fx, double fy, double cx, double cy) {
                 if (width < 1 || height < 1 || std::int64_t{width} * height > (1 << 28))
                     fail(ErrorKind::range, "splat", "width, height", "1 to 2^28 pixels",
                          std::to_string(width) + " x " + std::to_string(height));
                 for (const double f : {fx, fy})
                     if (!(f > 0 && f <= world_limit))
                         fail(ErrorKind::range, "splat", "fx, fy", "focal lengths above 0 pixels",
                              number_text(f));
                 for (const double c : {cx, cy})
                     if (!(std::abs(c) <= world_limit))
                         fail(ErrorKind::range, "splat", "cx, cy", "finite positions in pixels",
                              number_text(c));
                 return SplatImage{width, height, fx, fy, cx, cy};
             }),
             py::arg("width"), py::arg("height"), py::arg("fx"), py::arg("fy"), py::arg("cx"),
             py::arg("cy"));
    py::class_<SplatOptions>(m, "SplatOptions", "Policies of splatting.")
        .def(py::init([](double low_pass, bool antialiased, double alpha_min, double alpha_max,
                         bool pass_clamped, double extent_sigmas, double stop, double near,
                         double frustum_margin) {
                 const std::tuple<const char*, double, double> numbers[] = {
                     {"low_pass", low_pass, 1e12},
                     {"alpha_min", alpha_min, 1},
                     {"alpha_max", alpha_max, 1},
                     {"extent_sigmas", extent_sigmas, 1e6},
                     {"stop", stop, 1},
                     {"near", near, world_limit},
                     {"frustum_margin", frustum_margin, 1e12}};
                 for (const auto& [name, x, max] : numbers)
                     if (!(x >= 0 && x <= max))
                         fail(ErrorKind::range, "SplatOptions", name, "0 to " + number_text(max),
                              number_text(x));
                 return SplatOptions{low_pass,  antialiased,  alpha_min,
                                     alpha_max, pass_clamped, extent_sigmas,
                                     stop,      near,         frustum_margin};
             }),
             py::arg("low_pass"), py::arg("antialiased"), py::arg("alpha_min"),
             py::arg("alpha_max"), py::arg("pass_clamped"), py::arg("extent_sigmas"),
             py::arg("stop"), py::arg("near"), py::arg("frustum_margin"));
    bind_prepared<float>(m, "PreparedSplats32");
    bind_prepared<double>(m, "PreparedSplats64");
    m.def(
        "prepare_splats", &prepare, py::arg("gaussians"), py::arg("image"), py::arg("options"),
        py::arg("camera_from_world"), py::arg("background"),
        "Projects, sorts and bins; PreparedSplats32 or PreparedSplats64. gaussians: means (N, 3), "
        "log_scales (N, 3), quats (N, 4), opacity_logits (N,), sh (N, K, 3).");
    bind_splat_rays(m);
}

}  // namespace photograd
