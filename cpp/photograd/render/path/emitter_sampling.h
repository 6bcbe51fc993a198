// Next event estimation: an emitter, a direction to it, and the radiance that comes from there.
#pragma once

#include <limits>

#include "photograd/render/path/options.h"
#include "photograd/render/path/record.h"
#include "photograd/sampling/dimensions.h"

namespace photograd {

/// Where a shadow ray ends.
template <class R>
struct ShadowTarget {
    bool infinite = false;
    Vec3<R> end{R(0)};
};

template <Real R>
class EmitterSampler {
public:
    EmitterSampler(const PathScene<R>& scene, const PathOptions& options)
        : scene_(scene), options_(options) {}

    /// Whether there is anything to sample. With Strategy::bsdf that is delta lights alone: no ray
    /// can hit them.
    [[nodiscard]] bool has_direct() const {
        const SceneLights& lights = scene_.geometry->lights;
        return options_.strategy == Strategy::bsdf ? lights.has_delta() : !lights.empty();
    }

    /// Fills everything of `emitter` that is not the scattering's: `pdf` 0 if nothing is visible
    /// from there. `hit`: the vertex that is lit.
    ShadowTarget<R> sample_emitter(const SurfaceHit<R>& hit, const Philox4& words,
                                   EmitterSample<R>& emitter) const {
        const SceneLights& lights = scene_.geometry->lights;
        const Vec2<R> u2(uniform_from<R>(words[dimensions::emitter_u]),
                         uniform_from<R>(words[dimensions::emitter_v]));
        const double u = uniform_from<double>(words[dimensions::emitter]);
        const Choice choice =
            options_.strategy == Strategy::bsdf ? lights.choose_delta(u) : lights.choose(u);
        emitter.point = hit.position;
        return choice.index >= lights.infinite_and_delta_count()
                   ? sample_area_emitter(hit, choice, u2, emitter)
                   : sample_other_emitter(choice, u2, emitter);
    }

    /// Weight of an emitter sample against BSDF sampling.
    [[nodiscard]] R sample_weight(const EmitterSample<R>& emitter) const {
        // No ray hits a delta light.
        if (options_.strategy == Strategy::light || emitter.shape == SceneLights::delta)
            return R(1);
        return mis_weight(options_.heuristic, emitter.pdf, emitter.bsdf_pdf);
    }
    /// Weight of emission that a path hits against emitter sampling.
    [[nodiscard]] R hit_weight(R pdf, R emitter_pdf) const {
        if (pdf == R(0) || emitter_pdf == R(0) || options_.strategy == Strategy::bsdf) return R(1);
        if (options_.strategy == Strategy::light) return R(0);
        return mis_weight(options_.heuristic, pdf, emitter_pdf);
    }

private:
    ShadowTarget<R> sample_area_emitter(const SurfaceHit<R>& hit, const Choice& choice,
                                        const Vec2<R>& u2, EmitterSample<R>& emitter) const {
        const PathGeometry& geometry = *scene_.geometry;
        const EmissivePrimitive& primitive = geometry.lights.primitive(choice.index);
        emitter.shape = primitive.shape;
        // A sphere never lights itself; rounding could make it visible from a point on it.
        if (primitive.shape == hit.shape && primitive.shape >= geometry.bvh.sphere_instance())
            return {};
        const EmissiveSample<R> found =
            geometry.lights.sample(geometry.bvh, primitive, emitter.point, u2);
        const Vec3<R> end = emitter.point + found.light.direction * found.light.distance;
        emitter.uv = emissive_uv(geometry, primitive, end);
        emitter.Le = scene_.emitted(primitive.shape, emitter.uv);
        emitter.direction = found.light.direction;
        emitter.pdf = R(choice.pmf) * found.light.pdf;
        return {false, end + found.normal * R(geometry.offset)};
    }
    ShadowTarget<R> sample_other_emitter(const Choice& choice, const Vec2<R>& u2,
                                         EmitterSample<R>& emitter) const {
        const AnyLight<R>& light = scene_.lights[static_cast<std::size_t>(choice.index)];
        const LightSample<R> found = sample_any(light, emitter.point, u2);
        emitter.direction = found.direction;
        emitter.light = static_cast<std::int32_t>(choice.index);
        if (is_delta(light)) {
            emitter.shape = SceneLights::delta;
            emitter.Le = found.radiance;
            emitter.pdf = R(choice.pmf) * found.pdf;
        } else {
            const Background<R> behind =
                scene_.behind(found.direction, choice.index, {found.radiance, found.pdf});
            emitter.shape = SceneLights::background;
            emitter.Le = behind.radiance;
            emitter.pdf = behind.pdf;
        }
        if (!(found.distance < std::numeric_limits<R>::max())) return {true};
        return {false, emitter.point + found.direction * found.distance};
    }

    const PathScene<R>& scene_;
    PathOptions options_;
};

}  // namespace photograd
