// ggx_metal.h with compensation for multiple scattering between facets, a diffuse lobe [Kulla2017]
// with Schlick's color.
//
//   f = F L + M g,   L = D V and F = f0 + (1 - f0) ramp as in ggx_metal.h
//   g = loss(o_z) loss(i_z) / (pi average)          loss, average by roughness: ops/ggx_loss.h
//   M = A^2 E / (1 - A (1 - E)),   A = (20 f0 + 1) / 21 = 2 int F c dc,   E = 1 - average
//
// For f0 = 1, M is 1 and int g i_z = loss(o_z): all light comes back, but for the error of the fit.
// Each bounce takes A and E of what is left leaves, so that lobe is A^2 E + A^3 E (1 - E) + ...;
// the first bounce is F L. It is reciprocal, which scaling L by what it lacks [Turquin2019] is not.
//
//   dM/dA = A E (2 - A (1 - E)) / q^2,   dM/dE = A^2 (1 - A) / q^2,   q = 1 - A (1 - E)
//       dA/df0 = 20 / 21
//   dln(g)/droughness = dln(loss(o_z)) + dln(loss(i_z)) - dln(average)        of smooth fits: exact
#pragma once

#include "photograd/bsdf/ggx_lobe.h"
#include "photograd/ops/fresnel_schlick.h"
#include "photograd/ops/ggx_loss.h"

namespace photograd {

template <class R>
struct GgxMetalCompensated {
    Vec3<R> f0{R(0.9)};
    R roughness{R(0.4)};

    static constexpr const char* name = "ggx_metal_compensated";
    static constexpr EnergyClaim energy{Energy::gains, 1.006};
    static constexpr bool reciprocal = true;
    static constexpr auto params =
        describe(p("f0", &GgxMetalCompensated::f0, 0.0, 1.0),
                 p("roughness", &GgxMetalCompensated::roughness, least_roughness, 1.0));

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return Vec3<R>(R(0));
        const R average = ggx_average_loss(roughness).value, g = multiple_scattering(wo, wi).value;
        const Vec3<R> once =
            schlick(f0, dot(wo, half_vector(wo, wi))) * ggx_lobe(wo, wi, roughness);
        return once + g * Vec3<R>(Bounces::of(f0.x, average).M, Bounces::of(f0.y, average).M,
                                  Bounces::of(f0.z, average).M);
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                    GgxMetalCompensated& d_self) const {
        if (!both_above(wo, wi)) return;
        const R o_dot_h = dot(wo, half_vector(wo, wi));
        schlick_backward(o_dot_h, d_f * ggx_lobe(wo, wi, roughness), d_self.f0);
        ggx_lobe_backward(wo, wi, roughness, dot(d_f, schlick(f0, o_dot_h)), d_self.roughness);
        const Loss<R> average = ggx_average_loss(roughness), g = multiple_scattering(wo, wi);
        for (int c = 0; c < 3; ++c) {
            const Bounces of = Bounces::of(f0[c], average.value);
            d_self.f0[c] += d_f[c] * g.value * of.by_A * R(20.0 / 21);
            d_self.roughness += d_f[c] * (g.slope * of.M - g.value * of.by_E * average.slope);
        }
    }

    /// To that lobe as often as a white mirror would need it.
    Vec3<R> sample(const Vec3<R>& wo, Vec2<R> u2) const {
        if (take_first(compensation_probability(wo), u2)) return square_to_cosine_hemisphere(u2);
        return sample_ggx_lobe(wo, roughness, u2);
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return R(0);
        const R share = compensation_probability(wo);
        return share * cosine_hemisphere_pdf(wi) + (R(1) - share) * ggx_lobe_pdf(wo, wi, roughness);
    }

private:
    /// M and its derivatives.
    struct Bounces {
        R M, by_A, by_E;

        static Bounces of(R f0, R average) {
            const R A = (R(20) * f0 + R(1)) / R(21), E = R(1) - average, q = R(1) - A * average;
            return {A * A * E / q, A * E * (R(2) - A * average) / (q * q),
                    A * A * (R(1) - A) / (q * q)};
        }
    };
    /// g and its derivative with respect to roughness.
    Loss<R> multiple_scattering(const Vec3<R>& wo, const Vec3<R>& wi) const {
        const Loss<R> out = ggx_loss(wo.z, roughness), in = ggx_loss(wi.z, roughness);
        const Loss<R> average = ggx_average_loss(roughness);
        const R g = R(1 / pi) * out.value * in.value / average.value;
        return {g, R(1 / pi) * (out.slope * in.value + out.value * in.slope) / average.value -
                       g * average.slope / average.value};
    }
    R compensation_probability(const Vec3<R>& wo) const { return ggx_loss(wo.z, roughness).value; }
};

static_assert(Bsdf<GgxMetalCompensated>);

}  // namespace photograd
