// A path as a list of vertices, the radiance it carries, and the derivative of that radiance.
//
// A path is sampled first (path_walk.h) and summed up afterwards. Vertex k has emission Le_k with a weight w_k, one
// sample of a light with value f^l_k, weight w^l_k and radiance L^l_k, and one direction in which the path goes on, with
// value f_k and weight s_k. The radiance that leaves it towards vertex k - 1 is
//
//   L_k = w_k Le_k + w^l_k f^l_k L^l_k + s_k f_k L_{k+1}          L_n = 0        [Kajiya1986]
//
// All weights hold 1 / pdf, the cosine, the weight of multiple importance sampling and that of roulette. They say where
// was looked and how often: they are detached, and L_0 is a polynomial in f, Le and L^l. Its derivatives:
//
//   dL/dLe_k = d_k w_k     dL/df^l_k = d_k w^l_k L^l_k     dL/dL^l_k = d_k w^l_k f^l_k     dL/df_k = d_k s_k L_{k+1}
//   d_0 = dL/dL_0,         d_{k+1} = d_k s_k f_k
//
// Where a surface covers only in part (coverage.h), all of L_k has a factor c_k, and L^l_k one `through` for the veils before
// the light; a vertex where the path went straight on has s f = 1 and nothing else.
//
// A path that is held as a whole needs no division by f to find out what arrived from ahead (black surfaces have
// derivatives too), and no subtraction from a total. It is replayed from its random numbers when the derivative is
// wanted [Vicini2021], so memory is that of one path a thread.
#pragma once

#include <vector>

#include "photograd/scene/path_scene.h"

namespace photograd {

/// What a shadow ray passed, and the part 1 - alpha of the light that it left.
template <class R>
struct Veil {
    std::int32_t material;
    Vec2<R> uv;
    R left;
};

template <class R>
struct LightVertex {
    std::int32_t shape = SceneLights::none;  // that emits, or SceneLights::background or ::delta
    std::int32_t listed = -1;                // number of a delta light
    Vec3<R> point{R(0)};                     // that is lit
    Vec3<R> direction{R(0)}, wi{R(0)};       // world, shading frame
    Vec2<R> uv{R(0)};                        // of the shape that emits, where it has a texture
    Vec3<R> f{R(0)};
    Vec3<R> sent{R(0)};                // radiance, or a delta light's irradiance
    std::vector<Veil<R>> veils;        // that stand before it
    R through = R(1);                  // what all of them leave
    R weight = R(0);                   // 0 where something stands in front of it
    R pdf = R(0), scatter_pdf = R(0);  // of the light's choice; of the BSDF for the same direction
};

template <class R>
struct PathVertex {
    std::int32_t shape = SceneLights::background;
    Vec2<R> uv{R(0)};         // where the material has textures
    Footprint<R> seen{};      // around it, where any has mip maps
    Vec3<R> direction{R(0)};  // world, of the ray that arrived here
    Vec3<R> emitted{R(0)};    // what is met there sends to where the ray came from
    R emission_weight = R(0);
    R pdf = R(0),
      light_pdf =
          R(0);  // of arriving here: by the BSDF before; by choosing this light. 0: by no chance
    LightVertex<R> light;
    Vec3<R> wo{R(0)}, wi{R(0)};  // shading frame; wi is where the path goes on
    Vec3<R> value{R(0)};         // f, or the weight of a smooth surface's lobe
    int lobe = -1;
    bool passed = false;  // the path went straight on, behind what covers only in part
    R coverage = R(1), coverage_slope = R(0);  // c of everything here, dc/dalpha
    R weight = R(0);                           // 0: the path ends here
    R survival = R(1);  // probability of roulette, which `weight` is divided by
};

template <class R>
using Path = std::vector<PathVertex<R>>;

/// Derivatives by everything that a scene lets change.
template <Real R>
struct PathGradient {
    std::vector<Material<R>> materials;
    std::vector<Vec3<R>> emission;
    std::vector<AnyLightGradient<R>> lights;  // of the list
    std::vector<TexelAdjoint<R>> texels;      // of each texture, to be added up
    std::vector<Medium<R>> media;
    std::vector<DensityAdjoint<R>> densities;  // of each medium, to be added up

    explicit PathGradient(const PathScene<R>& scene)
        : emission(scene.geometry->shape_count(), Vec3<R>(R(0))),
          texels(scene.texels.size()),
          densities(scene.media.size()) {
        for (const Medium<R>& m : scene.media) media.push_back(m.zero());
        for (const Material<R>& m : scene.materials) materials.push_back(m.zero());
        for (const AnyLight<R>& light : scene.lights) lights.push_back(zero_gradient(light));
    }
};

/// Adds the derivative of <d_L, E t(uv)>, the radiance E of a shape times its texture.
template <Real R>
void glow_backward(const PathScene<R>& scene, std::int32_t shape, const EmissionUse& use,
                   const Vec2<R>& uv, const Vec3<R>& d_L, PathGradient<R>& d_scene) {
    const auto t = static_cast<std::size_t>(use.texture);
    const TextureLayout& layout = scene.geometry->textures.layouts[t];
    const Vec2<R> at = layout.inside(uv);
    const Vec3<R> d_color = d_L * scene.emitted(shape);
    d_scene.emission[static_cast<std::size_t>(shape)] += d_L * scene.glow(use, uv);
    d_scene.texels[t].start(layout, at, R(0));
    R* d_texel = d_scene.texels[t].last(layout) + use.channel;
    for (int c = 0; c < 3; ++c) d_texel[c] += d_color[c];
}

/// Adds the derivative of <d_L, radiance of a shape, or of what lies behind everything>.
template <Real R>
void emitted_backward(const PathScene<R>& scene, std::int32_t shape, const Vec2<R>& uv,
                      const Vec3<R>& direction, const Vec3<R>& d_L, PathGradient<R>& d_scene) {
    if (shape >= 0) {
        if (const EmissionUse* use =
                scene.geometry->textures.glows(static_cast<std::size_t>(shape)))
            return glow_backward(scene, shape, *use, uv, d_L, d_scene);
        d_scene.emission[static_cast<std::size_t>(shape)] += d_L;
        return;
    }
    for (const std::int32_t i : scene.geometry->lights.at_infinity()) {
        const auto k = static_cast<std::size_t>(i);
        background_backward(scene.lights[k], direction, d_L, d_scene.lights[k]);
    }
}
template <Real R>
void sent_backward(const PathScene<R>& scene, const LightVertex<R>& light, const Vec3<R>& d_L,
                   PathGradient<R>& d_scene) {
    if (light.shape != SceneLights::delta)
        return emitted_backward(scene, light.shape, light.uv, light.direction, d_L, d_scene);
    const auto k = static_cast<std::size_t>(light.listed);
    delta_backward(scene.lights[k], light.point, d_L, d_scene.lights[k]);
}

/// dthrough/dalpha_i: -product of what the other veils leave.
template <class R>
R veil_slope(const LightVertex<R>& light, std::size_t i) {
    R slope = R(-1);
    for (std::size_t j = 0; j < light.veils.size(); ++j)
        if (j != i) slope *= light.veils[j].left;
    return slope;
}

/// Adds the derivatives of `through` by the alphas of the veils.
template <Real R>
void veils_backward(const PathScene<R>& scene, const LightVertex<R>& light, R d_through,
                    PathGradient<R>& d_scene) {
    for (std::size_t i = 0; i < light.veils.size(); ++i) {
        const Veil<R>& veil = light.veils[i];
        const R d_alpha = d_through * veil_slope(light, i);
        const auto m = static_cast<std::size_t>(veil.material);
        const SurfaceTextures& textures = scene.geometry->textures;
        if (textures.of(m).empty()) {
            d_scene.materials[m].alpha += d_alpha;
            continue;
        }
        Material<R> d_own = scene.materials[m].zero();
        d_own.alpha = d_alpha;
        textured_backward(scene.materials[m], textures.of(m), textures, scene.texels, veil.uv, {},
                          d_own, d_scene.materials[m], d_scene.texels);
    }
}

/// What a vertex has but for c_k: the radiance of its three terms. `ahead` is L_{k+1}.
template <Real R>
Vec3<R> uncovered(const PathVertex<R>& v, const Vec3<R>& ahead) {
    Vec3<R> L = ahead * (v.value * v.weight);
    if (v.light.weight > R(0)) L += v.light.f * v.light.sent * (v.light.weight * v.light.through);
    if (v.emission_weight > R(0)) L += v.emitted * v.emission_weight;
    return L;
}

/// L_0. Fills ahead[k] with L_{k+1}, which the derivative needs, unless it is null.
template <Real R>
Vec3<R> gather(const Path<R>& path, Vec3<R>* ahead) {
    Vec3<R> L(R(0));
    for (std::size_t k = path.size(); k-- > 0;) {
        const PathVertex<R>& v = path[k];
        if (ahead) ahead[k] = L;
        L = uncovered(v, L) * v.coverage;
    }
    return L;
}

/// Adds the derivatives of <d_light, f^l> + <d_onward, f> at a surface, the value of the light's sample and that of the
/// direction in which the path goes on, and `d_alpha` by what it covers, to d_scene.
template <Real R>
void surface_backward(const PathScene<R>& scene, const PathVertex<R>& v, const Vec3<R>& d_light,
                      const Vec3<R>& d_onward, R d_alpha, PathGradient<R>& d_scene) {
    const auto m =
        static_cast<std::size_t>(scene.geometry->material[static_cast<std::size_t>(v.shape)]);
    const SurfaceTextures& textures = scene.geometry->textures;
    const std::span<const TextureUse> uses = textures.of(m);
    const auto add = [&](const Material<R>& material, Material<R>& d_material) {
        d_material.alpha += d_alpha;
        if (v.light.weight > R(0))
            material.value_backward(v.wo, v.light.wi, -1, d_light, d_material);
        if (v.weight > R(0) && !v.passed)
            material.value_backward(v.wo, v.wi, v.lobe, d_onward, d_material);
    };
    if (uses.empty()) return add(scene.materials[m], d_scene.materials[m]);
    // With textures the material at this point, and its derivative, are copies that textured_backward takes apart.
    const Material<R> own =
        textured(scene.materials[m], uses, textures, scene.texels, v.uv, v.seen);
    Material<R> d_own = own.zero();
    add(own, d_own);
    textured_backward(scene.materials[m], uses, textures, scene.texels, v.uv, v.seen, d_own,
                      d_scene.materials[m], d_scene.texels);
}

/// Adds the derivatives of <d_L, L_0> to d_scene.
template <Real R>
void gather_backward(const PathScene<R>& scene, const Path<R>& path, const Vec3<R>* ahead,
                     Vec3<R> d_L, PathGradient<R>& d_scene) {
    for (std::size_t k = 0; k < path.size(); ++k) {
        const PathVertex<R>& v = path[k];
        const R d_coverage = v.coverage_slope == R(0) ? R(0) : dot(d_L, uncovered(v, ahead[k]));
        d_L *= v.coverage;
        if (v.emission_weight > R(0))
            emitted_backward(scene, v.shape, v.uv, v.direction, d_L * v.emission_weight, d_scene);
        if (v.shape < 0) return;
        Vec3<R> d_light(R(0));
        if (v.light.weight > R(0)) {
            if (!v.light.veils.empty())
                veils_backward(scene, v.light, dot(d_L, v.light.f * v.light.sent) * v.light.weight,
                               d_scene);
            const Vec3<R> d = d_L * (v.light.weight * v.light.through);
            sent_backward(scene, v.light, d * v.light.f, d_scene);
            d_light = d * v.light.sent;
        }
        surface_backward(scene, v, d_light, d_L * ahead[k] * v.weight,
                         d_coverage * v.coverage_slope, d_scene);
        if (!(v.weight > R(0))) return;
        d_L *= v.value * v.weight;
    }
}

}  // namespace photograd
