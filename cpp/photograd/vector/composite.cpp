#include "photograd/vector/composite.h"

#include <algorithm>

#include "photograd/core/scatter.h"

namespace photograd {
namespace {

using Color = std::array<double, 4>;

/// visit(color, x, i) for the pixels of a span: what the paint is at pixel x, value number i.
template <class Visit>
void for_pixels(const AreaSpan& span, const Paint& paint, Visit&& visit) {
    const bool solid = paint.kind == PaintKind::solid;
    Color color = solid ? paint_color(paint, {0, 0}) : Color{};
    for (int k = 0; k < span.count; ++k) {
        const int x = span.x0 + k;
        if (!solid) color = paint_color(paint, {x + 0.5, span.row + 0.5});
        visit(color, static_cast<std::size_t>(x), span.first + static_cast<std::size_t>(k));
    }
}

/// The spans of row y over the background in `row` (W, 4); before(i, pixel) sees each pixel before
/// the span of value number i is put over it.
template <class Before>
void draw_row(const ShapeAreas& coverage, const PaintTable& paints, std::size_t y, double* row,
              Before&& before) {
    for (int x = 0; x < coverage.width(); ++x)
        std::copy_n(paints.background, 4, row + 4 * static_cast<std::size_t>(x));
    for (std::size_t s = coverage.row_begin()[y]; s < coverage.row_begin()[y + 1]; ++s) {
        const AreaSpan& span = coverage.spans()[s];
        const double opacity = paints.opacity[span.shape];
        for_pixels(span, paints.paint(span.shape),
                   [&](const Color& color, std::size_t x, std::size_t i) {
                       double* pixel = row + 4 * x;
                       before(i, pixel);
                       const double a = coverage.values()[i] * opacity * color[3];
                       for (std::size_t c = 0; c < 4; ++c)
                           pixel[c] += a * ((c < 3 ? color[c] : 1.0) - pixel[c]);
                   });
    }
}

/// Gradients of one span: opacity, geometry (4,), offsets (K,), colors (K, 4).
std::size_t share_size(std::size_t stops) { return 5 + 5 * stops; }

}  // namespace

void composite(const ShapeAreas& coverage, const PaintTable& paints, double* out) {
    const std::size_t width = static_cast<std::size_t>(coverage.width());
    parallel_for(coverage.height(), [&](std::int64_t y) {
        const auto row = static_cast<std::size_t>(y);
        draw_row(coverage, paints, row, out + 4 * row * width, [](std::size_t, const double*) {});
    });
}

namespace {

/// One row: writes d_values of its spans, and the sums over their pixels to `shares`, span after
/// span from share[s]; `g` (W, 4) is dL/d of the row, and becomes dL/d of the background.
void row_backward(const ShapeAreas& coverage, const PaintTable& paints, std::size_t y,
                  std::span<const std::size_t> share, double* g, std::span<double> d_values,
                  std::span<double> shares) {
    const std::size_t begin = coverage.row_begin()[y], end = coverage.row_begin()[y + 1];
    if (begin == end) return;
    const std::span<const AreaSpan> spans = coverage.spans();
    const std::size_t first = spans[begin].first;
    const std::size_t past = spans[end - 1].first + static_cast<std::size_t>(spans[end - 1].count);
    std::vector<double> row(4 * static_cast<std::size_t>(coverage.width()));
    std::vector<double> under(4 * (past - first));
    draw_row(coverage, paints, y, row.data(), [&](std::size_t i, const double* pixel) {
        std::copy_n(pixel, 4, &under[4 * (i - first)]);
    });
    for (std::size_t s = end; s-- > begin;) {
        const AreaSpan& span = spans[s];
        const Paint paint = paints.paint(span.shape);
        double* own = &shares[share[s]];
        const double opacity = paints.opacity[span.shape];
        for_pixels(span, paint, [&](const Color& color, std::size_t x, std::size_t i) {
            const double covered = coverage.values()[i];
            const double a = covered * opacity * color[3];
            double d_a = 0;
            Color d_color;
            for (std::size_t c = 0; c < 4; ++c) {
                double& g_c = g[4 * x + c];
                d_a += g_c * ((c < 3 ? color[c] : 1.0) - under[4 * (i - first) + c]);
                d_color[c] = a * g_c;
                g_c *= 1 - a;
            }
            d_color[3] = d_a * covered * opacity;
            d_values[i] = d_a * opacity * color[3];
            own[0] += d_a * covered * color[3];
            paint_color_backward(paint, {double(x) + 0.5, span.row + 0.5}, d_color, own + 1,
                                 own + 5, own + 5 + paint.offsets.size());
        });
    }
}

}  // namespace

void composite_backward(const ShapeAreas& coverage, const PaintTable& paints, const double* d_out,
                        std::span<double> d_values, const PaintGradients& gradients) {
    const std::size_t numbers = 4 * static_cast<std::size_t>(coverage.width());
    const std::span<const AreaSpan> spans = coverage.spans();
    std::vector<std::size_t> share(spans.size() + 1, 0);
    for (std::size_t s = 0; s < spans.size(); ++s)
        share[s + 1] = share[s] + share_size(paints.stop_count(spans[s].shape));
    std::vector<double> shares(share.back(), 0.0);
    std::vector<double> d_under(numbers * static_cast<std::size_t>(coverage.height()));
    parallel_for(coverage.height(), [&](std::int64_t y) {
        const auto row = static_cast<std::size_t>(y);
        std::copy_n(d_out + numbers * row, numbers, &d_under[numbers * row]);
        row_backward(coverage, paints, row, share, &d_under[numbers * row], d_values, shares);
    });
    for (std::size_t k = 0; k < d_under.size(); ++k) gradients.background[k % 4] += d_under[k];
    std::vector<std::uint32_t> owner(spans.size());
    for (std::size_t s = 0; s < spans.size(); ++s) owner[s] = spans[s].shape;
    OwnerBins bins;
    bin_by_owner(owner, static_cast<int>(coverage.shape_count()), bins);
    parallel_for(static_cast<std::int64_t>(coverage.shape_count()), [&](std::int64_t number) {
        const auto shape = static_cast<std::size_t>(number);
        const std::size_t stops = paints.stop_count(shape);
        const auto stop = static_cast<std::size_t>(paints.stop_begin[shape]);
        for (std::uint32_t k = bins.begin[shape]; k < bins.begin[shape + 1]; ++k) {
            const double* own = &shares[share[bins.order[k]]];
            gradients.opacity[shape] += own[0];
            for (std::size_t i = 0; i < 4; ++i) gradients.geometry[4 * shape + i] += own[1 + i];
            for (std::size_t i = 0; i < stops; ++i) gradients.offsets[stop + i] += own[5 + i];
            for (std::size_t i = 0; i < 4 * stops; ++i)
                gradients.colors[4 * stop + i] += own[5 + stops + i];
        }
    });
}

}  // namespace photograd
