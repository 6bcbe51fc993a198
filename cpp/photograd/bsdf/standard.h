// Filament's standard model [Guy2018, Sec. 4]: Lambert under a GGX lobe for dielectrics, the lobe
// alone for metals.
//
//   L = D V                             GGX with height-correlated masking, alpha_ggx = roughness^2
//   ramp = (1 - <wo, wh>)^5,   f0 = 0.16 reflectance^2   reflectance 0.5 is an index of 1.5
//   f = (1 - metalness) f_d + metalness f_m
//   f_d = base_color / pi + (f0 + (1 - f0) ramp) L
//   f_m = (base_color + (1 - base_color) ramp) L
//
// Filament mixes f0 and base_color to one f0 and has a single lobe. Here that is the same as
// blending the finished lobes: Schlick's F is linear in f0 and multiplies nothing else. In gltf.h
// it multiplies the base layer as well, and is not. Blending is what carries over, so it stands
// here too.
//
// The base layer does not lose what the lobe reflects: a white dielectric returns up to twice the
// light at grazing angles.
//
//   df/dbase_color = (1 - metalness) / pi + metalness (1 - ramp) L        df/dmetalness = f_m - f_d
//   df/dreflectance = (1 - metalness) 0.32 reflectance (1 - ramp) L
//   df/dL = (1 - metalness) F_d + metalness F_m
#pragma once

#include "photograd/bsdf/ggx_lobe.h"
#include "photograd/ops/fresnel_schlick.h"

namespace photograd {

template <class R>
struct Standard {
    Vec3<R> base_color{R(0.5)};
    R metalness{R(0)}, roughness{R(0.5)}, reflectance{R(0.5)};

    static constexpr const char* name = "standard";
    static constexpr EnergyClaim energy{Energy::gains, 2.0};
    static constexpr bool reciprocal = true;
    static constexpr auto params =
        describe(p("base_color", &Standard::base_color, 0.0, 1.0),
                 p("metalness", &Standard::metalness, 0.0, 1.0),
                 p("roughness", &Standard::roughness, least_roughness, 1.0),
                 p("reflectance", &Standard::reflectance, 0.0, 1.0));

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return Vec3<R>(R(0));
        const R o_dot_h = dot(wo, half_vector(wo, wi)), lobe = ggx_lobe(wo, wi, roughness);
        return (R(1) - metalness) * dielectric(o_dot_h, lobe) +
               metalness * (schlick(base_color, o_dot_h) * lobe);
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                    Standard& d_self) const {
        if (!both_above(wo, wi)) return;
        const R o_dot_h = dot(wo, half_vector(wo, wi)), lobe = ggx_lobe(wo, wi, roughness);
        const R rest = R(1) - metalness;
        const Vec3<R> F_m = schlick(base_color, o_dot_h);
        d_self.base_color += d_f * (rest * R(1 / pi));
        schlick_backward(o_dot_h, d_f * (metalness * lobe), d_self.base_color);
        d_self.metalness += dot(d_f, F_m * lobe - dielectric(o_dot_h, lobe));
        const R all = d_f.x + d_f.y + d_f.z;  // the dielectric's lobe has no color
        d_self.reflectance +=
            all * rest * R(0.32) * reflectance * (R(1) - schlick_ramp(o_dot_h)) * lobe;
        const R d_lobe = all * rest * fresnel(o_dot_h) + metalness * dot(d_f, F_m);
        ggx_lobe_backward(wo, wi, roughness, d_lobe, d_self.roughness);
    }

    Vec3<R> sample(const Vec3<R>& wo, const Vec2<R>& u2) const {
        return sample_base_and_lobe(wo, dielectric_diffuse_probability(metalness), roughness, u2);
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        return base_and_lobe_pdf(wo, wi, dielectric_diffuse_probability(metalness), roughness);
    }

private:
    [[nodiscard]] R fresnel(R o_dot_h) const {
        return schlick(R(0.16) * reflectance * reflectance, R(1), o_dot_h);
    }
    Vec3<R> dielectric(R o_dot_h, R lobe) const {
        return base_color * R(1 / pi) + Vec3<R>(fresnel(o_dot_h) * lobe);
    }
};

static_assert(Bsdf<Standard>);

}  // namespace photograd
