// Multiresolution hash encoding [Mueller2022].
//
// Level l divides the unit square or cube into N_l cells along each axis. At each corner of a cell
// stands a row of F features, in the level's table of T_l rows: row i + (N_l + 1) (j + (N_l + 1) k)
// where all (N_l + 1)^D corners have rows of their own, and otherwise
//
//   row = (i pi_1 xor j pi_2 xor k pi_3) mod T_l,  pi = 1, 2654435761, 805459861   [Eq. 4]
//
// for several corners, which then share what they learn. A point takes the D-linear interpolation
// of the 2^D corners of its cell, sum over corners of prod_a w_a, w_a = f_a or 1 - f_a with f the
// position in the cell; smoothstep replaces f by f^2 (3 - 2 f), whose derivative is continuous.
//
// Adjoint: d_table[row of corner] += weight d_feature; d_p_a = N_l sum over corners of
// (dw_a / df_a) prod_{b != a} w_b  <features of corner, d_features>.
//
// In float the kernels of kernels/hash_encoding.inl do this for many points at once. Every sum runs
// in the order given here, corner by corner and point by point: the two agree bit for bit.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "kernels/kernels.h"
#include "photograd/core/parallel.h"
#include "photograd/core/real.h"
#include "photograd/ops/hash_cell.h"

namespace photograd {

struct HashLevel {
    std::int32_t resolution;   // cells along an axis
    std::int64_t first, rows;  // of the table of all levels
    bool dense;

    [[nodiscard]] std::uint32_t mask() const {
        return dense ? 0 : static_cast<std::uint32_t>(rows - 1);
    }
};

template <Real R, int D>
class HashEncoding {
public:
    HashEncoding(std::vector<HashLevel> levels, int features, bool smoothstep)
        : levels_(std::move(levels)), features_(features), smoothstep_(smoothstep) {}

    [[nodiscard]] const std::vector<HashLevel>& levels() const { return levels_; }
    [[nodiscard]] int features() const { return features_; }

    /// The cell of a point on a level: where its corners' rows are, and their weights.
    struct Corners {
        std::array<std::array<std::uint32_t, 2>, D> part;  // [axis][side] of the row
        std::array<std::array<R, 2>, D> weight, slope;     // and d weight / d position
        std::uint32_t mask;                                // 0 for a dense level

        [[nodiscard]] std::int64_t row(int corner) const {
            std::uint32_t sum = 0, hash = 0;
            for (std::size_t a = 0; a < D; ++a) {
                sum += part[a][corner >> a & 1];
                hash ^= part[a][corner >> a & 1];
            }
            return mask ? hash & mask : sum;
        }
        [[nodiscard]] R product(int corner) const {
            R w = weight[0][corner & 1];
            for (std::size_t a = 1; a < D; ++a) w *= weight[a][corner >> a & 1];
            return w;
        }
        [[nodiscard]] R product_slope(int corner, std::size_t axis) const {
            R w = slope[axis][corner >> axis & 1];
            for (std::size_t a = 0; a < D; ++a)
                if (a != axis) w *= weight[a][corner >> a & 1];
            return w;
        }
    };

    /// p in the unit cube; a point outside belongs to the border of the outermost cells.
    [[nodiscard]] Corners corners(const HashLevel& level, const R* p) const {
        Corners c;
        c.mask = level.mask();
        for (std::size_t a = 0; a < D; ++a) {
            const HashAxis<R> at = hash_axis(p[a], level.resolution, smoothstep_);
            c.weight[a] = {R(1) - at.weight, at.weight};
            c.slope[a] = {-at.slope, at.slope};
            const std::uint32_t factor =
                hash_factor(static_cast<int>(a), level.resolution, level.dense);
            c.part[a][0] = static_cast<std::uint32_t>(at.cell) * factor;
            c.part[a][1] = c.part[a][0] + factor;
        }
        return c;
    }

    /// Writes feature f of level l at sample s of [begin, end) to out[f * stride + s].
    void encode(std::size_t l, const R* table, const R* points, std::int64_t begin,
                std::int64_t end, std::int64_t stride, R* out) const {
        const R* rows = table + features_ * levels_[l].first;
        if constexpr (std::is_same_v<R, float>)
            return kernels().hash_encode({level_args(l, points), rows, out, stride}, begin, end);
        for (std::int64_t s = begin; s < end; ++s) {
            const Corners c = corners(levels_[l], points + D * s);
            for (int f = 0; f < features_; ++f) {
                R sum = c.product(0) * rows[features_ * c.row(0) + f];
                for (int k = 1; k < 1 << D; ++k)
                    sum += c.product(k) * rows[features_ * c.row(k) + f];
                out[f * stride + s] = sum;
            }
        }
    }

    /// Adds to the rows of level l that are numbers [first, last) of it the derivatives of samples
    /// [0, samples), in their order; d_out as encode's out.
    void scatter(std::size_t l, const R* points, std::int64_t samples, std::int64_t stride,
                 const R* d_out, R* d_table, std::int64_t first, std::int64_t last) const {
        R* rows = d_table + features_ * levels_[l].first;
        if constexpr (std::is_same_v<R, float>)
            return kernels().hash_scatter(
                {level_args(l, points), d_out, stride, rows, static_cast<std::uint32_t>(first),
                 static_cast<std::uint32_t>(last)},
                0, samples);
        for (std::int64_t s = 0; s < samples; ++s) {
            const Corners c = corners(levels_[l], points + D * s);
            for (int k = 0; k < 1 << D; ++k) {
                const std::int64_t row = c.row(k);
                if (row < first || row >= last) continue;
                for (int f = 0; f < features_; ++f)
                    rows[features_ * row + f] += c.product(k) * d_out[f * stride + s];
            }
        }
    }

    /// Adds to d_points (samples, D) of samples [begin, end) what level l contributes.
    void backward_points(std::size_t l, const R* table, const R* points, std::int64_t begin,
                         std::int64_t end, std::int64_t stride, const R* d_out, R* d_points) const {
        const R* rows = table + features_ * levels_[l].first;
        if constexpr (std::is_same_v<R, float>)
            return kernels().hash_points({level_args(l, points), rows, d_out, stride, d_points},
                                         begin, end);
        for (std::int64_t s = begin; s < end; ++s) {
            const Corners c = corners(levels_[l], points + D * s);
            for (int k = 0; k < 1 << D; ++k) {
                const R* from = rows + features_ * c.row(k);
                R along = from[0] * d_out[s];
                for (int f = 1; f < features_; ++f) along += from[f] * d_out[f * stride + s];
                for (std::size_t a = 0; a < D; ++a)
                    d_points[D * s + std::int64_t(a)] += c.product_slope(k, a) * along;
            }
        }
    }

    static constexpr int max_features = 8;

private:
    [[nodiscard]] HashLevelArgs level_args(std::size_t l, const float* points) const {
        const HashLevel& level = levels_[l];
        return {D,           features_,    level.resolution,
                smoothstep_, level.mask(), static_cast<std::uint32_t>(level.rows),
                points};
    }

    std::vector<HashLevel> levels_;
    int features_;
    bool smoothstep_;
};

/// Levels of these resolutions in tables of at most 2^log2_rows rows, one behind the other.
inline std::vector<HashLevel> hash_levels(std::span<const std::int32_t> resolutions, int dimensions,
                                          int log2_rows) {
    std::vector<HashLevel> levels;
    std::int64_t first = 0;
    for (const std::int32_t n : resolutions) {
        const std::int64_t most = std::int64_t{1} << log2_rows;
        std::int64_t corners = 1;
        for (int a = 0; a < dimensions && corners <= most; ++a) corners *= n + 1;
        const bool dense = corners <= most;
        levels.push_back({n, first, dense ? corners : most, dense});
        first += levels.back().rows;
    }
    return levels;
}

/// Rows of one task of a scatter: fewer levels than threads are cut into ranges of rows. How many
/// there are changes no sum.
struct HashPart {
    std::size_t level;
    std::int64_t first, last;
};
inline std::vector<HashPart> hash_parts(std::span<const HashLevel> levels) {
    const std::int64_t count = std::int64_t(levels.size()), threads = thread_count();
    const std::int64_t parts = count >= threads ? 1 : (2 * threads + count - 1) / count;
    std::vector<HashPart> found;
    // The finest level is the slowest, and comes first.
    for (std::size_t l = levels.size(); l-- > 0;)
        for (std::int64_t k = 0; k < parts; ++k)
            found.push_back({l, levels[l].rows * k / parts, levels[l].rows * (k + 1) / parts});
    return found;
}

/// Samples whose features are brought into another order at a time.
inline constexpr std::int64_t hash_slab = 1 << 18, hash_piece = 8192;

namespace detail {
/// visit(begin, end) for pieces of [0, samples), on all threads.
template <class Visit>
void for_pieces(std::int64_t samples, Visit&& visit) {
    parallel_for((samples + hash_piece - 1) / hash_piece, [&](std::int64_t k) {
        visit(k * hash_piece, std::min((k + 1) * hash_piece, samples));
    });
}
/// visit(a, b) for all entries rows[s * width + f] = a, columns[f * stride + s] = b of samples
/// [begin, end), in tiles.
template <class Rows, class Columns, class Visit>
void for_transposed(Rows* rows, Columns* columns, std::int64_t width, std::int64_t stride,
                    std::int64_t begin, std::int64_t end, Visit&& visit) {
    constexpr std::int64_t tile = 16;
    for (std::int64_t first = begin; first < end; first += tile)
        for (std::int64_t f = 0; f < width; ++f)
            for (std::int64_t s = first; s < std::min(first + tile, end); ++s)
                visit(rows[s * width + f], columns[f * stride + s]);
}
}  // namespace detail

/// Writes features (samples, levels F).
template <Real R, int D>
void hash_encode(const HashEncoding<R, D>& e, const R* table, const R* points, std::int64_t samples,
                 R* out) {
    const std::int64_t width = std::int64_t(e.levels().size()) * e.features();
    const std::int64_t stride = std::min(samples, hash_slab);
    const auto columns =
        std::make_unique_for_overwrite<R[]>(static_cast<std::size_t>(width * stride));
    for (std::int64_t first = 0; first < samples; first += stride) {
        const std::int64_t count = std::min(stride, samples - first);
        // Level by level, so that one table at a time is in the cache.
        for (std::size_t l = 0; l < e.levels().size(); ++l)
            detail::for_pieces(count, [&](std::int64_t begin, std::int64_t end) {
                e.encode(l, table, points + D * first, begin, end, stride,
                         columns.get() + std::int64_t(l) * e.features() * stride);
            });
        detail::for_pieces(count, [&](std::int64_t begin, std::int64_t end) {
            detail::for_transposed(out + width * first, columns.get(), width, stride, begin, end,
                                   [](R& row, R column) { row = column; });
        });
    }
}

/// Adds to d_table (rows, F), and to d_points (samples, D) unless null.
template <Real R, int D>
void hash_encode_backward(const HashEncoding<R, D>& e, const R* table, const R* points,
                          std::int64_t samples, const R* d_out, R* d_table, R* d_points) {
    const std::int64_t width = std::int64_t(e.levels().size()) * e.features();
    const std::int64_t stride = std::min(samples, hash_slab);
    const auto columns =
        std::make_unique_for_overwrite<R[]>(static_cast<std::size_t>(width * stride));
    const std::vector<HashPart> parts = hash_parts(e.levels());
    for (std::int64_t first = 0; first < samples; first += stride) {
        const std::int64_t count = std::min(stride, samples - first);
        const R* p = points + D * first;
        const auto of_level = [&](std::size_t l) {
            return columns.get() + std::int64_t(l) * e.features() * stride;
        };
        detail::for_pieces(count, [&](std::int64_t begin, std::int64_t end) {
            detail::for_transposed(d_out + width * first, columns.get(), width, stride, begin, end,
                                   [](R row, R& column) { column = row; });
        });
        parallel_for(std::int64_t(parts.size()), [&](std::int64_t k) {
            const HashPart& part = parts[static_cast<std::size_t>(k)];
            e.scatter(part.level, p, count, stride, of_level(part.level), d_table, part.first,
                      part.last);
        });
        if (!d_points) continue;
        detail::for_pieces(count, [&](std::int64_t begin, std::int64_t end) {
            for (std::size_t l = 0; l < e.levels().size(); ++l)
                e.backward_points(l, table, p, begin, end, stride, of_level(l),
                                  d_points + D * first);
        });
    }
}

}  // namespace photograd
