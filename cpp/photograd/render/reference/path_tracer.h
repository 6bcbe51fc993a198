// A path tracer to read: one ray, one loop.
//
// It estimates the radiance that arrives along a ray [Kajiya1986, Kajiya1984],
//
//   L(x, w) = T(x, y) Lo(y, -w) + integral over the ray of T sigma_s integral p Li    (y: next hit)
//   Lo(y, wo) = Le(y, wo) + integral over the sphere of f(wo, wi) Li(y, wi) |cos| dwi
//
// by following a single path. `beta`, its throughput, is the product of everything that multiplies
// the radiance still to be found: f cos / pdf at surfaces, p / pdf in media, T / pdf between them.
// Emission is found in two ways, by next event estimation and by hitting emitters, and weighted by
// multiple importance sampling [Veach1995]. Russian roulette [Arvo1990] ends paths of low
// throughput.
//
// render/path/tracer.h is the same estimator, for sixteen paths at a time. The two agree in
// expectation on every built-in scene (tests/transport/test_reference_path_tracer.py).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "photograd/render/path/boundary.h"
#include "photograd/render/path/camera_medium.h"
#include "photograd/render/path/free_path.h"
#include "photograd/render/path/options.h"
#include "photograd/render/path/russian_roulette.h"
#include "photograd/render/path/trace16.h"
#include "photograd/scene/path_scene.h"

namespace photograd::reference {

using Color = Vec3<double>;
using Vec = Vec3<double>;
using Hit = SurfaceHit<double>;

inline double mean(const Color& c) { return (c.x + c.y + c.z) / 3; }

/// A path under way.
struct PathState {
    Ray<double> ray;  // of unit direction
    double time;      // of the shutter, from 0 to 1
    RandomStream& random;
    MediumStack media;  // the shapes around the ray
    Color L{0.0}, beta{1.0};
    Vec previous = ray.origin;  // the vertex from which the direction was sampled,
    double pdf = 0;             // with this density; 0: by a camera or a specular surface
    int depth = 0;              // segments so far

    double next() { return random.next<double>(); }
    Vec2<double> next2() {
        const double u = next();
        return {u, next()};
    }
};

class PathTracer {
public:
    PathTracer(const PathScene<double>& scene, const PathOptions& options)
        : scene_(scene), geometry_(*scene.geometry), options_(options) {}

    /// One estimate of the radiance that arrives along a ray at its origin.
    Color radiance(const Ray<double>& ray, double time, RandomStream& random) const {
        PathState path{ray, time, random, {}};
        if (geometry_.media.any())
            path.media = medium_stack_at(geometry_, ray.origin, static_cast<float>(time));
        while (path.depth < options_.max_depth && extend(path)) continue;
        return path.L;
    }

private:
    /// Follows the ray to the next vertex, and chooses the next ray; false where the path ends.
    bool extend(PathState& path) const {
        const std::optional<Hit> hit = closest_hit(path.ray, path.time);

        // 1. The medium up to the hit attenuates, and may scatter before.
        const std::int32_t medium =
            hit ? path.media.medium(geometry_.media) : geometry_.media.world;
        double t = hit ? length(hit->position - path.ray.origin) : endless;
        if (medium >= 0 && sample_medium(path, medium, t))
            return scatter_in_medium(path, medium, t);

        // 2. Nothing is hit: lights at infinity.
        if (!hit) {
            const Background<double> sky = scene_.behind(path.ray.direction);
            path.L += path.beta * sky.radiance * weight_of_hit(path.pdf, sky.pdf);
            return false;
        }

        // 3. A boundary between media neither reflects nor refracts; a partially opaque surface is
        //    there with probability alpha.
        const bool boundary = geometry_.media.any() && is_boundary(geometry_, hit->shape);
        if (boundary || path.next() >= opacity(*hit)) {
            cross(*hit, path.ray.direction, path.ray.direction, path.media);
            path.ray.origin = straight_through(geometry_, *hit, path.ray.direction);
            path.depth += boundary ? 0 : 1;
            return true;
        }

        // 4. Emission that the path has hit.
        path.L += path.beta * emission(path, *hit);
        return path.depth + 1 < options_.max_depth && scatter_at_surface(path, *hit);
    }

    bool scatter_at_surface(PathState& path, const Hit& hit) const {
        const Material<double> material = material_at(hit);
        const SurfaceSide<double> side(hit, -path.ray.direction, material.transmits());

        // 5. Next event estimation.
        if (!material.is_specular()) path.L += path.beta * direct(path, hit, side, material);

        // 6. The BSDF chooses where the path continues.
        const Vec2<double> u2 = path.next2();
        const ScatterSample<double> next = material.sample(side.wo, u2, path.next());
        if (!(next.pdf > 0)) return false;
        const Vec out = side.frame.to_world(next.wi);
        if (!side.agrees(out, next.wi)) return false;
        const bool specular = next.lobe >= 0;
        path.beta *= next.value * ((specular ? 1 : std::abs(next.wi.z)) / next.pdf);
        path.pdf = specular ? 0 : next.pdf;
        cross(hit, path.ray.direction, out, path.media);
        path.previous = hit.position;
        path.ray = {side.start(hit.position, out, geometry_.offset), out};
        return survives(path);
    }

    bool scatter_in_medium(PathState& path, std::int32_t medium, double t) const {
        if (path.depth + 1 == options_.max_depth) return false;
        const AnyPhase<double>& phase = *of(medium).phase;
        const Vec x = path.ray.at(t), direction = path.ray.direction;
        path.L += path.beta * direct(path, x, phase);
        const Vec wi = phase.sample(direction, path.next2());
        path.pdf = phase.pdf(dot(direction, wi));
        path.beta *= phase.p(dot(direction, wi)) / path.pdf;
        path.previous = x;
        path.ray = {x, wi};
        return survives(path);
    }

    /// 7. Russian roulette; false where the path ends.
    bool survives(PathState& path) const {
        if (path.beta == Color(0.0)) return false;
        if (path.depth++ < options_.roulette_from) return true;
        const double survival = survival_probability(path.beta);
        path.beta /= survival;
        return path.next() < survival;
    }

    const Medium<double>& of(std::int32_t medium) const {
        return scene_.media[static_cast<std::size_t>(medium)];
    }
    /// What a surface changes of the media around, between directions of arrival and departure.
    void cross(const Hit& hit, const Vec& arrived, const Vec& out, MediumStack& media) const {
        if (geometry_.media.any()) cross_if_transmitted(geometry_, hit, arrived, out, media);
    }

    std::optional<Hit> closest_hit(const Ray<double>& ray, double time) const {
        PacketHits found;
        const auto at = static_cast<float>(time);
        if (!closest1<double>(geometry_.bvh, {ray.origin, ray.direction, at}, found)) return {};
        return surface_hit(geometry_, ray, found.instance[0], found.primitive[0], found.t[0], at);
    }

    std::size_t material_number(const Hit& hit) const {
        return static_cast<std::size_t>(geometry_.material[static_cast<std::size_t>(hit.shape)]);
    }
    Material<double> material_at(const Hit& hit) const {
        const std::size_t m = material_number(hit);
        const SurfaceTextures& textures = geometry_.textures;
        return textured(scene_.materials[m], textures.of(m), textures, scene_.texels, hit.uv);
    }
    /// Probability that the surface is there: alpha, or what a mask makes of it.
    double opacity(const Hit& hit) const {
        if (!scene_.materials[material_number(hit)].has_opacity) return 1;
        const double alpha = material_at(hit).alpha;
        const double cutoff = geometry_.textures.cutoff(material_number(hit));
        return cutoff < 0 ? alpha : alpha >= cutoff ? 1 : 0;
    }
    Color emission(const PathState& path, const Hit& hit) const {
        const double cosine = -dot(hit.outside, path.ray.direction);
        if (!(cosine > 0)) return Color(0.0);  // emitters are one-sided
        const double t = length(hit.position - path.previous);
        const double emitter_pdf = geometry_.lights.hit_pdf(geometry_.bvh, hit.shape, hit.primitive,
                                                            path.previous, t, cosine);
        return scene_.emitted(hit.shape, hit.uv) * weight_of_hit(path.pdf, emitter_pdf);
    }

    // Next event estimation ----------------------------------------------------------------------

    struct Emitter {
        Vec direction;
        double distance;  // to where the shadow ray ends
        Color Le;         // radiance, or the irradiance of a delta light
        double pdf;       // per solid angle, with the probability of the choice
        bool delta;
    };

    std::optional<Emitter> sample_emitter(const Vec& x, std::int32_t own_shape,
                                          PathState& path) const {
        const SceneLights& lights = geometry_.lights;
        const bool deltas = options_.strategy == Strategy::bsdf;  // no ray can hit them
        if (deltas ? !lights.has_delta() : lights.empty()) return {};
        const double u = path.next();
        const Vec2<double> u2 = path.next2();
        const Choice choice = deltas ? lights.choose_delta(u) : lights.choose(u);
        if (choice.index < lights.infinite_and_delta_count()) {
            const auto& light = scene_.lights[static_cast<std::size_t>(choice.index)];
            const LightSample<double> one = sample_any(light, x, u2);
            if (is_delta(light))
                return Emitter{one.direction, std::min(one.distance, endless), one.radiance,
                               choice.pmf * one.pdf, true};
            const Background<double> sky = scene_.behind(one.direction);
            return Emitter{one.direction, endless, sky.radiance, sky.pdf, false};
        }
        const EmissivePrimitive& primitive = lights.primitive(choice.index);
        if (primitive.shape == own_shape && own_shape >= geometry_.bvh.sphere_instance()) return {};
        const EmissiveSample<double> one = lights.sample(geometry_.bvh, primitive, x, u2);
        const Vec y = x + one.light.direction * one.light.distance;
        const Color Le = scene_.emitted(primitive.shape, emissive_uv(geometry_, primitive, y));
        return Emitter{one.light.direction, one.light.distance - 2 * geometry_.offset, Le,
                       choice.pmf * one.light.pdf, false};
    }

    /// Light that one emitter sends to a surface, and the surface to where the path comes from.
    Color direct(PathState& path, const Hit& hit, const SurfaceSide<double>& side,
                 const Material<double>& material) const {
        const std::optional<Emitter> emitter = sample_emitter(hit.position, hit.shape, path);
        if (!emitter || !(emitter->pdf > 0)) return Color(0.0);
        const Vec wi = side.frame.to_local(emitter->direction);
        if (!side.agrees(emitter->direction, wi)) return Color(0.0);
        if (!(side.wo.z * wi.z > 0) && !material.transmits()) return Color(0.0);
        const Color f = material.f(side.wo, wi);
        const double weight = weight_of_sample(*emitter, material.pdf(side.wo, wi));
        MediumStack media = path.media;
        cross(hit, path.ray.direction, emitter->direction, media);
        const Vec start = side.start(hit.position, emitter->direction, geometry_.offset);
        return f * emitter->Le * transmittance(path, start, *emitter, media) *
               (weight * std::abs(wi.z) / emitter->pdf);
    }
    /// The same at a particle of a medium.
    Color direct(PathState& path, const Vec& x, const AnyPhase<double>& phase) const {
        const std::optional<Emitter> emitter = sample_emitter(x, SceneLights::none, path);
        if (!emitter || !(emitter->pdf > 0)) return Color(0.0);
        const double cosine = dot(path.ray.direction, emitter->direction);
        const double weight = weight_of_sample(*emitter, phase.pdf(cosine));
        return emitter->Le * transmittance(path, x, *emitter, path.media) *
               (phase.p(cosine) * weight / emitter->pdf);
    }

    double weight_of_sample(const Emitter& emitter, double bsdf_pdf) const {
        if (options_.strategy != Strategy::mis || emitter.delta) return 1;
        return mis_weight(options_.heuristic, emitter.pdf, bsdf_pdf);
    }
    double weight_of_hit(double pdf, double emitter_pdf) const {
        if (pdf == 0 || emitter_pdf == 0 || options_.strategy == Strategy::bsdf) return 1;
        if (options_.strategy == Strategy::light) return 0;
        return mis_weight(options_.heuristic, pdf, emitter_pdf);
    }

    /// What arrives of an emitter's light, through partially opaque surfaces and media.
    Color transmittance(PathState& path, const Vec& from, const Emitter& emitter,
                        MediumStack media) const {
        Color T(1.0);
        Ray<double> ray{from, emitter.direction};
        for (double left = emitter.distance; left > 0 && T != Color(0.0);) {
            std::optional<Hit> hit = closest_hit(ray, path.time);
            if (hit && length(hit->position - ray.origin) >= left) hit.reset();
            const double t = hit ? length(hit->position - ray.origin) : left;
            const std::int32_t medium =
                t < endless ? media.medium(geometry_.media) : geometry_.media.world;
            if (medium >= 0) attenuate(path, medium, ray, t, T);
            if (!hit) return T;
            if (!(geometry_.media.any() && is_boundary(geometry_, hit->shape)))
                T *= 1 - opacity(*hit);
            cross(*hit, ray.direction, ray.direction, media);
            const Vec next = straight_through(geometry_, *hit, ray.direction);
            left -= dot(next - ray.origin, ray.direction);
            ray.origin = next;
        }
        return T;
    }

    // Media --------------------------------------------------------------------------------------

    /// Samples where a medium scatters: true, at a distance t below the one given. Multiplies beta
    /// by transmittance and scattering coefficient over the density of what was sampled.
    bool sample_medium(PathState& path, std::int32_t medium, double& t) const {
        const Medium<double>& m = of(medium);
        if (!m.phase) {
            attenuate(path, medium, path.ray, t, path.beta);
            return false;
        }
        if (m.density) return delta_tracking(path, medium, t);
        // Sampled by the extinction of one channel; each of the three could have been chosen.
        const int channel = std::min(2, static_cast<int>(3 * path.next()));
        const double sampled = -std::log(1 - path.next()) / m.sigma_t[channel];
        const bool scatters = sampled < t;
        if (scatters) t = sampled;
        const Color T = photograd::transmittance(m.sigma_t, t);
        path.beta *= scatters ? T * m.sigma_t * m.albedo / mean(T * m.sigma_t) : T / mean(T);
        return scatters;
    }
    /// [Woodcock1965]: tentative collisions with the majorant. A real one scatters, a null one
    /// changes the weight alone.
    bool delta_tracking(PathState& path, std::int32_t medium, double& t) const {
        const Medium<double>& m = of(medium);
        for (double x = 0; (x = next_collision(path, medium, path.ray, x, t)) < t;) {
            const Color real = m.sigma_t * (density(medium, path.ray.at(x)) / m.sigma_maj);
            const double probability = mean(real);
            if (path.next() < probability) {
                path.beta *= real * m.albedo / probability;
                t = x;
                return true;
            }
            path.beta *= (Color(1.0) - real) / (1 - probability);
        }
        return false;
    }
    /// Multiplies T by the transmittance of a distance: exactly, or by ratio tracking [Novak2018].
    void attenuate(PathState& path, std::int32_t medium, const Ray<double>& ray, double distance,
                   Color& T) const {
        const Medium<double>& m = of(medium);
        if (!m.density) {
            T *= photograd::transmittance(m.sigma_t, distance);
            return;
        }
        for (double x = 0; (x = next_collision(path, medium, ray, x, distance)) < distance;)
            T *= Color(1.0) - m.sigma_t * (density(medium, ray.at(x)) / m.sigma_maj);
    }
    /// The next tentative collision behind x, in the grid's box; infinite if it is behind `end`.
    double next_collision(PathState& path, std::int32_t medium, const Ray<double>& ray, double x,
                          double end) const {
        const double majorant = of(medium).sigma_maj;
        grid(medium).clip(ray.origin, ray.direction, x, end);
        x = majorant > 0 && x < end ? x - std::log(1 - path.next()) / majorant : end;
        return x < end ? x : std::numeric_limits<double>::infinity();
    }
    const DensityLayout& grid(std::int32_t medium) const {
        return geometry_.media.grids[static_cast<std::size_t>(medium)];
    }
    double density(std::int32_t medium, const Vec& x) const {
        return density_at(grid(medium), of(medium).density, x);
    }

    const PathScene<double>& scene_;
    const PathGeometry& geometry_;
    PathOptions options_;
};

}  // namespace photograd::reference
