// Rough metals with the measured complex index eta + i k, for the three channels, and Fresnel's
// exact formula.
//
//   f = F(eta, k, <wo, wh>) D V       with the facets of GGX or of Beckmann [Walter2007; Heitz2014]
//
// Schlick's ramp misses what real metals do near grazing angles (aluminium dips before it turns
// white).
#pragma once

#include "photograd/bsdf/ggx_lobe.h"
#include "photograd/ops/fresnel_conductor.h"

namespace photograd {

/// A facet distribution: D V, its adjoint, a sampler and its density.
template <class R>
struct GgxFacets {
    static constexpr const char* name = "ggx_conductor";
    static R lobe(const Vec3<R>& wo, const Vec3<R>& wi, R roughness) {
        return ggx_lobe(wo, wi, roughness);
    }
    static void lobe_backward(const Vec3<R>& wo, const Vec3<R>& wi, R roughness, R d_lobe,
                              R& d_roughness) {
        ggx_lobe_backward(wo, wi, roughness, d_lobe, d_roughness);
    }
    static Vec3<R> sample(const Vec3<R>& wo, R roughness, const Vec2<R>& u2) {
        return sample_ggx_lobe(wo, roughness, u2);
    }
    static R pdf(const Vec3<R>& wo, const Vec3<R>& wi, R roughness) {
        return ggx_lobe_pdf(wo, wi, roughness);
    }
};

/// Samples all facets, not only those that wo sees: weights grow to 1 / o_z at grazing angles.
template <class R>
struct BeckmannFacets {
    static constexpr const char* name = "beckmann_conductor";
    static R lobe(const Vec3<R>& wo, const Vec3<R>& wi, R roughness) {
        const R alpha = roughness * roughness;
        return beckmann_D(half_vector(wo, wi), alpha) * beckmann_V(wo, wi, alpha);
    }
    static void lobe_backward(const Vec3<R>& wo, const Vec3<R>& wi, R roughness, R d_lobe,
                              R& d_roughness) {
        const R alpha = roughness * roughness;
        const Vec3<R> wh = half_vector(wo, wi);
        R d_alpha = R(0);
        beckmann_D_backward(wh, alpha, d_lobe * beckmann_V(wo, wi, alpha), d_alpha);
        beckmann_V_backward(wo, wi, alpha, d_lobe * beckmann_D(wh, alpha), d_alpha);
        d_roughness += R(2) * roughness * d_alpha;
    }
    static Vec3<R> sample(const Vec3<R>& wo, R roughness, const Vec2<R>& u2) {
        return reflect(wo, sample_beckmann(roughness * roughness, u2));
    }
    static R pdf(const Vec3<R>& wo, const Vec3<R>& wi, R roughness) {
        if (!both_above(wo, wi)) return R(0);
        const Vec3<R> wh = half_vector(wo, wi);
        return reflected_pdf(wo, wh, beckmann_pdf(wh, roughness * roughness));
    }
};

template <class R, class Facets>
struct Conductor {
    Vec3<R> eta{R(0.2)}, k{R(3)};
    R roughness{R(0.4)};

    static constexpr const char* name = Facets::name;
    static constexpr EnergyClaim energy{Energy::lossy, 1.0};
    static constexpr bool reciprocal = true;
    static constexpr auto params =
        describe(p("eta", &Conductor::eta, 0.05, 5.0), p("k", &Conductor::k, 0.2, 10.0),
                 p("roughness", &Conductor::roughness, least_roughness, 1.0));

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return Vec3<R>(R(0));
        return fresnel(dot(wo, half_vector(wo, wi))) * Facets::lobe(wo, wi, roughness);
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                    Conductor& d_self) const {
        if (!both_above(wo, wi)) return;
        const R o_dot_h = dot(wo, half_vector(wo, wi));
        const R lobe = Facets::lobe(wo, wi, roughness);
        R fixed = R(0);  // directions are held constant
        for (int c = 0; c < 3; ++c)
            fresnel_conductor_backward(eta[c], k[c], o_dot_h, d_f[c] * lobe, d_self.eta[c],
                                       d_self.k[c], fixed);
        Facets::lobe_backward(wo, wi, roughness, dot(d_f, fresnel(o_dot_h)), d_self.roughness);
    }

    Vec3<R> sample(const Vec3<R>& wo, const Vec2<R>& u2) const {
        return Facets::sample(wo, roughness, u2);
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const { return Facets::pdf(wo, wi, roughness); }

private:
    Vec3<R> fresnel(R o_dot_h) const {
        return {fresnel_conductor(eta.x, k.x, o_dot_h), fresnel_conductor(eta.y, k.y, o_dot_h),
                fresnel_conductor(eta.z, k.z, o_dot_h)};
    }
};

template <class R>
using GgxConductor = Conductor<R, GgxFacets<R>>;
template <class R>
using BeckmannConductor = Conductor<R, BeckmannFacets<R>>;

static_assert(Bsdf<GgxConductor> && Bsdf<BeckmannConductor>);

}  // namespace photograd
