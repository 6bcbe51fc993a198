// Sampling paths from the camera, sixteen side by side: the one loop of the picture and of its derivative.
//
// Each round finds what the rays hit, weighs the emission met there, asks a light (and casts a shadow ray), and lets
// the material choose where to go on; roulette [Arvo1990] ends paths that carry little. Everything is decided by
// `scene.sampling` and by random numbers that are a function of seed, pixel, sample and vertex: vertex k owns dimensions
// 4 + 8 k to 11 + 8 k (light: piece and point; direction, lobe and roulette), whatever the path has done before.
#pragma once

#include <algorithm>
#include <limits>

#include "photograd/render/coverage.h"
#include "photograd/render/path_options.h"
#include "photograd/render/path_vertex.h"
#include "photograd/render/ray_cone.h"
#include "photograd/render/ray_lanes.h"
#include "photograd/render/shutter_time.h"

namespace photograd {

template <Real R>
class PathWalk {
public:
    static constexpr int width = RayPacket::width;

    /// For rays of `camera`, whose pixels say how wide the cones open that mip maps are read by. `stop_when_black` gives up
    /// paths whose weight is 0: right for a picture, wrong for a derivative.
    PathWalk(const PathScene<R>& scene, const Pinhole& camera, const PathOptions& options,
             bool stop_when_black)
        : scene_(scene),
          options_(options),
          stop_when_black_(stop_when_black),
          sheer_(any_sheer(scene)),
          mips_(scene.geometry->textures.any_mips()),
          drawn_as_sampled_(scene.drawn_as_sampled()),
          pixel_spread_(R(1 / std::max(camera.fx, camera.fy))),
          numbers_(options.sampler) {}

    /// Samples the paths of `count` <= 16 camera rays; they are then in path(0), path(1), ...
    void trace(const Ray<R>* rays, const RandomKey* keys, int count) {
        begin(rays, keys, count);
        for (int depth = 0; depth < options_.max_depth && find_hits(depth); ++depth) {
            if (depth + 1 == options_.max_depth) break;
            if (may_ask()) ask_lights(depth);
            for (Lane& lane : lanes_)
                if (lane.alive) lane.path.back().passed ? pass_on(lane) : go_on(lane, depth);
        }
    }
    [[nodiscard]] const Path<R>& path(int k) const { return lanes_[k].path; }

protected:  // what a walk through media (volume_walk.h) shares
    struct Lane {
        bool alive = false, shadow = false;
        Ray<R> ray;
        Vec3<R> previous;  // the vertex that the ray comes from; the ray starts beside it
        RandomKey key;
        Vec3<R> beta;     // what the path would multiply by ahead, as `sampling` has it
        R pdf = R(0);     // of the ray's direction; 0 from the camera and from smooth surfaces
        RayCone<R> cone;  // from `previous`, where there are mip maps
        SurfaceHit<R> hit;
        SurfaceSide<R> side;
        bool textured = false;  // the hit has a material of its own, not one of the scene's
        Material<R> own_sampling, own_drawn;
        Path<R> path;
        Vec3<R> light_end;  // of the shadow ray, unless the light is at infinity
        bool light_far = false;
        float time = 0;  // at which the path sees what moves
    };

    void begin(const Ray<R>* rays, const RandomKey* keys, int count) {
        for (int k = 0; k < width; ++k) {
            Lane& lane = lanes_[k];
            lane.alive = k < count;
            lane.path.clear();
            if (!lane.alive) continue;
            lane.ray = rays[k];
            lane.previous = rays[k].origin;
            lane.key = keys[k];
            lane.beta = Vec3<R>(R(1));
            lane.pdf = R(0);
            lane.cone = {R(0), pixel_spread_};
            if (scene_.geometry->bvh.moves())
                lane.time = static_cast<float>(sample_time(lane.key, numbers_));
        }
    }

    /// Those who wait for light to be met ask for what cannot be met.
    [[nodiscard]] bool may_ask() const {
        const SceneLights& lights = scene_.geometry->lights;
        return options_.strategy == Strategy::bsdf ? lights.has_delta() : !lights.empty();
    }

    /// Follows the rays; returns whether any met a surface.
    bool find_hits(int depth) {
        RayPacket packet{};
        for (int k = 0; k < width; ++k) {
            const Lane& lane = lanes_[k];
            packet.active[k] = false;
            if (lane.alive)
                set_lane(packet, k, lane.ray.origin, lane.ray.direction,
                         std::numeric_limits<float>::infinity(), lane.time);
        }
        PacketHits found;
        scene_.geometry->bvh.trace(packet, depth == 0, found);
        bool any = false;
        for (int k = 0; k < width; ++k) {
            if (!lanes_[k].alive) continue;
            Lane& lane = lanes_[k];
            const bool met = found.primitive[k] >= 0;
            if (met)
                lane.hit = surface_hit(*scene_.geometry, lane.ray, found.instance[k],
                                       found.primitive[k], found.t[k], lane.time);
            arrive(lane, met);
            any = any || lanes_[k].alive;
        }
        return any;
    }

    /// A new vertex, where a surface was `met` or none: what is there, and how much its emission counts.
    void arrive(Lane& lane, bool met) {
        const PathGeometry& geometry = *scene_.geometry;
        PathVertex<R>& v = lane.path.emplace_back();
        v.direction = lane.ray.direction;
        v.pdf = lane.pdf;
        if (!met) {
            const Background<R> behind = scene_.behind(v.direction);
            v.emitted = behind.radiance;
            v.light_pdf = behind.pdf;
            v.emission_weight = emission_weight(v);
            lane.alive = false;
            return;
        }
        v.shape = lane.hit.shape;
        look_up_textures(lane);
        const Material<R>& material = sampling_of(lane);
        lane.side = SurfaceSide<R>(lane.hit, -v.direction, material.transmits());
        v.wo = lane.side.wo;
        if (material.has_opacity && cover(lane)) return;
        const R cosine = -dot(lane.hit.outside, v.direction);
        if (!(cosine > R(0))) return;  // the back of a light is dark
        if (geometry.textures.glows(static_cast<std::size_t>(v.shape))) v.uv = lane.hit.uv;
        v.emitted = scene_.emitted(v.shape, v.uv);
        const Vec3<R> way = lane.hit.position - lane.previous;
        v.light_pdf = geometry.lights.hit_pdf(geometry.bvh, v.shape, lane.hit.primitive,
                                              lane.previous, length(way), cosine);
        v.emission_weight = emission_weight(v);
    }
    /// Whether the path goes on behind a surface that covers only in part; draws the light block's fourth number.
    bool cover(Lane& lane) {
        PathVertex<R>& v = lane.path.back();
        const auto vertex = static_cast<std::uint32_t>(lane.path.size()) - 1;
        const Philox4 words = numbers_(lane.key, 1 + 2 * vertex);
        const Cover<R> chosen = choose_cover(sampling_of(lane).alpha, drawn_as(lane).alpha,
                                             scene_.geometry->textures.cutoff(material_of(lane)),
                                             uniform_from<R>(words[3]));
        v.passed = chosen.passes;
        v.coverage = chosen.weight;
        v.coverage_slope = chosen.slope;
        lane.beta *= chosen.sampled_weight;
        return v.passed;
    }
    void pass_on(Lane& lane) {
        PathVertex<R>& v = lane.path.back();
        v.value = Vec3<R>(R(1));
        v.weight = R(1);
        lane.ray.origin = lane.side.start(lane.hit.position, v.direction, scene_.geometry->offset);
        lane.alive = !(stop_when_black_ && is_black(lane.beta));
    }
    void look_up_textures(Lane& lane) const {
        const std::size_t m = material_of(lane);
        const SurfaceTextures& textures = scene_.geometry->textures;
        const std::span<const TextureUse> uses = textures.of(m);
        lane.textured = !uses.empty();
        if (!lane.textured) return;
        const Vec2<R> uv = lane.path.back().uv = lane.hit.uv;
        Footprint<R>& seen = lane.path.back().seen;
        if (mips_)
            seen = lane.cone.footprint(scene_.geometry->bvh, lane.hit, lane.ray.direction,
                                       length(lane.hit.position - lane.previous), lane.time);
        lane.own_sampling =
            textured(scene_.sampling[m], uses, textures, scene_.sampling_texels, uv, seen);
        if (!drawn_as_sampled_)
            lane.own_drawn = textured(scene_.materials[m], uses, textures, scene_.texels, uv, seen);
    }
    R emission_weight(const PathVertex<R>& v) const {
        if (v.pdf == R(0) || v.light_pdf == R(0) || options_.strategy == Strategy::bsdf)
            return R(1);
        if (options_.strategy == Strategy::light) return R(0);
        return mis_weight(options_.heuristic, v.pdf, v.light_pdf);
    }

    void ask_lights(int depth) {
        if (sheer_) return ask_lights_through_veils(depth);
        RayPacket packet{};
        for (int k = 0; k < width; ++k) {
            Lane& lane = lanes_[k];
            packet.active[k] = false;
            lane.shadow =
                lane.alive && !sampling_of(lane).is_specular() && choose_light(lane, depth);
            if (!lane.shadow) continue;
            const Vec3<R> start = lane.side.start(
                lane.hit.position, lane.path.back().light.direction, scene_.geometry->offset);
            if (lane.light_far)
                set_lane(packet, k, start, lane.path.back().light.direction,
                         std::numeric_limits<float>::infinity(), lane.time);
            else
                set_lane(packet, k, start, lane.light_end - start, 1.0f, lane.time);
        }
        bool blocked[width];
        scene_.geometry->bvh.occluded(packet, false, blocked);
        for (int k = 0; k < width; ++k)
            if (lanes_[k].shadow && blocked[k]) lanes_[k].path.back().light.weight = R(0);
    }

    /// The same in scenes where surfaces cover only in part.
    void ask_lights_through_veils(int depth) {
        ShadowRay<R> shadows[width];
        for (int k = 0; k < width; ++k) {
            Lane& lane = lanes_[k];
            lane.shadow = lane.alive && !lane.path.back().passed &&
                          !sampling_of(lane).is_specular() && choose_light(lane, depth);
            if (!lane.shadow) continue;
            LightVertex<R>& light = lane.path.back().light;
            const Vec3<R> start =
                lane.side.start(lane.hit.position, light.direction, scene_.geometry->offset);
            const Vec3<R> way = lane.light_far ? light.direction : lane.light_end - start;
            const R end = lane.light_far ? std::numeric_limits<R>::infinity() : length(way);
            shadows[k] = {true, false, {start, normalize(way)}, end, &light, lane.time};
        }
        look_through(scene_, stop_when_black_, shadows);
        for (int k = 0; k < width; ++k)
            if (shadows[k].blocked) shadows[k].light->weight = R(0);
    }

    /// Draws a light, a direction to it and its weight, shadow aside; returns whether it can count at all.
    bool choose_light(Lane& lane, int depth) {
        find_light(lane, depth);
        LightVertex<R>& light = lane.path.back().light;
        return light.pdf > R(0) && weigh_light(lane, light);
    }
    void find_light(Lane& lane, int depth) {
        const SceneLights& lights = scene_.geometry->lights;
        const Philox4 words = numbers_(lane.key, 1 + 2 * static_cast<std::uint32_t>(depth));
        const Vec2<R> u2(uniform_from<R>(words[1]), uniform_from<R>(words[2]));
        const double u = uniform_from<double>(words[0]);
        const bool deltas_alone = options_.strategy == Strategy::bsdf;
        const Choice choice = deltas_alone ? lights.choose_delta(u) : lights.choose(u);
        LightVertex<R>& light = lane.path.back().light;
        light.point = lane.hit.position;
        if (choice.index >= lights.infinite_and_delta_count())
            ask_piece(lane, light, choice, u2);
        else
            ask_listed(lane, light, choice, u2);
    }
    void ask_piece(Lane& lane, LightVertex<R>& light, const Choice& choice, const Vec2<R>& u2) {
        const PathGeometry& geometry = *scene_.geometry;
        const EmissivePrimitive& piece = geometry.lights.primitive(choice.index);
        light.shape = piece.shape;
        // A ball never lights itself; rounding could see it from a point on it.
        if (piece.shape == lane.hit.shape && piece.shape >= geometry.bvh.sphere_instance()) return;
        const EmissiveSample<R> found =
            geometry.lights.sample(geometry.bvh, piece, light.point, u2);
        if (geometry.textures.glows(static_cast<std::size_t>(piece.shape)))
            light.uv = piece_uv(geometry.bvh, piece,
                                light.point + found.light.direction * found.light.distance);
        light.sent = scene_.emitted(piece.shape, light.uv);
        light.direction = found.light.direction;
        light.pdf = R(choice.pmf) * found.light.pdf;
        lane.light_far = false;
        lane.light_end = light.point + found.light.direction * found.light.distance +
                         found.normal * R(geometry.offset);
    }
    void ask_listed(Lane& lane, LightVertex<R>& light, const Choice& choice, const Vec2<R>& u2) {
        const AnyLight<R>& listed = scene_.lights[static_cast<std::size_t>(choice.index)];
        const LightSample<R> found = sample_any(listed, light.point, u2);
        light.direction = found.direction;
        light.listed = static_cast<std::int32_t>(choice.index);
        lane.light_far = !(found.distance < std::numeric_limits<R>::max());
        if (!lane.light_far) lane.light_end = light.point + found.direction * found.distance;
        if (is_delta(listed)) {
            light.shape = SceneLights::delta;
            light.sent = found.radiance;
            light.pdf = R(choice.pmf) * found.pdf;
        } else {
            const Background<R> behind =
                scene_.behind(found.direction, choice.index, {found.radiance, found.pdf});
            light.shape = SceneLights::background;
            light.sent = behind.radiance;
            light.pdf = behind.pdf;
        }
    }
    bool weigh_light(const Lane& lane, LightVertex<R>& light) const {
        light.wi = lane.side.frame.to_local(light.direction);
        if (!lane.side.agrees(light.direction, light.wi) || !(light.pdf > R(0))) return false;
        const Vec3<R>& wo = lane.path.back().wo;
        if (!(wo.z * light.wi.z > R(0)) && !sampling_of(lane).transmits()) return false;
        const ScatterValue<R> sampled = sampling_of(lane).f_and_pdf(wo, light.wi);
        light.f = drawn_as_sampled_ ? sampled.f : drawn_as(lane).f(wo, light.wi);
        if (stop_when_black_ && is_black(light.f)) return false;
        light.scatter_pdf = sampled.pdf;
        light.weight = light_share(light) * std::abs(light.wi.z) / light.pdf;
        return true;
    }
    R light_share(const LightVertex<R>& light) const {
        // No ray meets a delta light: it is the light sample's alone.
        if (options_.strategy == Strategy::light || light.shape == SceneLights::delta) return R(1);
        return mis_weight(options_.heuristic, light.pdf, light.scatter_pdf);
    }

    /// Lets the material choose a direction; ends the path where it has none, or by roulette.
    void go_on(Lane& lane, int depth) {
        lane.alive = false;
        PathVertex<R>& v = lane.path.back();
        const auto vertex = static_cast<std::uint32_t>(depth);
        const Philox4 words = numbers_(lane.key, 2 + 2 * vertex);
        const ScatterSample<R> next = sampling_of(lane).sample(
            v.wo, Vec2<R>(uniform_from<R>(words[0]), uniform_from<R>(words[1])),
            uniform_from<R>(words[2]), lane.beta);
        if (!(next.pdf > R(0))) return;
        const Vec3<R> direction = lane.side.frame.to_world(next.wi);
        if (!lane.side.agrees(direction, next.wi)) return;
        v.wi = next.wi;
        v.lobe = next.lobe;
        v.value = drawn_as_sampled_ ? next.value : drawn_as(lane).value(v.wo, v.wi, v.lobe);
        const R weight = (next.lobe < 0 ? std::abs(next.wi.z) : R(1)) / next.pdf;
        if (!survives(lane, depth, next.value, weight, uniform_from<R>(words[3]))) return;
        lane.pdf = next.lobe < 0 ? next.pdf : R(0);
        if (mips_)
            lane.cone =
                lane.cone.onward(*scene_.geometry, lane.hit, v.direction, direction,
                                 length(lane.hit.position - lane.previous), lane.pdf, lane.time);
        lane.previous = lane.hit.position;
        lane.ray = {lane.side.start(lane.hit.position, direction, scene_.geometry->offset),
                    direction};
        lane.alive = true;
    }

    /// Weighs the path with where it goes on; false where it ends, black or by roulette.
    bool survives(Lane& lane, int depth, const Vec3<R>& value, R weight, R u) {
        PathVertex<R>& v = lane.path.back();
        lane.beta *= value * weight;
        if (stop_when_black_ && is_black(lane.beta)) return false;
        if (depth >= options_.roulette_from) {
            const R largest = std::max({lane.beta.x, lane.beta.y, lane.beta.z});
            v.survival = std::clamp(largest, R(0.05), R(0.95));
            if (u >= v.survival) return false;
            lane.beta *= R(1) / v.survival;
        }
        v.weight = weight / v.survival;
        return true;
    }

    static bool is_black(const Vec3<R>& v) { return v.x == R(0) && v.y == R(0) && v.z == R(0); }
    std::size_t material_of(const Lane& lane) const {
        return static_cast<std::size_t>(
            scene_.geometry->material[static_cast<std::size_t>(lane.hit.shape)]);
    }
    const Material<R>& sampling_of(const Lane& lane) const {
        return lane.textured ? lane.own_sampling : scene_.sampling[material_of(lane)];
    }
    const Material<R>& drawn_as(const Lane& lane) const {
        if (drawn_as_sampled_) return sampling_of(lane);
        return lane.textured ? lane.own_drawn : scene_.materials[material_of(lane)];
    }

    const PathScene<R>& scene_;
    PathOptions options_;
    bool stop_when_black_;
    bool sheer_;             // whether any surface covers only in part
    bool mips_;              // whether any texture has levels
    bool drawn_as_sampled_;  // whether one material decides both where paths go and what they find
    R pixel_spread_;         // how wide what a pixel sees becomes per metre
    SampleNumbers numbers_;
    Lane lanes_[width];
};

}  // namespace photograd
