// The radiance of a recorded path, and its derivatives with respect to everything the scene lets
// change.
//
// Vertex k has emission Le_k with the weight w_k, one emitter sample with the value f^l_k, the
// weight w^l_k, the radiance L^l_k and the transmittance T^l_k of its shadow ray, and one direction
// in which the path continues, with the value f_k and the weight s_k. T_k is the product of the
// events of the segment that arrives at vertex k (1 without media), s'_k its weight, c_k the weight
// of the alpha test (render/path/opacity.h; 1 without opacity). The radiance that leaves it towards
// vertex k - 1 is [Kajiya1986; Kajiya1984]
//
//   Lo_k = c_k (w_k Le_k + w^l_k f^l_k T^l_k L^l_k + s_k f_k Li_k)
//   Li_k = s'_{k+1} T_{k+1} Lo_{k+1},     Lo_n = 0,     L = s'_0 T_0 Lo_0
//
// All weights hold 1 / pdf, cosine, MIS weight and that of Russian roulette. They say what was
// sampled and how often: they are detached, and L is a polynomial in f, Le, L^l and the events.
// With d_0 = dL/dLo_0 and d_{k+1} = d_k c_k s_k f_k s'_{k+1} T_{k+1},
//
//   dL/dLe_k = d_k c_k w_k            dL/df^l_k = d_k c_k w^l_k T^l_k L^l_k
//   dL/df_k = d_k c_k s_k Li_k        dL/dL^l_k = d_k c_k w^l_k T^l_k f^l_k
//   dL/dc_k = d_k Lo_k / c_k, computed without the division
//
// and, for d = dL/dT and an event x_i of a product T (render/path/record.h),
//
//   dL/dx_i = d (product of the other events), from both ends without a division: an event may be 0
//   transmit:         dx/dsigma_t = -l x
//   scatter:          dx/dsigma_t = albedo rho c,   dx/dalbedo = sigma_t rho c,
//                     dx/drho = sum over channels of albedo sigma_t c
//   null collision:   dx/dsigma_t = -rho c,         dx/drho = -sum over channels of sigma_t c
//   occluders:        dT^l/dalpha_i = -product over the others of (1 - alpha_j)
//
// A path that is held as a whole needs no division by f to recover what arrived (black surfaces
// have derivatives too), and no subtraction from a total. It is replayed from its random numbers
// when the derivative is wanted [Vicini2021], so memory is that of one path a thread. Held fixed:
// geometry, so that edges of shadows and silhouettes do not move, and the directions of specular
// refraction.
#pragma once

#include "photograd/render/path/free_path.h"
#include "photograd/scene/gradient.h"

namespace photograd {

/// Lo_k / c_k: the radiance of the three terms, before the weight of the alpha test.
template <Real R>
Vec3<R> scattered_radiance(const PathVertex<R>& v, const Vec3<R>& Li) {
    Vec3<R> L = Li * (v.f * v.weight);
    if (v.nee.weight > R(0))
        L += v.nee.f * v.nee.Le * v.nee.shadow.value * (v.nee.weight * v.nee.alpha_transmittance);
    if (v.emission_weight > R(0)) L += v.Le * v.emission_weight;
    return L;
}

/// L. Writes Lo_k to Lo[k], which the backward pass needs, unless it is null.
template <Real R>
Vec3<R> radiance(const Path<R>& path, Vec3<R>* Lo) {
    Vec3<R> L(R(0));
    for (std::size_t k = path.vertices.size(); k-- > 0;) {
        const PathVertex<R>& v = path.vertices[k];
        L = scattered_radiance(v, L) * v.opacity_weight;
        if (Lo) Lo[k] = L;
        L *= v.arrival.product.value * v.arrival.weight;
    }
    return L;
}

// The backward passes add to d_scene ------------------------------------------------------------

/// <d_L, E t(uv)>, the radiance E of a shape times its texture.
template <Real R>
void textured_emission_backward(const PathScene<R>& scene, std::int32_t shape,
                                const EmissionUse& use, const Vec2<R>& uv, const Vec3<R>& d_L,
                                SceneGradient<R>& d_scene) {
    const auto t = static_cast<std::size_t>(use.texture);
    const TextureLayout& layout = scene.geometry->textures.layouts[t];
    const Vec2<R> at = layout.inside(uv);
    const Vec3<R> d_color = d_L * scene.emitted(shape);
    d_scene.emission[static_cast<std::size_t>(shape)] += d_L * scene.emission_factor(use, uv);
    d_scene.texels[t].start(layout, at, R(0));
    R* d_texel = d_scene.texels[t].last(layout) + use.channel;
    for (int c = 0; c < 3; ++c) d_texel[c] += d_color[c];
}

/// <d_L, radiance of a shape, or of the lights at infinity>.
template <Real R>
void emission_backward(const PathScene<R>& scene, std::int32_t shape, const Vec2<R>& uv,
                       const Vec3<R>& direction, const Vec3<R>& d_L, SceneGradient<R>& d_scene) {
    if (shape >= 0) {
        if (const EmissionUse* use =
                scene.geometry->textures.emission_texture(static_cast<std::size_t>(shape)))
            return textured_emission_backward(scene, shape, *use, uv, d_L, d_scene);
        d_scene.emission[static_cast<std::size_t>(shape)] += d_L;
        return;
    }
    for (const std::int32_t i : scene.geometry->lights.at_infinity()) {
        const auto k = static_cast<std::size_t>(i);
        background_backward(scene.lights[k], direction, d_L, d_scene.lights[k]);
    }
}

/// <d_Le, Le of an emitter sample>.
template <Real R>
void emitter_backward(const PathScene<R>& scene, const EmitterSample<R>& emitter,
                      const Vec3<R>& d_Le, SceneGradient<R>& d_scene) {
    if (emitter.shape != SceneLights::delta)
        return emission_backward(scene, emitter.shape, emitter.uv, emitter.direction, d_Le,
                                 d_scene);
    const auto k = static_cast<std::size_t>(emitter.light);
    delta_backward(scene.lights[k], emitter.point, d_Le, d_scene.lights[k]);
}

/// dT/dalpha of one occluder: -product of what the others transmit.
template <class R>
R d_transmittance(const Path<R>& path, const Range& occluders, std::int32_t i) {
    R d = R(-1);
    for (std::int32_t j = occluders.first; j < occluders.last; ++j)
        if (j != i) d *= path.occluders[static_cast<std::size_t>(j)].transmittance;
    return d;
}

/// d_transmittance times what the occluders transmit, with respect to their alphas.
template <Real R>
void occluders_backward(const PathScene<R>& scene, const Path<R>& path, const Range& occluders,
                        R d_product, SceneGradient<R>& d_scene) {
    const SurfaceTextures& textures = scene.geometry->textures;
    for (std::int32_t i = occluders.first; i < occluders.last; ++i) {
        const Occluder<R>& one = path.occluders[static_cast<std::size_t>(i)];
        const R d_alpha = d_product * d_transmittance(path, occluders, i);
        const auto m = static_cast<std::size_t>(one.material);
        if (textures.of(m).empty()) {
            d_scene.materials[m].alpha += d_alpha;
            continue;
        }
        Material<R> d_own = scene.materials[m].zero();
        d_own.alpha = d_alpha;
        textured_backward(scene.materials[m], textures.of(m), textures, scene.texels, one.uv, {},
                          d_own, d_scene.materials[m], d_scene.texels);
    }
}

template <Real R>
void event_backward(const PathScene<R>& scene, const MediumEvent<R>& event, const Vec3<R>& d_value,
                    SceneGradient<R>& d_scene) {
    const auto m = static_cast<std::size_t>(event.medium);
    const Medium<R>& medium = scene.media[m];
    Medium<R>& d_medium = d_scene.media[m];
    if (event.kind == EventKind::transmit) {
        d_medium.sigma_t -= d_value * event.value * event.length;
        return;
    }
    const R scale = event.length * event.density;
    Vec3<R> d_density = -d_value * medium.sigma_t;
    if (event.kind == EventKind::scatter) {
        d_medium.sigma_t += d_value * medium.albedo * scale;
        d_medium.albedo += d_value * medium.sigma_t * scale;
        d_density *= -medium.albedo;
    } else {
        d_medium.sigma_t -= d_value * scale;
    }
    if (!medium.density) return;
    DensityAdjoint<R>& lookups = d_scene.densities[m];
    for (int k = 0; k < 3; ++k) lookups.world.push_back(event.position[k]);
    lookups.d_density.push_back((d_density.x + d_density.y + d_density.z) * event.length);
}

/// <d_product, product of events>.
template <Real R>
void product_backward(const PathScene<R>& scene, const Path<R>& path, const Range& events,
                      const Vec3<R>& d_product, SceneGradient<R>& d_scene) {
    Vec3<R> d = d_product;  // times the events behind the one at hand
    for (std::int32_t i = events.last; i-- > events.first;) {
        const MediumEvent<R>& event = path.events[static_cast<std::size_t>(i)];
        event_backward(scene, event, d * event.before, d_scene);
        d *= event.value;
    }
}

/// <d_nee, f^l> + <d_onward, f> at a surface, and d_alpha with respect to its opacity.
template <Real R>
void surface_backward(const PathScene<R>& scene, const PathVertex<R>& v, const Vec3<R>& d_nee,
                      const Vec3<R>& d_onward, R d_alpha, SceneGradient<R>& d_scene) {
    const auto m =
        static_cast<std::size_t>(scene.geometry->material[static_cast<std::size_t>(v.shape)]);
    const SurfaceTextures& textures = scene.geometry->textures;
    const std::span<const TextureUse> uses = textures.of(m);
    const auto add = [&](const Material<R>& material, Material<R>& d_material) {
        d_material.alpha += d_alpha;
        if (v.nee.weight > R(0)) material.value_backward(v.wo, v.nee.wi, -1, d_nee, d_material);
        if (v.weight > R(0) && v.kind == VertexKind::surface)
            material.value_backward(v.wo, v.wi, v.lobe, d_onward, d_material);
    };
    if (uses.empty()) return add(scene.materials[m], d_scene.materials[m]);
    // With textures the material at this point, and its derivative, are copies that
    // textured_backward takes apart.
    const Material<R> own =
        textured(scene.materials[m], uses, textures, scene.texels, v.uv, v.footprint);
    Material<R> d_own = own.zero();
    add(own, d_own);
    textured_backward(scene.materials[m], uses, textures, scene.texels, v.uv, v.footprint, d_own,
                      d_scene.materials[m], d_scene.texels);
}

/// Derivatives at a scattering event: f is the phase function of the angle between two directions
/// of travel.
template <Real R>
void phase_backward(const PathScene<R>& scene, const PathVertex<R>& v, const Vec3<R>& d_nee,
                    const Vec3<R>& d_onward, SceneGradient<R>& d_scene) {
    const auto m = static_cast<std::size_t>(v.medium);
    const AnyPhase<R>& phase = *scene.media[m].phase;
    AnyPhase<R>& d_phase = *d_scene.media[m].phase;
    if (v.nee.weight > R(0))
        phase.p_backward(dot(v.direction, v.nee.wi), d_nee.x + d_nee.y + d_nee.z, d_phase);
    if (v.weight > R(0))
        phase.p_backward(dot(v.direction, v.wi), d_onward.x + d_onward.y + d_onward.z, d_phase);
}

/// The emitter sample's term: <d_L, w^l f^l T^l L^l>. Returns d_nee, with respect to f^l.
template <Real R>
Vec3<R> nee_backward(const PathScene<R>& scene, const Path<R>& path, const PathVertex<R>& v,
                     const Vec3<R>& d_L, SceneGradient<R>& d_scene) {
    const EmitterSample<R>& nee = v.nee;
    if (!(nee.weight > R(0))) return Vec3<R>(R(0));
    if (!nee.occluders.empty())
        occluders_backward(scene, path, nee.occluders,
                           dot(d_L, nee.f * nee.Le * nee.shadow.value) * nee.weight, d_scene);
    Vec3<R> d = d_L * (nee.weight * nee.alpha_transmittance);
    if (!nee.shadow.events.empty())
        product_backward(scene, path, nee.shadow.events, d * nee.f * nee.Le, d_scene);
    d *= nee.shadow.value;
    emitter_backward(scene, nee, d * nee.f, d_scene);
    return d * nee.Le;
}

/// <d_L, L>; Lo as `radiance` has written it.
template <Real R>
void radiance_backward(const PathScene<R>& scene, const Path<R>& path, const Vec3<R>* Lo,
                       Vec3<R> d_L, SceneGradient<R>& d_scene) {
    const std::size_t count = path.vertices.size();
    for (std::size_t k = 0; k < count; ++k) {
        const PathVertex<R>& v = path.vertices[k];
        const Segment<R>& arrival = v.arrival;
        if (!arrival.product.events.empty())
            product_backward(scene, path, arrival.product.events, d_L * Lo[k] * arrival.weight,
                             d_scene);
        d_L *= arrival.product.value * arrival.weight;
        const bool continues = v.weight > R(0) && k + 1 < count;
        Vec3<R> Li(R(0));
        if (continues) {
            const Segment<R>& next = path.vertices[k + 1].arrival;
            Li = Lo[k + 1] * (next.product.value * next.weight);
        }
        const R d_alpha =
            v.d_opacity == R(0) ? R(0) : dot(d_L, scattered_radiance(v, Li)) * v.d_opacity;
        d_L *= v.opacity_weight;
        if (v.emission_weight > R(0))
            emission_backward(scene, v.shape, v.uv, v.direction, d_L * v.emission_weight, d_scene);
        if (v.kind == VertexKind::escaped) return;
        const Vec3<R> d_nee = nee_backward(scene, path, v, d_L, d_scene);
        const Vec3<R> d_onward = d_L * Li * v.weight;
        if (v.kind == VertexKind::medium)
            phase_backward(scene, v, d_nee, d_onward, d_scene);
        else
            surface_backward(scene, v, d_nee, d_onward, d_alpha, d_scene);
        if (!continues) return;
        d_L *= v.f * v.weight;
    }
}

}  // namespace photograd
