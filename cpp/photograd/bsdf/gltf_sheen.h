// Charlie sheen over the metallic-roughness model, after KHR_materials_sheen
// [Khronos2022]. The base gets what the sheen leaves [Estevez2017].
//
//   f = color D V + (1 - max(color) E) f_base
//   D V of sheen_roughness_factor: sheen.h        color = sheen_color_factor
//   E = max(E(o_z), E(i_z)), E the albedo of white sheen: ops/charlie_albedo.h
//       max keeps f reciprocal
//
// So nothing is gained beyond what the base gains. Black sheen is the base.
//
//   df/dcolor = D V, and -E f_base for the largest channel
//       (a kink where two channels are equally large)
//   df/dsheen_roughness = color d(D V) - max(color) dE f_base
//       df/dbase parameters = (1 - max(color) E) df_base/d...
#pragma once

#include "photograd/bsdf/gltf.h"
#include "photograd/bsdf/sheen.h"
#include "photograd/ops/charlie_albedo.h"

namespace photograd {

template <class R>
struct GltfSheen {
    Vec3<R> base_color{R(0.5)};
    R metalness{R(0)}, roughness{R(0.5)};
    Vec3<R> sheen_color_factor{R(0.5)};
    R sheen_roughness_factor{R(0.5)};

    static constexpr const char* name = "gltf_sheen";
    static constexpr EnergyClaim energy = Gltf<R>::energy;
    static constexpr bool reciprocal = true;
    static constexpr auto params =
        describe(p("base_color", &GltfSheen::base_color, 0.0, 1.0),
                 p("metalness", &GltfSheen::metalness, 0.0, 1.0),
                 p("roughness", &GltfSheen::roughness, least_roughness, 1.0),
                 p("sheen_color_factor", &GltfSheen::sheen_color_factor, 0.0, 1.0),
                 p("sheen_roughness_factor", &GltfSheen::sheen_roughness_factor, 0.3, 1.0));

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return Vec3<R>(R(0));
        const R left = R(1) - sheen_color_factor[largest()] * taken(wo, wi).value;
        return sheen().f(wo, wi) + left * base().f(wo, wi);
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                    GltfSheen& d_self) const {
        if (!both_above(wo, wi)) return;
        const SheenAlbedo<R> E = taken(wo, wi);
        const R most = sheen_color_factor[largest()], below = dot(d_f, base().f(wo, wi));
        Sheen<R> d_sheen{Vec3<R>(R(0)), R(0)};
        sheen().f_backward(wo, wi, d_f, d_sheen);
        d_self.sheen_color_factor += d_sheen.color;
        d_self.sheen_color_factor[largest()] -= E.value * below;
        d_self.sheen_roughness_factor += d_sheen.roughness - most * E.slope * below;
        Gltf<R> d_base{Vec3<R>(R(0)), R(0), R(0)};
        base().f_backward(wo, wi, d_f * (R(1) - most * E.value), d_base);
        d_self.base_color += d_base.base_color;
        d_self.metalness += d_base.metalness;
        d_self.roughness += d_base.roughness;
    }

    /// To the sheen as often as it takes light.
    Vec3<R> sample(const Vec3<R>& wo, Vec2<R> u2) const {
        if (take_first(sheen_share(wo), u2)) return sheen().sample(wo, u2);
        return base().sample(wo, u2);
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return R(0);
        const R share = sheen_share(wo);
        return share * sheen().pdf(wo, wi) + (R(1) - share) * base().pdf(wo, wi);
    }

private:
    Gltf<R> base() const { return {base_color, metalness, roughness}; }
    Sheen<R> sheen() const { return {sheen_color_factor, sheen_roughness_factor}; }
    [[nodiscard]] int largest() const {
        const Vec3<R>& v = sheen_color_factor;
        const int first = v[1] > v[0] ? 1 : 0;
        return v[2] > v[first] ? 2 : first;
    }
    SheenAlbedo<R> taken(const Vec3<R>& wo, const Vec3<R>& wi) const {
        const SheenAlbedo<R> out = SheenAlbedo<R>::of(wo.z, sheen_roughness_factor);
        const SheenAlbedo<R> in = SheenAlbedo<R>::of(wi.z, sheen_roughness_factor);
        return out.value > in.value ? out : in;
    }
    /// Never all: the base reflects some for every color.
    R sheen_share(const Vec3<R>& wo) const {
        return R(0.9) * sheen_color_factor[largest()] *
               larger(SheenAlbedo<R>::of(wo.z, sheen_roughness_factor).value, R(0));
    }
};

static_assert(Bsdf<GltfSheen>);

}  // namespace photograd
