// Thin-film iridescence: the metallic-roughness model under a film, after
// KHR_materials_iridescence [Khronos2022].
//
//   L = D V,   alpha_ggx = roughness^2                       as in gltf.h
//   F(f0) = S(f0) + w (film(f0) - S(f0)),   S Schlick's ramp, film: ops/thin_film.h
//   w = iridescence_factor x^2 (3 - 2 x),   x = min(iridescence_thickness / 0.03 nm, 1)
//   f = (1 - metalness) f_d + metalness f_m
//   f_d = (1 - max(F_d)) base_color / pi + F_d L,   F_d = F(0.04)
//       max over the channels: colored light must not leave its complement in the base layer
//   f_m = F_m L,   F_m = F(base_color)
//
// Without a film (factor or thickness 0) this is gltf.h to the bit. The extension lets the film's
// index go to 1 over those 0.03 nm, a tenth of an atom; its approximations do not cancel there, so
// here the film itself goes. Colors of the spectrum are more than red, green and blue can hold: F
// reaches 1.28 (index 1.55, 310 nm, f0 0.8, c 0.07), and with what the base layer keeps at the
// horizon (gltf.h: 0.933) no view returns more than 2.22.
//
//   df/dbase_color = (1 - metalness) (1 - max(F_d)) / pi + metalness dF_m/df0 L
//   df_d/dF_d = L, and -base_color / pi of the largest channel
//       (a kink where two channels are equally large)
//   dF/df0 = (1 - w) (1 - ramp) + w dfilm/df0
//   dF/dw = film - S,   dw/dthickness = iridescence_factor 6 x (1 - x) / 0.03
#pragma once

#include "photograd/bsdf/ggx_lobe.h"
#include "photograd/ops/thin_film.h"

namespace photograd {

template <class R>
struct GltfIridescence {
    Vec3<R> base_color{R(0.5)};
    R metalness{R(0)}, roughness{R(0.5)};
    R iridescence_factor{R(1)}, iridescence_ior{R(1.3)}, iridescence_thickness{R(400)};

    static constexpr const char* name = "gltf_iridescence";
    static constexpr EnergyClaim energy{Energy::gains, 2.22};
    static constexpr bool reciprocal = true;
    static constexpr auto params = describe(
        p("base_color", &GltfIridescence::base_color, 0.0, 1.0),
        p("metalness", &GltfIridescence::metalness, 0.0, 1.0),
        p("roughness", &GltfIridescence::roughness, least_roughness, 1.0),
        p("iridescence_factor", &GltfIridescence::iridescence_factor, 0.0, 1.0),
        p("iridescence_ior", &GltfIridescence::iridescence_ior, 1.1, 2.3),
        p("iridescence_thickness", &GltfIridescence::iridescence_thickness, 0.0, 1000.0, "nm"));
    static constexpr double dielectric_f0 = 0.04, least_thickness = 0.03;

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return Vec3<R>(R(0));
        const R c = dot(wo, half_vector(wo, wi)), lobe = ggx_lobe(wo, wi, roughness);
        return (R(1) - metalness) * dielectric(c, lobe) +
               metalness * (fresnel(base_color, c) * lobe);
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                    GltfIridescence& d_self) const {
        if (!both_above(wo, wi)) return;
        const R c = dot(wo, half_vector(wo, wi)), lobe = ggx_lobe(wo, wi, roughness);
        const R rest = R(1) - metalness;
        const Vec3<R> F_d = fresnel(base_f0(), c), F_m = fresnel(base_color, c);
        const int most = largest(F_d);
        d_self.base_color += d_f * (rest * (R(1) - F_d[most]) * R(1 / pi));
        d_self.metalness += dot(d_f, F_m * lobe - dielectric(c, lobe));
        Vec3<R> d_F = d_f * (rest * lobe), fixed(R(0));
        d_F[most] -= rest * dot(d_f, base_color) * R(1 / pi);
        fresnel_backward(base_f0(), c, d_F, fixed, d_self);
        fresnel_backward(base_color, c, d_f * (metalness * lobe), d_self.base_color, d_self);
        const R d_lobe = rest * dot(d_f, F_d) + metalness * dot(d_f, F_m);
        ggx_lobe_backward(wo, wi, roughness, d_lobe, d_self.roughness);
    }

    Vec3<R> sample(const Vec3<R>& wo, const Vec2<R>& u2) const {
        return sample_base_and_lobe(wo, dielectric_diffuse_probability(metalness), roughness, u2);
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        return base_and_lobe_pdf(wo, wi, dielectric_diffuse_probability(metalness), roughness);
    }

private:
    static Vec3<R> base_f0() { return Vec3<R>(R(dielectric_f0)); }
    static int largest(const Vec3<R>& v) {
        const int first = v[1] > v[0] ? 1 : 0;
        return v[2] > v[first] ? 2 : first;
    }
    /// x of the head of this file.
    [[nodiscard]] R thinness() const {
        const R x = iridescence_thickness / R(least_thickness);
        return x < R(1) ? x : R(1);
    }
    [[nodiscard]] R weight() const {
        const R x = thinness();
        return iridescence_factor * x * x * (R(3) - R(2) * x);
    }
    Vec3<R> fresnel(const Vec3<R>& f0, R c) const {
        const Vec3<R> plain = schlick(f0, c);
        const R w = weight();
        if (!(w > R(0))) return plain;
        return plain + w * (thin_film(f0, iridescence_ior, iridescence_thickness, c) - plain);
    }
    void fresnel_backward(const Vec3<R>& f0, R c, const Vec3<R>& d_F, Vec3<R>& d_f0,
                          GltfIridescence& d_self) const {
        const R x = thinness(), smoothstep = x * x * (R(3) - R(2) * x), w = weight();
        const Vec3<R> film = thin_film(f0, iridescence_ior, iridescence_thickness, c);
        const R d_w = dot(d_F, film - schlick(f0, c));
        d_self.iridescence_factor += d_w * smoothstep;
        d_self.iridescence_thickness +=
            d_w * iridescence_factor * R(6) * x * (R(1) - x) / R(least_thickness);
        schlick_backward(c, d_F * (R(1) - w), d_f0);
        R fixed_cosine = R(0);
        thin_film_backward(f0, iridescence_ior, iridescence_thickness, c, d_F * w, d_f0,
                           d_self.iridescence_ior, d_self.iridescence_thickness, fixed_cosine);
    }
    Vec3<R> dielectric(R c, R lobe) const {
        const Vec3<R> F_d = fresnel(base_f0(), c);
        return base_color * ((R(1) - F_d[largest(F_d)]) * R(1 / pi)) + F_d * lobe;
    }
};

static_assert(Bsdf<GltfIridescence>);

}  // namespace photograd
