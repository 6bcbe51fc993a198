// The ray marcher: emission and absorption through any field, and its adjoint.
//
// Four stages over fixed blocks of rays: the sampler places samples (lattice.h), field.eval looks them
// up, composite adds them along each ray (ops/composite.h), and the adjoint walks the same stages back.
// `walk` is the one loop: both passes run through it, so that positions, early stop and order cannot
// drift apart. Rays of a chunk advance together, lane_count samples a wave, so that a field sees large
// batches and a ray that has become opaque drops out.
//
// Memory is O(1) per ray: the backward pass walks front to back again and subtracts from the totals that
// the forward pass left. march_dense.h is the fused form for the dense grid in float.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/march_dense.h"
#include "photograd/core/parallel.h"
#include "photograd/field/samples.h"
#include "photograd/ops/composite.h"

namespace photograd {

struct MarchOptions {
    double dt = 0.01;   // step in metres
    double stop = 0.0;  // early stop below this transmittance; 0 is off, as gradient proofs need it
    Quadrature quadrature = Quadrature::alpha;

    /// The stop as an optical depth, which needs no exp per sub-block; large and finite when off.
    [[nodiscard]] double tau_stop() const { return stop > 0 ? -std::log(stop) : 1e30; }
};

template <Real R>
struct RayBatch {
    std::int64_t count;
    const R* origins;             // (R, 3)
    const R* directions;          // (R, 3) unit
    const R* t0;                  // (R,) sample k lies at t0 + (k + 1/2) dt
    const std::int32_t* samples;  // (R,)
};

/// What a march leaves per ray. color excludes the background: image = color + transmittance background.
template <Real R>
struct RayOutputs {
    R* color;          // (R, 3) sum of w_k c_k
    R* transmittance;  // (R,) behind the last sample; opacity = 1 - transmittance
    R* depth;          // (R,) sum of w_k t_k
};

template <Real R>
struct RayAdjoints {
    const R* d_color;          // (R, 3) wrt color without background
    const R* d_transmittance;  // (R,)
    const R* d_depth;          // (R,)
    R* d_origins =
        nullptr;  // (R, 3) or null: camera adjoint, interior term (the clip is held fixed)
    R* d_directions = nullptr;
};

inline constexpr std::int64_t march_slab_samples = 1 << 20;  // samples whose contributions are kept

namespace detail {

/// The rays of a chunk that are still marching, and the batch of their next samples.
template <Real R>
struct Wave {
    std::vector<std::int64_t> rays;
    SampleBatch<R> batch;
    SampleValues<R> values;
};

template <Real R>
void place_wave(const RayBatch<R>& rays, R dt, std::int64_t begin, std::int32_t k0, Wave<R>& wave) {
    wave.batch.resize(wave.rays.size());
    wave.values.assign_zero(wave.rays.size());
    for (std::size_t g = 0; g < wave.rays.size(); ++g) {
        const std::int64_t ray = wave.rays[g];
        const R *o = rays.origins + 3 * ray, *d = rays.directions + 3 * ray;
        Lanes<R>& t = wave.batch.t[g];
        for (int i = 0; i < lane_count; ++i)
            t[i] = rays.t0[ray] + (static_cast<R>(k0 + i) + R(0.5)) * dt;
        for (int axis = 0; axis < 3; ++axis)
            for (int i = 0; i < lane_count; ++i)
                wave.batch.position[axis][g][i] = o[axis] + t[i] * d[axis];
        for (int axis = 0; axis < 3; ++axis) wave.batch.direction[axis][g] = d[axis];
        wave.batch.used[g] = std::min(lane_count, rays.samples[ray] - k0);
        wave.batch.ray[g] = static_cast<std::uint32_t>(ray - begin);
    }
}

/// The one loop. pass.ray(ray, wave, g) composites group g and returns the optical depth behind it;
/// pass.wave(wave, cache) then sees the whole batch.
template <Real R, class F, class Pass>
void walk(const F& field, const RayBatch<R>& rays, const MarchOptions& options, std::int64_t begin,
          std::int64_t end, Pass& pass) {
    const R dt = static_cast<R>(options.dt), tau_stop = static_cast<R>(options.tau_stop());
    typename F::Cache cache;
    Wave<R> wave;
    for (std::int64_t ray = begin; ray < end; ++ray)
        if (rays.samples[ray] > 0) wave.rays.push_back(ray);
    for (std::int32_t k0 = 0; !wave.rays.empty(); k0 += lane_count) {
        place_wave(rays, dt, begin, k0, wave);
        field.eval(wave.batch, cache, wave.values);
        std::vector<std::int64_t> alive;
        for (std::size_t g = 0; g < wave.rays.size(); ++g) {
            for (int i = wave.batch.used[g]; i < lane_count; ++i) wave.values.sigma_t[g][i] = R(0);
            const std::int64_t ray = wave.rays[g];
            const R tau = pass.ray(ray, wave, g);
            if (rays.samples[ray] > k0 + lane_count && tau <= tau_stop) alive.push_back(ray);
        }
        pass.wave(wave, cache);
        wave.rays.swap(alive);
    }
}

template <Real R>
struct Gather {  // the colour lanes of group g side by side, as composite wants them
    Lanes<R> rgb[3];
    Gather(const SampleValues<R>& values, std::size_t g)
        : rgb{values.rgb[0][g], values.rgb[1][g], values.rgb[2][g]} {}
};

template <Real R>
struct ForwardPass {
    Quadrature form;
    R dt;
    std::int64_t begin;
    std::vector<RayTotals<R>> totals;

    R ray(std::int64_t ray, const Wave<R>& wave, std::size_t g) {
        RayTotals<R>& total = totals[static_cast<std::size_t>(ray - begin)];
        const Gather<R> in(wave.values, g);
        composite(form, wave.values.sigma_t[g], in.rgb, wave.batch.t[g], dt, total);
        return total.tau;
    }
    template <class Cache>
    void wave(const Wave<R>&, const Cache&) {}
};

template <Real R, class F>
struct BackwardPass {
    const F& field;
    Quadrature form;
    R dt;
    std::int64_t begin;
    int chunk;
    typename F::Sink& sink;
    const RayAdjoints<R>& adjoints;
    std::vector<RayCotangents<R>> rays;
    SampleValues<R> d_values{};
    std::vector<Lanes<R>> d_position[3]{};
    std::vector<R> d_direction[3]{};  // through the colour; that through the positions comes below

    R ray(std::int64_t ray, const Wave<R>& wave, std::size_t g) {
        if (g == 0) {
            d_values.assign_zero(wave.rays.size());
            for (auto& axis : d_position) axis.assign(wave.rays.size(), Lanes<R>{});
            for (auto& axis : d_direction) axis.assign(wave.rays.size(), R(0));
        }
        RayCotangents<R>& cotangents = rays[static_cast<std::size_t>(ray - begin)];
        const Gather<R> in(wave.values, g);
        Lanes<R> d_rgb[3] = {};
        composite_backward(form, wave.values.sigma_t[g], in.rgb, wave.batch.t[g], dt, cotangents,
                           d_values.sigma_t[g], d_rgb);
        for (int c = 0; c < 3; ++c) d_values.rgb[c][g] = d_rgb[c];
        return cotangents.tau;
    }
    template <class Cache>
    void wave(const Wave<R>& wave, const Cache& cache) {
        const bool camera = adjoints.d_origins != nullptr;
        auto* d_p = camera ? d_position : nullptr;
        auto* d_d = camera ? d_direction : nullptr;
        if constexpr (requires {
                          field.backward(wave.batch, cache, d_values, sink, chunk, d_p, d_d);
                      })
            field.backward(wave.batch, cache, d_values, sink, chunk, d_p, d_d);
        else
            field.backward(wave.batch, cache, d_values, sink, chunk, d_p);
        if (!camera) return;
        // p = o + t d with t fixed:  d_o = sum d_p,  d_d = sum t d_p.
        for (std::size_t g = 0; g < wave.rays.size(); ++g)
            for (int axis = 0; axis < 3; ++axis) {
                Lanes<R> along;
                for (int i = 0; i < lane_count; ++i)
                    along[i] = wave.batch.t[g][i] * d_position[axis][g][i];
                adjoints.d_origins[3 * wave.rays[g] + axis] += sum(d_position[axis][g]);
                adjoints.d_directions[3 * wave.rays[g] + axis] += sum(along) + d_direction[axis][g];
            }
    }
};

/// End of the slab that starts at `begin`: at most march_slab_samples samples, at least one chunk.
inline std::int64_t slab_end(const std::int32_t* samples, std::int64_t begin, std::int64_t count) {
    std::int64_t total = 0, end = begin;
    while (end < count && (end < begin + march_chunk || total + samples[end] <= march_slab_samples))
        total += samples[end++];
    return end;
}

template <Real R>
RayCotangents<R> start_cotangents(const RayOutputs<R>& out, const RayAdjoints<R>& adjoints,
                                  std::int64_t ray) {
    RayCotangents<R> c;
    for (int k = 0; k < 3; ++k) c.d_color[k] = adjoints.d_color[3 * ray + k];
    c.d_depth = adjoints.d_depth[ray];
    // L depends on T_end through -opacity and the background; the caller folded both into one cotangent.
    c.end_term = -(adjoints.d_transmittance[ray] * out.transmittance[ray]);
    c.remainder = ((c.d_color[0] * out.color[3 * ray] + c.d_color[1] * out.color[3 * ray + 1]) +
                   c.d_color[2] * out.color[3 * ray + 2]) +
                  c.d_depth * out.depth[ray];
    return c;
}

}  // namespace detail

template <Real R, class F>
void march(const F& field, const RayBatch<R>& rays, const MarchOptions& options,
           const RayOutputs<R>& out) {
    const std::int64_t chunks = (rays.count + march_chunk - 1) / march_chunk;
    parallel_for(chunks, [&](std::int64_t chunk) {
        const std::int64_t begin = chunk * march_chunk;
        const std::int64_t end = std::min(begin + march_chunk, rays.count);
        detail::ForwardPass<R> pass{options.quadrature, static_cast<R>(options.dt), begin, {}};
        pass.totals.resize(static_cast<std::size_t>(end - begin));
        detail::walk(field, rays, options, begin, end, pass);
        for (std::int64_t ray = begin; ray < end; ++ray) {
            const RayTotals<R>& total = pass.totals[static_cast<std::size_t>(ray - begin)];
            for (int c = 0; c < 3; ++c) out.color[3 * ray + c] = sum(total.color[c]);
            out.transmittance[ray] = exp(-total.tau);
            out.depth[ray] = sum(total.depth);
        }
    });
}

/// Adds parameter gradients to the sink's buffer, and camera adjoints where they are asked for.
template <Real R, class F>
void march_backward(const F& field, const RayBatch<R>& rays, const MarchOptions& options,
                    const RayOutputs<R>& out, const RayAdjoints<R>& adjoints,
                    typename F::Sink& sink) {
    for (std::int64_t first = 0, last; first < rays.count; first = last) {
        last = detail::slab_end(rays.samples, first, rays.count);
        const std::int64_t chunks = (last - first + march_chunk - 1) / march_chunk;
        sink.begin(static_cast<int>(chunks));
        parallel_for(chunks, [&](std::int64_t chunk) {
            const std::int64_t begin = first + chunk * march_chunk;
            const std::int64_t end = std::min(begin + march_chunk, last);
            detail::BackwardPass<R, F> pass{field,
                                            options.quadrature,
                                            static_cast<R>(options.dt),
                                            begin,
                                            static_cast<int>(chunk),
                                            sink,
                                            adjoints,
                                            {}};
            for (std::int64_t ray = begin; ray < end; ++ray)
                pass.rays.push_back(detail::start_cotangents(out, adjoints, ray));
            detail::walk(field, rays, options, begin, end, pass);
        });
        sink.finish();
    }
}

}  // namespace photograd
