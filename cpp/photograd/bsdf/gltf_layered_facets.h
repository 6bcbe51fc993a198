// The facets of a layered glTF material's base: GGX, rougher along a tangent, as
// KHR_materials_anisotropy has it; they mirror, and those of KHR_materials_volume refract
// [Khronos2022].
//
//   alpha_y = roughness^2,   alpha_x = alpha_y + (1 - alpha_y) anisotropy^2     ggx_anisotropic.h
//   tangent: (x, y) = (anisotropy_x, anisotropy_y) / length, turned by rotation; 0 counts as (1, 0)
//   DV = D(wh) V(wo, wi)                                               of the turned directions
//
// Refraction of index e, far side over near side, z flipped so that o_z > 0: rough_dielectric.h
//
//   g = o + e i,  wh = +-g / |g|,  a = <o, wh>,  b = <i, wh>,  s2 = |g|^2,   K = -4 a b / s2
//   density of i: e^2 (-b) / s2 that of wh                              [Walter2007, Eq. 17]
//
//   dangle = drotation,   dangle/danisotropy_x = -y / length,  dangle/danisotropy_y = x / length
//   dwh/de = +-(i - wh <wh, i>) / |g|     the rest: ggx_anisotropic.h, rough_dielectric.h
#pragma once

#include "photograd/bsdf/gltf_layers.h"
#include "photograd/core/sincos.h"
#include "photograd/ops/fresnel_dielectric.h"

namespace photograd {

/// A facet that refracts, of two turned directions on two sides.
template <class R>
struct RefractingFacet {
    Vec3<R> h{R(0)};
    R e, a{R(0)}, b{R(0)}, s2, sign;
    bool possible = false;

    RefractingFacet(const Vec3<R>& o, const Vec3<R>& i, R index) : e(index) {
        const Vec3<R> g = o + e * i;
        s2 = dot(g, g);
        sign = g.z < R(0) ? R(-1) : R(1);
        if (!(s2 > R(0))) return;
        h = g * (sign / sqrt(s2));
        a = dot(o, h);
        b = dot(i, h);
        possible = a > R(0) && b < R(0);
    }
    [[nodiscard]] R K() const { return R(-4) * a * b / s2; }
    /// Of i over that of h.
    [[nodiscard]] R density() const { return e * e * -b / s2; }
    /// dL/de of derivatives with respect to h, a, b and K.
    R backward(const Vec3<R>& o, const Vec3<R>& i, Vec3<R> d_h, R d_a, R d_b, R d_K) const {
        d_h += o * (d_a + d_K * K() / a) + i * (d_b + d_K * K() / b);
        const Vec3<R> d_g = (d_h - h * dot(h, d_h)) * (sign / sqrt(s2));
        return dot(d_g, i) - d_K * K() / s2 * R(2) * (e + dot(o, i));
    }
};

template <class R>
class LayeredFacets {
public:
    explicit LayeredFacets(const GltfLayers<R>& layers) : layers_(layers) {
        alpha_y_ = layers.roughness * layers.roughness;
        alpha_x_ = alpha_y_ + (R(1) - alpha_y_) * layers.anisotropy * layers.anisotropy;
        const R x = layers.anisotropy_x, y = layers.anisotropy_y, length = sqrt(x * x + y * y);
        directed_ = length > R(1e-6);
        x_ = directed_ ? x / length : R(1);
        y_ = directed_ ? y / length : R(0);
        length_ = length;
        const SinCos<R> r = sin_cos(layers.rotation);
        tangent_ = {r.sin * x_ + r.cos * y_, r.cos * x_ - r.sin * y_};
    }

    /// A direction seen from the tangent.
    [[nodiscard]] Vec3<R> turned(const Vec3<R>& w) const {
        return {tangent_.cos * w.x + tangent_.sin * w.y, tangent_.cos * w.y - tangent_.sin * w.x,
                w.z};
    }
    [[nodiscard]] Vec3<R> turned_back(const Vec3<R>& w) const {
        return {tangent_.cos * w.x - tangent_.sin * w.y, tangent_.cos * w.y + tangent_.sin * w.x,
                w.z};
    }

    /// D V of turned directions above the surface.
    [[nodiscard]] R lobe(const Vec3<R>& o, const Vec3<R>& i, const Vec3<R>& h) const {
        return ggx_D(h, alpha_x_, alpha_y_) * ggx_V(o, i, alpha_x_, alpha_y_);
    }
    /// Directions are held, but that of the facet moves with an index: d_h is returned.
    Vec3<R> lobe_backward(const Vec3<R>& o, const Vec3<R>& i, const Vec3<R>& h, R d_lobe,
                          GltfLayers<R>& d) const {
        Vec3<R> d_o(R(0)), d_i(R(0)), d_h(R(0));
        R d_x = R(0), d_y = R(0);
        ggx_D_backward(h, alpha_x_, alpha_y_, d_lobe * ggx_V(o, i, alpha_x_, alpha_y_), d_h, d_x,
                       d_y);
        ggx_V_backward(o, i, alpha_x_, alpha_y_, d_lobe * ggx_D(h, alpha_x_, alpha_y_), d_o, d_i,
                       d_x, d_y);
        const R s = layers_.anisotropy, d_angle = turn(o, d_o) + turn(i, d_i) + turn(h, d_h);
        d.roughness += R(2) * layers_.roughness * (d_y + (R(1) - s * s) * d_x);
        d.anisotropy += R(2) * s * (R(1) - alpha_y_) * d_x;
        d.rotation += d_angle;
        if (directed_) {
            d.anisotropy_x -= d_angle * y_ / length_;
            d.anisotropy_y += d_angle * x_ / length_;
        }
        return d_h;
    }

    /// A facet that o sees, turned as o is; and its density.
    [[nodiscard]] Vec3<R> sample(const Vec3<R>& o, const Vec2<R>& u2) const {
        return sample_ggx_visible(o, alpha_x_, alpha_y_, u2);
    }
    [[nodiscard]] R pdf(const Vec3<R>& o, const Vec3<R>& h) const {
        return ggx_visible_pdf(o, h, alpha_x_, alpha_y_);
    }

private:
    const GltfLayers<R>& layers_;
    R alpha_x_, alpha_y_, x_, y_, length_;
    SinCos<R> tangent_;
    bool directed_;

    /// dL/dangle through one turned direction.
    static R turn(const Vec3<R>& w, const Vec3<R>& d_w) { return d_w.x * w.y - d_w.y * w.x; }
};

}  // namespace photograd
