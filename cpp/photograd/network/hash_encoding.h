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

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <type_traits>
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
        constexpr std::uint32_t prime[3] = {1u, 2654435761u, 805459861u};
        Corners c;
        c.mask = level.dense ? 0 : static_cast<std::uint32_t>(level.rows - 1);
        const R n = static_cast<R>(level.resolution);
        std::uint32_t stride = 1;
        for (std::size_t a = 0; a < D; ++a) {
            const R inside = std::min(std::max(p[a], R(0)), R(1)), at = inside * n;
            const auto cell = std::min(static_cast<std::int32_t>(at), level.resolution - 1);
            const R f = at - static_cast<R>(cell), rate = inside == p[a] ? n : R(0);
            const R w = smoothstep_ ? f * f * (R(3) - R(2) * f) : f;
            const R dw = rate * (smoothstep_ ? R(6) * f * (R(1) - f) : R(1));
            c.weight[a] = {R(1) - w, w};
            c.slope[a] = {-dw, dw};
            const std::uint32_t low = static_cast<std::uint32_t>(cell),
                                factor = level.dense ? stride : prime[a];
            c.part[a] = {low * factor, (low + 1) * factor};
            stride *= static_cast<std::uint32_t>(level.resolution + 1);
        }
        return c;
    }

    /// Features of samples [begin, end) of one level, behind those of the levels before it.
    void encode(std::size_t l, const R* table, const R* points, std::int64_t begin,
                std::int64_t end, FeatureStride stride, R* out) const {
        const HashLevel& level = levels_[l];
        const R* rows = table + features_ * level.first;
        out += std::int64_t(l) * features_ * stride.feature;
        with_features([&](auto features) {
            for (std::int64_t s = begin; s < end; ++s) {
                const Corners c = corners(level, points + D * s);
                R sum[max_features] = {};
                for (int k = 0; k < 1 << D; ++k) {
                    const R w = c.product(k);
                    const R* from = rows + features * c.row(k);
                    for (int f = 0; f < features; ++f) sum[f] += w * from[f];
                }
                for (int f = 0; f < features; ++f)
                    out[s * stride.sample + f * stride.feature] = sum[f];
            }
        });
    }

    /// Adds to d_table the derivatives of all samples of one level, in their order.
    void scatter(std::size_t l, const R* points, std::int64_t samples, FeatureStride stride,
                 const R* d_out, R* d_table) const {
        const HashLevel& level = levels_[l];
        R* rows = d_table + features_ * level.first;
        d_out += std::int64_t(l) * features_ * stride.feature;
        with_features([&](auto features) {
            for (std::int64_t s = 0; s < samples; ++s) {
                const Corners c = corners(level, points + D * s);
                R d[max_features];
                for (int f = 0; f < features; ++f)
                    d[f] = d_out[s * stride.sample + f * stride.feature];
                for (int k = 0; k < 1 << D; ++k) {
                    const R w = c.product(k);
                    R* to = rows + features * c.row(k);
                    for (int f = 0; f < features; ++f) to[f] += w * d[f];
                }
            }
        });
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
                    const R* from = table + features_ * (levels_[l].first + c.row(k));
                    R along = R(0);
                    for (int f = 0; f < features_; ++f) along += from[f] * d[f * stride.feature];
                    for (std::size_t a = 0; a < D; ++a)
                        d_points[D * s + std::int64_t(a)] += c.product_slope(k, a) * along;
                }
            }
    }

    static constexpr int max_features = 8;

private:
    /// use(number of features), as a constant where it is a usual one.
    template <class Use>
    void with_features(Use&& use) const {
        switch (features_) {
            case 1: return use(std::integral_constant<int, 1>{});
            case 2: return use(std::integral_constant<int, 2>{});
            case 4: return use(std::integral_constant<int, 4>{});
            default: return use(features_);
        }
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
