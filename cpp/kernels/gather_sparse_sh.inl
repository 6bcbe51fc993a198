// Sums of a sparse grid's gradient, brick by brick. A ray is done in two steps: first, for every
// voxel, the sum over the ray's samples of trilinear weight times cotangent, four numbers in a
// table that stays in the L1 cache; then, once a voxel, that sum times the harmonics of
// the ray's direction. The scalar form is gather_run of grid/cell_gather.h.
#pragma once

#include "kernels/cell_block.inl"

namespace photograd::PHOTOGRAD_ISA {

// The voxels of a brick with one more on every side, because cells of its samples may reach over:
// nobody reads what is added up there.
inline constexpr int share_side = 10;

struct RayShare {
    alignas(64) float d[share_side * share_side * share_side][4];
    std::uint16_t touched[share_side][share_side];  // a bit for each z
    int low[2], high[2];                            // of what is touched, along x and y

    void clear_box() {
        for (int axis = 0; axis < 2; ++axis) {
            low[axis] = share_side;
            high[axis] = 0;
        }
    }
};

// d[corner] += (trilinear weight of the corner) record.d
static inline void add_sample(const CellRecord<float>& record, const int* origin, RayShare& share) {
    int at[3];
    float end[3][2];
    for (int axis = 0; axis < 3; ++axis) {
        const float q = record.q[axis];
        const int cut = static_cast<int>(q);
        const int floor = cut - (q < static_cast<float>(cut) ? 1 : 0);
        at[axis] = floor - origin[axis] + 1;
        end[axis][1] = q - static_cast<float>(floor);
        end[axis][0] = 1.0f - end[axis][1];
    }
    const Float4 d = float4_at(record.d);
    for (int n = 0; n < 4; ++n) {
        const int x = at[0] + (n >> 1), y = at[1] + (n & 1);
        const float xy = end[0][n >> 1] * end[1][n & 1];
        float* to = share.d[(x * share_side + y) * share_side + at[2]];
        *reinterpret_cast<Float4*>(to) = float4_at(to) + (xy * end[2][0]) * d;
        *reinterpret_cast<Float4*>(to + 4) = float4_at(to + 4) + (xy * end[2][1]) * d;
        share.touched[x][y] = static_cast<std::uint16_t>(share.touched[x][y] | 3 << at[2]);
    }
    for (int axis = 0; axis < 2; ++axis) {
        share.low[axis] = smaller(share.low[axis], at[axis]);
        share.high[axis] = larger(share.high[axis], at[axis] + 1);
    }
}

// to[j] += Y3[j] d[j mod 3]
template <int Count>
static inline void add_harmonics(const float* Y3, const float* d, float* to) {
    const float r = d[0], g = d[1], b = d[2];
    const Float4 around[3] = {{r, g, b, r}, {g, b, r, g}, {b, r, g, b}};
    constexpr int whole = Count / sh_fold * sh_fold;
    for (int j = 0; j < whole; j += sh_fold)
        for (int k = 0; k < 3; ++k) {
            float* at = to + j + 4 * k;
            *reinterpret_cast<Float4*>(at) = float4_at(at) + float4_at(Y3 + j + 4 * k) * around[k];
        }
    for (int j = whole; j < Count; ++j) to[j] = to[j] + Y3[j] * d[j - whole];
}

// Delivers a ray's share to the brick's rows, and clears it.
template <int Count>
static inline void deliver_ray(const SparseShGather& g, const float* Y3, RayShare& share) {
    int rows[512], from[512], count = 0;
    for (int x = share.low[0]; x <= share.high[0]; ++x)
        for (int y = share.low[1]; y <= share.high[1]; ++y) {
            int bits = share.touched[x][y];
            share.touched[x][y] = 0;
            for (; bits != 0; bits &= bits - 1) {
                const int z = __builtin_ctz(static_cast<unsigned>(bits));
                const int slot = (x * share_side + y) * share_side + z;
                const bool own = (((x - 1) | (y - 1) | (z - 1)) & ~7) == 0;
                const int row = own ? g.rows[((x - 1) * 8 + y - 1) * 8 + z - 1] : -1;
                if (row < 0) {
                    *reinterpret_cast<Float4*>(share.d[slot]) = Float4{};
                    continue;
                }
                rows[count] = row;
                from[count++] = slot;
                for (int j = 0; j < Count; j += 16)
                    __builtin_prefetch(g.d_sh + static_cast<long long>(row) * Count + j, 1);
            }
        }
    for (int m = 0; m < count; ++m) {
        float* d = share.d[from[m]];
        g.d_density[rows[m]] = g.d_density[rows[m]] + d[3];
        add_harmonics<Count>(Y3, d, g.d_sh + static_cast<long long>(rows[m]) * Count);
        *reinterpret_cast<Float4*>(d) = Float4{};
    }
    share.clear_box();
}

template <int Count>
static void sparse_sh_gather(const SparseShGather& g) {
    RayShare share = {};
    share.clear_box();
    for (std::int64_t e = 0; e < g.count; ++e) {
        if (e + 2 < g.count) __builtin_prefetch(g.runs[g.order[e + 2]].records);
        const CellRun& run = g.runs[g.order[e]];
        for (std::int64_t r = 0; r < run.count; ++r) add_sample(run.records[r], g.origin, share);
        const auto ray = static_cast<long long>(run.records->ray);
        deliver_ray<Count>(g, g.basis + ray * sh_basis_stride, share);
    }
}

static void march_sparse_sh_gather(const SparseShGather& g) {
    with_sh_degree(g.degree, [&]<int D>() { sparse_sh_gather<3 * sh_count(D)>(g); });
}

}  // namespace photograd::PHOTOGRAD_ISA
