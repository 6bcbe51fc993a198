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
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "photograd/core/parallel.h"
#include "photograd/core/real.h"

namespace photograd {

struct HashLevel {
    std::int32_t resolution;   // cells along an axis
    std::int64_t first, rows;  // of the table of all levels
    bool dense;
};

/// Where a level's features are written: feature f of sample s at [s * sample + f * feature].
struct FeatureStride {
    std::int64_t sample, feature;
};

template <Real R, int D>
class HashEncoding {
public:
    HashEncoding(std::vector<HashLevel> levels, int features, bool smoothstep)
        : levels_(std::move(levels)), features_(features), smoothstep_(smoothstep) {}

    [[nodiscard]] const std::vector<HashLevel>& levels() const { return levels_; }
    [[nodiscard]] int features() const { return features_; }

    /// The cell of a point on a level: rows and weights of its corners.
    struct Corners {
        std::array<std::int64_t, 1 << D> row;
        std::array<std::array<R, 2>, D> weight, slope;  // [axis][side], and d weight / d position

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

    /// p in the unit cube; what lies outside belongs to the outermost cells' border.
    [[nodiscard]] Corners corners(const HashLevel& level, const R* p) const {
        Corners c;
        const R n = static_cast<R>(level.resolution);
        std::uint32_t low[D];
        for (std::size_t a = 0; a < D; ++a) {
            const R inside = p[a] > R(0) ? (p[a] < R(1) ? p[a] : R(1)) : R(0), at = inside * n;
            const R cell = std::min(static_cast<R>(static_cast<std::int32_t>(at)), n - R(1));
            const R f = at - cell, rate = inside == p[a] ? n : R(0);
            low[a] = static_cast<std::uint32_t>(cell);
            const R w = smoothstep_ ? f * f * (R(3) - R(2) * f) : f;
            const R dw = rate * (smoothstep_ ? R(6) * f * (R(1) - f) : R(1));
            c.weight[a] = {R(1) - w, w};
            c.slope[a] = {-dw, dw};
        }
        for (int k = 0; k < 1 << D; ++k) c.row[static_cast<std::size_t>(k)] = row(level, low, k);
        return c;
    }

    /// Features of samples [begin, end) of one level, behind those of the levels before it.
    void encode(std::size_t l, const R* table, const R* points, std::int64_t begin,
                std::int64_t end, FeatureStride stride, R* out) const {
        const HashLevel& level = levels_[l];
        for (std::int64_t s = begin; s < end; ++s) {
            const Corners c = corners(level, points + D * s);
            R* to = out + s * stride.sample + std::int64_t(l) * features_ * stride.feature;
            for (int f = 0; f < features_; ++f) to[f * stride.feature] = R(0);
            for (int k = 0; k < 1 << D; ++k) {
                const R w = c.product(k);
                const R* from = table + features_ * (level.first + c.row[std::size_t(k)]);
                for (int f = 0; f < features_; ++f) to[f * stride.feature] += w * from[f];
            }
        }
    }

    /// Adds to d_table what all samples of one level ask for, in their order.
    void scatter(std::size_t l, const R* points, std::int64_t samples, FeatureStride stride,
                 const R* d_out, R* d_table) const {
        const HashLevel& level = levels_[l];
        for (std::int64_t s = 0; s < samples; ++s) {
            const Corners c = corners(level, points + D * s);
            const R* d = d_out + s * stride.sample + std::int64_t(l) * features_ * stride.feature;
            for (int k = 0; k < 1 << D; ++k) {
                const R w = c.product(k);
                R* to = d_table + features_ * (level.first + c.row[std::size_t(k)]);
                for (int f = 0; f < features_; ++f) to[f] += w * d[f * stride.feature];
            }
        }
    }

    /// Adds to d_points (samples, D) of samples [begin, end), for all levels.
    void backward_points(const R* table, const R* points, std::int64_t begin, std::int64_t end,
                         FeatureStride stride, const R* d_out, R* d_points) const {
        for (std::int64_t s = begin; s < end; ++s)
            for (std::size_t l = 0; l < levels_.size(); ++l) {
                const Corners c = corners(levels_[l], points + D * s);
                const R* d =
                    d_out + s * stride.sample + std::int64_t(l) * features_ * stride.feature;
                for (int k = 0; k < 1 << D; ++k) {
                    const R* from = table + features_ * (levels_[l].first + c.row[std::size_t(k)]);
                    R along = R(0);
                    for (int f = 0; f < features_; ++f) along += from[f] * d[f * stride.feature];
                    for (std::size_t a = 0; a < D; ++a)
                        d_points[D * s + std::int64_t(a)] += c.product_slope(k, a) * along;
                }
            }
    }

private:
    static std::int64_t row(const HashLevel& level, const std::uint32_t* low, int corner) {
        constexpr std::uint32_t prime[3] = {1u, 2654435761u, 805459861u};
        const std::int64_t side = level.resolution + 1;
        std::int64_t dense = 0, scale = 1;
        std::uint32_t hashed = 0;
        for (int a = 0; a < D; ++a) {
            const std::uint32_t i = low[a] + (static_cast<std::uint32_t>(corner) >> a & 1u);
            dense += scale * i;
            scale *= side;
            hashed ^= i * prime[a];
        }
        return level.dense ? dense : std::int64_t(hashed) & (level.rows - 1);
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

/// Writes features (samples, levels F).
template <Real R, int D>
void hash_encode(const HashEncoding<R, D>& e, const R* table, const R* points, std::int64_t samples,
                 R* out) {
    // Level by level, so that one table at a time is in the cache.
    const FeatureStride stride{std::int64_t(e.levels().size()) * e.features(), 1};
    constexpr std::int64_t piece = 8192;
    for (std::size_t l = 0; l < e.levels().size(); ++l)
        parallel_for((samples + piece - 1) / piece, [&](std::int64_t k) {
            e.encode(l, table, points, k * piece, std::min((k + 1) * piece, samples), stride, out);
        });
}

/// Adds to d_table (rows, F), and to d_points (samples, D) unless null.
template <Real R, int D>
void hash_encode_backward(const HashEncoding<R, D>& e, const R* table, const R* points,
                          std::int64_t samples, const R* d_out, R* d_table, R* d_points) {
    const FeatureStride stride{std::int64_t(e.levels().size()) * e.features(), 1};
    parallel_for(std::int64_t(e.levels().size()), [&](std::int64_t l) {
        e.scatter(std::size_t(l), points, samples, stride, d_out, d_table);
    });
    if (!d_points) return;
    constexpr std::int64_t piece = 1024;
    parallel_for((samples + piece - 1) / piece, [&](std::int64_t k) {
        e.backward_points(table, points, k * piece, std::min((k + 1) * piece, samples), stride,
                          d_out, d_points);
    });
}

}  // namespace photograd
