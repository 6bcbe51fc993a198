// The metallic-roughness core of glTF 2.0 [Khronos2021, App. B]: a coated diffuse base layer, a
// metal, a blend of both.
//
//   L = D V                             GGX with height-correlated masking, alpha_ggx = roughness^2
//   ramp = (1 - <wo, wh>)^5
//   F_d = 0.04 + 0.96 ramp              a boundary of index 1.5
//   F_m = base_color + (1 - base_color) ramp
//   f = (1 - metalness) f_d + metalness f_m
//   f_d = (1 - F_d) base_color / pi + F_d L
//       what the coating does not reflect reaches the base layer
//   f_m = F_m L
//
// The finished lobes are blended, not their f0. Putting f0 = (1 - metalness) 0.04 + metalness
// base_color into one lobe also weakens the base layer by 1 - F of the mixture: a white surface of
// roughness 0.5 and metalness 0.5, seen from o_z = 0.6, then returns 0.698, less than its two ends
// (1.002 and 0.872). Blended, it returns 0.937, between them. 1 - F_d is that of the one wh of wo
// and wi, not of all that the coating reflects: towards grazing views the base layer keeps its
// light while the coating becomes a mirror. White of roughness 0.3, seen from o_z = 0.1, returns
// 1.28 of the light; smooth and seen from the horizon 0.933 + 1.
//
//   df/dbase_color = (1 - metalness) (1 - F_d) / pi + metalness (1 - ramp) L
//   df/dmetalness = f_m - f_d
//   df/dL = (1 - metalness) F_d + metalness F_m
#pragma once

#include "photograd/bsdf/ggx_lobe.h"
#include "photograd/ops/fresnel_schlick.h"

namespace photograd {

template <class R>
struct Gltf {
    Vec3<R> base_color{R(0.5)};
    R metalness{R(0)}, roughness{R(0.5)};

    static constexpr const char* name = "gltf";
    static constexpr EnergyClaim energy{Energy::gains, 1.94};
    static constexpr bool reciprocal = true;
    static constexpr auto params = describe(p("base_color", &Gltf::base_color, 0.0, 1.0),
                                            p("metalness", &Gltf::metalness, 0.0, 1.0),
                                            p("roughness", &Gltf::roughness, least_roughness, 1.0));
    static constexpr double dielectric_f0 = 0.04;

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return Vec3<R>(R(0));
        const R ramp = schlick_ramp(dot(wo, half_vector(wo, wi)));
        const R lobe = ggx_lobe(wo, wi, roughness);
        return (R(1) - metalness) * dielectric(ramp, lobe) + metalness * metal(ramp, lobe);
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f, Gltf& d_self) const {
        if (!both_above(wo, wi)) return;
        const R ramp = schlick_ramp(dot(wo, half_vector(wo, wi)));
        const R lobe = ggx_lobe(wo, wi, roughness), rest = R(1) - metalness;
        const R F_d = fresnel(ramp);
        d_self.base_color +=
            d_f * (rest * (R(1) - F_d) * R(1 / pi) + metalness * (R(1) - ramp) * lobe);
        d_self.metalness += dot(d_f, metal(ramp, lobe) - dielectric(ramp, lobe));
        const R d_lobe = dot(d_f, Vec3<R>(rest * F_d) + metalness * metal(ramp, R(1)));
        ggx_lobe_backward(wo, wi, roughness, d_lobe, d_self.roughness);
    }

    Vec3<R> sample(const Vec3<R>& wo, const Vec2<R>& u2) const {
        return sample_base_and_lobe(wo, dielectric_diffuse_probability(metalness), roughness, u2);
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        return base_and_lobe_pdf(wo, wi, dielectric_diffuse_probability(metalness), roughness);
    }

private:
    static R fresnel(R ramp) { return R(dielectric_f0) + R(1 - dielectric_f0) * ramp; }
    Vec3<R> dielectric(R ramp, R lobe) const {
        const R F_d = fresnel(ramp);
        return base_color * ((R(1) - F_d) * R(1 / pi)) + Vec3<R>(F_d * lobe);
    }
    Vec3<R> metal(R ramp, R lobe) const {
        return (base_color + (Vec3<R>(R(1)) - base_color) * ramp) * lobe;
    }
};

static_assert(Bsdf<Gltf>);

}  // namespace photograd
