// The metallic-roughness model with KHR_materials_specular and KHR_materials_ior [Khronos2022]: a
// coating of any index, whose reflection is weakened and colored by hand.
//
//   L = D V                                               GGX as in gltf.h, alpha_ggx = roughness^2
//   ramp = (1 - <wo, wh>)^5,   s = ((eta - 1) / (eta + 1))^2
//   f0 = min(s specular_color_factor, 1)                  of each channel
//   F = specular_factor (f0 + (1 - f0) ramp)
//       at grazing angles specular_factor, whatever the color
//   F_m = base_color + (1 - base_color) ramp
//   f = (1 - metalness) f_d + metalness F_m L
//   f_d = (1 - max F) base_color / pi + F L               the largest of the three channels
//
// The base layer of all channels loses what the strongest one reflects: a colored coating would
// else leave light of the complementary color. With factors 1 and eta 1.5 this is gltf.h; with
// specular_factor 0 the dielectric is Lambert's. Metals are as they were. White returns at most
// 0.972 + 1: smooth, eta 1, seen from the horizon.
//
//   df/dbase_color = (1 - metalness) (1 - max F) / pi + metalness (1 - ramp) L
//   df/dmetalness = F_m L - f_d
//   df/dF = (1 - metalness) L, and by the largest of F also -(1 - metalness) base_color / pi
//   df/dL = (1 - metalness) F + metalness F_m
//   dF/dspecular_factor = f0 + (1 - f0) ramp              dF/df0 = specular_factor (1 - ramp)
//   df0/dspecular_color_factor = s        df0/ds = specular_color_factor        both 0 where f0 = 1
//
// Where two channels are the largest, f has an edge; the first of them takes the derivative.
#pragma once

#include "photograd/bsdf/ggx_lobe.h"
#include "photograd/ops/fresnel_schlick.h"

namespace photograd {

template <class R>
struct GltfSpecular {
    Vec3<R> base_color{R(0.5)};
    R metalness{R(0)}, roughness{R(0.5)}, eta{R(1.5)}, specular_factor{R(1)};
    Vec3<R> specular_color_factor{R(1)};

    static constexpr const char* name = "gltf_specular";
    static constexpr EnergyClaim energy{Energy::gains, 1.98};
    static constexpr bool reciprocal = true;
    static constexpr auto params =
        describe(p("base_color", &GltfSpecular::base_color, 0.0, 1.0),
                 p("metalness", &GltfSpecular::metalness, 0.0, 1.0),
                 p("roughness", &GltfSpecular::roughness, least_roughness, 1.0),
                 p("eta", &GltfSpecular::eta, 1.0, 2.5),
                 p("specular_factor", &GltfSpecular::specular_factor, 0.0, 1.0),
                 p("specular_color_factor", &GltfSpecular::specular_color_factor, 0.0, 2.0));

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return Vec3<R>(R(0));
        const R ramp = schlick_ramp(dot(wo, half_vector(wo, wi)));
        const R lobe = ggx_lobe(wo, wi, roughness);
        return (R(1) - metalness) * dielectric(coating(ramp), lobe) + metalness * metal(ramp, lobe);
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                    GltfSpecular& d_self) const {
        if (!both_above(wo, wi)) return;
        const R ramp = schlick_ramp(dot(wo, half_vector(wo, wi)));
        const R lobe = ggx_lobe(wo, wi, roughness), rest = R(1) - metalness;
        const Vec3<R> F = coating(ramp);
        d_self.base_color += d_f * (rest * left(F) * R(1 / pi) + metalness * (R(1) - ramp) * lobe);
        d_self.metalness += dot(d_f, metal(ramp, lobe) - dielectric(F, lobe));
        Vec3<R> d_F = d_f * (rest * lobe);
        d_F[strongest(F)] -= rest * R(1 / pi) * dot(d_f, base_color);
        coating_backward(ramp, d_F, d_self);
        const R d_lobe = dot(d_f, rest * F + metalness * metal(ramp, R(1)));
        ggx_lobe_backward(wo, wi, roughness, d_lobe, d_self.roughness);
    }

    Vec3<R> sample(const Vec3<R>& wo, const Vec2<R>& u2) const {
        return sample_base_and_lobe(wo, dielectric_diffuse_probability(metalness), roughness, u2);
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        return base_and_lobe_pdf(wo, wi, dielectric_diffuse_probability(metalness), roughness);
    }

private:
    /// Straight on.
    [[nodiscard]] Vec3<R> f0() const {
        Vec3<R> out = schlick_f0(eta) * specular_color_factor;
        for (int k = 0; k < 3; ++k)
            if (out[k] > R(1)) out[k] = R(1);
        return out;
    }
    [[nodiscard]] Vec3<R> coating(R ramp) const {
        const Vec3<R> straight = f0();
        return specular_factor * (straight + (Vec3<R>(R(1)) - straight) * ramp);
    }
    void coating_backward(R ramp, const Vec3<R>& d_F, GltfSpecular& d_self) const {
        const Vec3<R> straight = f0();
        const R s = schlick_f0(eta);
        R d_s = R(0);
        for (int k = 0; k < 3; ++k) {
            d_self.specular_factor += d_F[k] * (straight[k] + (R(1) - straight[k]) * ramp);
            if (!(s * specular_color_factor[k] < R(1))) continue;
            const R d_f0 = d_F[k] * specular_factor * (R(1) - ramp);
            d_self.specular_color_factor[k] += d_f0 * s;
            d_s += d_f0 * specular_color_factor[k];
        }
        schlick_f0_backward(eta, d_s, d_self.eta);
    }
    static int strongest(const Vec3<R>& F) {
        if (F.x >= F.y) return F.x >= F.z ? 0 : 2;
        return F.y >= F.z ? 1 : 2;
    }
    /// Of the light, for the base layer.
    static R left(const Vec3<R>& F) { return R(1) - F[strongest(F)]; }
    [[nodiscard]] Vec3<R> dielectric(const Vec3<R>& F, R lobe) const {
        return base_color * (left(F) * R(1 / pi)) + F * lobe;
    }
    [[nodiscard]] Vec3<R> metal(R ramp, R lobe) const {
        return (base_color + (Vec3<R>(R(1)) - base_color) * ramp) * lobe;
    }
};

static_assert(Bsdf<GltfSpecular>);

}  // namespace photograd
