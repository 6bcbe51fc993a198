#include "photograd/vector/shape_areas.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "photograd/core/scatter.h"

namespace photograd {
namespace {

constexpr std::uint64_t most_meetings = std::uint64_t{1} << 28;
constexpr std::uint64_t most_pixels = std::uint64_t{1} << 28;

/// Rows [first, end) of a picture that an edge meets; none where it lies to the right of all.
std::pair<std::int64_t, std::int64_t> rows_of(Vec2<double> a, Vec2<double> b, int height,
                                              int width) {
    if (std::min(a.x, b.x) >= width) return {0, 0};
    const double top = std::floor(std::min(a.y, b.y));
    const double bottom = a.y == b.y ? top + 1 : std::ceil(std::max(a.y, b.y));
    return {static_cast<std::int64_t>(std::clamp(top, 0.0, double(height))),
            static_cast<std::int64_t>(std::clamp(bottom, 0.0, double(height)))};
}

/// The edges that meet each row, in their order.
OwnerBins edges_by_row(const Contours& contours, std::span<const std::uint32_t> next, int height,
                       int width) {
    const auto rows = [&](std::size_t v) {
        return rows_of(contours.vertex(v), contours.vertex(next[v]), height, width);
    };
    std::vector<std::uint64_t> count(static_cast<std::size_t>(height) + 1, 0);
    for (std::size_t v = 0; v < next.size(); ++v)
        for (auto [y, end] = rows(v); y < end; ++y) ++count[static_cast<std::size_t>(y) + 1];
    for (std::size_t y = 1; y < count.size(); ++y) count[y] += count[y - 1];
    if (count.back() > most_meetings)
        throw std::length_error("edges that meet rows of pixels more than 2^28 times");
    OwnerBins bins;
    bins.begin.assign(count.begin(), count.end());
    bins.order.resize(count.back());
    for (std::size_t v = 0; v < next.size(); ++v)
        for (auto [y, end] = rows(v); y < end; ++y)
            bins.order[count[static_cast<std::size_t>(y)]++] = static_cast<std::uint32_t>(v);
    return bins;
}

/// (V,) the shape of the edge that starts at each vertex.
std::vector<std::uint32_t> shapes_of_edges(const Contours& contours) {
    std::vector<std::uint32_t> shape(contours.vertex_count());
    for (std::size_t s = 0; s < contours.shape_count(); ++s) {
        const auto first = static_cast<std::size_t>(contours.shape_begin[s]);
        const auto end = static_cast<std::size_t>(contours.shape_begin[s + 1]);
        std::fill(shape.begin() + contours.contour_begin[first],
                  shape.begin() + contours.contour_begin[end], static_cast<std::uint32_t>(s));
    }
    return shape;
}

/// At most so many pixels of spans: from the leftmost to the rightmost vertex of the edges of a
/// shape in a row, or to the border where the shape may reach it.
std::uint64_t count_pixels(const Contours& contours, std::span<const std::uint32_t> next,
                           std::span<const std::uint32_t> shape_of, const OwnerBins& bins,
                           int height, int width) {
    std::vector<double> reach(contours.shape_count(), 0.0);
    for (std::size_t v = 0; v < next.size(); ++v)
        reach[shape_of[v]] = std::max(reach[shape_of[v]], contours.vertex(v).x);
    std::uint64_t total = 0;
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y)
        for (std::uint32_t k = bins.begin[y]; k < bins.begin[y + 1];) {
            const std::uint32_t shape = shape_of[bins.order[k]];
            double low = width, high = reach[shape] < width ? 0 : width;
            for (; k < bins.begin[y + 1] && shape_of[bins.order[k]] == shape; ++k)
                for (const std::uint32_t v : {bins.order[k], next[bins.order[k]]}) {
                    low = std::min(low, contours.vertex(v).x);
                    high = std::max(high, contours.vertex(v).x);
                }
            total += static_cast<std::uint64_t>(std::min(high + 1, double(width)) -
                                                std::clamp(low, 0.0, double(width)) + 1);
        }
    return total;
}

/// visit(column, u0, u1) for the parts of a line from x = x0 to x = x1 in each column, u in [0, 1]
/// along it.
template <class Visit>
void for_columns(double x0, double x1, Visit&& visit) {
    const double low = std::floor(std::min(x0, x1));
    if (x0 == x1 || std::max(x0, x1) <= low + 1) return visit(low, 0.0, 1.0);
    const double step = x1 > x0 ? 1 : -1;
    // Of a line that ends on a border, nothing is in the next column.
    double column = x1 > x0 ? low : std::ceil(x0) - 1, u = 0;
    while (u < 1) {
        const double border = step > 0 ? column + 1 : column;
        const double at = (border - x0) / (x1 - x0), end = at < 1 ? std::max(at, u) : 1.0;
        visit(column, u, end);
        u = end;
        column += step;
    }
}

/// The part [u0, u1] of a line from x = x0 to x = x1 that lies within [low, high].
std::pair<double, double> within(double x0, double x1, double low, double high) {
    if (x0 == x1) return x0 >= low && x0 < high ? std::pair(0.0, 1.0) : std::pair(1.0, 0.0);
    const double a = (low - x0) / (x1 - x0), b = (high - x0) / (x1 - x0);
    return {std::clamp(std::min(a, b), 0.0, 1.0), std::clamp(std::max(a, b), 0.0, 1.0)};
}

}  // namespace

/// One row's share, before all rows are put together.
struct ShapeAreas::Row {
    std::vector<AreaSpan> spans;
    std::vector<double> values;
    std::vector<StoredPiece> pieces;
};

ShapeAreas::ShapeAreas(const Contours& contours, int height, int width)
    : height_(height), width_(width), shape_count_(contours.shape_count()) {
    const std::vector<std::uint32_t> next = contours.next_vertices();
    const std::vector<std::uint32_t> shape_of = shapes_of_edges(contours);
    const OwnerBins bins = edges_by_row(contours, next, height, width);
    if (count_pixels(contours, next, shape_of, bins, height, width) > most_pixels)
        throw std::length_error("shapes that cover pixels more than 2^28 times");
    std::vector<Row> rows(static_cast<std::size_t>(height));
    parallel_for(height, [&](std::int64_t y) {
        const auto row = static_cast<std::size_t>(y);
        fill_row(contours, next, shape_of,
                 std::span<const std::uint32_t>(bins.order)
                     .subspan(bins.begin[row], bins.begin[row + 1] - bins.begin[row]),
                 static_cast<int>(y), rows[row]);
    });
    row_begin_.push_back(0);
    for (Row& row : rows) {
        const auto spans_before = static_cast<std::uint32_t>(spans_.size());
        for (AreaSpan& span : row.spans) span.first += values_.size();
        for (StoredPiece& piece : row.pieces) piece.span += spans_before;
        spans_.insert(spans_.end(), row.spans.begin(), row.spans.end());
        values_.insert(values_.end(), row.values.begin(), row.values.end());
        pieces_.insert(pieces_.end(), row.pieces.begin(), row.pieces.end());
        row_begin_.push_back(spans_.size());
        row = Row{};
    }
}

void ShapeAreas::fill_row(const Contours& contours, std::span<const std::uint32_t> next,
                          std::span<const std::uint32_t> shape_of,
                          std::span<const std::uint32_t> edges, int row, Row& out) const {
    RowBoundary boundary;
    std::vector<double> sums;
    for (std::size_t first = 0, end = 0; first < edges.size(); first = end) {
        const std::uint32_t shape = shape_of[edges[first]];
        double low = width_, high = 0;
        for (; end < edges.size() && shape_of[edges[end]] == shape; ++end)
            for (const std::uint32_t v : {edges[end], next[edges[end]]}) {
                low = std::min(low, contours.vertex(v).x);
                high = std::max(high, contours.vertex(v).x);
            }
        boundary.find(contours, next, edges.subspan(first, end - first), row,
                      static_cast<FillRule>(contours.rule[shape]));
        if (boundary.pieces().empty()) continue;
        const int x0 = static_cast<int>(std::max(0.0, std::floor(low)));
        const int last =
            std::max(static_cast<int>(std::min(double(width_), std::floor(high) + 1)), x0 + 1);
        sums.assign(static_cast<std::size_t>(last - x0) + 1, 0.0);
        const auto span_number = static_cast<std::uint32_t>(out.spans.size());
        for (const BoundaryPiece& piece : boundary.pieces()) {
            out.pieces.push_back({piece.edge, span_number, piece.t0, piece.t1, piece.sign});
            add_area(piece, contours.vertex(piece.edge), contours.vertex(next[piece.edge]), x0,
                     sums);
        }
        const std::size_t begin = out.values.size();
        double covered = 0;
        for (const double sum : sums) out.values.push_back(std::clamp(covered += sum, 0.0, 1.0));
        // Edges to the right of the picture were left out: the shape reaches its border.
        const bool open = out.values.back() > 1e-9;
        out.values.pop_back();
        const int count = (open ? width_ : last) - x0;
        out.values.resize(begin + static_cast<std::size_t>(count), std::clamp(covered, 0.0, 1.0));
        out.spans.push_back({shape, row, x0, count, begin});
    }
}

/// Adds a piece's share: the area to its right, as differences between neighboring pixels.
void ShapeAreas::add_area(const BoundaryPiece& piece, Vec2<double> a, Vec2<double> b, int x0,
                          std::span<double> sums) const {
    const double height = piece.y1 - piece.y0;
    if (height <= 0) return;
    const bool down = b.y > a.y;
    // Where the shape begins, the area to the right counts.
    const double area = piece.sign * (down ? -height : height);
    const double from = a.x + piece.t0 * (b.x - a.x), to = a.x + piece.t1 * (b.x - a.x);
    const auto last = static_cast<double>(sums.size() - 1);
    const auto add = [&](double column, double share, double mean) {
        const auto i = static_cast<std::size_t>(column);
        if (i + 1 >= sums.size()) return;
        sums[i] += area * share * (1 - mean);
        sums[i + 1] += area * share * mean;
    };
    // What lies before the first column covers all of it.
    const auto [u0, u1] = within(from, to, x0, x0 + last);
    if (from < x0)
        add(0, to < x0 ? 1 : u0, 0);
    else if (to < x0)
        add(0, 1 - u1, 0);
    if (u0 >= u1) return;
    const double start = std::clamp(from + u0 * (to - from) - x0, 0.0, last);
    const double end = std::clamp(from + u1 * (to - from) - x0, 0.0, last);
    for_columns(start, end, [&](double column, double v0, double v1) {
        const double mean = start + 0.5 * (v0 + v1) * (end - start) - column;
        add(column, (u1 - u0) * (v1 - v0), mean);
    });
}

void ShapeAreas::backward(const Contours& contours, std::span<const double> d_values,
                          double* d_vertices) const {
    const std::vector<std::uint32_t> next = contours.next_vertices();
    const auto edges = static_cast<std::int64_t>(next.size());
    std::vector<std::uint32_t> owner(pieces_.size());
    for (std::size_t i = 0; i < owner.size(); ++i) owner[i] = pieces_[i].edge;
    OwnerBins bins;
    bin_by_owner(owner, static_cast<int>(edges), bins);
    // With respect to the ends of each edge; dA = sign <m, n> with n = (dy, -dx).
    std::vector<Vec2<double>> d_start(next.size()), d_end(next.size());
    constexpr std::int64_t piece_size = 1024;
    parallel_for((edges + piece_size - 1) / piece_size, [&](std::int64_t p) {
        for (std::int64_t k = p * piece_size; k < std::min(edges, (p + 1) * piece_size); ++k) {
            const auto v = static_cast<std::size_t>(k);
            const Vec2<double> a = contours.vertex(v), b = contours.vertex(next[v]), d = b - a;
            double first = 0, second = 0;  // integrals of g and of g t
            for (std::uint32_t i = bins.begin[v]; i < bins.begin[v + 1]; ++i) {
                const StoredPiece& piece = pieces_[bins.order[i]];
                const AreaSpan& span = spans_[piece.span];
                const double from = a.x + piece.t0 * d.x, to = a.x + piece.t1 * d.x;
                const auto [low, high] = within(from, to, span.x0, span.x0 + span.count);
                if (low >= high) continue;
                const double t0 = piece.t0 + low * (piece.t1 - piece.t0);
                const double t1 = piece.t0 + high * (piece.t1 - piece.t0);
                for_columns(
                    a.x + t0 * d.x, a.x + t1 * d.x, [&](double column, double u0, double u1) {
                        const double x = std::clamp(column - span.x0, 0.0, span.count - 1.0);
                        const double g =
                            piece.sign * d_values[span.first + static_cast<std::size_t>(x)];
                        const double s0 = t0 + u0 * (t1 - t0), s1 = t0 + u1 * (t1 - t0);
                        first += g * (s1 - s0);
                        second += g * 0.5 * (s1 * s1 - s0 * s0);
                    });
            }
            const Vec2<double> normal(d.y, -d.x);
            d_start[v] = (first - second) * normal;
            d_end[v] = second * normal;
        }
    });
    for (std::size_t v = 0; v < next.size(); ++v)
        for (int i = 0; i < 2; ++i) {
            d_vertices[2 * v + static_cast<std::size_t>(i)] += d_start[v][i];
            d_vertices[2 * next[v] + static_cast<std::size_t>(i)] += d_end[v][i];
        }
}

}  // namespace photograd
