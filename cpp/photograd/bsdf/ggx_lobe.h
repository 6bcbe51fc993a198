// Common to all GGX models: the reflected lobe without Fresnel's factor, its sampling and its
// density.
//
//   lobe = D(wh) V(wo, wi),   roughness^2 = alpha_ggx   of the user and of the formulas
//
// Samples are the facets that wo sees, so that f cos / pdf = F G2 / G1(wo) is never above F.
#pragma once

#include "photograd/bsdf/half_vector.h"
#include "photograd/sampling/vndf.h"

namespace photograd {

/// Below this the lobe is narrower than any pixel, and float runs out of digits for its height.
inline constexpr double least_roughness = 0.045;

template <class R>
R ggx_lobe(const Vec3<R>& wo, const Vec3<R>& wi, R roughness) {
    const R alpha = roughness * roughness;
    return ggx_D(half_vector(wo, wi), alpha, alpha) * ggx_V(wo, wi, alpha, alpha);
}
/// Directions are held constant.
template <class R>
void ggx_lobe_backward(const Vec3<R>& wo, const Vec3<R>& wi, R roughness, R d_lobe,
                       R& d_roughness) {
    const R alpha = roughness * roughness;
    const Vec3<R> wh = half_vector(wo, wi);
    Vec3<R> fixed_h(R(0)), fixed_o(R(0)), fixed_i(R(0));
    R d_alpha = R(0);  // of both axes
    ggx_D_backward(wh, alpha, alpha, d_lobe * ggx_V(wo, wi, alpha, alpha), fixed_h, d_alpha,
                   d_alpha);
    ggx_V_backward(wo, wi, alpha, alpha, d_lobe * ggx_D(wh, alpha, alpha), fixed_o, fixed_i,
                   d_alpha, d_alpha);
    d_roughness += R(2) * roughness * d_alpha;
}

template <Real R>
Vec3<R> sample_ggx_lobe(const Vec3<R>& wo, R roughness, const Vec2<R>& u2) {
    const R alpha = roughness * roughness;
    return reflect(wo, sample_ggx_visible(wo, alpha, alpha, u2));
}
template <class R>
R ggx_lobe_pdf(const Vec3<R>& wo, const Vec3<R>& wi, R roughness) {
    if (!both_above(wo, wi)) return R(0);
    const R alpha = roughness * roughness;
    const Vec3<R> wh = half_vector(wo, wi);
    return reflected_pdf(wo, wh, ggx_visible_pdf(wo, wh, alpha, alpha));
}

/// The lobe over a diffuse base layer, which gets `diffuse_probability` of the samples.
template <Real R>
Vec3<R> sample_base_and_lobe(const Vec3<R>& wo, R diffuse_probability, R roughness, Vec2<R> u2) {
    if (take_first(diffuse_probability, u2)) return square_to_cosine_hemisphere(u2);
    return sample_ggx_lobe(wo, roughness, u2);
}
template <class R>
R base_and_lobe_pdf(const Vec3<R>& wo, const Vec3<R>& wi, R diffuse_probability, R roughness) {
    if (!both_above(wo, wi)) return R(0);
    return diffuse_probability * cosine_hemisphere_pdf(wi) +
           (R(1) - diffuse_probability) * ggx_lobe_pdf(wo, wi, roughness);
}
/// Half of a dielectric's samples; a metal has no base layer.
template <class R>
R dielectric_diffuse_probability(R metalness) {
    return R(0.5) * (R(1) - metalness);
}

}  // namespace photograd
