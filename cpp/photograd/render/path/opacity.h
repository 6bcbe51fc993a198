// Partially opaque surfaces (leaves, nets, alpha masks): with opacity alpha [Porter1984],
//
//   L = alpha L_surface + (1 - alpha) L_behind
//
// A path makes a stochastic alpha test [Enderton2010]: it stays at the surface with probability p
// or continues straight, a null interaction. p mixes in a small uniform share: without it the
// derivative with respect to an alpha of 0 or 1 would be biased, its other side never sampled. c
// weights all that follows:
//
//   p = q / 2 + (1 - q) alpha,   q = 0.05                                       p is detached
//   surface   c = alpha / p,                dc/dalpha = 1 / p
//   behind    c = (1 - alpha) / (1 - p),    dc/dalpha = -1 / (1 - p)
//
// A mask covers all or nothing: c = 1 on the side of its cutoff where alpha lies, without a
// derivative.
#pragma once

#include "photograd/render/path/record.h"

namespace photograd {

template <class R>
struct OpacitySample {
    bool is_null = false;
    R weight = R(1), d_opacity = R(0);  // c, dc/dalpha
    R sampled_weight = R(1);            // c by the alpha that is sampled
};

/// `cutoff` below 0: no mask. `u` is uniform.
template <class R>
OpacitySample<R> sample_opacity(R sampled_alpha, R alpha, double cutoff, R u) {
    constexpr R uniform_share = R(0.05);
    if (cutoff >= 0) return {!(sampled_alpha >= R(cutoff))};
    // A fit may step out of 0..1: the weights follow, p does not.
    const R lowest = R(0.5) * uniform_share;
    const R p = std::clamp(lowest + (R(1) - uniform_share) * sampled_alpha, lowest, R(1) - lowest);
    if (u < p) return {false, alpha / p, R(1) / p, sampled_alpha / p};
    const R rest = R(1) - p;
    return {true, (R(1) - alpha) / rest, R(-1) / rest, (R(1) - sampled_alpha) / rest};
}

/// Whether any material has an opacity.
template <Real R>
bool any_opacity(const PathScene<R>& scene) {
    return std::any_of(scene.materials.begin(), scene.materials.end(),
                       [](const Material<R>& m) { return m.has_opacity; });
}

/// Whether a shadow ray continues behind the surface that it hits; it then has one more occluder.
/// Nothing is sampled: the emitter sample keeps the product of 1 - alpha.
template <Real R>
bool passes_light(const PathScene<R>& scene, bool stop_when_black, const SurfaceHit<R>& hit,
                  EmitterSample<R>& emitter, Path<R>& path) {
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
    const R transmittance = R(1) - alpha_of(scene.materials, scene.texels);
    if (stop_when_black && transmittance == R(0)) return false;
    path.occluders.push_back({m, hit.uv, transmittance});
    emitter.occluders.last = static_cast<std::int32_t>(path.occluders.size());
    emitter.alpha_transmittance *= transmittance;
    return true;
}

}  // namespace photograd
