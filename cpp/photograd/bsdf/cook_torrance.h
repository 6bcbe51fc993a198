// Cook and Torrance's model [Cook1982]: Beckmann's facets in V-shaped grooves.
//
//   f = F D G / (4 o_z i_z)
//   D   Beckmann's, of root mean square slope `slope`; its integral times h_z is 1
//   F   Schlick's ramp from f0
//   G = min(1, 2 h_z o_z / <wo, wh>, 2 h_z i_z / <wo, wh>)
//       the two walls of a groove hide each other
//
// The paper prints D without the pi and the denominator pi instead of 4. Both are errors: a mirror
// (F = 1) of slope 0.2 then returns four times the light. With the constants above it returns 0.999
// of it, seen from o_z = 0.9.
//
//   dD/dslope   ops/beckmann.h                       G has no parameter
#pragma once

#include "photograd/bsdf/half_vector.h"
#include "photograd/ops/fresnel_schlick.h"
#include "photograd/sampling/vndf.h"

namespace photograd {

template <class R>
struct CookTorrance {
    Vec3<R> f0{R(0.5)};
    R slope{R(0.3)};

    static constexpr const char* name = "cook_torrance";
    static constexpr EnergyClaim energy{Energy::conserving, 1.0};
    static constexpr bool reciprocal = true;
    static constexpr auto params =
        describe(p("f0", &CookTorrance::f0, 0.0, 1.0), p("slope", &CookTorrance::slope, 0.02, 0.8));

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return Vec3<R>(R(0));
        const Vec3<R> wh = half_vector(wo, wi);
        return schlick(f0, dot(wo, wh)) * (beckmann_D(wh, slope) * groove_V(wo, wi, wh));
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                    CookTorrance& d_self) const {
        if (!both_above(wo, wi)) return;
        const Vec3<R> wh = half_vector(wo, wi);
        const R o_dot_h = dot(wo, wh), V = groove_V(wo, wi, wh);
        schlick_backward(o_dot_h, d_f * (beckmann_D(wh, slope) * V), d_self.f0);
        beckmann_D_backward(wh, slope, dot(d_f, schlick(f0, o_dot_h)) * V, d_self.slope);
    }

    Vec3<R> sample(const Vec3<R>& wo, const Vec2<R>& u2) const {
        return reflect(wo, sample_beckmann(slope, u2));
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return R(0);
        const Vec3<R> wh = half_vector(wo, wi);
        return reflected_pdf(wo, wh, beckmann_pdf(wh, slope));
    }

private:
    /// G / (4 o_z i_z).
    static R groove_V(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& wh) {
        const R lower = smaller(wo.z, wi.z);
        return smaller(R(1), R(2) * wh.z * lower / dot(wo, wh)) / (R(4) * wo.z * wi.z);
    }
};

static_assert(Bsdf<CookTorrance>);

}  // namespace photograd
