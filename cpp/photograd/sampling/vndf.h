// Sampling of the normals of microfacets, all or visible ones (VNDF); each sampler stands beside
// its density over solid angle.
//
// A mirror at facet wh sends wo to wi = 2 <wo, wh> wh - wo. Turning wh by an angle turns wi by two,
// and the density of wi is that of wh times dwh/dwi = 1 / (4 <wo, wh>) [Walter2007, Eq. 14]. The
// densities here are those of wh.
#pragma once

#include "photograd/core/log.h"
#include "photograd/ops/beckmann.h"
#include "photograd/ops/ggx.h"
#include "photograd/ops/gtr1.h"
#include "photograd/sampling/warp.h"

namespace photograd {

/// Visible normals of GGX [Dupuy2023]. Scaling by alpha turns the surface into a hemisphere; its
/// visible part reflects v uniformly into the cap z >= -v_z. So: a uniform point of the cap, the
/// half vector with v, and back by the inverse transpose.
template <Real R>
Vec3<R> sample_ggx_visible(const Vec3<R>& wo, R alpha_x, R alpha_y, const Vec2<R>& u2) {
    const Vec3<R> v = normalize(Vec3<R>(alpha_x * wo.x, alpha_y * wo.y, wo.z));
    const Vec3<R> h = square_to_cap(u2, R(1) + v.z) + v;
    return normalize(Vec3<R>(alpha_x * h.x, alpha_y * h.y, larger(h.z, R(1e-9))));
}
/// G1 D <wo, wh> / o_z [Heitz2018, Eq. 1]; zero for normals that face away from wo.
template <class R>
R ggx_visible_pdf(const Vec3<R>& wo, const Vec3<R>& wh, R alpha_x, R alpha_y) {
    const R cosine = dot(wo, wh);
    if (!(cosine > R(0)) || !(wh.z > R(0))) return R(0);
    const R over_z = R(2) / (wo.z + ggx_stretched_length(wo, alpha_x, alpha_y));
    return over_z * ggx_D(wh, alpha_x, alpha_y) * cosine;
}

/// All normals, visible or not, with density D h_z: the squared tangent is exponential, -alpha^2
/// ln(1 - r^2).
template <Real R>
Vec3<R> sample_beckmann(R alpha, const Vec2<R>& u2) {
    const Vec2<R> p = square_to_disk(u2);
    const R r2 = p.x * p.x + p.y * p.y;
    if (!(r2 > R(0))) return {R(0), R(0), R(1)};
    const R tangent = alpha * sqrt(-log(larger(R(1) - r2, R(1e-30)))), scale = tangent / sqrt(r2);
    return normalize(Vec3<R>(p.x * scale, p.y * scale, R(1)));
}
template <class R>
R beckmann_pdf(const Vec3<R>& wh, R alpha) {
    return beckmann_D(wh, alpha) * wh.z;
}

/// All normals of GTR1, with density D h_z: sin^2 = q (q^(-r^2) - 1) / (1 - q), q = alpha^2.
template <Real R>
Vec3<R> sample_gtr1(R alpha, const Vec2<R>& u2) {
    const Vec2<R> p = square_to_disk(u2);
    const R r2 = p.x * p.x + p.y * p.y, q = alpha * alpha;
    if (!(r2 > R(0))) return {R(0), R(0), R(1)};
    const R s2 = q * expm1(-r2 * log(q)) / (R(1) - q), scale = sqrt(s2 / r2);
    return {p.x * scale, p.y * scale, sqrt(larger(R(1) - s2, R(0)))};
}
template <class R>
R gtr1_pdf(const Vec3<R>& wh, R alpha) {
    return gtr1_D(wh, alpha) * wh.z;
}

/// Around +Z with density (n + 1) / (2 pi) cos^n: cos = (1 - r^2)^(1 / (n + 1)).
template <Real R>
Vec3<R> sample_cosine_power(R n, const Vec2<R>& u2) {
    const Vec2<R> p = square_to_disk(u2);
    const R r2 = p.x * p.x + p.y * p.y;
    if (!(r2 > R(0))) return {R(0), R(0), R(1)};
    // s2 = 1 - cos^2, without the cancellation that the subtraction would have near +Z.
    const R power = log(larger(R(1) - r2, R(1e-30))) / (n + R(1));
    const R scale = sqrt(-expm1(R(2) * power) / r2);
    return {p.x * scale, p.y * scale, exp(power)};
}
template <class R>
R cosine_power_pdf(R n, R cos_theta) {
    return cos_theta > R(0) ? (n + R(1)) * R(0.5 / pi) * pow(cos_theta, n) : R(0);
}

/// Chooses between two samplers, the first with probability `share`, and gives the number used for
/// it back, stretched over [0, 1] again.
template <Real R>
bool take_first(R share, Vec2<R>& u2) {
    const bool first = u2.x < share;
    u2.x = first ? u2.x / share : (u2.x - share) / (R(1) - share);
    return first;
}

}  // namespace photograd
