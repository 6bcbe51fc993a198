// Burley's diffuse reflection, fitted to measured materials [Burley2012, Sec. 5.3]: smooth ones
// darken at grazing angles, rough ones light up there.
//
//   d = <wi, wh>,   f90 = 0.5 + 2 roughness d^2,   m(c) = (1 - c)^5
//   f = albedo / pi  s(o_z) s(i_z),   s(c) = 1 + (f90 - 1) m(c)
//
//   df/droughness = albedo / pi (m(o_z) s(i_z) + s(o_z) m(i_z)) 2 d^2
//
// It is a fit, not a balance: at roughness 1 it returns 1.46 times the light at o_z = 0.05 and, at
// the horizon,
//
//   int_0^1 2 c (3/2 + (1 - c)^5 (3/4 + (1 - c^2) / 2)) dc
//       = 3/2 + 1/28 + 1/56 + 1/252 = 1.5575 times
//
// (f90 = 3/2 + s cos(phi) there, with s the sine of wi, and its mean square over phi is 9/4 + s^2 /
// 2).
#pragma once

#include "photograd/bsdf/half_vector.h"
#include "photograd/ops/fresnel_schlick.h"
#include "photograd/sampling/warp.h"

namespace photograd {

template <class R>
struct BurleyDiffuse {
    Vec3<R> albedo{R(0.5)};
    R roughness{R(0.5)};

    static constexpr const char* name = "burley_diffuse";
    static constexpr EnergyClaim energy{Energy::gains, 1.558};
    static constexpr bool reciprocal = true;
    static constexpr auto params = describe(p("albedo", &BurleyDiffuse::albedo, 0.0, 1.0),
                                            p("roughness", &BurleyDiffuse::roughness, 0.0, 1.0));

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return Vec3<R>(R(0));
        const R f90 = grazing(wo, wi);
        return albedo * (R(1 / pi) * schlick(R(1), f90, wo.z) * schlick(R(1), f90, wi.z));
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                    BurleyDiffuse& d_self) const {
        if (!both_above(wo, wi)) return;
        const R f90 = grazing(wo, wi), out = schlick(R(1), f90, wo.z),
                in = schlick(R(1), f90, wi.z);
        d_self.albedo += d_f * (R(1 / pi) * out * in);
        const R d_f90 =
            dot(d_f, albedo) * R(1 / pi) * (schlick_ramp(wo.z) * in + out * schlick_ramp(wi.z));
        d_self.roughness += d_f90 * (R(1) + dot(wo, wi));
    }

    Vec3<R> sample(const Vec3<R>&, const Vec2<R>& u2) const {
        return square_to_cosine_hemisphere(u2);
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        return wo.z > R(0) ? cosine_hemisphere_pdf(wi) : R(0);
    }

private:
    /// f90; 2 d^2 is 1 + <wo, wi>, the cosine of twice the half angle.
    R grazing(const Vec3<R>& wo, const Vec3<R>& wi) const {
        return R(0.5) + roughness * (R(1) + dot(wo, wi));
    }
};

static_assert(Bsdf<BurleyDiffuse>);

}  // namespace photograd
