// Energy-preserving Oren-Nayar [Portsmouth2025]: Fujii's form of single scattering between facets,
// and a lobe for multiple scattering. roughness runs from 0 (Lambert) to 1.
//
//   f = albedo / pi A (1 + roughness t) + K / pi A roughness g(o_z) g(i_z) / (k1 - k2)
//   A = 1 / (1 + k1 roughness),   k1 = 1/2 - 2 / (3 pi),   k2 = 2/3 - 28 / (15 pi)
//   t = s / max(o_z, i_z) for s > 0, else s;   s = <wo, wi> - o_z i_z
//   K = albedo^2 E / (1 - albedo (1 - E)),   E = A (1 + k2 roughness)
//
// E is the average albedo of the first part for albedo 1, and its loss seen from c is
//
//   1 - A (1 + roughness G(c) / pi) = A roughness g(c),   g = k1 - G / pi
//   G(c) = s (acos(c) - s c) + 2/3 (s / c (1 - s^3) - s),   s = sqrt(1 - c^2)
//
// so that the second part, light that bounced at least twice, returns just this to white: the
// albedo is 1 for every view and roughness. In [Portsmouth2025] it is
// (1 - E(wo)) (1 - E(wi)) / (1 - E), 0 / 0 at roughness 0; dividing A roughness out of it leaves g,
// which depends on no parameter.
//
//   dA/droughness = -k1 A^2      dE/droughness = (k2 - k1) A^2
//   dK/dalbedo = albedo E (2 - albedo (1 - E)) / q^2      dK/dE = albedo^2 (1 - albedo) / q^2,
//       q = 1 - albedo (1 - E)
//   d(A roughness)/droughness = A^2      d(A (1 + roughness t))/droughness = (t - k1) A^2
#pragma once

#include "photograd/bsdf/half_vector.h"
#include "photograd/core/atan.h"
#include "photograd/sampling/warp.h"

namespace photograd {

template <class R>
struct OrenNayarEnergyPreserving {
    Vec3<R> albedo{R(0.5)};
    R roughness{R(0.5)};

    static constexpr const char* name = "oren_nayar_energy_preserving";
    static constexpr EnergyClaim energy{Energy::conserving, 1.0};
    static constexpr bool reciprocal = true;
    static constexpr auto params =
        describe(p("albedo", &OrenNayarEnergyPreserving::albedo, 0.0, 1.0),
                 p("roughness", &OrenNayarEnergyPreserving::roughness, 0.0, 1.0));

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return Vec3<R>(R(0));
        const R A = R(1) / (R(1) + R(k1) * roughness), E = A * (R(1) + R(k2) * roughness);
        const R once = A * (R(1) + roughness * sine_tangent(wo, wi));
        const R more = A * roughness * multiple_scattering(wo, wi);
        Vec3<R> value;
        for (int c = 0; c < 3; ++c) {
            const R x = albedo[c], K = x * x * E / (R(1) - x * (R(1) - E));
            value[c] = R(1 / pi) * (x * once + K * more);
        }
        return value;
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                    OrenNayarEnergyPreserving& d_self) const {
        if (!both_above(wo, wi)) return;
        const R A = R(1) / (R(1) + R(k1) * roughness), E = A * (R(1) + R(k2) * roughness);
        const R t = sine_tangent(wo, wi), g = multiple_scattering(wo, wi);
        const R once = A * (R(1) + roughness * t), more = A * roughness * g;
        for (int c = 0; c < 3; ++c) {
            const R x = albedo[c], q = R(1) - x * (R(1) - E), d = d_f[c] * R(1 / pi);
            const R K = x * x * E / q;
            d_self.albedo[c] += d * (once + more * x * E * (R(2) - x * (R(1) - E)) / (q * q));
            const R dK = x * x * (R(1) - x) / (q * q) * R(k2 - k1);  // by roughness, over A^2
            d_self.roughness += d * A * A * (x * (t - R(k1)) + K * g + more * dK);
        }
    }

    Vec3<R> sample(const Vec3<R>&, const Vec2<R>& u2) const {
        return square_to_cosine_hemisphere(u2);
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        return wo.z > R(0) ? cosine_hemisphere_pdf(wi) : R(0);
    }

private:
    static constexpr double k1 = 0.5 - 2 / (3 * pi), k2 = 2.0 / 3 - 28 / (15 * pi);

    /// t of the head of this file.
    static R sine_tangent(const Vec3<R>& wo, const Vec3<R>& wi) {
        const R s = wo.x * wi.x + wo.y * wi.y;
        return s > R(0) ? s / larger(wo.z, wi.z) : s;
    }
    /// g(o_z) g(i_z) / (k1 - k2)
    static R multiple_scattering(const Vec3<R>& wo, const Vec3<R>& wi) {
        return loss(wo) * loss(wi) * R(1 / (k1 - k2));
    }
    /// g, where (1 - s^3) / c^2 = (1 + s + s^2) / (1 + s): near the horizon the quotient in G would
    /// lose its digits.
    static R loss(const Vec3<R>& w) {
        const R c = w.z, s = sqrt(larger(w.x * w.x + w.y * w.y, R(0)));
        const R G = s * (polar_angle(s, c) - s * c) +
                    R(2.0 / 3) * s * (c * (R(1) + s + s * s) / (R(1) + s) - R(1));
        return R(k1) - R(1 / pi) * G;
    }
};

static_assert(Bsdf<OrenNayarEnergyPreserving>);

}  // namespace photograd
