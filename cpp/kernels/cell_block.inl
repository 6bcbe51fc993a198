// Sub-blocks of a march through a sparse grid: where the samples lie, what they see, which are jumped over.
// Positions, cells and densities take lane_count samples of a ray side by side; the colour of a sample
// takes its coefficients side by side, 3 K of each corner.
#pragma once

#include "kernels/march_dense.inl"
#include "kernels/march_sparse_sh.h"
#include "photograd/ops/sh_blend.h"

namespace photograd::PHOTOGRAD_ISA {

// As wide as the registers are: of wider vectors gcc makes single numbers.
#if defined(__AVX512F__)
inline constexpr int vector_floats = 16;
#elif defined(__AVX__)
inline constexpr int vector_floats = 8;
#else
inline constexpr int vector_floats = 4;
#endif
using FloatWide = float __attribute__((vector_size(4 * vector_floats), aligned(4), may_alias));

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
    if constexpr (left >= vector_floats) {
        blend_vector<FloatWide>(corner, w, Y3, out, At);
        blend_basis<Count, At + vector_floats>(corner, w, Y3, out);
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

}  // namespace photograd::PHOTOGRAD_ISA
