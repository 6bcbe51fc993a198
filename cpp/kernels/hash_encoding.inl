// Points go in blocks: cells, rows and weights in lanes, then rows are looked up or added to. The
// rows of a block are prefetched while the block before is looked up: a table is larger than the
// second-level cache, and the hash makes its rows lie anywhere.
//
// Of each sum the order is that of the corners, and of increments that of the points, so all
// instruction sets give the same bits.
#pragma once

#include "kernels/hash_encoding.h"
#include "photograd/ops/hash_cell.h"

namespace photograd::PHOTOGRAD_ISA {

inline constexpr int hash_block = 32;
// Tables of more bytes than this are prefetched.
inline constexpr std::int64_t hash_near = 1 << 17;

template <int D>
struct HashBlock {
    std::uint32_t row[1 << D][hash_block];
    float weight[1 << D][hash_block];
};

// The two corners of a block's cells along one axis.
struct HashSides {
    std::uint32_t part[2][hash_block];               // of the row
    float weight[2][hash_block], slope[hash_block];  // d weight[1] / d p
};

// Coordinates of a block's points along one axis, with zeros behind the last.
template <int D>
static inline void axis_of_points(const float* points, int n, int axis, float* p) {
    if (n == hash_block)
        for (int i = 0; i < hash_block; ++i) p[i] = points[D * i + axis];
    else
        for (int i = 0; i < hash_block; ++i) p[i] = i < n ? points[D * i + axis] : 0.0f;
}

template <int D>
static inline void locate_axis(const HashLevelArgs& level, const float* points, int n, int axis,
                               HashSides& out) {
    float p[hash_block];
    axis_of_points<D>(points, n, axis, p);
    const std::uint32_t factor = hash_factor(axis, level.resolution, level.mask == 0);
    const int resolution = level.resolution;
    const auto fill = [&](bool smoothstep) {
        for (int i = 0; i < hash_block; ++i) {
            const HashAxis<float> at = hash_axis(p[i], resolution, smoothstep);
            const std::uint32_t low = static_cast<std::uint32_t>(at.cell) * factor;
            out.part[0][i] = low;
            out.part[1][i] = low + factor;
            out.weight[0][i] = 1.0f - at.weight;
            out.weight[1][i] = at.weight;
            out.slope[i] = at.slope;
        }
    };
    if (level.smoothstep)
        fill(true);
    else
        fill(false);
}

template <int D>
static inline void combine_rows(const HashLevelArgs& level, const HashSides* sides,
                                std::uint32_t (*row)[hash_block]) {
    for (int k = 0; k < 1 << D; ++k)
        for (int i = 0; i < hash_block; ++i) {
            std::uint32_t sum = sides[0].part[k & 1][i], hash = sum;
            for (int a = 1; a < D; ++a) {
                sum += sides[a].part[k >> a & 1][i];
                hash ^= sides[a].part[k >> a & 1][i];
            }
            row[k][i] = level.mask != 0 ? hash & level.mask : sum;
        }
}

// Rows and weights of all corners, in one loop that leaves nothing between in memory.
template <int D, bool Dense>
static inline void fill_block(const HashLevelArgs& level, bool smoothstep,
                              const float (*p)[hash_block], HashBlock<D>& out) {
    std::uint32_t factor[D];
    for (int a = 0; a < D; ++a) factor[a] = hash_factor(a, level.resolution, Dense);
    const int resolution = level.resolution;
    const std::uint32_t mask = Dense ? ~0u : level.mask;
    const auto join = [](std::uint32_t a, std::uint32_t b) { return Dense ? a + b : a ^ b; };
    for (int i = 0; i < hash_block; ++i) {
        const HashAxis<float> x = hash_axis(p[0][i], resolution, smoothstep);
        const HashAxis<float> y = hash_axis(p[1][i], resolution, smoothstep);
        const std::uint32_t x0 = static_cast<std::uint32_t>(x.cell) * factor[0],
                            x1 = x0 + factor[0];
        const std::uint32_t y0 = static_cast<std::uint32_t>(y.cell) * factor[1],
                            y1 = y0 + factor[1];
        const std::uint32_t r0 = join(x0, y0), r1 = join(x1, y0), r2 = join(x0, y1),
                            r3 = join(x1, y1);
        const float u = 1.0f - x.weight, v = 1.0f - y.weight;
        const float w0 = u * v, w1 = x.weight * v, w2 = u * y.weight, w3 = x.weight * y.weight;
        const auto put = [&](int k, std::uint32_t row, float weight) {
            out.row[k][i] = row & mask;
            out.weight[k][i] = weight;
        };
        if constexpr (D == 2) {
            put(0, r0, w0);
            put(1, r1, w1);
            put(2, r2, w2);
            put(3, r3, w3);
        } else {
            const HashAxis<float> z = hash_axis(p[2][i], resolution, smoothstep);
            const std::uint32_t z0 = static_cast<std::uint32_t>(z.cell) * factor[2],
                                z1 = z0 + factor[2];
            const float low = 1.0f - z.weight, high = z.weight;
            put(0, join(r0, z0), w0 * low);
            put(1, join(r1, z0), w1 * low);
            put(2, join(r2, z0), w2 * low);
            put(3, join(r3, z0), w3 * low);
            put(4, join(r0, z1), w0 * high);
            put(5, join(r1, z1), w1 * high);
            put(6, join(r2, z1), w2 * high);
            put(7, join(r3, z1), w3 * high);
        }
    }
}

template <int D>
static void locate_block(const HashLevelArgs& level, const float* points, int n,
                         HashBlock<D>& out) {
    float p[D][hash_block];
    for (int a = 0; a < D; ++a) axis_of_points<D>(points, n, a, p[a]);
    if (level.smoothstep && level.mask == 0)
        fill_block<D, true>(level, true, p, out);
    else if (level.smoothstep)
        fill_block<D, false>(level, true, p, out);
    else if (level.mask == 0)
        fill_block<D, true>(level, false, p, out);
    else
        fill_block<D, false>(level, false, p, out);
}

// Corners that differ along the first axis alone are mostly on one cache line: of a dense level
// they are neighbors, and of a hashed one their numbers differ in the last bits.
template <int D>
static inline void prefetch_block(const HashLevelArgs& level, const float* table, int n,
                                  const HashBlock<D>& block) {
    const std::int64_t width = level.features;
    if (level.rows * width * 4 <= hash_near) return;
    for (int k = 0; k < 1 << D; k += 2)
        for (int i = 0; i < n; ++i) __builtin_prefetch(table + width * block.row[k][i]);
}

// visit(block, first, n) for all points [begin, end).
template <int D, class Visit>
static inline void for_hash_blocks(const HashLevelArgs& level, const float* table,
                                   std::int64_t begin, std::int64_t end, Visit&& visit) {
    HashBlock<D> blocks[2];
    const auto length = [end](std::int64_t from) {
        return static_cast<int>(smaller<std::int64_t>(hash_block, end - from));
    };
    const auto prepare = [&](std::int64_t from, HashBlock<D>& block) {
        locate_block<D>(level, level.points + D * from, length(from), block);
        prefetch_block<D>(level, table, length(from), block);
    };
    if (begin < end) prepare(begin, blocks[0]);
    int now = 0;
    for (std::int64_t from = begin; from < end; from += hash_block, now ^= 1) {
        if (from + hash_block < end) prepare(from + hash_block, blocks[now ^ 1]);
        visit(blocks[now], from, length(from));
    }
}

using Pair4 = float __attribute__((vector_size(16), aligned(4), may_alias));

// Rows of two features at two points: (a0, a1, b0, b1).
static inline Pair4 row_pairs(const float* table, const std::uint32_t* row) {
    using Double2 = double __attribute__((vector_size(16)));
    using Unaligned = double __attribute__((aligned(4), may_alias));
    const Double2 both = {*reinterpret_cast<const Unaligned*>(table + 2 * std::int64_t{row[0]}),
                          *reinterpret_cast<const Unaligned*>(table + 2 * std::int64_t{row[1]})};
    return reinterpret_cast<Pair4>(both);
}

// Features of the block; `out` has room for a whole block.
template <int D, int F>
static inline void blend_rows(const HashBlock<D>& block, const float* table, int features,
                              float (*out)[hash_block]) {
    if constexpr (F == 2) {
        for (int i = 0; i < hash_block; i += 4) {
            Pair4 low, high;
#pragma GCC unroll 8
            for (int k = 0; k < 1 << D; ++k) {
                const Pair4 w = *reinterpret_cast<const Pair4*>(block.weight[k] + i);
                const Pair4 a =
                    __builtin_shufflevector(w, w, 0, 0, 1, 1) * row_pairs(table, block.row[k] + i);
                const Pair4 b = __builtin_shufflevector(w, w, 2, 2, 3, 3) *
                                row_pairs(table, block.row[k] + i + 2);
                low = k == 0 ? a : low + a;
                high = k == 0 ? b : high + b;
            }
            *reinterpret_cast<Pair4*>(out[0] + i) = __builtin_shufflevector(low, high, 0, 2, 4, 6);
            *reinterpret_cast<Pair4*>(out[1] + i) = __builtin_shufflevector(low, high, 1, 3, 5, 7);
        }
        return;
    }
    const std::int64_t width = F > 0 ? F : features;
    for (int f = 0; f < width; ++f)
        for (int k = 0; k < 1 << D; ++k) {
            float value[hash_block];
            for (int i = 0; i < hash_block; ++i) value[i] = table[width * block.row[k][i] + f];
            if (k == 0)
                for (int i = 0; i < hash_block; ++i) out[f][i] = block.weight[k][i] * value[i];
            else
                for (int i = 0; i < hash_block; ++i)
                    out[f][i] = out[f][i] + block.weight[k][i] * value[i];
        }
}

inline constexpr int most_hash_features = 8;

template <int D, int F>
static inline void encode_level(const HashEncode& e, std::int64_t begin, std::int64_t end) {
    const auto blend = [&](const HashBlock<D>& block, std::int64_t first, int n) {
        float out[most_hash_features][hash_block];
        blend_rows<D, F>(block, e.table, e.level.features, out);
        for (int f = 0; f < (F > 0 ? F : e.level.features); ++f) {
            float* to = e.features + f * e.stride + first;
            if (n == hash_block)
                for (int i = 0; i < hash_block; ++i) to[i] = out[f][i];
            else
                for (int i = 0; i < n; ++i) to[i] = out[f][i];
        }
    };
    for_hash_blocks<D>(e.level, e.table, begin, end, blend);
}

// d(features) of a block's points, those of a point side by side.
template <int F>
static inline void side_by_side(const HashScatter& s, std::int64_t first, int n, float* d) {
    const int features = F > 0 ? F : s.level.features;
    for (int f = 0; f < features; ++f) {
        const float* from = s.d_features + f * s.stride + first;
        for (int i = 0; i < n; ++i) d[features * i + f] = from[i];
    }
}

template <int F>
static inline void add_to_row(float weight, const float* d, int features, float* to) {
    if constexpr (F == 2) {
        using Pair = float __attribute__((vector_size(8), aligned(4), may_alias));
        Pair& row = *reinterpret_cast<Pair*>(to);
        row = row + weight * *reinterpret_cast<const Pair*>(d);
    } else {
        for (int f = 0; f < (F > 0 ? F : features); ++f) to[f] = to[f] + weight * d[f];
    }
}

template <int D, int F>
static inline void scatter_level(const HashScatter& s, std::int64_t begin, std::int64_t end) {
    const std::int64_t width = F > 0 ? F : s.level.features;
    const bool all = s.first == 0 && s.last == s.level.rows;
    const std::uint32_t span = s.last - s.first;
    const auto add = [&](const HashBlock<D>& block, std::int64_t first, int n) {
        float d[most_hash_features * hash_block];
        side_by_side<F>(s, first, n, d);
        const auto add_corner = [&](int i, int k) {
            add_to_row<F>(block.weight[k][i], d + width * i, s.level.features,
                          s.d_table + width * block.row[k][i]);
        };
        if (all) {
            for (int i = 0; i < n; ++i)
#pragma GCC unroll 8
                for (int k = 0; k < 1 << D; ++k) add_corner(i, k);
            return;
        }
        // Without branches: which rows are served is as good as random.
        std::uint16_t served[hash_block << D];
        int count = 0;
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < 1 << D; ++k) {
                served[count] = static_cast<std::uint16_t>(i << D | k);
                count += block.row[k][i] - s.first < span ? 1 : 0;
            }
        for (int e = 0; e < count; ++e) add_corner(served[e] >> D, served[e] & ((1 << D) - 1));
    };
    for_hash_blocks<D>(s.level, s.d_table, begin, end, add);
}

// d_p_a += sum over corners of (d weight / d p_a) <features of the corner, d_features>.
template <int D>
static inline void points_of_level(const HashPoints& p, std::int64_t begin, std::int64_t end) {
    const std::int64_t width = p.level.features;
    for (std::int64_t first = begin; first < end; first += hash_block) {
        const int n = static_cast<int>(smaller<std::int64_t>(hash_block, end - first));
        HashSides sides[D];
        std::uint32_t row[1 << D][hash_block];
        float d_p[D][hash_block];
        for (int a = 0; a < D; ++a) {
            locate_axis<D>(p.level, p.level.points + D * first, n, a, sides[a]);
            for (int i = 0; i < n; ++i) d_p[a][i] = p.d_points[D * (first + i) + a];
        }
        combine_rows<D>(p.level, sides, row);
        for (int k = 0; k < 1 << D; ++k) {
            float along[hash_block];
            for (int f = 0; f < width; ++f) {
                const float* d = p.d_features + f * p.stride + first;
                for (int i = 0; i < n; ++i) {
                    const float term = p.table[width * row[k][i] + f] * d[i];
                    along[i] = f == 0 ? term : along[i] + term;
                }
            }
            for (int a = 0; a < D; ++a)
                for (int i = 0; i < n; ++i) {
                    float w = (k >> a & 1) != 0 ? sides[a].slope[i] : -sides[a].slope[i];
                    for (int b = 0; b < D; ++b)
                        if (b != a) w = w * sides[b].weight[k >> b & 1][i];
                    d_p[a][i] = d_p[a][i] + w * along[i];
                }
        }
        for (int a = 0; a < D; ++a)
            for (int i = 0; i < n; ++i) p.d_points[D * (first + i) + a] = d_p[a][i];
    }
}

// use<D, F>() with the dimensions and the number of features; F is 0 for unusual ones.
template <class Use>
static inline void with_hash_sizes(const HashLevelArgs& level, Use&& use) {
    const auto with_features = [&]<int D>() {
        switch (level.features) {
            case 1: return use.template operator()<D, 1>();
            case 2: return use.template operator()<D, 2>();
            case 4: return use.template operator()<D, 4>();
            default: return use.template operator()<D, 0>();
        }
    };
    if (level.dimensions == 2)
        with_features.template operator()<2>();
    else
        with_features.template operator()<3>();
}

static void hash_encode(const HashEncode& e, std::int64_t begin, std::int64_t end) {
    with_hash_sizes(e.level, [&]<int D, int F>() { encode_level<D, F>(e, begin, end); });
}

static void hash_scatter(const HashScatter& s, std::int64_t begin, std::int64_t end) {
    with_hash_sizes(s.level, [&]<int D, int F>() { scatter_level<D, F>(s, begin, end); });
}

static void hash_points(const HashPoints& p, std::int64_t begin, std::int64_t end) {
    if (p.level.dimensions == 2)
        points_of_level<2>(p, begin, end);
    else
        points_of_level<3>(p, begin, end);
}

}  // namespace photograd::PHOTOGRAD_ISA
