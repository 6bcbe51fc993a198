// Next event estimation at the vertices of sixteen paths: an emitter each, weighted against BSDF
// sampling, and its shadow ray.
#pragma once

#include "photograd/render/path/emitter_sampling.h"
#include "photograd/render/path/lane.h"
#include "photograd/render/path/shadow_rays.h"

namespace photograd {

template <class R>
bool is_black(const Vec3<R>& v) {
    return v.x == R(0) && v.y == R(0) && v.z == R(0);
}

template <Real R, bool Media>
class DirectLighting {
public:
    DirectLighting(const PathScene<R>& scene, const PathOptions& options, bool stop_when_black)
        : scene_(scene),
          emitters_(scene, options),
          shadow_rays_(scene, stop_when_black),
          stop_when_black_(stop_when_black) {}

    [[nodiscard]] bool has_direct() const { return emitters_.has_direct(); }
    [[nodiscard]] R hit_weight(R pdf, R emitter_pdf) const {
        return emitters_.hit_weight(pdf, emitter_pdf);
    }

    /// Fills `nee` of the last vertices, where an emitter can be sampled.
    void sample(Lane<R> (&lanes)[trace_width], PathSampler& sampler) const {
        ShadowRay<R, Media> rays[trace_width];
        for (int k = 0; k < trace_width; ++k) {
            Lane<R>& lane = lanes[k];
            if (!lane.alive || !lane.at_vertex) continue;
            PathVertex<R>& v = lane.path.vertices.back();
            if (v.kind == VertexKind::null_surface ||
                (v.kind == VertexKind::surface && lane.material.sampling().is_specular()))
                continue;
            const Philox4 words = sampler(lane.key, dimensions::light_block(lane.vertex()));
            const ShadowTarget<R> target = emitters_.sample_emitter(lane.hit, words, v.nee);
            if (!(v.nee.pdf > R(0))) continue;
            if (v.kind == VertexKind::surface ? weigh_bsdf(lane, v.nee) : weigh_phase(v))
                start_shadow(lane, target, rays[k]);
        }
        shadow_rays_.follow(rays);
    }

private:
    bool weigh_bsdf(const Lane<R>& lane, EmitterSample<R>& emitter) const {
        emitter.wi = lane.side.frame.to_local(emitter.direction);
        if (!lane.side.agrees(emitter.direction, emitter.wi)) return false;
        const Material<R>& material = lane.material.sampling();
        const Vec3<R>& wo = lane.side.wo;
        if (!(wo.z * emitter.wi.z > R(0)) && !material.transmits()) return false;
        const ScatterValue<R> sampled = material.f_and_pdf(wo, emitter.wi);
        emitter.f =
            lane.material.is_attached() ? sampled.f : lane.material.eval().f(wo, emitter.wi);
        if (stop_when_black_ && is_black(emitter.f)) return false;
        emitter.bsdf_pdf = sampled.pdf;
        emitter.weight = emitters_.sample_weight(emitter) * std::abs(emitter.wi.z) / emitter.pdf;
        return true;
    }
    bool weigh_phase(PathVertex<R>& v) const {
        const auto m = static_cast<std::size_t>(v.medium);
        const R cosine = dot(v.direction, v.nee.direction);
        v.nee.wi = v.nee.direction;
        v.nee.f = Vec3<R>(scene_.media[m].phase->p(cosine));
        v.nee.bsdf_pdf = scene_.sampling_media[m].phase->pdf(cosine);
        v.nee.weight = emitters_.sample_weight(v.nee) / v.nee.pdf;
        return true;
    }
    void start_shadow(Lane<R>& lane, const ShadowTarget<R>& target,
                      ShadowRay<R, Media>& ray) const {
        PathVertex<R>& v = lane.path.vertices.back();
        const Vec3<R>& direction = v.nee.direction;
        ray.open = true;
        ray.infinite = target.infinite;
        ray.end = target.end;
        ray.from = ray.origin = lane.hit.position;
        ray.time = lane.time;
        ray.emitter = &v.nee;
        ray.path = &lane.path;
        const auto occluders = static_cast<std::int32_t>(lane.path.occluders.size());
        v.nee.occluders = {occluders, occluders};
        const bool surface = v.kind == VertexKind::surface;
        if (surface)
            ray.origin = lane.side.start(lane.hit.position, direction, scene_.geometry->offset);
        if constexpr (Media) {
            ray.stack = lane.stack;
            if (surface)
                cross_if_transmitted(*scene_.geometry, lane.hit, v.direction, direction, ray.stack);
            ray.state.stream = RandomStream(lane.key, dimensions::shadow_step(lane.vertex()));
            ray.state.product = lane.path.start_product();
        }
    }

    const PathScene<R>& scene_;
    EmitterSampler<R> emitters_;
    ShadowRays<R, Media> shadow_rays_;
    bool stop_when_black_;
};

}  // namespace photograd
