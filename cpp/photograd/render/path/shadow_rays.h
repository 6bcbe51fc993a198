// The visibility of emitter samples, sixteen at a time: blocked, or a transmittance through
// partially opaque surfaces and media. Nothing is sampled at a surface; both transmittances are
// products:
//
//   alpha_transmittance = product over occluders of (1 - alpha_i)
//   shadow              = product over media of their transmittance (render/path/free_path.h)
#pragma once

#include <type_traits>

#include "photograd/render/path/boundary.h"
#include "photograd/render/path/free_path.h"
#include "photograd/render/path/opacity.h"
#include "photograd/render/path/trace16.h"

namespace photograd {

/// Where a shadow ray is, in scenes with media.
template <Real R>
struct ShadowMedium {
    MediumStack stack;
    typename FreePathSampler<R>::State state;
};
struct NoMedium {};

template <Real R, bool Media>
struct ShadowRay : std::conditional_t<Media, ShadowMedium<R>, NoMedium> {
    bool open = false;  // neither at its end nor blocked
    bool infinite = false;
    Vec3<R> end{R(0)};  // unless the emitter is at infinity
    Vec3<R> origin{R(0)};
    Vec3<R> from{R(0)};  // where the present stretch starts, exactly
    float time = 0;
    int boundaries = 0;
    EmitterSample<R>* emitter = nullptr;
    Path<R>* path = nullptr;

    [[nodiscard]] RayQuery<R> query() const {
        if (infinite) return {origin, emitter->direction, time};
        return {origin, end - origin, time, 1.0f};
    }
    /// The length of the direction of `query`.
    [[nodiscard]] float unit() const {
        return infinite ? 1.0f : static_cast<float>(length(end - origin));
    }
};

template <Real R, bool Media>
class ShadowRays {
public:
    ShadowRays(const PathScene<R>& scene, bool stop_when_black)
        : scene_(scene),
          free_path_(scene),
          stop_when_black_(stop_when_black),
          opacity_(any_opacity(scene)) {}

    /// Follows open rays to their ends; the weight of emitters that are blocked becomes 0.
    void follow(ShadowRay<R, Media>* rays) const {
        const auto ray_of = [&](int k, RayQuery<R>& query) {
            if (rays[k].open) query = rays[k].query();
            return rays[k].open;
        };
        if (!Media && !opacity_) {
            bool blocked[trace_width];
            occluded16<R>(scene_.geometry->bvh, ray_of, blocked);
            for (int k = 0; k < trace_width; ++k)
                if (blocked[k]) rays[k].emitter->weight = R(0);
            return;
        }
        PacketHits found;
        while (closest16<R>(scene_.geometry->bvh, false, ray_of, found))
            for (int k = 0; k < trace_width; ++k)
                if (rays[k].open) rays[k].open = goes_on(rays[k], found, k);
    }

private:
    bool goes_on(ShadowRay<R, Media>& ray, const PacketHits& found, int k) const {
        const PathGeometry& geometry = *scene_.geometry;
        EmitterSample<R>& emitter = *ray.emitter;
        const bool hits = found.primitive[k] >= 0;
        SurfaceHit<R> hit;
        if (hits) {
            hit = surface_hit(geometry, Ray<R>{ray.origin, emitter.direction}, found.instance[k],
                              found.primitive[k], found.t[k] * ray.unit(), ray.time);
            if (!(Media && is_boundary(geometry, hit.shape)) &&
                !passes_light(scene_, stop_when_black_, hit, emitter, *ray.path)) {
                emitter.weight = R(0);
                return false;
            }
        }
        if constexpr (Media) attenuate(ray, hits, hit);
        if (!hits) return false;
        if constexpr (Media)
            ray.stack.cross(geometry.media, hit.shape, dot(hit.outside, emitter.direction) < R(0));
        ray.from = hit.position;
        ray.origin = straight_through(geometry, hit, emitter.direction);
        if (!ray.infinite && !(dot(ray.end - ray.origin, emitter.direction) > R(0))) return false;
        if (++ray.boundaries <= max_boundaries) return true;
        emitter.weight = R(0);
        return false;
    }
    void attenuate(ShadowRay<R, Media>& ray, bool hits, const SurfaceHit<R>& hit) const {
        const MediaGeometry& media = scene_.geometry->media;
        const bool escapes = !hits && ray.infinite;
        const std::int32_t medium = escapes ? media.world : ray.stack.medium(media);
        const R distance = hits      ? length(hit.position - ray.from)
                           : escapes ? R(endless)
                                     : length(ray.end - ray.from);
        if (medium >= 0)
            free_path_.add_transmittance(medium, ray.from, ray.emitter->direction, distance,
                                         ray.state, *ray.path);
        ray.emitter->shadow = ray.state.product;
    }

    const PathScene<R>& scene_;
    FreePathSampler<R> free_path_;
    bool stop_when_black_, opacity_;
};

}  // namespace photograd
