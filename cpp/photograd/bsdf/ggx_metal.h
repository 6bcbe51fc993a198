// A rough metal whose reflectance is one color, f0: GGX facets, Smith's masking, Schlick's Fresnel
// [Walter2007; Heitz2014; Schlick1994].
//
//   f = F D V,   F = f0 + (1 - f0) (1 - <wo, wh>)^5
//
// With f0 = 1 every facet is a perfect mirror and what is missing to an albedo of 1 is light that
// met a second facet, which the model drops: nothing on a polished surface, 69 % for a view along
// the normal at roughness 1 (the albedo is 1 - ln 2 there).
#pragma once

#include "photograd/bsdf/ggx_lobe.h"
#include "photograd/ops/fresnel_schlick.h"

namespace photograd {

template <class R>
struct GgxMetal {
    Vec3<R> f0{R(0.9)};
    R roughness{R(0.4)};

    static constexpr const char* name = "ggx_metal";
    static constexpr EnergyClaim energy{Energy::conserving, 1.0};
    static constexpr bool reciprocal = true;
    static constexpr auto params =
        describe(p("f0", &GgxMetal::f0, 0.0, 1.0),
                 p("roughness", &GgxMetal::roughness, least_roughness, 1.0));

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return Vec3<R>(R(0));
        return schlick(f0, dot(wo, half_vector(wo, wi))) * ggx_lobe(wo, wi, roughness);
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                    GgxMetal& d_self) const {
        if (!both_above(wo, wi)) return;
        const R o_dot_h = dot(wo, half_vector(wo, wi));
        schlick_backward(o_dot_h, d_f * ggx_lobe(wo, wi, roughness), d_self.f0);
        ggx_lobe_backward(wo, wi, roughness, dot(d_f, schlick(f0, o_dot_h)), d_self.roughness);
    }

    Vec3<R> sample(const Vec3<R>& wo, const Vec2<R>& u2) const {
        return sample_ggx_lobe(wo, roughness, u2);
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const { return ggx_lobe_pdf(wo, wi, roughness); }
};

static_assert(Bsdf<GgxMetal>);

}  // namespace photograd
