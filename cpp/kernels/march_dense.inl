// The fused march: position, trilinear lookup, activation and compositing of lane_count consecutive
// samples of one ray at a time. The corners of one sample are loaded as vectors: (z, z + 1) x (r,
// g, b, sigma) are eight neighboring floats, so a lookup is four loads.
#pragma once

#include "kernels/march_dense.h"
#include "photograd/ops/activation.h"
#include "photograd/ops/composite.h"
#include "photograd/ops/trilinear.h"

namespace photograd::PHOTOGRAD_ISA {

// Unaligned views of four and eight floats; the compiler splits them where registers are narrower.
using Float4 = float __attribute__((vector_size(16), aligned(4), may_alias));
using Float8 = float __attribute__((vector_size(32), aligned(4), may_alias));

// lane_count samples of one ray as they are composited.
struct ShadedBlock {
    Lanes<float> t;
    Lanes<float> raw[4];  // r, g, b, density before activation
    Lanes<float> sigma_t, rgb[3];
};

struct SampleBlock : ShadedBlock {
    Lanes<float> p[3];
    int base[3][lane_count];
    int voxel[lane_count];  // number of the base voxel
    Lanes<float> row[4];    // weights of the four rows (x, y): 00 01 10 11
    Lanes<float> z0, z1;    // weights of the two ends of a row
};

// Positions of samples k0, k0 + 1, ... and their cells and weights.
static inline void place_block(const MarchDenseArgs& a, std::int64_t ray, int k0, SampleBlock& b) {
    const float t0 = a.rays.t0[ray], dt = a.dt;
    for (int i = 0; i < lane_count; ++i) b.t[i] = t0 + (static_cast<float>(k0 + i) + 0.5f) * dt;
    for (int axis = 0; axis < 3; ++axis) {
        const float o = a.rays.origins[3 * ray + axis], d = a.rays.directions[3 * ray + axis];
        for (int i = 0; i < lane_count; ++i) b.p[axis][i] = o + b.t[i] * d;
    }
}

static inline void weigh_block(const MarchDenseArgs& a, SampleBlock& b) {
    const Border border = static_cast<Border>(a.border);
    Lanes<float> w0[3], w1[3];
    for (int axis = 0; axis < 3; ++axis) {
        const float lo = a.lo[axis], scale = a.scale[axis];
        const int n = a.shape[axis];
        for (int i = 0; i < lane_count; ++i) {
            const AxisWeights<float> w =
                axis_weights((b.p[axis][i] - lo) * scale - 0.5f, n, border);
            b.base[axis][i] = w.base;
            w0[axis][i] = w.w0;
            w1[axis][i] = w.w1;
        }
    }
    for (int i = 0; i < lane_count; ++i) {
        b.row[0][i] = w0[0][i] * w0[1][i];
        b.row[1][i] = w0[0][i] * w1[1][i];
        b.row[2][i] = w1[0][i] * w0[1][i];
        b.row[3][i] = w1[0][i] * w1[1][i];
    }
    b.z0 = w0[2];
    b.z1 = w1[2];
    for (int i = 0; i < lane_count; ++i)
        b.voxel[i] = (b.base[0][i] * a.shape[1] + b.base[1][i]) * a.shape[2] + b.base[2][i];
}

// Everything about a sub-block that needs no voxel; prefetches the voxels that it will need.
static inline void locate_block(const MarchDenseArgs& a, std::int64_t ray, int k0, SampleBlock& b) {
    place_block(a, ray, k0, b);
    weigh_block(a, b);
    const long long to_y = static_cast<long long>(a.shape[2]) * 4;
    const long long to_x = a.shape[1] * to_y;
    for (int i = 0; i < lane_count; i += 2) {
        const float* row = a.values + static_cast<long long>(b.voxel[i]) * 4;
        __builtin_prefetch(row);
        __builtin_prefetch(row + to_y);
        __builtin_prefetch(row + to_x);
        __builtin_prefetch(row + to_x + to_y);
    }
}

static inline void look_up_block(const MarchDenseArgs& a, SampleBlock& b) {
    const long long to_y = static_cast<long long>(a.shape[2]) * 4;
    const long long to_x = a.shape[1] * to_y;
    alignas(64) float found[lane_count][4];
    for (int i = 0; i < lane_count; ++i) {
        const float* row = a.values + static_cast<long long>(b.voxel[i]) * 4;
        const Float8 ends = ((b.row[0][i] * *reinterpret_cast<const Float8*>(row) +
                              b.row[1][i] * *reinterpret_cast<const Float8*>(row + to_y)) +
                             b.row[2][i] * *reinterpret_cast<const Float8*>(row + to_x)) +
                            b.row[3][i] * *reinterpret_cast<const Float8*>(row + to_x + to_y);
        const Float4 near = {ends[0], ends[1], ends[2], ends[3]};
        const Float4 far = {ends[4], ends[5], ends[6], ends[7]};
        *reinterpret_cast<Float4*>(found[i]) = near * b.z0[i] + far * b.z1[i];
    }
    for (int c = 0; c < 4; ++c)
        for (int i = 0; i < lane_count; ++i) b.raw[c][i] = found[i][c];
}

static inline void activate_lanes(Activation kind, const Lanes<float>& x, Lanes<float>& y) {
    switch (kind) {  // one loop each, so that each becomes lanes
        case Activation::relu:
            for (int i = 0; i < lane_count; ++i) y[i] = relu(x[i]);
            break;
        case Activation::softplus:
            for (int i = 0; i < lane_count; ++i) y[i] = softplus(x[i]);
            break;
        case Activation::exp:
            for (int i = 0; i < lane_count; ++i) y[i] = exponential(x[i]);
            break;
        case Activation::sigmoid:
            for (int i = 0; i < lane_count; ++i) y[i] = sigmoid(x[i]);
            break;
        default: y = x;
    }
}

static inline void activate_lanes_backward(Activation kind, const Lanes<float>& x,
                                           const Lanes<float>& d_y, Lanes<float>& d_x) {
    switch (kind) {
        case Activation::relu:
            for (int i = 0; i < lane_count; ++i) relu_backward(x[i], d_y[i], d_x[i]);
            break;
        case Activation::softplus:
            for (int i = 0; i < lane_count; ++i) softplus_backward(x[i], d_y[i], d_x[i]);
            break;
        case Activation::exp:
            for (int i = 0; i < lane_count; ++i) exponential_backward(x[i], d_y[i], d_x[i]);
            break;
        case Activation::sigmoid:
            for (int i = 0; i < lane_count; ++i) sigmoid_backward(x[i], d_y[i], d_x[i]);
            break;
        default: d_x = d_y;
    }
}

// sigma_t is still without density_scale.
static inline void activate_block(const MarchArgs& a, ShadedBlock& b) {
    activate_lanes(static_cast<Activation>(a.density_activation), b.raw[3], b.sigma_t);
    for (int c = 0; c < 3; ++c)
        activate_lanes(static_cast<Activation>(a.color_activation), b.raw[c], b.rgb[c]);
}

static inline void evaluate_block(const MarchDenseArgs& a, std::int64_t ray, int k0,
                                  SampleBlock& b) {
    look_up_block(a, b);
    activate_block(a, b);
    // Lanes behind the last sample take part in every loop, with no extinction.
    for (int i = 0; i < lane_count; ++i)
        b.sigma_t[i] = k0 + i < a.rays.samples[ray] ? a.density_scale * b.sigma_t[i] : 0.0f;
}

// Rays of a chunk advance together, lane_count samples at a time: neighboring rays read the same
// voxels, which are then still in the L1 cache. visit(i, k0, block) handles one located
// sub-block of ray begin + i and returns the optical depth behind it. The next sub-block is located
// first, so that its voxels are on their way while this one is computed.
template <class Visit>
static inline void walk_chunk(const MarchDenseArgs& a, std::int64_t begin, std::int64_t end,
                              Visit&& visit) {
    int alive[march_chunk];
    int count = 0;
    for (int i = 0; i < static_cast<int>(end - begin); ++i)
        if (a.rays.samples[begin + i] > 0) alive[count++] = i;
    SampleBlock blocks[2];
    for (int k0 = 0; count > 0; k0 += lane_count) {
        int left = 0;
        locate_block(a, begin + alive[0], k0, blocks[0]);
        for (int j = 0; j < count; ++j) {
            const int i = alive[j];
            if (j + 1 < count) locate_block(a, begin + alive[j + 1], k0, blocks[(j + 1) % 2]);
            const float tau = visit(i, k0, blocks[j % 2]);
            if (a.rays.samples[begin + i] > k0 + lane_count && tau <= a.tau_stop) alive[left++] = i;
        }
        count = left;
    }
}

static void march_dense_forward(const MarchDenseArgs& a, std::int64_t begin, std::int64_t end) {
    const Quadrature form = static_cast<Quadrature>(a.quadrature);
    RayTotals<float> totals[march_chunk];
    walk_chunk(a, begin, end, [&](int i, int k0, SampleBlock& b) {
        evaluate_block(a, begin + i, k0, b);
        composite(form, b.sigma_t, b.rgb, b.t, a.dt, totals[i]);
        return totals[i].tau;
    });
    for (std::int64_t ray = begin; ray < end; ++ray) write_outputs(totals[ray - begin], ray, a.out);
}

// d_raw[c][i]: adjoint of the raw values of one sub-block.
static inline void differentiate_block(const MarchArgs& a, const ShadedBlock& b,
                                       RayCotangents<float>& ray, Lanes<float>* d_raw) {
    Lanes<float> d_sigma_t = {}, d_rgb[3] = {};
    composite_backward(static_cast<Quadrature>(a.quadrature), b.sigma_t, b.rgb, b.t, a.dt, ray,
                       d_sigma_t, d_rgb);
    for (int c = 0; c < 3; ++c)
        activate_lanes_backward(static_cast<Activation>(a.color_activation), b.raw[c], d_rgb[c],
                                d_raw[c]);
    for (int i = 0; i < lane_count; ++i) d_sigma_t[i] = a.density_scale * d_sigma_t[i];
    activate_lanes_backward(static_cast<Activation>(a.density_activation), b.raw[3], d_sigma_t,
                            d_raw[3]);
}

// Writes d_raw of every sample that was passed, and the runs of samples that share a brick.
static std::int64_t march_dense_backward(const MarchDenseArgs& a, const MarchDenseBackward& back,
                                         std::int64_t begin, std::int64_t end, BrickRun* runs) {
    const BrickLayout layout = BrickLayout::of(a.shape);
    RayCotangents<float> cotangents[march_chunk];
    for (std::int64_t ray = begin; ray < end; ++ray)
        cotangents[ray - begin] = start_cotangents(a.out, back.adjoint, ray);
    BrickRun* next = runs;
    walk_chunk(a, begin, end, [&](int i, int k0, SampleBlock& b) {
        const std::int64_t ray = begin + i;
        evaluate_block(a, ray, k0, b);
        Lanes<float> d_raw[4] = {};
        differentiate_block(a, b, cotangents[i], d_raw);
        int brick[lane_count];
        for (int j = 0; j < lane_count; ++j)
            brick[j] = layout.owner(b.base[0][j], b.base[1][j], b.base[2][j]);
        const int used = smaller(lane_count, a.rays.samples[ray] - k0);
        const std::int64_t first = back.sample_offset[ray - back.first_ray] + k0;
        float* out = back.d_raw + 4 * first;
        for (int j = 0; j < used; ++j)
            for (int c = 0; c < 4; ++c) out[4 * j + c] = d_raw[c][j];
        for (int j = 0, start = 0; j < used; ++j) {
            if (j + 1 < used && brick[j + 1] == brick[j]) continue;
            *next++ = {static_cast<std::uint32_t>(brick[j]), static_cast<std::uint32_t>(ray),
                       static_cast<std::uint32_t>(k0 + start),
                       static_cast<std::uint32_t>(j + 1 - start),
                       static_cast<std::uint32_t>(first + start)};
            start = j + 1;
        }
        return cotangents[i].tau;
    });
    return next - runs;
}

// Samples of a brick to be accumulated. Runs are short and of any length; lining up their
// samples in a queue keeps all lanes busy. The queue has room for the block in hand and one more
// run.
struct SampleQueue {
    int used = 0;
    alignas(64) float p[3][2 * lane_count];
    alignas(64) int source[2 * lane_count];  // number of the sample in d_raw
};

// Appends samples k, k + 1, ... of a run, at most lane_count of them; lanes beyond `count` are
// overwritten by whatever comes next.
static inline void enqueue(const MarchDenseArgs& a, const BrickRun& run, SampleQueue& q) {
    const std::int64_t ray = run.ray;
    const float t0 = a.rays.t0[ray], dt = a.dt;
    float t[lane_count];
    for (int i = 0; i < lane_count; ++i)
        t[i] = t0 + (static_cast<float>(static_cast<int>(run.k) + i) + 0.5f) * dt;
    for (int axis = 0; axis < 3; ++axis) {
        const float o = a.rays.origins[3 * ray + axis], d = a.rays.directions[3 * ray + axis];
        float* p = q.p[axis] + q.used;
        for (int i = 0; i < lane_count; ++i) p[i] = o + t[i] * d;
    }
    int* source = q.source + q.used;
    for (int i = 0; i < lane_count; ++i) source[i] = static_cast<int>(run.sample) + i;
    q.used += static_cast<int>(run.count);
}

// Adds the first `count` samples of the queue to a brick's halo.
static inline void add_to_halo(const MarchDenseArgs& a, const SampleQueue& q, int count,
                               const int* corner, const float* d_raw, float* halo) {
    SampleBlock b;
    for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < lane_count; ++i) b.p[axis][i] = q.p[axis][i];
    weigh_block(a, b);
    constexpr int to_y = brick_halo_side * 4, to_x = brick_halo_side * to_y;
    int offset[lane_count];
    for (int i = 0; i < lane_count; ++i)
        offset[i] = (b.base[0][i] - corner[0]) * to_x + (b.base[1][i] - corner[1]) * to_y +
                    (b.base[2][i] - corner[2]) * 4;
    for (int i = 0; i < count; ++i) {
        float* row = halo + offset[i];
        const Float4 d =
            *reinterpret_cast<const Float4*>(d_raw + 4 * static_cast<std::int64_t>(q.source[i]));
        const Float4 near = d * b.z0[i], far = d * b.z1[i];
        const Float8 ends = {near[0], near[1], near[2], near[3], far[0], far[1], far[2], far[3]};
        constexpr int to_row[4] = {0, to_y, to_x, to_x + to_y};
        for (int r = 0; r < 4; ++r)
            *reinterpret_cast<Float8*>(row + to_row[r]) += b.row[r][i] * ends;
    }
}

// All runs of one brick, in the order given, into its halo (brick_halo_side^3, 4).
static void march_dense_gather(const MarchDenseArgs& a, const BrickRun* runs,
                               const std::uint32_t* order, std::int64_t count, const float* d_raw,
                               float* halo) {
    int corner[3];
    BrickLayout::of(a.shape).corner(static_cast<int>(runs[order[0]].brick), corner);
    SampleQueue q = {};
    for (std::int64_t j = 0; j < count; ++j) {
        // Runs of a brick lie far apart in memory; asked for early, they are there when needed.
        if (j + 24 < count) __builtin_prefetch(runs + order[j + 24]);
        if (j + 6 < count) {
            const float* soon = d_raw + 4 * static_cast<std::int64_t>(runs[order[j + 6]].sample);
            __builtin_prefetch(soon);
            __builtin_prefetch(soon + 16);
            __builtin_prefetch(soon + 32);
        }
        enqueue(a, runs[order[j]], q);
        if (q.used < lane_count) continue;
        add_to_halo(a, q, lane_count, corner, d_raw, halo);
        q.used -= lane_count;
        for (int axis = 0; axis < 3; ++axis)
            for (int i = 0; i < lane_count; ++i) q.p[axis][i] = q.p[axis][i + lane_count];
        for (int i = 0; i < lane_count; ++i) q.source[i] = q.source[i + lane_count];
    }
    add_to_halo(a, q, q.used, corner, d_raw, halo);
}

}  // namespace photograd::PHOTOGRAD_ISA
