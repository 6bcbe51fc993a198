// The fused march through a sparse grid. Positions, cells, densities and compositing take lane_count samples
// of a ray side by side; the colour of a sample takes its coefficients side by side, 3 K of each corner.
#pragma once

#include "kernels/march_dense.inl"
#include "kernels/march_sparse_sh.h"
#include "photograd/ops/sh_blend.h"

namespace photograd::PHOTOGRAD_ISA {

// As wide as the registers are: of wider vectors gcc makes single numbers.
#if defined(__AVX512F__)
inline constexpr int wide = 16;
#elif defined(__AVX__)
inline constexpr int wide = 8;
#else
inline constexpr int wide = 4;
#endif
using FloatWide = float __attribute__((vector_size(4 * wide), aligned(4), may_alias));

struct CellBlock {
    Lanes<float> t, q[3];
    Lanes<float> w[8];
    int row[8][lane_count];
    int cell[lane_count];  // of the lowest voxel, in the rows of all tiles
    int seen[lane_count];  // neither vacuum nor cut off
    Lanes<float> missing;  // weight of the corners without a row
    Lanes<float> raw[4];   // colour with its offset, density before activation
    Lanes<float> sigma_t, rgb[3];
};

// Number of sub-blocks from sample k0 on that lie in empty space for certain. A ray that starts in an empty
// brick whose nearest neighbour with rows is D bricks away may run 8 (D - 1) voxels along any axis.
static inline int empty_blocks(const MarchSparseShArgs& a, std::int64_t ray, int k0) {
    const float t = a.t0[ray] + (static_cast<float>(k0) + 0.5f) * a.dt;
    int base[3];
    float step = 1e-6f;  // voxels a sample, along the axis that changes most
    for (int axis = 0; axis < 3; ++axis) {
        const float d = a.directions[3 * ray + axis];
        const float q = ((a.origins[3 * ray + axis] + t * d) - a.lo[axis]) * a.scale[axis] - 0.5f;
        base[axis] = static_cast<int>(q + 8.0f) - 8;
        const float change = d * a.dt * a.scale[axis];
        step = larger(step, larger(change, -change));
    }
    const int entry = tile_entry(a.cells, base[0], base[1], base[2]);
    if (entry < 0) return 0;
    const int distance = -a.cells.top[entry];
    if (distance < 2) return 0;
    // A hundredth of a voxel is left for rounding.
    const float samples = (static_cast<float>(distance - 1) * 8.0f - 0.01f) / step + 1.0f;
    return static_cast<int>(smaller(samples, 1e6f)) / lane_count;
}

// Positions, cells and trilinear weights; returns how many of the first `used` lanes lie in a tile. With
// none the weights are left out.
static inline int locate_cells(const MarchSparseShArgs& a, std::int64_t ray, int k0, int used,
                               CellBlock& b) {
    const float t0 = a.t0[ray], dt = a.dt;
    Lanes<float> one[3], zero[3];  // weights of the upper and the lower end of each axis
    int base[3][lane_count];
    for (int i = 0; i < lane_count; ++i) b.t[i] = t0 + (static_cast<float>(k0 + i) + 0.5f) * dt;
    for (int axis = 0; axis < 3; ++axis) {
        const float o = a.origins[3 * ray + axis], d = a.directions[3 * ray + axis];
        const float lo = a.lo[axis], scale = a.scale[axis];
        for (int i = 0; i < lane_count; ++i) {
            const float q = ((o + b.t[i] * d) - lo) * scale - 0.5f;
            const int cut = static_cast<int>(q);
            const int floor = cut - (q < static_cast<float>(cut) ? 1 : 0);
            b.q[axis][i] = q;
            base[axis][i] = floor;
            one[axis][i] = q - static_cast<float>(floor);
            zero[axis][i] = 1.0f - one[axis][i];
        }
    }
    int in_tile = 0;
    const int* extent = a.cells.extent;
    for (int i = 0; i < lane_count; ++i) {
        const int x = (base[0][i] >> 3) + 1, y = (base[1][i] >> 3) + 1, z = (base[2][i] >> 3) + 1;
        const bool inside =
            (x >= 0) & (y >= 0) & (z >= 0) & (x < extent[0]) & (y < extent[1]) & (z < extent[2]);
        const int entry = inside ? (x * extent[1] + y) * extent[2] + z : 0;
        const int tile = inside ? larger(a.cells.top[entry], 0) : 0;
        b.cell[i] = tile * cell_tile_voxels + place_in_tile(base[0][i], base[1][i], base[2][i]);
        in_tile += (tile > 0) & (i < used) ? 1 : 0;
    }
    if (in_tile == 0) return 0;
    for (int n = 0; n < 8; ++n) {
        const Lanes<float>& x = n >> 2 ? one[0] : zero[0];
        const Lanes<float>& y = n >> 1 & 1 ? one[1] : zero[1];
        const Lanes<float>& z = n & 1 ? one[2] : zero[2];
        for (int i = 0; i < lane_count; ++i) b.w[n][i] = (x[i] * y[i]) * z[i];
    }
    return in_tile;
}

// Rows and raw densities; false if no lane is seen. Lanes behind the last sample are not.
static inline bool look_up_density(const MarchSparseShArgs& a, int used, CellBlock& b) {
    // Rows, then values, then arithmetic, in loops of their own: what only loads would keep the rest from
    // becoming lanes.
    for (int n = 0; n < 8; ++n) {
        const std::int32_t* rows = a.cells.rows + corner_offset(n);
        for (int i = 0; i < lane_count; ++i) b.row[n][i] = rows[b.cell[i]];
    }
    Lanes<float> value[8];
    for (int n = 0; n < 8; ++n)
        for (int i = 0; i < lane_count; ++i) value[n][i] = a.density[larger(b.row[n][i], 0)];
    Lanes<float> raw = {}, missing = {};
    int any[lane_count] = {};
    const float background = a.background[0];
    for (int n = 0; n < 8; ++n)
        for (int i = 0; i < lane_count; ++i) {
            const bool here = b.row[n][i] >= 0;
            const float w = b.w[n][i];
            raw[i] = raw[i] + w * (here ? value[n][i] : background);
            missing[i] = missing[i] + (here ? 0.0f : w);
            any[i] |= here ? 1 : 0;
        }
    const bool cuts = a.density_activation == static_cast<int>(Activation::relu);
    int count = 0;
    for (int i = 0; i < lane_count; ++i) {
        const bool cut = cuts & (raw[i] <= 0.0f);
        b.seen[i] = (any[i] != 0) & !cut & (i < used) ? 1 : 0;
        count += b.seen[i];
    }
    b.raw[3] = raw;
    b.missing = missing;
    return count != 0;
}

// out[at ..] = Y3[at ..] sum_n w_n corner[n][at ..], in the order of ops/sh_blend.h.
template <class Vector>
static inline void blend_vector(const float* const* corner, const float* w, const float* Y3,
                                float* out, int at) {
    Vector total = w[0] * *reinterpret_cast<const Vector*>(corner[0] + at);
#pragma GCC unroll 8
    for (int n = 1; n < 8; ++n)
        total = total + w[n] * *reinterpret_cast<const Vector*>(corner[n] + at);
    *reinterpret_cast<Vector*>(out + at) = *reinterpret_cast<const Vector*>(Y3 + at) * total;
}

// What is done to a number does not depend on the width of the vector that it is in.
template <int Count, int At = 0>
static inline void blend_basis(const float* const* corner, const float* w, const float* Y3,
                               float* out) {
    constexpr int left = Count - At;
    if constexpr (left >= wide) {
        blend_vector<FloatWide>(corner, w, Y3, out, At);
        blend_basis<Count, At + wide>(corner, w, Y3, out);
    } else if constexpr (left >= 4) {
        blend_vector<Float4>(corner, w, Y3, out, At);
        blend_basis<Count, At + 4>(corner, w, Y3, out);
    } else if constexpr (left > 0) {
        float total = w[0] * corner[0][At];
        for (int n = 1; n < 8; ++n) total = total + w[n] * corner[n][At];
        out[At] = Y3[At] * total;
        blend_basis<Count, At + 1>(corner, w, Y3, out);
    }
}

template <int Count>
static inline void fold_products(const float* p, float* color) {
    constexpr int whole = Count / sh_fold * sh_fold;
    float part[sh_fold] = {};
    for (int block = 0; block < whole; block += sh_fold)
        for (int j = 0; j < sh_fold; ++j) part[j] = part[j] + p[block + j];
    for (int c = 0; c < 3; ++c) {
        color[c] = ((part[c] + part[3 + c]) + part[6 + c]) + part[9 + c];
        if constexpr (whole < Count) color[c] = color[c] + p[whole + c];
    }
}

// Asks for the coefficients of a sample's corners, where they are not those of the sample before. The two
// corners along z are neighbours in memory more often than not.
template <int Count>
static inline void ask_for_rows(const MarchSparseShArgs& a, const CellBlock& b, int i) {
    if (b.cell[i] == b.cell[i - 1]) return;
    for (int n = 0; n < 8; ++n) {
        const float* row = a.sh + static_cast<long long>(larger(b.row[n][i], 0)) * Count;
        for (int j = 0; j < Count; j += 16) __builtin_prefetch(row + j);
    }
}

template <int Count>
static inline void look_up_color(const MarchSparseShArgs& a, const float* Y3, CellBlock& b) {
    for (int c = 0; c < 3; ++c) b.raw[c] = {};
    constexpr int ahead = 3;
    for (int i = 0; i < lane_count; ++i) {
        if (i + ahead < lane_count && b.seen[i + ahead]) ask_for_rows<Count>(a, b, i + ahead);
        if (!b.seen[i]) continue;
        const float* corner[8];
        float w[8];
        alignas(64) float product[sh_basis_stride];
        float color[3];
        for (int n = 0; n < 8; ++n) {
            const int row = b.row[n][i];
            corner[n] = row < 0 ? a.background + 1 : a.sh + static_cast<long long>(row) * Count;
            w[n] = b.w[n][i];
        }
        blend_basis<Count>(corner, w, Y3, product);
        fold_products<Count>(product, color);
        for (int c = 0; c < 3; ++c) b.raw[c][i] = a.color_offset + color[c];
    }
}

template <int Degree>
static inline void evaluate_cells(const MarchSparseShArgs& a, const float* Y3, CellBlock& b) {
    look_up_color<3 * sh_count(Degree)>(a, Y3, b);
    activate_lanes(static_cast<Activation>(a.density_activation), b.raw[3], b.sigma_t);
    for (int c = 0; c < 3; ++c)
        activate_lanes(static_cast<Activation>(a.color_activation), b.raw[c], b.rgb[c]);
    for (int i = 0; i < lane_count; ++i)
        b.sigma_t[i] = b.seen[i] ? a.density_scale * b.sigma_t[i] : 0.0f;
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < lane_count; ++i) b.rgb[c][i] = b.seen[i] ? b.rgb[c][i] : 0.0f;
}

// Rays of a chunk advance together, as in the dense march; sub-blocks in empty space are jumped over, so
// that those that remain lie where they would lie without. visit(i, block) handles a sub-block in which
// something is seen and returns the optical depth behind it. Returns the number of samples looked up.
template <class Visit>
static inline std::int64_t walk_cells(const MarchSparseShArgs& a, std::int64_t begin,
                                      std::int64_t end, Visit&& visit) {
    int alive[march_chunk], next[march_chunk] = {};
    float tau[march_chunk] = {};
    int count = 0;
    std::int64_t looked_up = 0;
    for (int i = 0; i < static_cast<int>(end - begin); ++i)
        if (a.count[begin + i] > 0) alive[count++] = i;
    CellBlock block;
    for (int k0 = 0; count > 0; k0 += lane_count) {
        int left = 0;
        for (int j = 0; j < count; ++j) {
            const int i = alive[j];
            const std::int64_t ray = begin + i;
            if (k0 >= next[i]) {
                const int empty = a.skip ? empty_blocks(a, ray, k0) : 0;
                next[i] = k0 + lane_count * larger(empty, 1);
                const int used = smaller(lane_count, a.count[ray] - k0);
                const int in_tile = empty ? 0 : locate_cells(a, ray, k0, used, block);
                looked_up += a.skip ? in_tile : used;
                if (in_tile && look_up_density(a, used, block)) tau[i] = visit(i, block);
            }
            if (a.count[ray] > next[i] && tau[i] <= a.tau_stop) alive[left++] = i;
        }
        count = left;
    }
    return looked_up;
}

template <int Degree>
static std::int64_t sparse_sh_forward(const MarchSparseShArgs& a, std::int64_t begin,
                                      std::int64_t end) {
    const Quadrature form = static_cast<Quadrature>(a.quadrature);
    RayTotals<float> totals[march_chunk];
    alignas(64) float basis[march_chunk][sh_basis_stride];
    for (std::int64_t ray = begin; ray < end; ++ray)
        sh_basis_by_channel<Degree>(a.directions + 3 * ray, basis[ray - begin]);
    const std::int64_t looked_up = walk_cells(a, begin, end, [&](int i, CellBlock& b) {
        evaluate_cells<Degree>(a, basis[i], b);
        composite(form, b.sigma_t, b.rgb, b.t, a.dt, totals[i]);
        return totals[i].tau;
    });
    for (std::int64_t ray = begin; ray < end; ++ray) {
        const RayTotals<float>& total = totals[ray - begin];
        for (int c = 0; c < 3; ++c) a.color[3 * ray + c] = sum(total.color[c]);
        a.transmittance[ray] = exp(-total.tau);
        a.depth[ray] = sum(total.depth);
    }
    return looked_up;
}

static inline RayCotangents<float> start_sparse(const MarchSparseShArgs& a,
                                                const MarchSparseShBackward& back,
                                                std::int64_t ray) {
    RayCotangents<float> c;
    for (int k = 0; k < 3; ++k) c.d_color[k] = back.d_color[3 * ray + k];
    c.d_depth = back.d_depth[ray];
    c.end_term = -(back.d_transmittance[ray] * a.transmittance[ray]);
    c.remainder = ((c.d_color[0] * a.color[3 * ray] + c.d_color[1] * a.color[3 * ray + 1]) +
                   c.d_color[2] * a.color[3 * ray + 2]) +
                  c.d_depth * a.depth[ray];
    return c;
}

// d[c][i]: adjoint of raw colour and raw density, zero where nothing is seen.
static inline void differentiate_cells(const MarchSparseShArgs& a, const CellBlock& b,
                                       RayCotangents<float>& ray, Lanes<float>* d) {
    Lanes<float> d_sigma_t = {}, d_rgb[3] = {};
    composite_backward(static_cast<Quadrature>(a.quadrature), b.sigma_t, b.rgb, b.t, a.dt, ray,
                       d_sigma_t, d_rgb);
    for (int c = 0; c < 3; ++c)
        activate_lanes_backward(static_cast<Activation>(a.color_activation), b.raw[c], d_rgb[c],
                                d[c]);
    for (int i = 0; i < lane_count; ++i) d_sigma_t[i] = a.density_scale * d_sigma_t[i];
    activate_lanes_backward(static_cast<Activation>(a.density_activation), b.raw[3], d_sigma_t,
                            d[3]);
    for (int c = 0; c < 4; ++c)
        for (int i = 0; i < lane_count; ++i) d[c][i] = b.seen[i] ? d[c][i] : 0.0f;
}

static inline void add_lost(const CellBlock& b, const Lanes<float>* d, const float* Y3, int count,
                            double* lost) {
    float total[4];
    for (int c = 0; c < 4; ++c) {
        Lanes<float> part;
        for (int i = 0; i < lane_count; ++i) part[i] = b.missing[i] * d[c][i];
        total[c] = sum(part);
    }
    lost[0] += static_cast<double>(total[3]);
    for (int j = 0; j < count; ++j)
        lost[1 + j] += static_cast<double>(Y3[j]) * static_cast<double>(total[j % 3]);
}

template <int Degree>
static std::int64_t sparse_sh_backward(const MarchSparseShArgs& a,
                                       const MarchSparseShBackward& back, std::int64_t begin,
                                       std::int64_t end) {
    RayCotangents<float> cotangents[march_chunk];
    float* basis = back.basis + (begin - back.first_ray) * sh_basis_stride;
    for (std::int64_t ray = begin; ray < end; ++ray) {
        cotangents[ray - begin] = start_sparse(a, back, ray);
        sh_basis_by_channel<Degree>(a.directions + 3 * ray,
                                    basis + (ray - begin) * sh_basis_stride);
    }
    CellRecord<float>* next = back.records;
    walk_cells(a, begin, end, [&](int i, CellBlock& b) {
        const float* Y3 = basis + i * sh_basis_stride;
        evaluate_cells<Degree>(a, Y3, b);
        Lanes<float> d[4] = {};
        differentiate_cells(a, b, cotangents[i], d);
        bool lacks = false;
        for (int j = 0; j < lane_count; ++j) {
            lacks |= b.seen[j] && b.missing[j] > 0.0f;
            if (!b.seen[j]) continue;
            *next++ = {{b.q[0][j], b.q[1][j], b.q[2][j]},
                       static_cast<std::uint32_t>(begin - back.first_ray + i),
                       {d[0][j], d[1][j], d[2][j], d[3][j]}};
        }
        if (lacks) add_lost(b, d, Y3, 3 * sh_count(Degree), back.lost);
        return cotangents[i].tau;
    });
    return next - back.records;
}

// Weight of every sample, as d[0] of a record: what pruning asks for. Colours are not needed.
static std::int64_t march_sparse_sh_weights(const MarchSparseShArgs& a,
                                            const MarchSparseShBackward& back, std::int64_t begin,
                                            std::int64_t end) {
    const Quadrature form = static_cast<Quadrature>(a.quadrature);
    float tau[march_chunk] = {};
    CellRecord<float>* next = back.records;
    walk_cells(a, begin, end, [&](int i, CellBlock& b) {
        activate_lanes(static_cast<Activation>(a.density_activation), b.raw[3], b.sigma_t);
        for (int j = 0; j < lane_count; ++j)
            b.sigma_t[j] = b.seen[j] ? a.density_scale * b.sigma_t[j] : 0.0f;
        const SampleWeights<float> found = composite_weights(form, tau[i], b.sigma_t, a.dt);
        for (int j = 0; j < lane_count; ++j)
            if (b.seen[j])
                *next++ = {{b.q[0][j], b.q[1][j], b.q[2][j]}, 0, {found.w[j], 0.0f, 0.0f, 0.0f}};
        tau[i] = found.tau_end;
        return tau[i];
    });
    return next - back.records;
}

// to[j] += w Y3[j] d[j mod 3] for the corners that this brick owns.
template <int Count>
static void sparse_sh_gather(const SparseShGather& g) {
    for (std::int64_t e = 0; e < g.count; ++e) {
        if (e + 8 < g.count) __builtin_prefetch(g.records + g.order[e + 8]);
        const CellRecord<float>& record = g.records[g.order[e]];
        const float* Y3 = g.basis + static_cast<long long>(record.ray) * sh_basis_stride;
        const float* d = record.d;
        const float around[sh_fold] = {d[0], d[1], d[2], d[0], d[1], d[2],
                                       d[0], d[1], d[2], d[0], d[1], d[2]};
        alignas(64) float D[sh_basis_stride];
        for (int j = 0; j < Count; ++j) D[j] = Y3[j] * around[j % sh_fold];
        int base[3];
        float end[3][2];
        for (int axis = 0; axis < 3; ++axis) {
            const float q = record.q[axis];
            const int cut = static_cast<int>(q);
            const int floor = cut - (q < static_cast<float>(cut) ? 1 : 0);
            base[axis] = floor - g.origin[axis];
            end[axis][1] = q - static_cast<float>(floor);
            end[axis][0] = 1.0f - end[axis][1];
        }
        for (int n = 0; n < 8; ++n) {
            const int x = base[0] + (n >> 2), y = base[1] + (n >> 1 & 1), z = base[2] + (n & 1);
            if (((x | y | z) & ~7) != 0) continue;
            const int row = g.rows[(x * 8 + y) * 8 + z];
            if (row < 0) continue;
            const float w = (end[0][n >> 2] * end[1][n >> 1 & 1]) * end[2][n & 1];
            g.d_density[row] = g.d_density[row] + w * d[3];
            float* to = g.d_sh + static_cast<long long>(row) * Count;
            int j = 0;
            for (; j + wide <= Count; j += wide)
                *reinterpret_cast<FloatWide*>(to + j) += w * *reinterpret_cast<FloatWide*>(D + j);
            for (; j + 4 <= Count; j += 4)
                *reinterpret_cast<Float4*>(to + j) += w * *reinterpret_cast<Float4*>(D + j);
            for (; j < Count; ++j) to[j] = to[j] + w * D[j];
        }
    }
}

static std::int64_t march_sparse_sh_forward(const MarchSparseShArgs& a, std::int64_t begin,
                                            std::int64_t end) {
    std::int64_t result = 0;
    with_sh_degree(a.degree, [&]<int D>() { result = sparse_sh_forward<D>(a, begin, end); });
    return result;
}

static std::int64_t march_sparse_sh_backward(const MarchSparseShArgs& a,
                                             const MarchSparseShBackward& back, std::int64_t begin,
                                             std::int64_t end) {
    std::int64_t result = 0;
    with_sh_degree(a.degree, [&]<int D>() { result = sparse_sh_backward<D>(a, back, begin, end); });
    return result;
}

static void march_sparse_sh_gather(const SparseShGather& g) {
    with_sh_degree(g.degree, [&]<int D>() { sparse_sh_gather<3 * sh_count(D)>(g); });
}

}  // namespace photograd::PHOTOGRAD_ISA
