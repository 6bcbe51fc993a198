// ggx_metal.h with the masking that renderers for phones take, without roots (ops/ggx_fast.h), to
// see what it costs:
//
//   f = F D V_fast,   F = f0 + (1 - f0) (1 - <wo, wh>)^5        by each parameter as in ggx_metal.h
//
// Samples are those of the exact form, so f cos / pdf is never above F here, either.
#pragma once

#include "photograd/bsdf/ggx_lobe.h"
#include "photograd/ops/fresnel_schlick.h"
#include "photograd/ops/ggx_fast.h"

namespace photograd {

template <class R>
struct GgxMetalFast {
    Vec3<R> f0{R(0.9)};
    R roughness{R(0.4)};

    static constexpr const char* name = "ggx_metal_fast";
    static constexpr EnergyClaim energy{Energy::conserving, 1.0};
    static constexpr bool reciprocal = true;
    static constexpr auto params =
        describe(p("f0", &GgxMetalFast::f0, 0.0, 1.0),
                 p("roughness", &GgxMetalFast::roughness, least_roughness, 1.0));

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return Vec3<R>(R(0));
        const R alpha = roughness * roughness;
        const Vec3<R> wh = half_vector(wo, wi);
        return schlick(f0, dot(wo, wh)) * (ggx_D(wh, alpha, alpha) * ggx_V_fast(wo.z, wi.z, alpha));
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                    GgxMetalFast& d_self) const {
        if (!both_above(wo, wi)) return;
        const R alpha = roughness * roughness;
        const Vec3<R> wh = half_vector(wo, wi);
        Vec3<R> fixed_h(R(0));
        const R o_dot_h = dot(wo, wh), D = ggx_D(wh, alpha, alpha);
        const R V = ggx_V_fast(wo.z, wi.z, alpha), d_lobe = dot(d_f, schlick(f0, o_dot_h));
        schlick_backward(o_dot_h, d_f * (D * V), d_self.f0);
        R d_alpha = R(0), fixed_o = R(0), fixed_i = R(0);
        ggx_D_backward(wh, alpha, alpha, d_lobe * V, fixed_h, d_alpha, d_alpha);
        ggx_V_fast_backward(wo.z, wi.z, alpha, d_lobe * D, fixed_o, fixed_i, d_alpha);
        d_self.roughness += R(2) * roughness * d_alpha;
    }

    Vec3<R> sample(const Vec3<R>& wo, const Vec2<R>& u2) const {
        return sample_ggx_lobe(wo, roughness, u2);
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const { return ggx_lobe_pdf(wo, wi, roughness); }
};

static_assert(Bsdf<GgxMetalFast>);

}  // namespace photograd
