// Burley's principled model of 2012 [Burley2012, Sec. 5 and its code]: a base color and ten
// sliders from 0 to 1, none of them physical, all of them plausible.
//
//   f = (1 - metalness) (f_base + S(f0) L) + metalness S(base_color) L + f_coat
//   f_base = base_color / pi diffuse + sheen ramp tinted(sheen_tint)    diffuse, hue: disney_base.h
//   f0 = 0.08 specular tinted(specular_tint),   tinted(x) = 1 + x (hue - 1)
//   ramp = (1 - <wo, wh>)^5,   S(f0) = f0 + (1 - f0) ramp
//   L = D v(o_z) v(i_z)   D: GGX with alpha_x = roughness^2 / aspect, alpha_y = roughness^2 aspect,
//                         aspect = sqrt(1 - 0.9 anisotropic)
//   v(c) = 1 / (c + k(c)),  k(c) = sqrt(u + (1 - u) c^2)
//       Smith's masking, u = (1/2 + roughness / 2)^4
//   f_coat = clearcoat / 4 S(0.04) D_1 v_1(o_z) v_1(i_z)
//       D_1: ops/gtr1.h, alpha = 0.1 - 0.099 clearcoat_gloss;
//                                                              v_1: u = 1/16
//
// The paper mixes the f0 of both by metalness into one lobe (its `metallic`); Schlick's ramp is
// linear in f0 and nothing else depends on it, so that this is the blend of the finished lobes
// which stands here. Its masking is not that of D, and not correlated by height. Nothing takes from
// the base layer what the highlights reflect, and sheen and coat come on top: white returns up to
// 1.83 of the light. A hue is up to 10, that of pure blue, which makes f0 0.8: blue with all
// sliders up returns 3.80 times the light at the horizon.
//
//   dv/du = -v^2 (1 - c^2) / (2 k)      du/droughness = 2 (1/2 + roughness / 2)^3
//   dalpha_x/droughness = 2 roughness / aspect            dalpha_y/droughness = 2 roughness aspect
//   dalpha_x/daspect = -alpha_x / aspect                  dalpha_y/daspect = alpha_y / aspect
//   daspect/danisotropic = -0.45 / aspect
#pragma once

#include <initializer_list>

#include "photograd/bsdf/disney_base.h"
#include "photograd/bsdf/ggx_lobe.h"
#include "photograd/ops/gtr1.h"

namespace photograd {

template <class R>
struct Disney {
    Vec3<R> base_color{R(0.5)};
    R subsurface{R(0)}, metalness{R(0)}, specular{R(0.5)}, specular_tint{R(0)}, roughness{R(0.5)};
    R anisotropic{R(0)}, sheen{R(0)}, sheen_tint{R(0.5)}, clearcoat{R(0)}, clearcoat_gloss{R(1)};

    static constexpr const char* name = "disney";
    static constexpr EnergyClaim energy{Energy::gains, 3.81};
    static constexpr bool reciprocal = true;
    static constexpr auto params = describe(
        p("base_color", &Disney::base_color, 0.0, 1.0),
        p("subsurface", &Disney::subsurface, 0.0, 1.0),
        p("metalness", &Disney::metalness, 0.0, 1.0), p("specular", &Disney::specular, 0.0, 1.0),
        p("specular_tint", &Disney::specular_tint, 0.0, 1.0),
        p("roughness", &Disney::roughness, least_roughness, 1.0),
        p("anisotropic", &Disney::anisotropic, 0.0, 1.0), p("sheen", &Disney::sheen, 0.0, 1.0),
        p("sheen_tint", &Disney::sheen_tint, 0.0, 1.0),
        p("clearcoat", &Disney::clearcoat, 0.0, 1.0),
        p("clearcoat_gloss", &Disney::clearcoat_gloss, 0.0, 1.0));

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return Vec3<R>(R(0));
        const Vec3<R> wh = half_vector(wo, wi);
        const R c = dot(wo, wh), L = lobe(wo, wi, wh);
        return (R(1) - metalness) * dielectric(wo, wi, c, L) +
               metalness * (schlick(base_color, c) * L) +
               Vec3<R>(R(0.25) * clearcoat * coat(wo, wi, wh));
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                    Disney& d_self) const {
        if (!both_above(wo, wi)) return;
        const Vec3<R> wh = half_vector(wo, wi), metal = schlick(base_color, dot(wo, wh));
        const R c = dot(wo, wh), L = lobe(wo, wi, wh), rest = R(1) - metalness;
        d_self.metalness += dot(d_f, metal * L - dielectric(wo, wi, c, L));
        schlick_backward(c, d_f * (metalness * L), d_self.base_color);
        dielectric_backward(wo, wi, c, L, d_f * rest, d_self);
        const R d_L = rest * dot(d_f, schlick(f0(), c)) + metalness * dot(d_f, metal);
        lobe_backward(wo, wi, wh, d_L, d_self);
        const R all = R(0.25) * (d_f.x + d_f.y + d_f.z);
        d_self.clearcoat += all * coat(wo, wi, wh);
        R d_alpha = R(0);
        gtr1_D_backward(wh, coat_alpha(), all * clearcoat * coat_factor(wo, wi, c), d_alpha);
        d_self.clearcoat_gloss -= R(0.099) * d_alpha;
    }

    /// Some to the coat; of the others, half to the base layer where there is one, and the rest to
    /// the highlight.
    Vec3<R> sample(const Vec3<R>& wo, Vec2<R> u2) const {
        if (take_first(coat_share(), u2)) return reflect(wo, sample_gtr1(coat_alpha(), u2));
        if (take_first(diffuse_probability(), u2)) return square_to_cosine_hemisphere(u2);
        return reflect(wo, sample_ggx_visible(wo, alpha_x(), alpha_y(), u2));
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return R(0);
        const Vec3<R> wh = half_vector(wo, wi);
        const R facet = ggx_visible_pdf(wo, wh, alpha_x(), alpha_y());
        const R uncoated = diffuse_probability() * cosine_hemisphere_pdf(wi) +
                           (R(1) - diffuse_probability()) * reflected_pdf(wo, wh, facet);
        const R coated = reflected_pdf(wo, wh, gtr1_pdf(wh, coat_alpha()));
        return coat_share() * coated + (R(1) - coat_share()) * uncoated;
    }

private:
    [[nodiscard]] R aspect() const { return sqrt(R(1) - R(0.9) * anisotropic); }
    [[nodiscard]] R alpha_x() const { return roughness * roughness / aspect(); }
    [[nodiscard]] R alpha_y() const { return roughness * roughness * aspect(); }
    [[nodiscard]] R coat_alpha() const { return R(0.1) - R(0.099) * clearcoat_gloss; }
    [[nodiscard]] R coat_share() const { return clearcoat / (R(4) + clearcoat); }
    [[nodiscard]] R diffuse_probability() const { return R(0.5) * (R(1) - metalness); }
    Vec3<R> tinted(R x) const {
        return Vec3<R>(R(1)) + x * (disney::hue(base_color) - Vec3<R>(R(1)));
    }
    Vec3<R> f0() const { return R(0.08) * specular * tinted(specular_tint); }

    Vec3<R> dielectric(const Vec3<R>& wo, const Vec3<R>& wi, R c, R L) const {
        return base_color * (R(1 / pi) * disney::diffuse(wo, wi, roughness, subsurface)) +
               sheen * schlick_ramp(c) * tinted(sheen_tint) + schlick(f0(), c) * L;
    }
    /// By all but L.
    void dielectric_backward(const Vec3<R>& wo, const Vec3<R>& wi, R c, R L, const Vec3<R>& d,
                             Disney& d_self) const {
        const Vec3<R> colored = disney::hue(base_color) - Vec3<R>(R(1));
        const R ramp = schlick_ramp(c), diffuse = disney::diffuse(wo, wi, roughness, subsurface);
        d_self.base_color += d * (R(1 / pi) * diffuse);
        disney::diffuse_backward(wo, wi, roughness, subsurface, R(1 / pi) * dot(d, base_color),
                                 d_self.roughness, d_self.subsurface);
        d_self.sheen += ramp * dot(d, tinted(sheen_tint));
        d_self.sheen_tint += ramp * sheen * dot(d, colored);
        const Vec3<R> d_f0 = d * (R(0.08) * L * (R(1) - ramp));  // times 0.08
        d_self.specular += dot(d_f0, tinted(specular_tint));
        d_self.specular_tint += specular * dot(d_f0, colored);
        const Vec3<R> d_hue = d * (ramp * sheen * sheen_tint) + d_f0 * (specular * specular_tint);
        disney::hue_backward(base_color, d_hue, d_self.base_color);
    }

    /// k of the head of this file.
    static R length(R cosine, R u) { return sqrt(u + (R(1) - u) * cosine * cosine); }
    static R masking(const Vec3<R>& wo, const Vec3<R>& wi, R u) {
        return R(1) / ((wo.z + length(wo.z, u)) * (wi.z + length(wi.z, u)));
    }
    static R masking_by_u(const Vec3<R>& wo, const Vec3<R>& wi, R u) {
        R sum = R(0);
        for (const R c : {wo.z, wi.z})
            sum += (R(1) - c * c) / (R(2) * length(c, u) * (c + length(c, u)));
        return -masking(wo, wi, u) * sum;
    }
    R lobe(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& wh) const {
        const R w = R(0.5) + R(0.5) * roughness;
        return ggx_D(wh, alpha_x(), alpha_y()) * masking(wo, wi, (w * w) * (w * w));
    }
    void lobe_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& wh, R d_L,
                       Disney& d_self) const {
        const R w = R(0.5) + R(0.5) * roughness, u = (w * w) * (w * w);
        Vec3<R> fixed(R(0));
        R d_x = R(0), d_y = R(0);
        ggx_D_backward(wh, alpha_x(), alpha_y(), d_L * masking(wo, wi, u), fixed, d_x, d_y);
        const R d_u = d_L * ggx_D(wh, alpha_x(), alpha_y()) * masking_by_u(wo, wi, u);
        d_self.roughness +=
            R(2) * roughness * (d_x / aspect() + d_y * aspect()) + d_u * R(2) * w * w * w;
        const R d_aspect = (d_y * alpha_y() - d_x * alpha_x()) / aspect();
        d_self.anisotropic -= R(0.45) * d_aspect / aspect();
    }

    /// f_coat without clearcoat / 4, and that without D_1.
    R coat(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& wh) const {
        return gtr1_D(wh, coat_alpha()) * coat_factor(wo, wi, dot(wo, wh));
    }
    static R coat_factor(const Vec3<R>& wo, const Vec3<R>& wi, R c) {
        return schlick(R(0.04), R(1), c) * masking(wo, wi, R(0.0625));
    }
};

static_assert(Bsdf<Disney>);

}  // namespace photograd
