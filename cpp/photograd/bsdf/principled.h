// Burley's principled model, its most common parameters: base color, metalness and
// roughness [Burley2012].
//
//   f = base_color P + Q
//       ops/principled.h: Burley's diffuse base layer under a coating of index 1.5, or metal
//
//   df/dbase_color = P       each channel on its own; dL/dP = <d_f, base_color>, dL/dQ = sum of d_f
//
// It differs from standard.h in three ways: the base layer is Burley's, not Lambert's; the coating
// has Fresnel's exact reflectance; masking and shadowing are independent. As there, the base layer
// does not lose what the coating reflects.
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
        return sample_base_and_lobe(wo, diffuse_probability(), roughness, u2);
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        return base_and_lobe_pdf(wo, wi, diffuse_probability(), roughness);
    }

private:
    static PrincipledAngles<R> angles(const Vec3<R>& wo, const Vec3<R>& wi) {
        return PrincipledAngles<R>::of(wo.x, wo.y, wo.z, wi.x, wi.y, wi.z);
    }
    /// Of the samples, in proportion to the light that the base layer and the lobe give back,
    /// roughly; both get some, since the derivative with respect to metalness needs the other one
    /// as well.
    [[nodiscard]] R diffuse_probability() const {
        const R albedo = (base_color.x + base_color.y + base_color.z) * R(1.0 / 3);
        const R diffuse = (R(1) - metalness) * albedo;
        const R lobe = metalness * albedo + (R(1) - metalness) * R(0.06);
        return R(0.1) + R(0.8) * diffuse / (diffuse + lobe + R(1e-6));
    }
};

static_assert(Bsdf<Principled>);

}  // namespace photograd
