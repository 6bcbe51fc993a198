// The ray marcher: emission and absorption through any field, and its adjoint.
//
// Four stages over fixed blocks of rays: the sampler places samples (lattice.h), field.eval looks
// them up, composite adds them along each ray (ops/composite.h), and the adjoint runs the stages
// backwards. `walk` is the one loop of both passes, so that positions, early stop and order cannot
// drift apart. Rays of a chunk advance together, lane_count samples each a batch: a field gets
// large batches, and a ray that has become opaque drops out.
//
// Memory is O(1) per ray: the backward pass walks front to back again and subtracts from the totals
// that the forward pass left. march_dense.h and march_sparse_sh.h are fused forms in float.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "photograd/field/samples.h"
#include "photograd/ops/composite.h"
#include "photograd/render/march/chunks.h"

namespace photograd {

struct MarchOptions {
    double dt = 0.01;   // step in meters
    double stop = 0.0;  // early stop below this transmittance; 0 is off, as gradient proofs need it
    Quadrature quadrature = Quadrature::alpha;

    /// The stop as an optical depth, which needs no exp per sub-block; large and finite when off.
    [[nodiscard]] double tau_stop() const { return stop > 0 ? -std::log(stop) : 1e30; }
};

/// Samples that do not lie on the lattice: where they are on each ray, and what length each stands
/// for. Both are held constant: no derivative is taken with respect to them.
template <Real R>
struct PlacedSamples {
    const R* t = nullptr;      // (R, stride), in meters; null for the lattice
    const R* width = nullptr;  // (R, stride), in meters
    std::int64_t stride = 0;
};

/// Rays of a chunk: what the field says, if it does.
template <class F>
constexpr std::int64_t chunk_rays() {
    if constexpr (requires { F::chunk_rays; })
        return F::chunk_rays;
    else
        return march_chunk;
}

namespace detail {

/// The rays of a chunk that still march, and the batch of their next samples.
template <Real R>
struct SampleBatchState {
    std::vector<std::int64_t> rays;
    SampleBatch<R> batch;
    SampleValues<R> values;
    std::vector<Lanes<R>> stretch;  // width of each sample over dt; none on the lattice

    /// Places samples k0, k0 + 1, ... of each ray.
    void place(const RayBatch<R>& all, const PlacedSamples<R>& placed, R dt, std::int64_t begin,
               std::int32_t k0) {
        batch.resize(rays.size());
        values.assign_zero(rays.size());
        for (std::size_t g = 0; g < rays.size(); ++g) {
            const std::int64_t ray = rays[g];
            const R *o = all.origins + 3 * ray, *d = all.directions + 3 * ray;
            Lanes<R>& t = batch.t[g];
            for (int i = 0; i < lane_count; ++i)
                t[i] = all.t0[ray] + (static_cast<R>(k0 + i) + R(0.5)) * dt;
            if (placed.t) {
                stretch.resize(rays.size());
                for (int i = 0; i < lane_count; ++i) {
                    const auto k = ray * placed.stride + std::min(k0 + i, all.samples[ray] - 1);
                    t[i] = placed.t[k];
                    stretch[g][i] = placed.width[k] / dt;
                }
            }
            for (int axis = 0; axis < 3; ++axis)
                for (int i = 0; i < lane_count; ++i)
                    batch.position[axis][g][i] = o[axis] + t[i] * d[axis];
            for (int axis = 0; axis < 3; ++axis) batch.direction[axis][g] = d[axis];
            batch.used[g] = std::min(lane_count, all.samples[ray] - k0);
            batch.ray[g] = static_cast<std::uint32_t>(ray - begin);
        }
    }
    /// Extinction times width is extinction times this times dt; the same for derivatives.
    void stretch_by_width(std::vector<Lanes<R>>& sigma_t) const {
        for (std::size_t g = 0; g < std::min(stretch.size(), sigma_t.size()); ++g)
            for (int i = 0; i < lane_count; ++i) sigma_t[g][i] *= stretch[g][i];
    }
};

/// The one loop. lookup(batch, values) writes the field's values of a batch and returns its cache;
/// pass.on_group(ray, state, g) composites group g and returns the optical depth behind it;
/// pass.on_batch(state, cache) then gets the whole batch.
template <Real R, class Lookup, class Pass>
void walk(Lookup lookup, const RayBatch<R>& rays, const PlacedSamples<R>& placed,
          const MarchOptions& options, std::int64_t begin, std::int64_t end, Pass& pass) {
    const R dt = static_cast<R>(options.dt), tau_stop = static_cast<R>(options.tau_stop());
    SampleBatchState<R> state;
    for (std::int64_t ray = begin; ray < end; ++ray)
        if (rays.samples[ray] > 0) state.rays.push_back(ray);
    for (std::int32_t k0 = 0; !state.rays.empty(); k0 += lane_count) {
        state.place(rays, placed, dt, begin, k0);
        const auto& cache = lookup(state.batch, state.values);
        state.stretch_by_width(state.values.sigma_t);
        std::vector<std::int64_t> alive;
        for (std::size_t g = 0; g < state.rays.size(); ++g) {
            for (int i = state.batch.used[g]; i < lane_count; ++i)
                state.values.sigma_t[g][i] = R(0);
            const std::int64_t ray = state.rays[g];
            const R tau = pass.on_group(ray, state, g);
            if (rays.samples[ray] > k0 + lane_count && tau <= tau_stop) alive.push_back(ray);
        }
        pass.on_batch(state, cache);
        state.rays.swap(alive);
    }
}

template <Real R>
struct GroupColors {  // the color lanes of group g side by side, as composite takes them
    Lanes<R> rgb[3];
    GroupColors(const SampleValues<R>& values, std::size_t g)
        : rgb{values.rgb[0][g], values.rgb[1][g], values.rgb[2][g]} {}
};

template <Real R>
struct ForwardPass {
    Quadrature form;
    R dt;
    std::int64_t begin;
    std::vector<RayTotals<R>> totals;

    R on_group(std::int64_t ray, const SampleBatchState<R>& state, std::size_t g) {
        RayTotals<R>& total = totals[static_cast<std::size_t>(ray - begin)];
        const GroupColors<R> in(state.values, g);
        composite(form, state.values.sigma_t[g], in.rgb, state.batch.t[g], dt, total);
        return total.tau;
    }
    template <class Cache>
    void on_batch(const SampleBatchState<R>&, const Cache&) {}
};

template <Real R, class F>
struct BackwardPass {
    const F& field;
    Quadrature form;
    R dt;
    std::int64_t begin;
    int chunk;
    typename F::Sink& sink;
    const MarchAdjoint<R>& adjoint;
    std::vector<RayCotangents<R>> cotangents;
    SampleValues<R> d_values{};
    std::vector<Lanes<R>> d_position[3]{};
    std::vector<R> d_direction[3]{};  // through the color; that through the positions comes below

    R on_group(std::int64_t ray, const SampleBatchState<R>& state, std::size_t g) {
        if (g == 0) {
            d_values.assign_zero(state.rays.size());
            for (auto& axis : d_position) axis.assign(state.rays.size(), Lanes<R>{});
            for (auto& axis : d_direction) axis.assign(state.rays.size(), R(0));
        }
        RayCotangents<R>& along = cotangents[static_cast<std::size_t>(ray - begin)];
        const GroupColors<R> in(state.values, g);
        Lanes<R> d_rgb[3] = {};
        composite_backward(form, state.values.sigma_t[g], in.rgb, state.batch.t[g], dt, along,
                           d_values.sigma_t[g], d_rgb);
        for (int c = 0; c < 3; ++c) d_values.rgb[c][g] = d_rgb[c];
        return along.tau;
    }
    template <class Cache>
    void on_batch(const SampleBatchState<R>& state, const Cache& cache) {
        const bool camera = adjoint.d_origins != nullptr;
        auto* d_p = camera ? d_position : nullptr;
        auto* d_d = camera ? d_direction : nullptr;
        state.stretch_by_width(d_values.sigma_t);
        field.backward(state.batch, cache, d_values, sink, chunk, d_p, d_d);
        if (!camera) return;
        // p = o + t d with t fixed:  d_o = sum d_p,  d_d = sum t d_p.
        for (std::size_t g = 0; g < state.rays.size(); ++g)
            for (int axis = 0; axis < 3; ++axis) {
                Lanes<R> along;
                for (int i = 0; i < lane_count; ++i)
                    along[i] = state.batch.t[g][i] * d_position[axis][g][i];
                adjoint.d_origins[3 * state.rays[g] + axis] += sum(d_position[axis][g]);
                adjoint.d_directions[3 * state.rays[g] + axis] += sum(along) + d_direction[axis][g];
            }
    }
};

}  // namespace detail

/// Evaluates each batch, in one cache. Another form is in render/march/kept_samples.h.
template <class F>
struct Evaluation {
    const F& field;
    typename F::Cache cache{};

    const typename F::Cache& operator()(const SampleBatch<typename F::Scalar>& batch,
                                        SampleValues<typename F::Scalar>& values) {
        field.eval(batch, cache, values);
        return cache;
    }
};

/// lookup_of(chunk) looks up the batches of a chunk of rays, see detail::walk.
template <class F, Real R, class LookupOf>
void march_by(const LookupOf& lookup_of, const RayBatch<R>& rays, const MarchOptions& options,
              const MarchOutputs<R>& out, const PlacedSamples<R>& placed = {}) {
    for_chunks(
        0, rays.count,
        [&](std::int64_t chunk, std::int64_t begin, std::int64_t end) {
            detail::ForwardPass<R> pass{options.quadrature, static_cast<R>(options.dt), begin, {}};
            pass.totals.resize(static_cast<std::size_t>(end - begin));
            detail::walk(lookup_of(chunk), rays, placed, options, begin, end, pass);
            for (std::int64_t ray = begin; ray < end; ++ray)
                write_outputs(pass.totals[static_cast<std::size_t>(ray - begin)], ray, out);
        },
        chunk_rays<F>());
}
template <Real R, class F>
void march(const F& field, const RayBatch<R>& rays, const MarchOptions& options,
           const MarchOutputs<R>& out) {
    march_by<F>([&](std::int64_t) { return Evaluation<F>{field}; }, rays, options, out);
}

/// Adds parameter gradients to the sink's buffer, and gradients of the rays where `adjoint` has
/// room. lookup_of(chunk) looks up the batches of a chunk of a slab, see detail::walk.
template <Real R, class F, class LookupOf>
void march_backward_by(const LookupOf& lookup_of, const F& field, const RayBatch<R>& rays,
                       const MarchOptions& options, const MarchOutputs<R>& out,
                       const MarchAdjoint<R>& adjoint, typename F::Sink& sink,
                       const PlacedSamples<R>& placed = {}) {
    for_slabs(rays.samples, rays.count, [&](std::int64_t first, std::int64_t last) {
        sink.begin(static_cast<int>(chunk_count(last - first, chunk_rays<F>())));
        for_chunks(
            first, last,
            [&](std::int64_t chunk, std::int64_t begin, std::int64_t end) {
                detail::BackwardPass<R, F> pass{field,
                                                options.quadrature,
                                                static_cast<R>(options.dt),
                                                begin,
                                                static_cast<int>(chunk),
                                                sink,
                                                adjoint,
                                                {}};
                for (std::int64_t ray = begin; ray < end; ++ray)
                    pass.cotangents.push_back(start_cotangents(out, adjoint, ray));
                detail::walk(lookup_of(chunk), rays, placed, options, begin, end, pass);
            },
            chunk_rays<F>());
        sink.finish();
    });
}
template <Real R, class F>
void march_backward(const F& field, const RayBatch<R>& rays, const MarchOptions& options,
                    const MarchOutputs<R>& out, const MarchAdjoint<R>& adjoint,
                    typename F::Sink& sink) {
    march_backward_by([&](std::int64_t) { return Evaluation<F>{field}; }, field, rays, options, out,
                      adjoint, sink);
}

}  // namespace photograd
