#include "photograd/frame/bloom.h"

#include <vector>

#include "photograd/frame/chunk_sums.h"

namespace photograd {
namespace {

std::int64_t half(std::int64_t n) { return (n + 1) / 2; }
std::int64_t mirrored(std::int64_t i, std::int64_t n) {
    if (n == 1) return 0;
    if (i < 0) return std::min(-1 - i, n - 1);
    return i < n ? i : std::max<std::int64_t>(2 * n - 1 - i, 0);
}

/// A linear map of lines: line i of the output is the sum over k of weight(i, k) times line
/// source(i, k) of the input.
struct Halving {
    static constexpr int taps = 4;
    std::int64_t n;
    [[nodiscard]] std::int64_t source(std::int64_t i, int k) const {
        return mirrored(2 * i - 1 + k, n);
    }
    [[nodiscard]] static double weight(std::int64_t, int k) {
        return k == 0 || k == 3 ? 0.125 : 0.375;
    }
};
struct Doubling {
    static constexpr int taps = 2;
    std::int64_t n;
    [[nodiscard]] std::int64_t source(std::int64_t i, int k) const {
        const std::int64_t j = i / 2 + (k == 0 ? 0 : i % 2 == 0 ? -1 : 1);
        return std::clamp<std::int64_t>(j, 0, n - 1);
    }
    [[nodiscard]] static double weight(std::int64_t, int k) { return k == 0 ? 0.75 : 0.25; }
};

template <class R>
struct Picture {
    FrameSize size;
    std::vector<R> values;
    explicit Picture(FrameSize s)
        : size(s), values(static_cast<std::size_t>(3 * s.height * s.width), R(0)) {}
    R* row(std::int64_t y) { return values.data() + 3 * y * size.width; }
    const R* row(std::int64_t y) const { return values.data() + 3 * y * size.width; }
};

/// Rows of `out` from rows of `in`.
template <class R, class Map>
void along_y(const Map& map, const Picture<R>& in, Picture<R>& out) {
    const std::int64_t width = 3 * in.size.width;
    parallel_for(out.size.height, [&](std::int64_t y) {
        R* to = out.row(y);
        for (int k = 0; k < Map::taps; ++k) {
            const R weight = R(Map::weight(y, k));
            const R* from = in.row(map.source(y, k));
            for (std::int64_t x = 0; x < width; ++x) to[x] += weight * from[x];
        }
    });
}
template <class R, class Map>
void along_y_backward(const Map& map, const Picture<R>& d_out, Picture<R>& d_in) {
    constexpr std::int64_t strip = 128;  // columns that one piece of work owns
    const std::int64_t width = 3 * d_in.size.width;
    parallel_for((width + strip - 1) / strip, [&](std::int64_t s) {
        const std::int64_t first = s * strip, last = std::min(width, first + strip);
        for (std::int64_t y = 0; y < d_out.size.height; ++y)
            for (int k = 0; k < Map::taps; ++k) {
                const R weight = R(Map::weight(y, k));
                const R* from = d_out.row(y);
                R* to = d_in.row(map.source(y, k));
                for (std::int64_t x = first; x < last; ++x) to[x] += weight * from[x];
            }
    });
}
template <class R, class Map>
void along_x(const Map& map, const Picture<R>& in, Picture<R>& out) {
    parallel_for(out.size.height, [&](std::int64_t y) {
        const R* from = in.row(y);
        R* to = out.row(y);
        for (std::int64_t x = 0; x < out.size.width; ++x)
            for (int k = 0; k < Map::taps; ++k)
                for (int c = 0; c < 3; ++c)
                    to[3 * x + c] += R(Map::weight(x, k)) * from[3 * map.source(x, k) + c];
    });
}
template <class R, class Map>
void along_x_backward(const Map& map, const Picture<R>& d_out, Picture<R>& d_in) {
    parallel_for(d_out.size.height, [&](std::int64_t y) {
        const R* from = d_out.row(y);
        R* to = d_in.row(y);
        for (std::int64_t x = 0; x < d_out.size.width; ++x)
            for (int k = 0; k < Map::taps; ++k)
                for (int c = 0; c < 3; ++c)
                    to[3 * map.source(x, k) + c] += R(Map::weight(x, k)) * from[3 * x + c];
    });
}

template <class R>
Picture<R> halved(const Picture<R>& in) {
    Picture<R> rows({half(in.size.height), in.size.width});
    along_y(Halving{in.size.height}, in, rows);
    Picture<R> out({rows.size.height, half(in.size.width)});
    along_x(Halving{in.size.width}, rows, out);
    return out;
}
/// Adds the adjoint of `halved` to d_in.
template <class R>
void halved_backward(const Picture<R>& d_out, Picture<R>& d_in) {
    Picture<R> d_rows({d_out.size.height, d_in.size.width});
    along_x_backward(Halving{d_in.size.width}, d_out, d_rows);
    along_y_backward(Halving{d_in.size.height}, d_rows, d_in);
}
/// Adds `in`, at twice its size, to out.
template <class R>
void add_doubled(const Picture<R>& in, Picture<R>& out) {
    Picture<R> rows({out.size.height, in.size.width});
    along_y(Doubling{in.size.height}, in, rows);
    along_x(Doubling{in.size.width}, rows, out);
}
template <class R>
void doubled_backward(const Picture<R>& d_out, Picture<R>& d_in) {
    Picture<R> d_rows({d_out.size.height, d_in.size.width});
    along_x_backward(Doubling{d_in.size.width}, d_out, d_rows);
    along_y_backward(Doubling{d_in.size.height}, d_rows, d_in);
}

template <class R>
Picture<R> brights(FrameSize size, const R* color, R threshold) {
    Picture<R> out(size);
    for_chunks(static_cast<std::int64_t>(out.values.size()), [&](std::int64_t, std::int64_t first,
                                                                 std::int64_t last) {
        for (std::int64_t i = first; i < last; ++i)
            out.values[static_cast<std::size_t>(i)] = std::max(color[i] - threshold, R(0));
    });
    return out;
}

/// {bright, D bright, D^2 bright, ...}
template <class R>
std::vector<Picture<R>> pyramid(FrameSize size, const R* color, R threshold, int levels) {
    std::vector<Picture<R>> out{brights(size, color, threshold)};
    for (int l = 0; l < levels; ++l) out.push_back(halved(out.back()));
    return out;
}

template <class R>
R sum_of(const R* weights, int levels) {
    R sum = R(0);
    for (int l = 0; l < levels; ++l) sum += weights[l];
    return sum;
}

}  // namespace

template <Real R>
void bloom(FrameSize size, const R* color, R threshold, const R* weights, int levels, R* out) {
    std::vector<Picture<R>> level = pyramid(size, color, threshold, levels);
    const Picture<R> bright = level[0];
    const R total = sum_of(weights, levels);
    for (int l = levels; l >= 0; --l) {
        Picture<R>& own = level[static_cast<std::size_t>(l)];
        const R weight = l == 0 ? R(0) : weights[l - 1];
        for (R& value : own.values) value *= weight;
        if (l < levels) add_doubled(level[static_cast<std::size_t>(l) + 1], own);
    }
    const R *spread = level[0].values.data(), *taken = bright.values.data();
    for_chunks(3 * size.height * size.width,
               [&](std::int64_t, std::int64_t first, std::int64_t last) {
                   for (std::int64_t i = first; i < last; ++i)
                       out[i] = color[i] + (spread[i] - total * taken[i]);
               });
}

template <Real R>
void bloom_backward(FrameSize size, const R* color, R threshold, const R* weights, int levels,
                    const R* d_out, R* d_color, R* d_weights, R* d_threshold) {
    const std::vector<Picture<R>> level = pyramid(size, color, threshold, levels);
    const std::int64_t count = 3 * size.height * size.width;
    Picture<R> d_spread(size);
    std::copy(d_out, d_out + count, d_spread.values.begin());
    // Of the sum on each level, from the first to the last; then of the levels themselves.
    std::vector<Picture<R>> d_sum{d_spread};
    for (int l = 1; l <= levels; ++l) {
        Picture<R> d_own(level[static_cast<std::size_t>(l)].size);
        doubled_backward(d_sum.back(), d_own);
        d_sum.push_back(std::move(d_own));
    }
    R d_total = R(0);
    for (std::size_t i = 0; i < d_spread.values.size(); ++i)
        d_total -= d_spread.values[i] * level[0].values[i];
    Picture<R> d_level = d_sum.back();
    for (int l = levels; l >= 1; --l) {
        const auto at = static_cast<std::size_t>(l);
        R d_weight = R(0);
        for (std::size_t i = 0; i < level[at].values.size(); ++i)
            d_weight += d_sum[at].values[i] * level[at].values[i];
        d_weights[l - 1] += d_weight + d_total;
        // d_level holds what comes from the levels below this one.
        if (l == levels) std::fill(d_level.values.begin(), d_level.values.end(), R(0));
        for (std::size_t i = 0; i < d_level.values.size(); ++i)
            d_level.values[i] += weights[l - 1] * d_sum[at].values[i];
        Picture<R> d_above(level[at - 1].size);
        halved_backward(d_level, d_above);
        d_level = std::move(d_above);
    }
    const R total = sum_of(weights, levels);
    R d_below = R(0);
    for (std::int64_t i = 0; i < count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const R d_bright = d_level.values[at] - total * d_out[i];
        const bool bright = color[i] > threshold;
        d_color[i] += d_out[i] + (bright ? d_bright : R(0));
        d_below -= bright ? d_bright : R(0);
    }
    *d_threshold += d_below;
}

template void bloom(FrameSize, const float*, float, const float*, int, float*);
template void bloom(FrameSize, const double*, double, const double*, int, double*);
template void bloom_backward(FrameSize, const float*, float, const float*, int, const float*,
                             float*, float*, float*);
template void bloom_backward(FrameSize, const double*, double, const double*, int, const double*,
                             double*, double*, double*);

}  // namespace photograd
