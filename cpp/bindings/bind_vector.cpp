// Vector graphics; photograd.vector is the typed face. All numbers are float64.
#include <optional>

#include "array_args.h"
#include "module.h"
#include "photograd/vector/composite.h"
#include "photograd/vector/stroke.h"

namespace photograd {
namespace {

// Products of coordinates keep 3 digits after the point.
constexpr double largest_coordinate = 1e6;

template <class T>
std::span<const T> all_of(ArrayArgs& args, const char* name, const py::array& array,
                          std::string_view axes) {
    return {args.in<T>(name, array, axes), static_cast<std::size_t>(array.size())};
}

/// Begins of ranges in `count` things: from 0, never falling, to `count`.
std::span<const std::int64_t> begins(ArrayArgs& args, const char* name, const py::array& array,
                                     std::string_view axis, std::int64_t count) {
    const std::span<const std::int64_t> found = all_of<std::int64_t>(args, name, array, axis);
    bool rises = !found.empty() && found.front() == 0 && found.back() == count;
    for (std::size_t k = 0; rises && k + 1 < found.size(); ++k) rises = found[k] <= found[k + 1];
    if (!rises) args.range(name, "0, rising to " + std::to_string(count), "other numbers");
    return found;
}

/// Kinds below `end`.
std::span<const std::uint8_t> kinds(ArrayArgs& args, const char* name, const py::array& array,
                                    const char* axes, std::uint8_t end) {
    const auto found = all_of<std::uint8_t>(args, name, array, axes);
    for (const std::uint8_t kind : found)
        if (kind >= end)
            args.range(name, "numbers below " + std::to_string(int{end}), std::to_string(kind));
    return found;
}

/// Contours with their area: the arrays are copied.
class VectorShapes {
public:
    VectorShapes(const py::array& vertices, const py::array& contour_begin,
                 const py::array& shape_begin, const py::array& rule, int height, int width) {
        ArrayArgs args("draw_shapes");
        const double* points = args.within<double>("vertices", vertices, "V 2", largest_coordinate);
        if (width < 1 || height < 1 || std::int64_t{width} * height > (1 << 26))
            args.range("width, height", "1 to 2^26 pixels",
                       std::to_string(width) + " x " + std::to_string(height));
        if (args.size("V") > (1 << 28))
            args.range("vertices", "up to 2^28", std::to_string(args.size("V")));
        const auto contours = begins(args, "contour_begin", contour_begin, "C", args.size("V"));
        const auto shapes = begins(args, "shape_begin", shape_begin, "B", args.size("C") - 1);
        const auto rules = kinds(args, "rule", rule, "S", 2);
        if (args.size("B") != args.size("S") + 1)
            args.range("shape_begin", "one more than rules", std::to_string(args.size("B")));
        vertices_.assign(points, points + vertices.size());
        contour_begin_.assign(contours.begin(), contours.end());
        shape_begin_.assign(shapes.begin(), shapes.end());
        rule_.assign(rules.begin(), rules.end());
        const py::gil_scoped_release release;
        try {
            areas_.emplace(this->contours(), height, width);
        } catch (const std::length_error& failure) {
            args.range("drawing", "a smaller one", failure.what(),
                       "draw fewer shapes, or a smaller picture");
        }
    }

    void cover(std::int64_t shape, py::array out) const {
        ArrayArgs args("area");
        double* to = picture(args, "out", out);
        check_shape(args, shape);
        for (const AreaSpan& span : areas_->spans())
            if (span.shape == static_cast<std::uint32_t>(shape))
                std::copy_n(&areas_->values()[span.first], span.count,
                            to + std::int64_t{span.row} * areas_->width() + span.x0);
    }

    void cover_backward(std::int64_t shape, const py::array& d_out, py::array d_vertices) const {
        ArrayArgs args("area_backward");
        const double* d = args.finite<double>("d_out", d_out, "H W");
        check_size(args);
        check_shape(args, shape);
        double* to = vertex_rows(args, d_vertices);
        std::vector<double> d_values(areas_->values().size(), 0.0);
        const py::gil_scoped_release release;
        for (const AreaSpan& span : areas_->spans())
            if (span.shape == static_cast<std::uint32_t>(shape))
                std::copy_n(d + std::int64_t{span.row} * areas_->width() + span.x0, span.count,
                            &d_values[span.first]);
        areas_->backward(contours(), d_values, to);
    }

    void draw(const py::array& kind, const py::array& stop_begin, const py::array& opacity,
              const py::array& geometry, const py::array& offsets, const py::array& colors,
              const py::array& background, py::array out) const {
        ArrayArgs args("draw");
        const PaintTable paints =
            table(args, kind, stop_begin, opacity, geometry, offsets, colors, background);
        double* to = args.out<double>("out", out, "H W 4");
        check_size(args);
        const py::gil_scoped_release release;
        composite(*areas_, paints, to);
    }

    void draw_backward(const py::array& kind, const py::array& stop_begin, const py::array& opacity,
                       const py::array& geometry, const py::array& offsets, const py::array& colors,
                       const py::array& background, const py::array& d_out, py::array d_vertices,
                       py::array d_opacity, py::array d_geometry, py::array d_offsets,
                       py::array d_colors, py::array d_background) const {
        ArrayArgs args("draw_backward");
        const PaintTable paints =
            table(args, kind, stop_begin, opacity, geometry, offsets, colors, background);
        const double* d = args.finite<double>("d_out", d_out, "H W 4");
        check_size(args);
        double* to = vertex_rows(args, d_vertices);
        const PaintGradients gradients{args.out<double>("d_opacity", d_opacity, "S"),
                                       args.out<double>("d_geometry", d_geometry, "S 4"),
                                       args.out<double>("d_offsets", d_offsets, "K"),
                                       args.out<double>("d_colors", d_colors, "K 4"),
                                       args.out<double>("d_background", d_background, "4")};
        const py::gil_scoped_release release;
        std::vector<double> d_values(areas_->values().size());
        composite_backward(*areas_, paints, d, d_values, gradients);
        areas_->backward(contours(), d_values, to);
    }

private:
    [[nodiscard]] Contours contours() const {
        return {vertices_, contour_begin_, shape_begin_, rule_};
    }
    void check_size(const ArrayArgs& args) const {
        if (args.size("H") != areas_->height() || args.size("W") != areas_->width())
            args.range("H, W", "the size of the drawing", "another");
    }
    void check_shape(const ArrayArgs& args, std::int64_t shape) const {
        if (shape < 0 || shape >= static_cast<std::int64_t>(rule_.size()))
            args.range("shape", "a number below " + std::to_string(rule_.size()),
                       std::to_string(shape));
    }
    double* picture(ArrayArgs& args, const char* name, py::array& out) const {
        double* to = args.out<double>(name, out, "H W");
        check_size(args);
        return to;
    }
    double* vertex_rows(ArrayArgs& args, py::array& d_vertices) const {
        double* to = args.out<double>("d_vertices", d_vertices, "V 2");
        if (2 * args.size("V") != static_cast<std::int64_t>(vertices_.size()))
            args.range("d_vertices", "as many as vertices", std::to_string(args.size("V")));
        return to;
    }
    PaintTable table(ArrayArgs& args, const py::array& kind, const py::array& stop_begin,
                     const py::array& opacity, const py::array& geometry, const py::array& offsets,
                     const py::array& colors, const py::array& background) const {
        PaintTable found{.kind = kinds(args, "kind", kind, "S", 3),
                         .stop_begin = {},
                         .opacity = args.finite<double>("opacity", opacity, "S"),
                         .geometry = args.finite<double>("geometry", geometry, "S 4"),
                         .offsets = args.finite<double>("offsets", offsets, "K"),
                         .colors = args.finite<double>("colors", colors, "K 4"),
                         .background = args.finite<double>("background", background, "4")};
        found.stop_begin = begins(args, "stop_begin", stop_begin, "B", args.size("K"));
        if (args.size("S") != static_cast<std::int64_t>(rule_.size()) ||
            args.size("B") != args.size("S") + 1)
            args.range("kind", "one for each shape", std::to_string(args.size("S")));
        for (std::size_t s = 0; s < found.kind.size(); ++s)
            if (found.stop_count(s) == 0) args.range("stop_begin", "stops of each shape", "none");
        return found;
    }

    std::vector<double> vertices_;
    std::vector<std::int64_t> contour_begin_, shape_begin_;
    std::vector<std::uint8_t> rule_;
    std::optional<ShapeAreas> areas_;
};

/// The strokes of a drawing with their outlines, one after the other.
class VectorStrokes {
public:
    VectorStrokes(const py::array& points, const py::array& corner, const py::array& line_begin,
                  const py::array& closed, const py::array& half_width, const py::array& cap,
                  const py::array& join, const py::array& miter_limit, int arc) {
        ArrayArgs args("outline_strokes");
        const double* data = args.within<double>("points", points, "P 2", largest_coordinate);
        const auto corners = kinds(args, "corner", corner, "P", 2);
        const auto first = begins(args, "line_begin", line_begin, "B", args.size("P"));
        const auto closings = kinds(args, "closed", closed, "L", 2);
        const double* h = args.within<double>("half_width", half_width, "L", largest_coordinate);
        const auto caps = kinds(args, "cap", cap, "L", 3);
        const auto joins = kinds(args, "join", join, "L", 3);
        const double* limit = args.finite<double>("miter_limit", miter_limit, "L");
        if (args.size("B") != args.size("L") + 1)
            args.range("line_begin", "one more than lines", std::to_string(args.size("B")));
        if (arc < 1 || arc > 4096) args.range("arc", "1 to 4096", std::to_string(arc));
        points_.assign(data, data + points.size());
        corner_.assign(corners.begin(), corners.end());
        line_begin_.assign(first.begin(), first.end());
        for (std::size_t k = 0; k < closings.size(); ++k)
            styles_.push_back({h[k], limit[k], static_cast<Cap>(caps[k]),
                               static_cast<Join>(joins[k]), closings[k] != 0, arc});
        outlines_.resize(styles_.size());
        const py::gil_scoped_release release;
        parallel_for(static_cast<std::int64_t>(styles_.size()), [&](std::int64_t k) {
            const auto i = static_cast<std::size_t>(k);
            outlines_[i] = stroke_outline(line(i), styles_[i]);
        });
    }

    /// Vertices (K, 2), the number of vertices of each contour, the line of each contour.
    [[nodiscard]] py::tuple outlines() const {
        std::vector<double> vertices;
        std::vector<std::int64_t> size, owner;
        for (std::size_t k = 0; k < outlines_.size(); ++k) {
            for (const OutlineVertex& vertex : outlines_[k].vertices)
                for (int i = 0; i < 2; ++i)
                    vertices.push_back(line(k).points[2 * vertex.point + std::size_t(i)] +
                                       styles_[k].half_width * vertex.r[i]);
            std::int64_t before = 0;
            for (const std::int64_t end : outlines_[k].contour_ends) {
                size.push_back(end - std::exchange(before, end));
                owner.push_back(static_cast<std::int64_t>(k));
            }
        }
        py::array_t<double> rows({static_cast<py::ssize_t>(vertices.size() / 2), py::ssize_t{2}});
        std::copy(vertices.begin(), vertices.end(), rows.mutable_data());
        return py::make_tuple(rows,
                              py::array_t<std::int64_t>(py::ssize_t(size.size()), size.data()),
                              py::array_t<std::int64_t>(py::ssize_t(owner.size()), owner.data()));
    }

    void backward(const py::array& d_vertices, py::array d_points, py::array d_half_width) const {
        ArrayArgs args("outline_strokes_backward");
        const double* d = args.in<double>("d_vertices", d_vertices, "K 2");
        double* to_points = args.out<double>("d_points", d_points, "P 2");
        double* to_width = args.out<double>("d_half_width", d_half_width, "L");
        std::vector<std::size_t> first{0};
        for (const StrokeOutline& outline : outlines_)
            first.push_back(first.back() + outline.vertices.size());
        if (args.size("K") != static_cast<std::int64_t>(first.back()) ||
            2 * args.size("P") != static_cast<std::int64_t>(points_.size()) ||
            args.size("L") != static_cast<std::int64_t>(styles_.size()))
            args.range("d_vertices, d_points, d_half_width", "the sizes of the strokes", "others");
        const py::gil_scoped_release release;
        parallel_for(static_cast<std::int64_t>(styles_.size()), [&](std::int64_t k) {
            const auto i = static_cast<std::size_t>(k);
            to_width[i] +=
                stroke_outline_backward(line(i), styles_[i], outlines_[i], d + 2 * first[i],
                                        to_points + 2 * line_begin_[i]);
        });
    }

private:
    [[nodiscard]] Polyline line(std::size_t k) const {
        const auto first = static_cast<std::size_t>(line_begin_[k]);
        const auto count = static_cast<std::size_t>(line_begin_[k + 1]) - first;
        return {std::span<const double>(points_).subspan(2 * first, 2 * count),
                std::span<const std::uint8_t>(corner_).subspan(first, count)};
    }

    std::vector<double> points_;
    std::vector<std::uint8_t> corner_;
    std::vector<std::int64_t> line_begin_;
    std::vector<StrokeStyle> styles_;
    std::vector<StrokeOutline> outlines_;
};

}  // namespace

void bind_vector(py::module_& m) {
    py::class_<VectorShapes>(m, "VectorShapes",
                             "Filled contours and what they cover of each pixel.")
        .def(py::init<const py::array&, const py::array&, const py::array&, const py::array&, int,
                      int>(),
             py::arg("vertices"), py::arg("contour_begin"), py::arg("shape_begin"), py::arg("rule"),
             py::arg("height"), py::arg("width"))
        .def("area", &VectorShapes::cover, py::arg("shape"), py::arg("out"),
             "Writes the pixels that one shape may cover.")
        .def("area_backward", &VectorShapes::cover_backward, py::arg("shape"), py::arg("d_out"),
             py::arg("d_vertices"), "Adds to d_vertices.")
        .def("draw", &VectorShapes::draw, py::arg("kind"), py::arg("stop_begin"),
             py::arg("opacity"), py::arg("geometry"), py::arg("offsets"), py::arg("colors"),
             py::arg("background"), py::arg("out"))
        .def("draw_backward", &VectorShapes::draw_backward, py::arg("kind"), py::arg("stop_begin"),
             py::arg("opacity"), py::arg("geometry"), py::arg("offsets"), py::arg("colors"),
             py::arg("background"), py::arg("d_out"), py::arg("d_vertices"), py::arg("d_opacity"),
             py::arg("d_geometry"), py::arg("d_offsets"), py::arg("d_colors"),
             py::arg("d_background"), "Adds to all that begin with d_ but d_out.");
    py::class_<VectorStrokes>(m, "VectorStrokes", "Polylines and the outlines of their strokes.")
        .def(
            py::init<const py::array&, const py::array&, const py::array&, const py::array&,
                     const py::array&, const py::array&, const py::array&, const py::array&, int>(),
            py::arg("points"), py::arg("corner"), py::arg("line_begin"), py::arg("closed"),
            py::arg("half_width"), py::arg("cap"), py::arg("join"), py::arg("miter_limit"),
            py::arg("arc"))
        .def("outlines", &VectorStrokes::outlines,
             "Vertices (K, 2), number of vertices of each contour, line of each contour.")
        .def("backward", &VectorStrokes::backward, py::arg("d_vertices"), py::arg("d_points"),
             py::arg("d_half_width"), "Adds to d_points and d_half_width.");
}

}  // namespace photograd
