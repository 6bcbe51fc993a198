// The rasterizer; photograd.raster is the typed face. All arrays are float64 or integers.
#include <optional>

#include "array_args.h"
#include "module.h"
#include "photograd/raster/interpolate.h"
#include "photograd/raster/rasterize.h"
#include "photograd/raster/silhouettes.h"

namespace photograd {
namespace {

// z^3 of the largest must not overflow.
constexpr double largest_position = 1e60;

void check_numbers(const ArrayArgs& args, const char* name, std::span<const std::uint32_t> numbers,
                   std::int64_t end, const char* of) {
    for (const std::uint32_t number : numbers)
        if (number >= end)
            args.range(name, std::string("numbers of ") + of + " below " + std::to_string(end),
                       std::to_string(number));
}

std::span<const std::uint32_t> faces_of(ArrayArgs& args, const py::array& faces) {
    const std::uint32_t* data = args.in<std::uint32_t>("faces", faces, "F 3");
    const std::span<const std::uint32_t> found(data, static_cast<std::size_t>(faces.size()));
    if (args.size("F") >= std::int64_t{1} << 30)
        args.range("faces", "fewer than 2^30 triangles", std::to_string(args.size("F")));
    check_numbers(args, "faces", found, args.size("V"), "vertices");
    return found;
}

ScreenMesh mesh_of(ArrayArgs& args, const py::array& positions, const py::array& faces, int height,
                   int width) {
    const double* data = args.within<double>("positions", positions, "V 3", largest_position);
    if (width < 1 || height < 1 || std::int64_t{width} * height > (1 << 28))
        args.range("width, height", "1 to 2^28 pixels",
                   std::to_string(width) + " x " + std::to_string(height));
    return {
        {data, static_cast<std::size_t>(positions.size())}, faces_of(args, faces), width, height};
}

void check_range(const ArrayArgs& args, double near, double far) {
    if (!(near > 0 && far >= near))
        args.range("near, far", "0 < near <= far", number_text(near) + " and " + number_text(far));
}

Compare compare_of(const ArrayArgs& args, const char* name, int value) {
    if (value < 0 || value > static_cast<int>(Compare::always))
        args.range(name, "0 to 7", std::to_string(value));
    return static_cast<Compare>(value);
}

StencilRules stencil_of(const ArrayArgs& args, const std::array<int, 7>& n) {
    for (const int value : {n[1], n[2], n[3]})
        if (value < 0 || value > 255)
            args.range("stencil", "a reference and masks of 8 bits", std::to_string(value));
    StencilOp ops[3];
    for (std::size_t i = 0; i < 3; ++i) {
        if (n[4 + i] < 0 || n[4 + i] > static_cast<int>(StencilOp::decrement_wrap))
            args.range("stencil", "operations 0 to 7", std::to_string(n[4 + i]));
        ops[i] = static_cast<StencilOp>(n[4 + i]);
    }
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(n[i]); };
    return {compare_of(args, "stencil", n[0]), byte(1), byte(2), byte(3), ops[0], ops[1], ops[2]};
}

/// camera_from_world (3, 4); positions (V, 3) = K (R X + t).
void project(const py::array& vertices, const py::array& camera_from_world,
             const std::array<double, 4>& intrinsics, py::array positions) {
    ArrayArgs args("project");
    const double* x = args.in<double>("vertices", vertices, "V 3");
    const double* m = args.in<double>("camera_from_world", camera_from_world, "3 4");
    double* out = args.out<double>("positions", positions, "V 3");
    const auto [fx, fy, cx, cy] = intrinsics;
    const std::int64_t count = args.size("V");
    constexpr std::int64_t piece = 4096;
    const py::gil_scoped_release release;
    parallel_for((count + piece - 1) / piece, [&](std::int64_t p) {
        for (std::int64_t i = p * piece; i < std::min(count, (p + 1) * piece); ++i) {
            double q[3];
            for (int k = 0; k < 3; ++k) {
                const double* row = m + 4 * k;
                q[k] = x[3 * i] * row[0] + x[3 * i + 1] * row[1] + x[3 * i + 2] * row[2] + row[3];
            }
            out[3 * i] = fx * q[0] + cx * q[2];
            out[3 * i + 1] = fy * q[1] + cy * q[2];
            out[3 * i + 2] = q[2];
        }
    });
}

void draw(const py::array& positions, const py::array& faces, double near, double far, int cull,
          int depth_test, bool depth_write, const std::array<int, 7>& stencil_rules,
          std::int32_t first_face, py::array face, py::array barycentrics, py::array depth,
          const py::object& stencil, const py::object& overdraw,
          const std::optional<py::array>& behind, const std::optional<py::array>& face_mask) {
    ArrayArgs args("rasterize");
    std::int32_t* numbers = args.out<std::int32_t>("face", face, "H W");
    VisibilityBuffers out{numbers,
                          args.out<double>("barycentrics", barycentrics, "H W 2"),
                          args.out<double>("depth", depth, "H W"),
                          nullptr,
                          first_face,
                          nullptr,
                          behind ? args.in<double>("behind", *behind, "H W") : nullptr,
                          false};
    py::array bytes, counts;
    if (!stencil.is_none()) {
        bytes = stencil.cast<py::array>();
        out.stencil = args.out<std::uint8_t>("stencil", bytes, "H W");
    }
    if (!overdraw.is_none()) {
        counts = overdraw.cast<py::array>();
        out.overdraw = args.out<std::int32_t>("overdraw", counts, "H W");
    }
    ScreenMesh mesh = mesh_of(args, positions, faces, static_cast<int>(args.size("H")),
                              static_cast<int>(args.size("W")));
    if (face_mask) mesh.face_mask = args.in<bool>("face_mask", *face_mask, "F");
    check_range(args, near, far);
    if (cull < 0 || cull > 2) args.range("cull", "0 to 2", std::to_string(cull));
    if (first_face < 0 || mesh.face_count() > 0x7fffffff - std::int64_t{first_face})
        args.range("first_face", "numbers of faces below 2^31", std::to_string(first_face));
    const FragmentRules rules{static_cast<Cull>(cull),
                              compare_of(args, "depth_test", depth_test),
                              depth_write,
                              near,
                              far,
                              stencil_of(args, stencil_rules)};
    const py::gil_scoped_release release;
    rasterize(mesh, rules, out);
}

void draw_depth(const py::array& positions, const py::array& faces, double near, double far,
                py::array depth, const std::optional<py::array>& face_mask) {
    ArrayArgs args("rasterize_depth");
    const VisibilityBuffers out{nullptr, nullptr, args.out<double>("depth", depth, "H W"),
                                nullptr, 0,       nullptr,
                                nullptr, true};
    ScreenMesh mesh = mesh_of(args, positions, faces, static_cast<int>(args.size("H")),
                              static_cast<int>(args.size("W")));
    if (face_mask) mesh.face_mask = args.in<bool>("face_mask", *face_mask, "F");
    check_range(args, near, far);
    const FragmentRules rules{Cull::none, Compare::less, true, near, far, {}};
    const py::gil_scoped_release release;
    rasterize(mesh, rules, out);
}

void draw_backward(const py::array& positions, const py::array& faces, const py::array& face,
                   const py::array& d_barycentrics, const py::array& d_depth,
                   py::array d_positions) {
    ArrayArgs args("rasterize_backward");
    const std::int32_t* numbers = args.in<std::int32_t>("face", face, "H W");
    const ScreenMesh mesh = mesh_of(args, positions, faces, static_cast<int>(args.size("H")),
                                    static_cast<int>(args.size("W")));
    const double* d_b = args.in<double>("d_barycentrics", d_barycentrics, "H W 2");
    const double* d_z = args.in<double>("d_depth", d_depth, "H W");
    double* d_out = args.out<double>("d_positions", d_positions, "V 3");
    const py::gil_scoped_release release;
    rasterize_backward(mesh, numbers, d_b, d_z, d_out);
}

VisibleFaces visible_of(ArrayArgs& args, const py::array& faces, const py::array& face,
                        const py::array& barycentrics) {
    const std::int32_t* numbers = args.in<std::int32_t>("face", face, "P");
    const double* b = args.in<double>("barycentrics", barycentrics, "P 2");
    return {{numbers, static_cast<std::size_t>(face.size())}, b, faces_of(args, faces)};
}

void blend_attributes(const py::array& attributes, const py::array& faces, const py::array& face,
                      const py::array& barycentrics, py::array out) {
    ArrayArgs args("interpolate");
    const double* values = args.in<double>("attributes", attributes, "V C");
    const VisibleFaces visible = visible_of(args, faces, face, barycentrics);
    double* to = args.out<double>("out", out, "P C");
    const py::gil_scoped_release release;
    interpolate(visible, values, args.size("C"), to);
}

void blend_attributes_backward(const py::array& attributes, const py::array& faces,
                               const py::array& face, const py::array& barycentrics,
                               const py::array& d_out, py::array d_attributes,
                               py::array d_barycentrics) {
    ArrayArgs args("interpolate_backward");
    const double* values = args.in<double>("attributes", attributes, "V C");
    const VisibleFaces visible = visible_of(args, faces, face, barycentrics);
    const double* d_blended = args.in<double>("d_out", d_out, "P C");
    double* d_values = args.out<double>("d_attributes", d_attributes, "V C");
    double* d_b = args.out<double>("d_barycentrics", d_barycentrics, "P 2");
    const py::gil_scoped_release release;
    interpolate_backward(visible, values, args.size("V"), args.size("C"), d_blended, d_values, d_b);
}

void silhouettes(const py::array& positions, const py::array& ends, const py::array& opposite,
                 py::array out) {
    ArrayArgs args("silhouettes");
    const double* data = args.within<double>("positions", positions, "V 3", largest_position);
    const std::uint32_t* pairs = args.in<std::uint32_t>("ends", ends, "E 2");
    const std::int32_t* thirds = args.in<std::int32_t>("opposite", opposite, "E 2");
    std::uint8_t* flags = args.out<std::uint8_t>("out", out, "E");
    const auto count = static_cast<std::size_t>(ends.size());
    const std::span<const std::uint32_t> numbers(pairs, count);
    check_numbers(args, "ends", numbers, args.size("V"), "vertices");
    for (std::size_t i = 0; i < count; ++i)
        if (thirds[i] >= args.size("V"))
            args.range("opposite", "numbers of vertices below " + std::to_string(args.size("V")),
                       std::to_string(thirds[i]));
    const py::gil_scoped_release release;
    find_silhouettes({data, static_cast<std::size_t>(positions.size())}, numbers, {thirds, count},
                     flags);
}

PreparedTriangles prepared(const py::array& positions, const py::array& faces, int height,
                           int width, double near) {
    ArrayArgs args("prepare_triangles");
    const ScreenMesh mesh = mesh_of(args, positions, faces, height, width);
    check_range(args, near, near);
    const py::gil_scoped_release release;
    return {mesh, near, Reach::anywhere};
}

py::tuple nearest(const PreparedTriangles& triangles, const py::array& points, double near,
                  double far) {
    ArrayArgs args("nearest");
    const double* at = args.finite<double>("points", points, "N 2");
    check_range(args, near, far);
    py::array_t<std::int32_t> face(args.size("N"));
    py::array_t<double> depth(args.size("N"));
    std::int32_t* to_face = face.mutable_data();
    double* to_depth = depth.mutable_data();
    {
        const py::gil_scoped_release release;
        triangles.nearest({at, static_cast<std::size_t>(points.size())}, near, far, to_face,
                          to_depth);
    }
    return py::make_tuple(face, depth);
}

py::array count_nearer(const PreparedTriangles& triangles, const py::array& points,
                       const py::array& depth, double near) {
    ArrayArgs args("count");
    const double* at = args.finite<double>("points", points, "N 2");
    const double* farthest = args.finite<double>("depth", depth, "N");
    py::array_t<std::int32_t> counts(args.size("N"));
    std::int32_t* to = counts.mutable_data();
    {
        const py::gil_scoped_release release;
        triangles.count({at, static_cast<std::size_t>(points.size())}, near, farthest, to);
    }
    return counts;
}

}  // namespace

void bind_raster(py::module_& m) {
    m.def("project", &project, py::arg("vertices"), py::arg("camera_from_world"),
          py::arg("intrinsics"), py::arg("positions"),
          "positions (V, 3) in homogeneous pixels; camera_from_world (3, 4), (fx, fy, cx, cy).");
    m.def("rasterize", &draw, py::arg("positions"), py::arg("faces"), py::arg("near"),
          py::arg("far"), py::arg("cull"), py::arg("depth_test"), py::arg("depth_write"),
          py::arg("stencil_rules"), py::arg("first_face"), py::arg("face"), py::arg("barycentrics"),
          py::arg("depth"), py::arg("stencil"), py::arg("overdraw"), py::arg("behind") = py::none(),
          py::arg("face_mask") = py::none(),
          "Draws onto face, barycentrics and depth, and onto stencil and overdraw unless None; "
          "only what lies behind `behind` (H, W), and only faces of face_mask (F,), unless "
          "None.");
    m.def("rasterize_depth", &draw_depth, py::arg("positions"), py::arg("faces"), py::arg("near"),
          py::arg("far"), py::arg("depth"), py::arg("face_mask") = py::none(),
          "Writes depth (H, W) alone, infinite where nothing is seen; of faces of face_mask "
          "(F,) unless None.");
    m.def("rasterize_backward", &draw_backward, py::arg("positions"), py::arg("faces"),
          py::arg("face"), py::arg("d_barycentrics"), py::arg("d_depth"), py::arg("d_positions"),
          "Adds to d_positions.");
    m.def("interpolate", &blend_attributes, py::arg("attributes"), py::arg("faces"),
          py::arg("face"), py::arg("barycentrics"), py::arg("out"),
          "Writes the pixels that see a face.");
    m.def("interpolate_backward", &blend_attributes_backward, py::arg("attributes"),
          py::arg("faces"), py::arg("face"), py::arg("barycentrics"), py::arg("d_out"),
          py::arg("d_attributes"), py::arg("d_barycentrics"),
          "Adds to d_attributes, writes d_barycentrics where a face is seen.");
    m.def("silhouettes", &silhouettes, py::arg("positions"), py::arg("ends"), py::arg("opposite"),
          py::arg("out"));
    py::class_<PreparedTriangles>(m, "PreparedTriangles", "Triangles of one view, by tile.")
        .def(py::init(&prepared), py::arg("positions"), py::arg("faces"), py::arg("height"),
             py::arg("width"), py::arg("near"))
        .def("nearest", &nearest, py::arg("points"), py::arg("near"), py::arg("far"),
             "Face (N,) and depth (N,) at points (x, y) of the image.")
        .def("count", &count_nearer, py::arg("points"), py::arg("depth"), py::arg("near"),
             "How many faces (N,) from near to depth (N,) lie at points (x, y) of the image.");
}

}  // namespace photograd
