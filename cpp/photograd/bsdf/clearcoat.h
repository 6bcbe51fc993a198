// A clear coat over the metallic-roughness model, after [Khronos2022, KHR_materials_clearcoat].
//
//   t(c) = 1 - coat S(c),   S(c) = 0.04 + 0.96 (1 - c)^5   what one passage through the coat leaves
//   f = t(o_z) t(i_z) f_base + coat S(<wo, wh>) D V        D V of coat_roughness
//
// Light passes the coat twice, in and out. The extension takes off S(o_z) alone, which is brighter
// and not reciprocal; here both passages count, f(wo, wi) = f(wi, wo) holds, and coat = 0 is the
// base, with what that gains.
//
//   df/dbase parameters = t(o_z) t(i_z) df_base/d...
//   df/dcoat = -(S(o_z) t(i_z) + t(o_z) S(i_z)) f_base + S(<wo, wh>) D V
#pragma once

#include "photograd/bsdf/gltf.h"

namespace photograd {

template <class R>
struct Clearcoat {
    Vec3<R> base_color{R(0.5)};
    R metalness{R(0)}, roughness{R(0.5)}, coat{R(1)}, coat_roughness{R(0.1)};

    static constexpr const char* name = "clearcoat";
    static constexpr EnergyClaim energy{Energy::gains, 1.94};
    static constexpr bool reciprocal = true;
    static constexpr auto params =
        describe(p("base_color", &Clearcoat::base_color, 0.0, 1.0),
                 p("metalness", &Clearcoat::metalness, 0.0, 1.0),
                 p("roughness", &Clearcoat::roughness, least_roughness, 1.0),
                 p("coat", &Clearcoat::coat, 0.0, 1.0),
                 p("coat_roughness", &Clearcoat::coat_roughness, least_roughness, 1.0));

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return Vec3<R>(R(0));
        const R glint = S(dot(wo, half_vector(wo, wi))) * ggx_lobe(wo, wi, coat_roughness);
        return base().f(wo, wi) * (passage(wo.z) * passage(wi.z)) + Vec3<R>(coat * glint);
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                    Clearcoat& d_self) const {
        if (!both_above(wo, wi)) return;
        const R out = passage(wo.z), in = passage(wi.z), all = d_f.x + d_f.y + d_f.z;
        const R F = S(dot(wo, half_vector(wo, wi)));
        Gltf<R> d_base{Vec3<R>(R(0)), R(0), R(0)};
        base().f_backward(wo, wi, d_f * (out * in), d_base);
        d_self.base_color += d_base.base_color;
        d_self.metalness += d_base.metalness;
        d_self.roughness += d_base.roughness;
        d_self.coat += all * F * ggx_lobe(wo, wi, coat_roughness) -
                       dot(d_f, base().f(wo, wi)) * (S(wo.z) * in + out * S(wi.z));
        ggx_lobe_backward(wo, wi, coat_roughness, all * coat * F, d_self.coat_roughness);
    }

    /// A full coat takes half of the samples; it is much fainter than the base, but may be much
    /// sharper.
    Vec3<R> sample(const Vec3<R>& wo, Vec2<R> u2) const {
        if (take_first(R(0.5) * coat, u2)) return sample_ggx_lobe(wo, coat_roughness, u2);
        return base().sample(wo, u2);
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return R(0);
        const R share = R(0.5) * coat;
        return share * ggx_lobe_pdf(wo, wi, coat_roughness) + (R(1) - share) * base().pdf(wo, wi);
    }

private:
    [[nodiscard]] Gltf<R> base() const { return {base_color, metalness, roughness}; }
    static R S(R cos_theta) { return schlick(R(Gltf<R>::dielectric_f0), R(1), cos_theta); }
    [[nodiscard]] R passage(R cos_theta) const { return R(1) - coat * S(cos_theta); }
};

static_assert(Bsdf<Clearcoat>);

}  // namespace photograd
