// How a path continues at a surface: radiance by the BSDF, importance by its adjoint.
//
// A particle that arrives from direction a (unit, back to where it came from) continues along b,
// which the material samples as if a were its viewer. Its weight follows from what a camera that
// looks from b would see, L(b) = f(b, a) L(a) |a n|, with the shading normal n and the geometric
// one m [Veach1997, Ch. 5]:
//
//   weight = f(b, a) |a n| |b m| / (|a m| pdf(b))
//
// It differs in two ways from the weight of a camera's path, f(a, b) |b n| / pdf(b). Shading
// normals: areas are those of the true surface, and the two agree only for n = m. Refraction:
// radiance scales with the square of the ratio of indices where a cone of rays narrows, power does
// not. Non-specular models evaluate f(b, a), with the arguments in the camera's order. A specular
// lobe has a weight W for the radiance there and W' for the reverse; the factors eta^2 and 1 /
// eta^2 cancel in
//
//   weight = sqrt(W W') |a n| |b m| / (|a m| |b n|)
//
// which holds for every lobe that is its own reverse.
#pragma once

#include <cmath>

#include "photograd/scene/path_scene.h"

namespace photograd {

/// A sampled direction in the world, and the factor of the throughput along it.
template <class R>
struct Continuation {
    Vec3<R> direction{R(0)};
    ScatterSample<R> sample;  // pdf 0: the path ends
    Vec3<R> value{R(0)};
    R weight = R(0);
};

/// Continues a camera's path; `beta` is its throughput.
template <Real R>
Continuation<R> sample_bsdf(const Material<R>& material, const SurfaceSide<R>& side,
                            const Vec2<R>& u2, R u, const Vec3<R>& beta) {
    const ScatterSample<R> next = material.sample(side.wo, u2, u, beta);
    if (!(next.pdf > R(0))) return {};
    const Vec3<R> direction = side.frame.to_world(next.wi);
    if (!side.agrees(direction, next.wi)) return {};
    return {direction, next, next.value, (next.lobe < 0 ? std::abs(next.wi.z) : R(1)) / next.pdf};
}

/// The weight of a particle from `back` that continues along `out`; see the head of this file.
template <Real R>
Vec3<R> importance_weight(const Material<R>& material, const SurfaceHit<R>& hit,
                          const SurfaceSide<R>& side, const Vec3<R>& back, const Vec3<R>& out,
                          const ScatterSample<R>& next) {
    const R areas = std::abs(dot(out, side.normal) / dot(back, side.normal));
    if (next.lobe >= 0) {
        const Vec3<R> reverse = material.value(next.wi, side.wo, next.lobe);
        Vec3<R> both;
        for (int c = 0; c < 3; ++c) both[c] = std::sqrt(next.value[c] * reverse[c]);
        return both * (areas * std::abs(side.wo.z / next.wi.z) / next.pdf);
    }
    // The frame that a viewer at `out` would see.
    const SurfaceSide<R> from_out(hit, out, material.transmits());
    const Vec3<R> wi = from_out.frame.to_local(back);
    if (!from_out.agrees(back, wi)) return Vec3<R>(R(0));
    if (!(from_out.wo.z * wi.z > R(0)) && !material.transmits()) return Vec3<R>(R(0));
    return material.f(from_out.wo, wi) * (std::abs(wi.z) * areas / next.pdf);
}

/// Continues a particle. Where shading normals differ, half of the directions of non-specular
/// models are sampled around the geometric normal: those that the surface can see and its shading
/// normal cannot are then sampled as well.
template <Real R>
Continuation<R> sample_adjoint_bsdf(const Material<R>& material, const SurfaceHit<R>& hit,
                                    const SurfaceSide<R>& side, const Vec3<R>& back,
                                    const Vec2<R>& u2, R u) {
    const bool bent = !material.is_specular() && side.frame.normal != side.normal;
    SurfaceHit<R> level = hit;
    level.shading = hit.outside;
    const SurfaceSide<R> flat =
        bent ? SurfaceSide<R>(level, side.frame.to_world(side.wo), material.transmits()) : side;
    const SurfaceSide<R>& used = bent && u < R(0.5) ? flat : side;
    ScatterSample<R> next = material.sample(used.wo, u2, u);
    if (!(next.pdf > R(0))) return {};
    const Vec3<R> out = used.frame.to_world(next.wi);
    if (!used.agrees(out, next.wi)) return {};
    if (bent)
        next.pdf = R(0.5) * (material.pdf(side.wo, side.frame.to_local(out)) +
                             material.pdf(flat.wo, flat.frame.to_local(out)));
    return {out, next, importance_weight(material, hit, side, back, out, next), R(1)};
}

}  // namespace photograd
