// The metallic-roughness model with KHR_materials_transmission and KHR_materials_volume
// [Khronos2022]: closed bodies of clear, colored or frosted glass that refract.
//
//   f = (1 - metalness) ((1 - transmission) f_d + transmission f_t) + metalness f_m
//   f_d, f_m of gltf.h, with f0 = ((eta - 1) / (eta + 1))^2 for its 0.04
//       0 unless both directions are outside
//   f_t = G where it mirrors, base_color G where it refracts                 G: rough_dielectric.h
//
// Finished lobes are blended, as in gltf.h. f_t has Fresnel's exact reflectance, f_d Schlick's:
// inside of the body there is total internal reflection, which Schlick's ramp lacks. Absorption in
// the body belongs to its medium, not to the surface.
//
//   df/dtransmission = (1 - metalness) (f_t - f_d)
//   df/dmetalness = f_m - (1 - transmission) f_d - transmission f_t
//   df/deta: by G, and by F_d with dF_d/df0 = 1 - ramp       the others: gltf.h, rough_dielectric.h
#pragma once

#include "photograd/bsdf/rough_dielectric.h"
#include "photograd/ops/fresnel_schlick.h"

namespace photograd {

template <class R>
struct GltfRefraction {
    Vec3<R> base_color{R(0.5)};
    R metalness{R(0)}, roughness{R(0.4)}, transmission{R(1)}, eta{R(1.5)};

    static constexpr const char* name = "gltf_refraction";
    static constexpr EnergyClaim energy{Energy::gains, 1.97};
    static constexpr bool reciprocal = true, transmits = true;
    static constexpr auto params =
        describe(p("base_color", &GltfRefraction::base_color, 0.0, 1.0),
                 p("metalness", &GltfRefraction::metalness, 0.0, 1.0),
                 p("roughness", &GltfRefraction::roughness, 0.1, 1.0),
                 p("transmission", &GltfRefraction::transmission, 0.0, 1.0),
                 p("eta", &GltfRefraction::eta, 1.2, 2.5));

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        const R rest = R(1) - metalness;
        const Vec3<R> through = glass_color(wo, wi) * glass().f(wo, wi) * (rest * transmission);
        if (!both_above(wo, wi)) return through;
        const R c = dot(wo, half_vector(wo, wi)), lobe = ggx_lobe(wo, wi, roughness);
        return through + rest * (R(1) - transmission) * dielectric(c, lobe) +
               metalness * (schlick(base_color, c) * lobe);
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                    GltfRefraction& d_self) const {
        const R rest = R(1) - metalness, G = glass().f(wo, wi).x;
        const R colored = dot(d_f, glass_color(wo, wi));
        RoughDielectric<R> d_glass{R(0), R(0)};
        glass().f_backward(wo, wi, Vec3<R>(rest * transmission * colored, R(0), R(0)), d_glass);
        d_self.eta += d_glass.eta;
        d_self.roughness += d_glass.roughness;
        d_self.transmission += rest * colored * G;
        d_self.metalness -= transmission * colored * G;
        if (!(wo.z * wi.z > R(0))) d_self.base_color += d_f * (rest * transmission * G);
        if (both_above(wo, wi)) opaque_backward(wo, wi, d_f, d_self);
    }

    /// Outside both lobes are sampled, inside only glass. A facet that reflects the opaque lobe
    /// below the surface gives an invalid sample: a direction in the horizon, of no density.
    Vec3<R> sample(const Vec3<R>& wo, Vec2<R> u2) const {
        if (!(wo.z > R(0)) || take_first(glass_share(wo), u2)) return glass().sample(wo, u2);
        const Vec3<R> wi = sample_base_and_lobe(wo, diffuse_probability(), roughness, u2);
        return wi.z > R(0) ? wi : Vec3<R>(R(1), R(0), R(0));
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        const R share = glass_share(wo);
        return share * glass().pdf(wo, wi) +
               (R(1) - share) * base_and_lobe_pdf(wo, wi, diffuse_probability(), roughness);
    }
    Vec3<R> index_inside() const { return Vec3<R>(eta); }

private:
    RoughDielectric<R> glass() const { return {eta, roughness}; }
    Vec3<R> glass_color(const Vec3<R>& wo, const Vec3<R>& wi) const {
        return wo.z * wi.z > R(0) ? Vec3<R>(R(1)) : base_color;
    }
    R fresnel(R cosine) const { return schlick(schlick_f0(eta), R(1), cosine); }
    Vec3<R> dielectric(R cosine, R lobe) const {
        const R F_d = fresnel(cosine);
        return base_color * ((R(1) - F_d) * R(1 / pi)) + Vec3<R>(F_d * lobe);
    }
    /// By (1 - metalness) (1 - transmission) f_d + metalness f_m.
    void opaque_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                         GltfRefraction& d_self) const {
        const R rest = R(1) - metalness, share = rest * (R(1) - transmission);
        const R c = dot(wo, half_vector(wo, wi)), lobe = ggx_lobe(wo, wi, roughness);
        const R F_d = fresnel(c), all = d_f.x + d_f.y + d_f.z;
        const R of_dielectric = dot(d_f, dielectric(c, lobe));
        const Vec3<R> F_m = schlick(base_color, c);
        d_self.transmission -= rest * of_dielectric;
        d_self.metalness += dot(d_f, F_m) * lobe - (R(1) - transmission) * of_dielectric;
        d_self.base_color += d_f * (share * (R(1) - F_d) * R(1 / pi));
        schlick_backward(c, d_f * (metalness * lobe), d_self.base_color);
        const R d_F = share * (all * lobe - dot(d_f, base_color) * R(1 / pi));
        R d_f0 = R(0), fixed_f90 = R(0), fixed_cosine = R(0);
        schlick_backward(schlick_f0(eta), R(1), c, d_F, d_f0, fixed_f90, fixed_cosine);
        schlick_f0_backward(eta, d_f0, d_self.eta);
        const R d_lobe = share * F_d * all + metalness * dot(d_f, F_m);
        ggx_lobe_backward(wo, wi, roughness, d_lobe, d_self.roughness);
    }
    R glass_share(const Vec3<R>& wo) const {
        if (!(wo.z > R(0))) return R(1);
        return R(0.1) + R(0.8) * (R(1) - metalness) * transmission;
    }
    [[nodiscard]] R diffuse_probability() const { return R(0.1) + R(0.4) * (R(1) - metalness); }
};

static_assert(Bsdf<GltfRefraction>);

}  // namespace photograd
