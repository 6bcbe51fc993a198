// Rough dielectric, frosted glass: GGX facets that reflect and refract [Walter2007].
//
// eta is the index inside over outside. Seen from wo's side, e is the far index over the near one:
// eta for a viewer outside (o_z > 0), 1 / eta inside; there all z are flipped first, so that o_z >
// 0 below.
//
//   mirrored    wh ~ wo + wi            f = F D V
//   refracted   g = wo + e wi, wh = +-g / |g| with h_z > 0                     [Walter2007, Eq. 16]
//               f = K (1 - F) D V,   K = 4 a (-b) / s2,   a = <wo, wh> > 0,  b = <wi, wh> < 0
//                   [Walter2007, Eq. 21]
//               s2 = (a + e b)^2 = |g|^2 = 1 + e^2 + 2 e <wo, wi>
//
// F = F(e, a) is exact, V = G2 / (4 o_z |i_z|). f is for radiance, which grows by e^2 where light
// enters the denser medium: f(wo, wi) n_i^2 = f(wi, wo) n_o^2 is its reciprocity, and what passes
// is f |i_z| e^2. Light that meets a second facet is dropped, as in all models of one facet. What
// is smoother, or hardly bends light, is glass.h.
//
//   dK/da = K / a      dK/db = K / b      dK/ds2 = -K / s2,   ds2/de = 2 e + 2 <wo, wi>
//   da = <wo, dwh>,  db = <wi, dwh>       dwh/de = +-(wi - wh <wh, wi>) / |g|
//
// The directions are held constant, but wh of a refraction moves with e: D, F and K follow it.
#pragma once

#include "photograd/bsdf/ggx_lobe.h"
#include "photograd/ops/fresnel_dielectric.h"

namespace photograd {

template <class R>
struct RoughDielectric {
    R eta{R(1.5)}, roughness{R(0.4)};

    static constexpr const char* name = "rough_dielectric";
    static constexpr EnergyClaim energy{Energy::lossy, 1.0};
    static constexpr bool reciprocal = true, transmits = true;
    static constexpr auto params = describe(p("eta", &RoughDielectric::eta, 1.2, 2.5),
                                            p("roughness", &RoughDielectric::roughness, 0.1, 1.0));

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        const Pair w = pair(wo, wi);
        if (!w.possible) return Vec3<R>(R(0));
        const R alpha = roughness * roughness, F = fresnel_dielectric(w.e, w.a);
        const R DV = ggx_D(w.h, alpha, alpha) * ggx_V(w.o, w.above(), alpha, alpha);
        return Vec3<R>((w.mirrored ? F : w.K() * (R(1) - F)) * DV);
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                    RoughDielectric& d_self) const {
        const Pair w = pair(wo, wi);
        if (!w.possible) return;
        const R alpha = roughness * roughness, F = fresnel_dielectric(w.e, w.a);
        const R D = ggx_D(w.h, alpha, alpha), V = ggx_V(w.o, w.above(), alpha, alpha);
        const R d = d_f.x + d_f.y + d_f.z, K = w.mirrored ? R(1) : w.K();
        const R part = w.mirrored ? F : K * (R(1) - F);
        Vec3<R> d_h(R(0)), fixed_o(R(0)), fixed_i(R(0));
        R d_alpha = R(0), d_e = R(0), d_a = R(0);  // d_alpha of both axes
        ggx_D_backward(w.h, alpha, alpha, d * part * V, d_h, d_alpha, d_alpha);
        ggx_V_backward(w.o, w.above(), alpha, alpha, d * part * D, fixed_o, fixed_i, d_alpha,
                       d_alpha);
        fresnel_dielectric_backward(w.e, w.a, (w.mirrored ? d : -d * K) * D * V, d_e, d_a);
        if (!w.mirrored) {
            const R d_K = d * (R(1) - F) * D * V;
            d_h += w.o * (d_a + d_K * K / w.a) + w.i * (d_K * K / w.b);
            const Vec3<R> d_g = (d_h - w.h * dot(w.h, d_h)) * (w.sign / sqrt(w.s2));
            d_e += dot(d_g, w.i) - d_K * K / w.s2 * R(2) * (w.e + dot(w.o, w.i));
        }
        d_self.roughness += R(2) * roughness * d_alpha;
        d_self.eta += wo.z > R(0) ? d_e : -d_e * (w.e * w.e);
    }

    /// A visible facet; light is mirrored there with a probability near to what a flat boundary
    /// reflects. Where a facet cannot send it, the sample is lost: a direction in the horizon, of
    /// no density.
    Vec3<R> sample(const Vec3<R>& wo, Vec2<R> u2) const {
        const R side = wo.z > R(0) ? R(1) : R(-1), e = wo.z > R(0) ? eta : R(1) / eta;
        const Vec3<R> o(wo.x, wo.y, wo.z * side), invalid(R(1), R(0), R(0));
        const bool mirrored = take_first(mirrored_share(e, o.z), u2);
        const R alpha = roughness * roughness;
        const Vec3<R> h = sample_ggx_visible(o, alpha, alpha, u2);
        const R a = dot(o, h), t2 = refracted_cos_squared(e, a);
        if (!mirrored && !(t2 > R(0))) return invalid;
        const Vec3<R> i = mirrored ? reflect(o, h) : h * (a / e - sqrt(t2)) - o * (R(1) / e);
        if (mirrored ? !(i.z > R(0)) : !(i.z < R(0))) return invalid;
        return {i.x, i.y, i.z * side};
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        const Pair w = pair(wo, wi);
        if (!w.possible) return R(0);
        const R alpha = roughness * roughness, share = mirrored_share(w.e, w.o.z);
        const R pdf_h = ggx_visible_pdf(w.o, w.h, alpha, alpha);
        // dwh / dwi = e^2 (-b) / s2 [Walter2007, Eq. 17].
        return w.mirrored ? share * reflected_pdf(w.o, w.h, pdf_h)
                          : (R(1) - share) * pdf_h * (w.e * w.e * -w.b / w.s2);
    }
    Vec3<R> index_inside() const { return Vec3<R>(eta); }

private:
    /// Two directions, flipped so that wo is above, and the facet that joins them.
    struct Pair {
        Vec3<R> o, i, h;
        R e, a, b, s2, sign;  // sign of g in wh
        bool mirrored, possible;

        [[nodiscard]] R K() const { return R(-4) * a * b / s2; }
        [[nodiscard]] Vec3<R> above() const { return {i.x, i.y, i.z < R(0) ? -i.z : i.z}; }
    };
    Pair pair(const Vec3<R>& wo, const Vec3<R>& wi) const {
        const R side = wo.z > R(0) ? R(1) : R(-1);
        Pair w{};
        w.e = wo.z > R(0) ? eta : R(1) / eta;
        w.o = Vec3<R>(wo.x, wo.y, wo.z * side);
        w.i = Vec3<R>(wi.x, wi.y, wi.z * side);
        w.mirrored = w.i.z > R(0);
        const Vec3<R> g = w.mirrored ? w.o + w.i : w.o + w.e * w.i;
        w.s2 = dot(g, g);
        w.sign = g.z < R(0) ? R(-1) : R(1);
        if (!(w.s2 > R(0)) || wo.z == R(0) || wi.z == R(0)) return w;
        w.h = g * (w.sign / sqrt(w.s2));
        w.a = dot(w.o, w.h);
        w.b = dot(w.i, w.h);
        w.possible = w.a > R(0) && (w.mirrored || w.b < R(0));
        return w;
    }
    static R mirrored_share(R e, R cos_o) {
        return R(0.25) + R(0.5) * fresnel_dielectric(e, cos_o);
    }
};

static_assert(Bsdf<RoughDielectric>);

}  // namespace photograd
