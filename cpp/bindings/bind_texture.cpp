// Texture lookups, mip maps and the plan of a texture's recovery. Results are added to, or written
// into, arrays that the Python face (photograd.textures) makes.

#include <memory>
#include <optional>
#include <variant>

#include "array_args.h"
#include "module.h"
#include "photograd/core/parallel.h"
#include "photograd/texture/mip_chain.h"
#include "photograd/texture/mip_sample.h"
#include "photograd/texture/sample.h"
#include "photograd/texture/ssim.h"
#include "photograd/texture/texture_plan.h"

namespace photograd {
namespace {

constexpr std::int64_t largest_side = 1 << 16;
constexpr std::int64_t most_points = std::int64_t{1} << 31;

std::string text_of(TextureShape shape) {
    return std::to_string(shape.height) + " x " + std::to_string(shape.width);
}

void check_side(const ArrayArgs& args, std::int64_t height, std::int64_t width,
                const char* name = "shape") {
    if (height < 1 || width < 1 || height > largest_side || width > largest_side)
        args.range(name, "1 to " + std::to_string(largest_side) + " texels along each axis",
                   std::to_string(height) + " x " + std::to_string(width));
}

/// The shape that the axes H, W and C of `args` have.
TextureShape checked_shape(const ArrayArgs& args, const char* name) {
    const std::int64_t h = args.size("H"), w = args.size("W"), c = args.size("C");
    check_side(args, h, w, name);
    if (c < 1 || c > max_channels)
        args.range(name, "1 to " + std::to_string(max_channels) + " channels", std::to_string(c));
    return {static_cast<int>(h), static_cast<int>(w)};
}

template <class R>
ImageView<const R> texture_in(ArrayArgs& args, const py::array& texture) {
    const R* texels = args.in<R>("texture", texture, "H W C");
    return {texels, checked_shape(args, "texture"), static_cast<int>(args.size("C"))};
}

/// Numbers of points (N, ...), all of them finite: a NaN has no texels.
template <class R>
const R* finite_in(ArrayArgs& args, const char* name, const py::array& array, const char* axes) {
    const R* values = args.finite<R>(name, array, axes);
    if (args.size("N") >= most_points)
        args.range(name, "fewer than 2^31 points", std::to_string(args.size("N")));
    return values;
}

void sample_any(const py::array& texture, const py::array& uv, py::array color) {
    dispatch_real("sample", "texture", texture, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const ImageView<const R> view = texture_in<R>(args, texture);
        const R* points = args.in<R>("uv", uv, "N 2");
        R* out = args.out<R>("out", color, "N C");
        bool finite = false;
        {
            const py::gil_scoped_release release;
            finite = sample(view, points, args.size("N"), out);
        }
        if (!finite) finite_in<R>(args, "uv", uv, "N 2");  // counts them, and throws
    });
}

void sample_any_backward(const py::array& texture, const py::array& uv, const py::array& d_color,
                         std::optional<py::array> d_texture, std::optional<py::array> d_uv) {
    dispatch_real("sample_backward", "texture", texture, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const ImageView<const R> view = texture_in<R>(args, texture);
        const R* points = finite_in<R>(args, "uv", uv, "N 2");
        const R* d_out = args.in<R>("d_color", d_color, "N C");
        R* d_texels = d_texture ? args.out<R>("d_texture", *d_texture, "H W C") : nullptr;
        R* d_points = d_uv ? args.out<R>("d_uv", *d_uv, "N 2") : nullptr;
        const py::gil_scoped_release release;
        sample_backward(view, points, args.size("N"), d_out, d_texels, d_points);
    });
}

/// Checked views of the levels; T is R for levels that are written to.
template <class R, class T>
std::vector<ImageView<T>> mips_in(const char* function, const char* name,
                                  std::vector<py::array>& levels) {
    std::vector<ImageView<T>> views;
    std::vector<TextureShape> shapes;
    for (std::size_t k = 0; k < levels.size(); ++k) {
        ArrayArgs args(function);
        const std::string label = std::string(name) + "[" + std::to_string(k) + "]";
        T* texels = nullptr;
        if constexpr (std::is_const_v<T>)
            texels = args.in<R>(label.c_str(), levels[k], "H W C");
        else
            texels = args.out<R>(label.c_str(), levels[k], "H W C");
        const TextureShape shape = checked_shape(args, label.c_str());
        if (k == 0) shapes = mip_shapes(shape);
        const TextureShape wanted = shapes[std::min(k, shapes.size() - 1)];
        const int channels = static_cast<int>(args.size("C"));
        if (k >= shapes.size() || shape.height != wanted.height || shape.width != wanted.width ||
            (k > 0 && channels != views[0].channels))
            args.range(label, "the shapes that build_mips makes",
                       text_of(shape) + " x " + std::to_string(channels));
        views.push_back({texels, shape, channels});
    }
    if (views.empty()) fail(ErrorKind::range, function, name, "at least one level", "none");
    return views;
}

/// Calls body(views) with checked views of levels that it may write to, without the interpreter.
template <class Body>
void with_mips(const char* function, const char* name, std::vector<py::array>& levels, Body body) {
    if (levels.empty()) fail(ErrorKind::range, function, name, "at least one level", "none");
    dispatch_real(function, name, levels[0], [&](auto real, ArrayArgs&) {
        const auto views = mips_in<decltype(real), decltype(real)>(function, name, levels);
        const py::gil_scoped_release release;
        body(views);
    });
}

void build(std::vector<py::array> mips) {
    with_mips("build_mips", "mips", mips, [](const auto& views) {
        for (std::size_t k = 0; k + 1 < views.size(); ++k) halve(read_only(views[k]), views[k + 1]);
    });
}

void build_backward(std::vector<py::array> d_mips) {
    with_mips("build_mips_backward", "d_mips", d_mips, [](const auto& views) {
        for (std::size_t k = views.size() - 1; k > 0; --k)
            halve_backward(read_only(views[k]), views[k - 1]);
    });
}

py::array level_of(std::int64_t height, std::int64_t width, const py::array& footprint) {
    return dispatch_real("mip_level", "footprint", footprint,
                         [&](auto real, ArrayArgs& args) -> py::array {
                             using R = decltype(real);
                             const R* d = finite_in<R>(args, "footprint", footprint, "N 2 2");
                             check_side(args, height, width);
                             py::array_t<R> level(args.size("N"));
                             mip_level({static_cast<int>(height), static_cast<int>(width)}, d,
                                       args.size("N"), level.mutable_data());
                             return level;
                         });
}

void sample_mips_any(std::vector<py::array> mips, const py::array& uv, const py::array& level,
                     py::array color) {
    dispatch_real("sample_mips", "uv", uv, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const auto views = mips_in<R, const R>("sample_mips", "mips", mips);
        const R* points = finite_in<R>(args, "uv", uv, "N 2");
        const R* levels = finite_in<R>(args, "level", level, "N");
        R* out = args.out<R>("out", color, "N " + std::to_string(views[0].channels));
        const py::gil_scoped_release release;
        sample_mips<R>(views, points, levels, args.size("N"), out);
    });
}

void sample_mips_any_backward(std::vector<py::array> mips, const py::array& uv,
                              const py::array& level, const py::array& d_color,
                              std::vector<py::array> d_mips, py::array d_uv, py::array d_level) {
    const char* name = "sample_mips_backward";
    dispatch_real(name, "uv", uv, [&](auto real, ArrayArgs& args) {
        using R = decltype(real);
        const auto views = mips_in<R, const R>(name, "mips", mips);
        const auto d_views = mips_in<R, R>(name, "d_mips", d_mips);
        if (views.size() != d_views.size())
            args.range("d_mips", std::to_string(views.size()) + " levels as in mips",
                       std::to_string(d_views.size()));
        const R* points = finite_in<R>(args, "uv", uv, "N 2");
        const R* levels = finite_in<R>(args, "level", level, "N");
        const R* d_out = args.in<R>("d_color", d_color, "N " + std::to_string(views[0].channels));
        R* d_points = args.out<R>("d_uv", d_uv, "N 2");
        R* d_levels = args.out<R>("d_level", d_level, "N");
        const py::gil_scoped_release release;
        sample_mips_backward<R>(views, points, levels, args.size("N"), d_out, d_views, d_points,
                                d_levels);
    });
}

struct BoundPlan {
    std::variant<std::unique_ptr<TexturePlan<float>>, std::unique_ptr<TexturePlan<double>>> plan;
};

BoundPlan make_plan(std::int64_t height, std::int64_t width, const py::array& uv,
                    const py::array& target) {
    return dispatch_real("TexturePlan", "uv", uv, [&](auto real, ArrayArgs& args) -> BoundPlan {
        using R = decltype(real);
        const R* points = finite_in<R>(args, "uv", uv, "N 2");
        const R* colors = args.in<R>("colors", target, "N C");
        const std::int64_t channels = args.size("C"), count = args.size("N");
        if (count == 0) args.range("uv", "at least one point", "none");
        if (channels < 1 || channels > max_channels)
            args.range("colors", "1 to " + std::to_string(max_channels) + " channels",
                       std::to_string(channels));
        check_side(args, height, width);
        const py::gil_scoped_release release;
        return {std::make_unique<TexturePlan<R>>(
            TextureShape{static_cast<int>(height), static_cast<int>(width)},
            static_cast<int>(channels), points, colors, count)};
    });
}

template <class R>
double plan_loss(const TexturePlan<R>& plan, const py::array& texture, py::array& d_texture) {
    ArrayArgs args("loss_and_gradient");
    const ImageView<const R> view = texture_in<R>(args, texture);
    R* d_texels = args.out<R>("d_texture", d_texture, "H W C");
    if (view.shape.height != plan.shape().height || view.shape.width != plan.shape().width ||
        view.channels != plan.channels())
        args.range("texture", "the shape that the plan was made for",
                   text_of(view.shape) + " x " + std::to_string(view.channels));
    const py::gil_scoped_release release;
    return plan.loss_and_gradient(view.texels, d_texels);
}

/// Two pictures (H, W, C) that the window of structural similarity fits into; the second's numbers.
template <class R>
std::pair<ImageView<const R>, const R*> pictures_in(ArrayArgs& args, const py::array& x,
                                                    const py::array& y) {
    const R* first = args.in<R>("x", x, "H W C");
    const R* second = args.in<R>("y", y, "H W C");
    const TextureShape shape = checked_shape(args, "x");
    if (std::min(shape.height, shape.width) < ssim_window)
        args.range("x", "at least 11 x 11 pixels", text_of(shape));
    return {{first, shape, static_cast<int>(args.size("C"))}, second};
}

double ssim_any(const py::array& x, const py::array& y) {
    return dispatch_real("ssim", "x", x, [&](auto real, ArrayArgs& args) -> double {
        const auto [view, other] = pictures_in<decltype(real)>(args, x, y);
        const py::gil_scoped_release release;
        return ssim(view, other);
    });
}

double ssim_any_backward(const py::array& x, const py::array& y, double d_value, py::array d_x) {
    return dispatch_real("ssim_backward", "x", x, [&](auto real, ArrayArgs& args) -> double {
        using R = decltype(real);
        const auto [view, other] = pictures_in<R>(args, x, y);
        R* d_pixels = args.out<R>("d_x", d_x, "H W C");
        const py::gil_scoped_release release;
        return ssim_backward(view, other, d_value, d_pixels);
    });
}

}  // namespace

void bind_texture(py::module_& m) {
    m.def("sample", &sample_any, py::arg("texture"), py::arg("uv"), py::arg("out"),
          "Writes the colors (N, C) of a texture (H, W, C) at uv (N, 2) to out.");
    m.def("sample_backward", &sample_any_backward, py::arg("texture"), py::arg("uv"),
          py::arg("d_color"), py::arg("d_texture") = py::none(), py::arg("d_uv") = py::none(),
          "Adds to d_texture (H, W, C) and d_uv (N, 2), where given.");
    m.def(
        "mip_shapes",
        [](int height, int width) {
            std::vector<std::pair<int, int>> shapes;
            check_side(ArrayArgs("mip_shapes"), height, width);
            for (const TextureShape& s : mip_shapes({height, width}))
                shapes.emplace_back(s.height, s.width);
            return shapes;
        },
        py::arg("height"), py::arg("width"), "Height and width of every level of a mip map.");
    m.def("build_mips", &build, py::arg("mips"), "Fills level 1 and all after it from level 0.");
    m.def("build_mips_backward", &build_backward, py::arg("d_mips"),
          "Adds the adjoint of every level to the one before; level 0 ends as the texture's.");
    m.def("mip_level", &level_of, py::arg("height"), py::arg("width"), py::arg("footprint"),
          "Level (N,) of footprints (N, 2, 2): du/dx, dv/dx; du/dy, dv/dy.");
    m.def("sample_mips", &sample_mips_any, py::arg("mips"), py::arg("uv"), py::arg("level"),
          py::arg("out"), "Writes the colors (N, C) at uv (N, 2) and level (N,) to out.");
    m.def("sample_mips_backward", &sample_mips_any_backward, py::arg("mips"), py::arg("uv"),
          py::arg("level"), py::arg("d_color"), py::arg("d_mips"), py::arg("d_uv"),
          py::arg("d_level"), "Adds to all levels of d_mips, d_uv (N, 2) and d_level (N,).");
    m.def("ssim", &ssim_any, py::arg("x"), py::arg("y"),
          "Mean structural similarity of two pictures (H, W, C) in 0 .. 1.");
    m.def("ssim_backward", &ssim_any_backward, py::arg("x"), py::arg("y"), py::arg("d_value"),
          py::arg("d_x"), "Adds d_value times its derivative to d_x (H, W, C); returns the value.");
    py::class_<BoundPlan>(m, "TexturePlan", "Points sorted by tile, with their colors.")
        .def(py::init(&make_plan), py::arg("height"), py::arg("width"), py::arg("uv"),
             py::arg("colors"))
        .def(
            "loss_and_gradient",
            [](const BoundPlan& bound, const py::array& texture, py::array d_texture) {
                return std::visit(
                    [&](const auto& plan) { return plan_loss(*plan, texture, d_texture); },
                    bound.plan);
            },
            py::arg("texture"), py::arg("d_texture"), "The loss; adds to d_texture (H, W, C).");
}

}  // namespace photograd
