// Charlie sheen: scattering by the fibers of cloth, brightest at the rim [Estevez2017].
//
//   f = color D V,   alpha = roughness^2        D, V: ops/charlie.h
//
//   df/dcolor = D V        df/droughness = color 2 roughness (dD/dalpha V + D dV/dalpha)
//
// The masking is the fitted one. Near the horizon, below roughness 0.25, the fit returns more light
// than came; the range ends before that. The shorter V = 1 / (4 (o_z + i_z - o_z i_z)) in its place
// returns up to 1.29 of the light at roughness 0.2. Alone it is the nap of velvet; over a base
// layer, the base layer must lose what the sheen returns.
#pragma once

#include "photograd/bsdf/half_vector.h"
#include "photograd/ops/charlie.h"
#include "photograd/sampling/warp.h"

namespace photograd {

template <class R>
struct Sheen {
    Vec3<R> color{R(0.5)};
    R roughness{R(0.5)};

    static constexpr const char* name = "sheen";
    static constexpr EnergyClaim energy{Energy::lossy, 1.0};
    static constexpr bool reciprocal = true;
    static constexpr auto params =
        describe(p("color", &Sheen::color, 0.0, 1.0), p("roughness", &Sheen::roughness, 0.3, 1.0));

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        if (!both_above(wo, wi)) return Vec3<R>(R(0));
        const R alpha = roughness * roughness;
        return color * (charlie_D(half_sine(wo, wi), alpha) * charlie_V(wo.z, wi.z, alpha));
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f, Sheen& d_self) const {
        if (!both_above(wo, wi)) return;
        const R alpha = roughness * roughness, sine = half_sine(wo, wi);
        const R D = charlie_D(sine, alpha), V = charlie_V(wo.z, wi.z, alpha);
        R d_alpha = R(0);
        d_self.color += d_f * (D * V);
        charlie_D_backward(sine, alpha, dot(d_f, color) * V, d_alpha);
        charlie_V_backward(wo.z, wi.z, alpha, dot(d_f, color) * D, d_alpha);
        d_self.roughness += R(2) * roughness * d_alpha;
    }

    /// Evenly over the hemisphere: the lobe is wide, and brightest at the horizon, where a cosine
    /// would not look.
    Vec3<R> sample(const Vec3<R>&, const Vec2<R>& u2) const { return square_to_cap(u2, R(1)); }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        return both_above(wo, wi) ? R(0.5 / pi) : R(0);
    }

private:
    /// Sine between normal and half vector; 0 has no logarithm.
    static R half_sine(const Vec3<R>& wo, const Vec3<R>& wi) {
        const Vec3<R> wh = half_vector(wo, wi);
        return sqrt(larger(wh.x * wh.x + wh.y * wh.y, R(1e-12)));
    }
};

static_assert(Bsdf<Sheen>);

}  // namespace photograd
