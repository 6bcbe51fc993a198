// Oren-Nayar diffuse reflection with all its terms [Oren1994, Eqs. 40 and 41]: besides what one
// facet sends (the qualitative form keeps two of its three terms), light that goes from one facet
// to its neighbor and then out.
//
//   f = albedo / pi (S + albedo M N)
//   S = A + B T,   A = 1 - sigma^2 / (2 (sigma^2 + 0.33)),   B = sigma^2 / (sigma^2 + 0.09),
//   T = 0.45 c (sin(alpha) - [c < 0] (2 beta / pi)^3) tan(beta)
//       + 0.125 (1 - |c|) (4 alpha beta / pi^2)^2
//       tan((alpha + beta) / 2)
//   M = 0.17 sigma^2 / (sigma^2 + 0.13),   N = 1 - c (2 beta / pi)^2
//
// with c = cos(phi_o - phi_i), and alpha and beta the larger and smaller angle to the normal. Then
// tan((alpha + beta) / 2) = (sin(alpha) + sin(beta)) / (cos(alpha) + cos(beta)). T and N do not
// depend on parameters:
//
//   df/dalbedo = (S + 2 albedo M N) / pi
//   dA/dsigma = -0.33 sigma / (sigma^2 + 0.33)^2        dB/dsigma = 0.18 sigma / (sigma^2 + 0.09)^2
//   dM/dsigma = 0.0442 sigma / (sigma^2 + 0.13)^2
//
// A fit to simulated facets: white plaster returns up to 5 % more than came (sigma 0.3, at the
// horizon), and at sigma 1 loses 23 % straight on, where the qualitative form loses 38 %. Towards
// the horizon on the far side of the normal S falls below 0, to -0.16; what is below 0 is 0 here,
// and has no derivative.
#pragma once

#include "photograd/bsdf/half_vector.h"
#include "photograd/core/atan.h"
#include "photograd/sampling/warp.h"

namespace photograd {

template <class R>
struct OrenNayarFull {
    Vec3<R> albedo{R(0.5)};
    R sigma{R(0.5)};

    static constexpr const char* name = "oren_nayar_full";
    static constexpr EnergyClaim energy{Energy::gains, 1.051};
    static constexpr bool reciprocal = true;
    static constexpr auto params = describe(p("albedo", &OrenNayarFull::albedo, 0.0, 1.0),
                                            p("sigma", &OrenNayarFull::sigma, 0.0, 1.0, "rad"));

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return Vec3<R>(R(0));
        const Angles at = angles(wo, wi);
        const R S = once(at), MN = twice(at);
        Vec3<R> value;
        for (int c = 0; c < 3; ++c)
            value[c] = albedo[c] * R(1 / pi) * larger(S + albedo[c] * MN, R(0));
        return value;
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                    OrenNayarFull& d_self) const {
        if (!both_above(wo, wi)) return;
        const Angles at = angles(wo, wi);
        const R S = once(at), MN = twice(at), v = sigma * sigma;
        const R a = v + R(0.33), b = v + R(0.09), m = v + R(0.13);
        const R dS = sigma * (R(0.18) * at.T / (b * b) - R(0.33) / (a * a));
        const R dMN = sigma * R(0.0442) * at.N / (m * m);
        for (int c = 0; c < 3; ++c) {
            if (!(S + albedo[c] * MN > R(0))) continue;
            d_self.albedo[c] += d_f[c] * R(1 / pi) * (S + R(2) * albedo[c] * MN);
            d_self.sigma += d_f[c] * albedo[c] * R(1 / pi) * (dS + albedo[c] * dMN);
        }
    }

    Vec3<R> sample(const Vec3<R>&, const Vec2<R>& u2) const {
        return square_to_cosine_hemisphere(u2);
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        return wo.z > R(0) ? cosine_hemisphere_pdf(wi) : R(0);
    }

private:
    /// What the directions contribute.
    struct Angles {
        R T, N;
    };
    static Angles angles(const Vec3<R>& wo, const Vec3<R>& wi) {
        const R sin_o = sqrt(larger(wo.x * wo.x + wo.y * wo.y, R(1e-20)));
        const R sin_i = sqrt(larger(wi.x * wi.x + wi.y * wi.y, R(1e-20)));
        const bool o_is_lower = wo.z < wi.z;
        const R c = (wo.x * wi.x + wo.y * wi.y) / (sin_o * sin_i);
        const R sin_alpha = o_is_lower ? sin_o : sin_i, cos_alpha = o_is_lower ? wo.z : wi.z;
        const R sin_beta = o_is_lower ? sin_i : sin_o, cos_beta = o_is_lower ? wi.z : wo.z;
        const R x = R(2 / pi) * polar_angle(sin_alpha, cos_alpha);
        const R y = R(2 / pi) * polar_angle(sin_beta, cos_beta);
        const R sin_term = c < R(0) ? sin_alpha - y * y * y : sin_alpha;
        const R across = R(1) - (c < R(0) ? -c : c);
        const R tan_half = (sin_alpha + sin_beta) / (cos_alpha + cos_beta);
        return {R(0.45) * c * sin_term * sin_beta / cos_beta +
                    R(0.125) * across * (x * x * y * y) * tan_half,
                R(1) - c * y * y};
    }
    /// S: from one facet.
    R once(const Angles& at) const {
        const R v = sigma * sigma;
        return R(1) - R(0.5) * v / (v + R(0.33)) + v / (v + R(0.09)) * at.T;
    }
    /// M N: by way of a second facet.
    R twice(const Angles& at) const {
        const R v = sigma * sigma;
        return R(0.17) * v / (v + R(0.13)) * at.N;
    }
};

static_assert(Bsdf<OrenNayarFull>);

}  // namespace photograd
