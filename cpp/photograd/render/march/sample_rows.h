// A march in separate stages, for fields that are decoded between lookup and compositing: the
// visible samples of all rays as one list, their weights, and sums over the samples of a ray.
//
//   s_k = sigma_k dt,   w_k = exp(-s_0 - ... - s_{k-1}) (1 - exp(-s_k)),   T = exp(-sum_k s_k)
//   out = sum_k w_k x_k                                 x: colors, features, distances
//
//   d_s_k = exp(-s_0 - ... - s_k) d_w_k - sum_{j>k} w_j d_w_j - d_T T
//
// Samples of ray r are rows offset[r] .. offset[r + 1] - 1, front to back. What lies in cells where
// no voxel is active is left out: it is empty.
#pragma once

#include <vector>

#include "photograd/field/sparse_sh.h"
#include "photograd/ops/sh.h"
#include "photograd/render/march/chunks.h"

namespace photograd {

/// Samples of rays in cells with an active voxel: their number a ray, and where they are.
template <Real R>
struct VisibleSamples {
    std::vector<std::int64_t> offset;  // (R + 1,)
    std::vector<R> t;                  // (M,) along the ray
    std::vector<R> point;              // (M, 3) in voxels: voxel i has its value at i
};

/// Of a grid that `field` describes by its table and box; its values are not read.
template <Real R>
VisibleSamples<R> visible_samples(const SparseSh<R>& field, const RayBatch<R>& rays, R dt) {
    VisibleSamples<R> out;
    out.offset.assign(static_cast<std::size_t>(rays.count) + 1, 0);
    const auto each = [&](std::int64_t ray, auto&& visit) {
        const R *o = rays.origins + 3 * ray, *d = rays.directions + 3 * ray;
        for (std::int32_t k = 0; k < rays.samples[ray]; ++k) {
            const R t = rays.t0[ray] + (static_cast<R>(k) + R(0.5)) * dt;
            R q[3];
            for (int a = 0; a < 3; ++a)
                q[a] = (o[a] + t * d[a] - field.lo[a]) * field.scale[a] - R(0.5);
            std::int32_t row[8];
            if (field.rows(CellPoint<R>::of(q).base, row)) visit(t, q);
        }
    };
    for_chunks(0, rays.count, [&](std::int64_t, std::int64_t begin, std::int64_t end) {
        for (std::int64_t ray = begin; ray < end; ++ray) {
            std::int64_t count = 0;
            each(ray, [&](R, const R*) { ++count; });
            out.offset[static_cast<std::size_t>(ray) + 1] = count;
        }
    });
    for (std::size_t r = 1; r < out.offset.size(); ++r) out.offset[r] += out.offset[r - 1];
    const auto total = static_cast<std::size_t>(out.offset.back());
    out.t.resize(total);
    out.point.resize(3 * total);
    for_chunks(0, rays.count, [&](std::int64_t, std::int64_t begin, std::int64_t end) {
        for (std::int64_t ray = begin; ray < end; ++ray) {
            auto at = static_cast<std::size_t>(out.offset[static_cast<std::size_t>(ray)]);
            each(ray, [&](R t, const R* q) {
                out.t[at] = t;
                std::copy_n(q, 3, out.point.data() + 3 * at++);
            });
        }
    });
    return out;
}

/// Rows of samples, a range of them a ray.
struct SampleRows {
    std::int64_t rays;
    const std::int64_t* offset;  // (R + 1,)

    template <class Visit>
    void for_rays(Visit&& visit) const {
        for_chunks(0, rays, [&](std::int64_t, std::int64_t begin, std::int64_t end) {
            for (std::int64_t ray = begin; ray < end; ++ray)
                visit(ray, offset[ray], offset[ray + 1]);
        });
    }
};

/// weight (M,), behind (M,): transmittance behind each sample; transmittance (R,).
template <Real R>
void sample_weights(const SampleRows& rows, const R* sigma_t, R dt, R* weight, R* behind,
                    R* transmittance) {
    rows.for_rays([&](std::int64_t ray, std::int64_t first, std::int64_t last) {
        R tau = R(0), front = R(1);
        for (std::int64_t k = first; k < last; ++k) {
            const R s = sigma_t[k] * dt;
            weight[k] = front * -expm1(-s);
            tau += s;
            behind[k] = front = exp(-tau);
        }
        transmittance[ray] = front;
    });
}

/// d_sigma_t (M,) for d_weight (M,) and d_transmittance (R,).
template <Real R>
void sample_weights_backward(const SampleRows& rows, const R* weight, const R* behind, R dt,
                             const R* d_weight, const R* d_transmittance, R* d_sigma_t) {
    rows.for_rays([&](std::int64_t ray, std::int64_t first, std::int64_t last) {
        if (first == last) return;
        R later = d_transmittance[ray] * behind[last - 1];
        for (std::int64_t k = last - 1; k >= first; --k) {
            d_sigma_t[k] = dt * (behind[k] * d_weight[k] - later);
            later += weight[k] * d_weight[k];
        }
    });
}

/// out (R, C): sum_k weight_k values_k of values (M, C).
template <Real R>
void blend_samples(const SampleRows& rows, const R* weight, const R* values, int channels, R* out) {
    rows.for_rays([&](std::int64_t ray, std::int64_t first, std::int64_t last) {
        R* to = out + ray * channels;
        std::fill_n(to, channels, R(0));
        for (std::int64_t k = first; k < last; ++k)
            for (int c = 0; c < channels; ++c) to[c] += weight[k] * values[k * channels + c];
    });
}

}  // namespace photograd
