// Emission-absorption compositing along one ray [Max1995], [Mildenhall2020, Eq. 3].
//
// Sample k covers a step dt with extinction sigma_k and color c_k. With s_k = sigma_k dt,
//
//   tau_k   = s_0 + ... + s_{k-1}                 optical depth in front of sample k (exclusive!)
//   T_k     = exp(-tau_k)                         transmittance in front of it
//   alpha_k = 1 - exp(-s_k)                       opacity of the step, never above 1
//   w_k     = T_k alpha_k                         alpha form (default)
//   w_k     = T_k s_k                             Riemann form: first order, may exceed 1
//
//   color = sum_k w_k c_k + T_end background,  opacity = 1 - T_end,  depth = sum_k w_k t_k
//
// (depth is weighted by opacity, not divided by it). Adjoint, with v_k = <d_color, c_k> + d_depth
// t_k:
//
//   d_c_k   = w_k d_color
//   alpha:    dw_k/ds_k = T_k (1 - alpha_k) = T_{k+1},   dw_j/ds_k = -w_j for j > k
//   Riemann:  dw_k/ds_k = T_k,                           dw_j/ds_k = -w_j for j > k
//   dT_end/ds_k = -T_end
//   d_sigma_k = dt (dw_k/ds_k v_k - sum_{j>k} w_j v_j + (d_opacity - <d_color, background>) T_end)
//
// The sum over later samples needs no memory: the forward pass left sum_j w_j v_j = <d_color, color
// - T_end background> + d_depth depth, and the backward pass walks front to back again and
// subtracts what it has passed. Nothing is divided by T or 1 - alpha, so opaque walls are harmless.
//
// The ray is walked in sub-blocks of lane_count samples. Both passes call `composite_weights`, so
// the early stop (after a sub-block that leaves T below a threshold) acts at the same sample in
// both.
#pragma once

#include "photograd/core/lanes.h"
#include "photograd/ops/activation.h"
#include "photograd/ops/march_data.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

enum class Quadrature : int { alpha = 0, riemann = 1 };

/// What a sub-block of samples contributes: weights, and T behind each sample.
template <class R>
struct SampleWeights {
    Lanes<R> w;
    Lanes<R> slope;  // dw_k / ds_k
    R tau_end;       // optical depth behind the block
};

template <class R>
inline SampleWeights<R> composite_weights(Quadrature form, R tau, const Lanes<R>& sigma_t, R dt) {
    Lanes<R> s;
    for (int i = 0; i < lane_count; ++i) s[i] = sigma_t[i] * dt;
    const Lanes<R> through = running_sum(s);
    Lanes<R> front;
    for (int i = 0; i < lane_count; ++i) front[i] = exp(-(tau + (through[i] - s[i])));
    SampleWeights<R> out;
    if (form == Quadrature::alpha) {
        for (int i = 0; i < lane_count; ++i) out.w[i] = front[i] * -expm1(-s[i]);
        for (int i = 0; i < lane_count; ++i) out.slope[i] = front[i] - out.w[i];
    } else {
        for (int i = 0; i < lane_count; ++i) out.w[i] = front[i] * s[i];
        out.slope = front;
    }
    out.tau_end = tau + through[lane_count - 1];
    return out;
}

/// Running totals of a ray. Sums are kept per lane and added up once at the end (`sum` in lanes.h).
template <class R>
struct RayTotals {
    R tau = R(0);
    Lanes<R> color[3] = {};
    Lanes<R> depth = {};
};

/// Adds one sub-block to the totals. rgb[c][i] and t[i] belong to sample i; unused lanes have
/// sigma_t 0.
template <class R>
inline void composite(Quadrature form, const Lanes<R>& sigma_t, const Lanes<R>* rgb,
                      const Lanes<R>& t, R dt, RayTotals<R>& totals) {
    const SampleWeights<R> block = composite_weights(form, totals.tau, sigma_t, dt);
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < lane_count; ++i)
            totals.color[c][i] = totals.color[c][i] + block.w[i] * rgb[c][i];
    for (int i = 0; i < lane_count; ++i) totals.depth[i] = totals.depth[i] + block.w[i] * t[i];
    totals.tau = block.tau_end;
}

/// Writes the outputs of a ray whose totals are complete.
template <class R>
inline void write_outputs(const RayTotals<R>& total, std::int64_t ray, const MarchOutputs<R>& out) {
    for (int c = 0; c < 3; ++c) out.color[3 * ray + c] = sum(total.color[c]);
    out.transmittance[ray] = exp(-total.tau);
    out.depth[ray] = sum(total.depth);
}

/// Cotangents of a ray, and what the backward walk still has in front of it.
template <class R>
struct RayCotangents {
    R d_color[3];
    R d_depth;
    R end_term;   // (d_opacity - <d_color, background>) T_end
    R remainder;  // sum of w_j v_j over the samples not yet passed
    R tau = R(0);
};

/// Where the backward walk of a ray starts, from the outputs of the forward pass.
template <class R>
inline RayCotangents<R> start_cotangents(const MarchOutputs<R>& out, const MarchAdjoint<R>& adjoint,
                                         std::int64_t ray) {
    RayCotangents<R> c;
    for (int k = 0; k < 3; ++k) c.d_color[k] = adjoint.d_color[3 * ray + k];
    c.d_depth = adjoint.d_depth[ray];
    c.end_term = -(adjoint.d_transmittance[ray] * out.transmittance[ray]);
    c.remainder = ((c.d_color[0] * out.color[3 * ray] + c.d_color[1] * out.color[3 * ray + 1]) +
                   c.d_color[2] * out.color[3 * ray + 2]) +
                  c.d_depth * out.depth[ray];
    return c;
}

/// Adds d_sigma_t[i] and d_rgb[c][i] of one sub-block, and moves `ray` behind it.
template <class R>
inline void composite_backward(Quadrature form, const Lanes<R>& sigma_t, const Lanes<R>* rgb,
                               const Lanes<R>& t, R dt, RayCotangents<R>& ray, Lanes<R>& d_sigma_t,
                               Lanes<R>* d_rgb) {
    const SampleWeights<R> block = composite_weights(form, ray.tau, sigma_t, dt);
    const R d_color[3] = {ray.d_color[0], ray.d_color[1], ray.d_color[2]};
    const R d_depth = ray.d_depth, remainder = ray.remainder, end_term = ray.end_term;
    Lanes<R> v, passed;
    for (int i = 0; i < lane_count; ++i)
        v[i] = ((d_color[0] * rgb[0][i] + d_color[1] * rgb[1][i]) + d_color[2] * rgb[2][i]) +
               d_depth * t[i];
    for (int i = 0; i < lane_count; ++i) passed[i] = block.w[i] * v[i];
    const Lanes<R> through = running_sum(passed);
    for (int i = 0; i < lane_count; ++i) {
        const R later = remainder - through[i];
        d_sigma_t[i] = d_sigma_t[i] + dt * ((block.slope[i] * v[i] - later) + end_term);
    }
    for (int c = 0; c < 3; ++c)
        for (int i = 0; i < lane_count; ++i) d_rgb[c][i] = d_rgb[c][i] + block.w[i] * d_color[c];
    ray.remainder = ray.remainder - through[lane_count - 1];
    ray.tau = block.tau_end;
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
