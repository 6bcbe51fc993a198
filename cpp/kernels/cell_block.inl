// Sub-blocks of a march through a sparse grid: positions, cells, values, empty-space skipping.
// Positions, cells and densities take lane_count samples of a ray side by side; the color of a
// voxel takes its 3 K coefficients side by side, once for all samples of the sub-block that have it
// as a corner.
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

struct CellBlock : ShadedBlock {  // raw color with its offset
    Lanes<float> q[3];
    Lanes<float> w[8];
    int cell[lane_count];     // of the lowest voxel, in the rows of all tiles
    int parity[lane_count];   // of the lowest voxel's coordinates, as the number of a corner
    int visible[lane_count];  // neither vacuum nor cut off
    Lanes<float> missing;     // weight of the corners without a row
};

// Number of sub-blocks from sample k0 on that lie in empty space for certain. A ray that starts in
// an empty brick whose nearest neighbor with rows is D bricks away may run 8 (D - 1) voxels along
// any axis.
static inline int empty_blocks(const MarchSparseShArgs& a, std::int64_t ray, int k0) {
    const float t = a.rays.t0[ray] + (static_cast<float>(k0) + 0.5f) * a.dt;
    int base[3];
    float step = 1e-6f;  // voxels a sample, along the axis that changes most
    for (int axis = 0; axis < 3; ++axis) {
        const float d = a.rays.directions[3 * ray + axis];
        const float q =
            ((a.rays.origins[3 * ray + axis] + t * d) - a.lo[axis]) * a.scale[axis] - 0.5f;
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

// Positions, cells and trilinear weights; returns how many of the first `used` lanes lie in a tile.
// With none the weights are left out.
static inline int locate_cells(const MarchSparseShArgs& a, std::int64_t ray, int k0, int used,
                               CellBlock& b) {
    const float t0 = a.rays.t0[ray], dt = a.dt;
    Lanes<float> one[3], zero[3];  // weights of the upper and the lower end of each axis
    int base[3][lane_count];
    for (int i = 0; i < lane_count; ++i) b.t[i] = t0 + (static_cast<float>(k0 + i) + 0.5f) * dt;
    for (int axis = 0; axis < 3; ++axis) {
        const float o = a.rays.origins[3 * ray + axis], d = a.rays.directions[3 * ray + axis];
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
        b.cell[i] = tile * cell_tile_voxels + offset_in_tile(base[0][i], base[1][i], base[2][i]);
        b.parity[i] = (base[0][i] & 1) * 4 + (base[1][i] & 1) * 2 + (base[2][i] & 1);
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

// Raw densities; false if no lane is visible. Lanes behind the last sample are not.
static inline bool look_up_density(const MarchSparseShArgs& a, int used, CellBlock& b) {
    // Bits of corners, then values, then arithmetic, in loops of their own: what only loads would
    // keep the rest from becoming lanes.
    int corners[lane_count], any = 0;
    for (int i = 0; i < lane_count; ++i) {
        corners[i] = a.cells.active[b.cell[i]];
        any |= i < used ? corners[i] : 0;
    }
    if (any == 0) return false;
    Lanes<float> value[8];
    for (int n = 0; n < 8; ++n) {
        const float* density = a.density + corner_offset(n);
        for (int i = 0; i < lane_count; ++i) value[n][i] = density[b.cell[i]];
    }
    Lanes<float> raw = {}, missing = {};
    for (int n = 0; n < 8; ++n)
        for (int i = 0; i < lane_count; ++i) {
            const float w = b.w[n][i];
            raw[i] = raw[i] + w * value[n][i];
            missing[i] = missing[i] + ((corners[i] >> n & 1) != 0 ? 0.0f : w);
        }
    const bool cuts = a.density_activation == static_cast<int>(Activation::relu);
    int count = 0;
    for (int i = 0; i < lane_count; ++i) {
        const bool cut = cuts & (raw[i] <= 0.0f);
        b.visible[i] = (corners[i] != 0) & !cut & (i < used) ? 1 : 0;
        count += b.visible[i];
    }
    b.raw[3] = raw;
    b.missing = missing;
    return count != 0;
}

// The voxels at the corners of a sub-block's samples.
struct CornerVoxels {
    int count;
    int row[8 * lane_count];                     // -1: the background
    int number[lane_count][8];                   // corner n of sample i is voxel number[i][n]
    alignas(16) float color[8 * lane_count][4];  // that a voxel shows along the ray; three are used
};

// Gives each voxel a number. The eight corners of a cell differ in the parity of their coordinates,
// so that eight places, one a parity, hold what the sample before had: along a ray a voxel leaves
// its place only when no sample to come has it. The coefficients are asked for at once: they are
// needed when all voxels have their numbers, and to wait for memory is most of what a color costs.
template <int Count>
static inline void number_corners(const MarchSparseShArgs& a, const CellBlock& b, CornerVoxels& v) {
    int held[8], number[8] = {}, count = 0, last = -1;
    for (int s = 0; s < 8; ++s) held[s] = -2;  // no voxel, and not the background either
    for (int i = 0; i < lane_count; ++i) {
        if (!b.visible[i]) continue;
        const int parity = b.parity[i];
        for (int n = 0; n < 8 && b.cell[i] != last; ++n) {
            const int s = n ^ parity, row = a.cells.rows[b.cell[i] + corner_offset(n)];
            if (held[s] == row) continue;
            held[s] = row;
            number[s] = count;
            v.row[count++] = row;
            const float* values = a.sh + static_cast<long long>(larger(row, 0)) * Count;
            for (int j = 0; j < Count; j += 16) __builtin_prefetch(values + j);
        }
        last = b.cell[i];
        for (int n = 0; n < 8; ++n) v.number[i][n] = number[n ^ parity];
    }
    v.count = count;
}

static inline Float4 float4_at(const float* p) { return *reinterpret_cast<const Float4*>(p); }

// fold_color of ops/sh_blend.h. Nothing behind the last coefficient is read.
template <int Count>
static inline Float4 fold_color_lanes(const float* v, const float* Y3) {
    if constexpr (Count < sh_fold) {
        return Float4{Y3[0] * v[0], Y3[1] * v[1], Y3[2] * v[2], 0.0f};
    } else {
        constexpr int whole = Count / sh_fold * sh_fold;
        Float4 part[3];
        for (int k = 0; k < 3; ++k) part[k] = float4_at(Y3 + 4 * k) * float4_at(v + 4 * k);
        for (int j = sh_fold; j < whole; j += sh_fold)
            for (int k = 0; k < 3; ++k)
                part[k] = part[k] + float4_at(Y3 + j + 4 * k) * float4_at(v + j + 4 * k);
        const Float4 second = __builtin_shufflevector(part[0], part[1], 3, 4, 5, 6);
        const Float4 third = __builtin_shufflevector(part[1], part[2], 2, 3, 4, 5);
        const Float4 fourth = __builtin_shufflevector(part[2], part[2], 1, 2, 3, 3);
        Float4 color = ((part[0] + second) + third) + fourth;
        if constexpr (whole < Count) {  // one harmonic is left: read from one float before it
            const Float4 rest = float4_at(Y3 + whole - 1) * float4_at(v + whole - 1);
            color = color + __builtin_shufflevector(rest, rest, 1, 2, 3, 3);
        }
        return color;
    }
}

template <int Count>
static inline void color_corners(const MarchSparseShArgs& a, const float* Y3, CornerVoxels& v) {
    for (int m = 0; m < v.count; ++m) {
        const long long row = v.row[m];
        const float* values = row < 0 ? a.background + 1 : a.sh + row * Count;
        *reinterpret_cast<Float4*>(v.color[m]) = fold_color_lanes<Count>(values, Y3);
    }
}

template <int Count>
static inline void look_up_color(const MarchSparseShArgs& a, const float* Y3, CellBlock& b) {
    CornerVoxels voxels;
    number_corners<Count>(a, b, voxels);
    color_corners<Count>(a, Y3, voxels);
    for (int c = 0; c < 3; ++c) b.raw[c] = {};
    for (int i = 0; i < lane_count; ++i) {
        if (!b.visible[i]) continue;
        const int* number = voxels.number[i];
        Float4 color = b.w[0][i] * float4_at(voxels.color[number[0]]);
        for (int n = 1; n < 8; ++n) color = color + b.w[n][i] * float4_at(voxels.color[number[n]]);
        for (int c = 0; c < 3; ++c) b.raw[c][i] = a.color_offset + color[c];
    }
}

template <int Degree>
static inline void evaluate_cells(const MarchSparseShArgs& a, const float* Y3, CellBlock& b) {
    look_up_color<3 * sh_count(Degree)>(a, Y3, b);
    activate_block(a, b);
    for (int i = 0; i < lane_count; ++i)
        b.sigma_t[i] = b.visible[i] ? a.density_scale * b.sigma_t[i] : 0.0f;
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < lane_count; ++i) b.rgb[c][i] = b.visible[i] ? b.rgb[c][i] : 0.0f;
}

// Rays of a chunk advance together, as in the dense march; sub-blocks in empty space are skipped
// without moving the others. visit(i, block) handles a sub-block with visible samples and returns
// the optical depth behind it. Returns the number of samples looked up.
template <class Visit>
static inline std::int64_t walk_cells(const MarchSparseShArgs& a, std::int64_t begin,
                                      std::int64_t end, Visit&& visit) {
    int alive[march_chunk], next[march_chunk] = {};
    float tau[march_chunk] = {};
    int count = 0;
    std::int64_t looked_up = 0;
    for (int i = 0; i < static_cast<int>(end - begin); ++i)
        if (a.rays.samples[begin + i] > 0) alive[count++] = i;
    CellBlock block;
    for (int k0 = 0; count > 0; k0 += lane_count) {
        int left = 0;
        for (int j = 0; j < count; ++j) {
            const int i = alive[j];
            const std::int64_t ray = begin + i;
            if (k0 >= next[i]) {
                const int empty = a.skip ? empty_blocks(a, ray, k0) : 0;
                next[i] = k0 + lane_count * larger(empty, 1);
                const int used = smaller(lane_count, a.rays.samples[ray] - k0);
                const int in_tile = empty ? 0 : locate_cells(a, ray, k0, used, block);
                looked_up += a.skip ? in_tile : used;
                if (in_tile && look_up_density(a, used, block)) tau[i] = visit(i, block);
            }
            if (a.rays.samples[ray] > next[i] && tau[i] <= a.tau_stop) alive[left++] = i;
        }
        count = left;
    }
    return looked_up;
}

}  // namespace photograd::PHOTOGRAD_ISA
