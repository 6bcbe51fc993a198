// Burley's principled model, the part that most programs share: base colour, metalness and roughness [Burley2012].
//
//   f = base_color P + Q               ops/principled.h: Burley's diffuse ground under a varnish of index 1.5, or metal
//
//   df/dbase_color = P                 each channel on its own; dL/dP = <d_f, base_color>, dL/dQ = sum of d_f
//
// It differs from standard.h in three ways: the ground is Burley's, not Lambert's; the varnish has Fresnel's exact
// reflectance; masking and shadowing are independent. As there, the ground does not lose what the varnish reflects.
#pragma once

#include "photograd/bsdf/ggx_lobe.h"
#include "photograd/ops/principled.h"

namespace photograd {

template <class R>
struct Principled {
    Vec3<R> base_color{R(0.5)};
    R metalness{R(0)}, roughness{R(0.5)};

    static constexpr const char* name = "principled";
    static constexpr EnergyClaim energy{Energy::gains, 1.61};
    static constexpr bool reciprocal = true;
    static constexpr auto params =
        describe(p("base_color", &Principled::base_color, 0.0, 1.0),
                 p("metalness", &Principled::metalness, 0.0, 1.0),
                 p("roughness", &Principled::roughness, least_roughness, 1.0));

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return Vec3<R>(R(0));
        const PrincipledTerms<R> t = principled(angles(wo, wi), metalness, roughness);
        return {base_color.x * t.P + t.Q, base_color.y * t.P + t.Q, base_color.z * t.P + t.Q};
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                    Principled& d_self) const {
        if (!both_above(wo, wi)) return;
        const PrincipledAngles<R> w = angles(wo, wi);
        d_self.base_color += d_f * principled(w, metalness, roughness).P;
        principled_backward(w, metalness, roughness, dot(d_f, base_color), d_f.x + d_f.y + d_f.z,
                            d_self.metalness, d_self.roughness);
    }

    Vec3<R> sample(const Vec3<R>& wo, const Vec2<R>& u2) const {
        return sample_ground_and_lobe(wo, ground_share(), roughness, u2);
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        return ground_and_lobe_pdf(wo, wi, ground_share(), roughness);
    }

private:
    static PrincipledAngles<R> angles(const Vec3<R>& wo, const Vec3<R>& wi) {
        return PrincipledAngles<R>::of(wo.x, wo.y, wo.z, wi.x, wi.y, wi.z);
    }
    /// Of the samples, in proportion to the light that the ground and the lobe give back, roughly; both get
    /// some, since the derivative by metalness needs the other one as well.
    [[nodiscard]] R ground_share() const {
        const R base = (base_color.x + base_color.y + base_color.z) * R(1.0 / 3);
        const R ground = (R(1) - metalness) * base;
        const R lobe = metalness * base + (R(1) - metalness) * R(0.06);
        return R(0.1) + R(0.8) * ground / (ground + lobe + R(1e-6));
    }
};

static_assert(Bsdf<Principled>);

}  // namespace photograd
