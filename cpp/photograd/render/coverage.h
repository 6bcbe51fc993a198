// Surfaces that cover only a part of what lies behind them: leaves, nets, smoke on a card. alpha is that part
// [Porter1984]; the rest of the light goes straight through, unbent.
//
//   L = alpha L_surface + (1 - alpha) L_behind
//
// A path meets one of the two. It stays with probability p, a little even chance mixed in, or the derivative by an alpha
// of 0 or 1 would miss what is never looked at; c is then the weight of everything that follows:
//
//   p = q / 2 + (1 - q) alpha,   q = 0.05
//   stays   c = alpha / p,                  dc/dalpha = 1 / p
//   passes  c = (1 - alpha) / (1 - p),      dc/dalpha = -1 / (1 - p)             p detached
//
// A mask covers all or nothing: where alpha is at least its cutoff, c = 1 and nothing has a derivative.
//
// A shadow ray takes no chance. It is followed through all veils, and keeps of its light
//
//   through = product over veils of (1 - alpha_i),     dthrough/dalpha_i = -product over the others
//
// The path behind a veil is still the path from the surface before it: its density, and the place that lights are
// weighed from, stay those.
#pragma once

#include "photograd/render/path_vertex.h"
#include "photograd/render/ray_lanes.h"

namespace photograd {

template <class R>
struct Cover {
    bool passes = false;
    R weight = R(1), slope = R(0), sampled_weight = R(1);  // c, dc/dalpha; c as `sampling` has it
};

/// `cutoff` below 0: no mask. `u` is uniform.
template <class R>
Cover<R> choose_cover(R sampled_alpha, R alpha, double cutoff, R u) {
    constexpr R even_share = R(0.05);
    if (cutoff >= 0) return {!(sampled_alpha >= R(cutoff))};
    const R least =
        R(0.5) * even_share;  // a fit may step out of 0..1: the weights follow, p does not
    const R stays = std::clamp(least + (R(1) - even_share) * sampled_alpha, least, R(1) - least);
    if (u < stays) return {false, alpha / stays, R(1) / stays, sampled_alpha / stays};
    const R rest = R(1) - stays;
    return {true, (R(1) - alpha) / rest, R(-1) / rest, (R(1) - sampled_alpha) / rest};
}

/// Whether a walk that has met a surface of the material `number` goes straight on behind it, where `ray` then starts.
/// `beta` takes the weight of either choice.
template <Real R>
bool goes_straight_on(const PathScene<R>& scene, std::size_t number, const Material<R>& material,
                      const SurfaceHit<R>& hit, const SurfaceSide<R>& side, R u, Ray<R>& ray,
                      Vec3<R>& beta) {
    const Cover<R> chosen =
        choose_cover(material.alpha, material.alpha, scene.geometry->textures.cutoff(number), u);
    beta *= chosen.weight;
    if (chosen.passes) ray.origin = side.start(hit.position, ray.direction, scene.geometry->offset);
    return chosen.passes;
}

/// Whether any material covers only in part.
template <Real R>
bool any_sheer(const PathScene<R>& scene) {
    return std::any_of(scene.materials.begin(), scene.materials.end(),
                       [](const Material<R>& m) { return m.has_opacity; });
}

template <class R>
struct ShadowRay {
    bool open = false;  // its end has been neither reached nor blocked
    bool blocked = false;
    Ray<R> ray;  // of unit direction
    R end = R(0);
    LightVertex<R>* light = nullptr;
    float time = 0;  // while the shutter is open
};

/// Whether light passes what a shadow ray has met; then the light has one more veil.
template <Real R>
bool leaves_light(const PathScene<R>& scene, bool stop_when_black, const SurfaceHit<R>& hit,
                  LightVertex<R>& light) {
    const std::int32_t m = scene.geometry->material[static_cast<std::size_t>(hit.shape)];
    const auto number = static_cast<std::size_t>(m);
    if (!scene.materials[number].has_opacity) return false;
    const SurfaceTextures& textures = scene.geometry->textures;
    const auto alpha_of = [&](std::span<const Material<R>> from, std::span<const R* const> texels) {
        const std::span<const TextureUse> uses = textures.of(number);
        return uses.empty() ? from[number].alpha
                            : textured(from[number], uses, textures, texels, hit.uv).alpha;
    };
    const double cutoff = textures.cutoff(number);
    if (cutoff >= 0) return !(alpha_of(scene.sampling, scene.sampling_texels) >= R(cutoff));
    const R left = R(1) - alpha_of(scene.materials, scene.texels);
    if (stop_when_black && left == R(0)) return false;
    light.veils.push_back({m, hit.uv, left});
    light.through *= left;
    return true;
}

/// Steps behind what a ray has met, unless nothing passes there.
template <Real R>
void pass_veil(const PathScene<R>& scene, bool stop_when_black, std::int32_t instance,
               std::int32_t primitive, float t, ShadowRay<R>& shadow) {
    const PathGeometry& geometry = *scene.geometry;
    const SurfaceHit<R> hit =
        surface_hit(geometry, shadow.ray, instance, primitive, t, shadow.time);
    shadow.blocked = !leaves_light(scene, stop_when_black, hit, *shadow.light);
    if (shadow.blocked) return;
    const Vec3<R>& way = shadow.ray.direction;
    // Along the ray, not along the normal as a path goes on: beside its way it might end behind the light.
    const R step = R(geometry.offset) / std::max(std::abs(dot(hit.outside, way)), R(0.05));
    const Vec3<R> start = hit.position + way * step;
    shadow.end -= dot(start - shadow.ray.origin, way);
    shadow.ray.origin = start;
    shadow.open = shadow.end > R(0);
}

/// Follows shadow rays to their ends, and says which are blocked.
template <Real R>
void look_through(const PathScene<R>& scene, bool stop_when_black, ShadowRay<R>* shadows) {
    constexpr int width = RayPacket::width, most_veils = 256;
    for (int round = 0; round < most_veils; ++round) {
        RayPacket packet{};
        bool any = false;
        for (int k = 0; k < width; ++k) {
            packet.active[k] = false;
            if (!shadows[k].open) continue;
            any = true;
            set_lane(packet, k, shadows[k].ray.origin, shadows[k].ray.direction,
                     static_cast<float>(shadows[k].end), shadows[k].time);
        }
        if (!any) return;
        PacketHits found;
        scene.geometry->bvh.trace(packet, false, found);
        for (int k = 0; k < width; ++k) {
            ShadowRay<R>& shadow = shadows[k];
            if (!shadow.open) continue;
            shadow.open = false;
            if (found.primitive[k] < 0) continue;
            pass_veil(scene, stop_when_black, found.instance[k], found.primitive[k], found.t[k],
                      shadow);
        }
    }
    for (int k = 0; k < width; ++k) shadows[k].blocked = shadows[k].blocked || shadows[k].open;
}

}  // namespace photograd
