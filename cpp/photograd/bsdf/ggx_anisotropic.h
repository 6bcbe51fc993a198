// Brushed metal: GGX facets that are rougher along one tangent direction than across it
// [Heitz2014].
//
//   alpha_y = roughness^2,   alpha_x = alpha_y + (1 - alpha_y) anisotropy^2
//       KHR_materials_anisotropy [Khronos2022]
//   x' = cos(r) x + sin(r) y,  y' = -sin(r) x + cos(r) y
//       directions seen from the tangent turned by r = rotation
//   f = F D V of the turned directions,   F = f0 + (1 - f0) (1 - <wo, wh>)^5
//
//   dalpha_y/droughness = 2 roughness      dalpha_x/droughness = 2 roughness (1 - anisotropy^2)
//   dalpha_x/danisotropy = 2 anisotropy (1 - alpha_y)
//   dx'/dr = y',  dy'/dr = -x'             of each of wo, wi and wh; <wo, wh> does not turn
//
// At anisotropy 0 the rotation changes nothing, and its derivative is 0: both axes are alike.
#pragma once

#include "photograd/bsdf/ggx_lobe.h"
#include "photograd/core/sincos.h"
#include "photograd/ops/fresnel_schlick.h"

namespace photograd {

template <class R>
struct GgxAnisotropic {
    Vec3<R> f0{R(0.9)};
    R roughness{R(0.4)}, anisotropy{R(0.5)}, rotation{R(0)};

    static constexpr const char* name = "ggx_anisotropic";
    static constexpr EnergyClaim energy{Energy::conserving, 1.0};
    static constexpr bool reciprocal = true;
    static constexpr auto params =
        describe(p("f0", &GgxAnisotropic::f0, 0.0, 1.0),
                 p("roughness", &GgxAnisotropic::roughness, least_roughness, 1.0),
                 p("anisotropy", &GgxAnisotropic::anisotropy, 0.0, 1.0),
                 p("rotation", &GgxAnisotropic::rotation, -pi, pi, "rad"));

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return Vec3<R>(R(0));
        const Turned w = turned(wo, wi);
        return schlick(f0, dot(w.o, w.h)) *
               (ggx_D(w.h, alpha_x(), alpha_y()) * ggx_V(w.o, w.i, alpha_x(), alpha_y()));
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                    GgxAnisotropic& d_self) const {
        if (!both_above(wo, wi)) return;
        const Turned w = turned(wo, wi);
        const R D = ggx_D(w.h, alpha_x(), alpha_y()), V = ggx_V(w.o, w.i, alpha_x(), alpha_y());
        const R o_dot_h = dot(w.o, w.h), d_DV = dot(d_f, schlick(f0, o_dot_h));
        schlick_backward(o_dot_h, d_f * (D * V), d_self.f0);
        Vec3<R> d_o(R(0)), d_i(R(0)), d_h(R(0));
        R d_x = R(0), d_y = R(0);
        ggx_D_backward(w.h, alpha_x(), alpha_y(), d_DV * V, d_h, d_x, d_y);
        ggx_V_backward(w.o, w.i, alpha_x(), alpha_y(), d_DV * D, d_o, d_i, d_x, d_y);
        const R rest = R(1) - anisotropy * anisotropy;
        d_self.roughness += R(2) * roughness * (d_y + rest * d_x);
        d_self.anisotropy += R(2) * anisotropy * (R(1) - alpha_y()) * d_x;
        d_self.rotation += turn(w.o, d_o) + turn(w.i, d_i) + turn(w.h, d_h);
    }

    Vec3<R> sample(const Vec3<R>& wo, const Vec2<R>& u2) const {
        const SinCos<R> r = sin_cos(rotation);
        const Vec3<R> wh = sample_ggx_visible(turned(wo, r), alpha_x(), alpha_y(), u2);
        return reflect(wo, turned(wh, SinCos<R>{-r.sin, r.cos}));
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return R(0);
        const Turned w = turned(wo, wi);
        return reflected_pdf(w.o, w.h, ggx_visible_pdf(w.o, w.h, alpha_x(), alpha_y()));
    }

private:
    struct Turned {
        Vec3<R> o, i, h;
    };
    static Vec3<R> turned(const Vec3<R>& w, const SinCos<R>& r) {
        return {r.cos * w.x + r.sin * w.y, r.cos * w.y - r.sin * w.x, w.z};
    }
    Turned turned(const Vec3<R>& wo, const Vec3<R>& wi) const {
        const SinCos<R> r = sin_cos(rotation);
        return {turned(wo, r), turned(wi, r), turned(half_vector(wo, wi), r)};
    }
    /// dL/drotation through one turned direction.
    static R turn(const Vec3<R>& w, const Vec3<R>& d_w) { return d_w.x * w.y - d_w.y * w.x; }
    [[nodiscard]] R alpha_y() const { return roughness * roughness; }
    [[nodiscard]] R alpha_x() const {
        return alpha_y() + (R(1) - alpha_y()) * anisotropy * anisotropy;
    }
};

static_assert(Bsdf<GgxAnisotropic>);

}  // namespace photograd
