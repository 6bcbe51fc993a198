// What the boundaries of a layered glTF material reflect at a cosine c: a dielectric's coating with
// KHR_materials_specular and KHR_materials_ior, and a metal, both perhaps under the film of
// KHR_materials_iridescence [Khronos2022].
//
//   S(f0) = f0 + (1 - f0) (1 - c)^5,   film(f0): ops/thin_film.h
//   coating   F = specular (S + w (film - S)),   f0 = min(s specular_color, 1)
//             s = ((eta - 1) / (eta + 1))^2
//             left = 1 - specular ((1 - w) max S + w max film)      max over the channels
//   metal     F = S + w (film - S),   f0 = base_color
//   w = iridescence_factor x^2 (3 - 2 x),   x = min(thickness / 0.03 nm, 1): gltf_iridescence.h
//
// That is the extension's mix of both finished layers by w, and the specular strength weighs both:
// at 0 the coating is gone. The film borders on air, under a coat as well.
//
// The conserving variant holds film at 1 or less, and needs what a rough surface reflects at most
// of the light at c. Measured over all roughnesses and anisotropies, that is what a flat one
// reflects at 0.85 c; B is film's bound over all thicknesses:
//
//   left_diffuse = 1 - specular ((1 - w) max S + w max min(B, 1))     both at 0.85 c
//
//   dF/dS = specular (1 - w)     dF/dfilm = specular w     dF/dw = specular (film - S)
//   dleft/dS, dleft/dfilm: minus the same, for the largest channel
//   dleft/dw = specular (max S - max film)     dF/dspecular = F / specular,  so of 1 - left
//   dS/df0 = 1 - (1 - c)^5     dS/dc = -5 (1 - f0) (1 - c)^4
//   df0/dspecular_color = s, df0/ds = specular_color, both 0 where f0 = 1
//   dw/dfactor = x^2 (3 - 2 x)     dw/dthickness = iridescence_factor 6 x (1 - x) / 0.03
#pragma once

#include "photograd/bsdf/gltf_layers.h"
#include "photograd/ops/thin_film.h"

namespace photograd {

template <bool conserving, class R>
class LayeredFresnel {
public:
    static constexpr double slant = 0.85, least_thickness = 0.03;

    /// F, and the part that goes on to the layers below.
    struct Coating {
        Vec3<R> F;
        R left;
    };

    explicit LayeredFresnel(const GltfLayers<R>& layers)
        : layers_(layers), f0_(schlick_f0(layers.eta) * layers.specular_color_factor) {
        for (int k = 0; k < 3; ++k)
            if (f0_[k] > R(1)) f0_[k] = R(1);
        const R thickness = layers.iridescence_thickness / R(least_thickness);
        x_ = thickness < R(1) ? thickness : R(1);
        w_ = layers.iridescence_factor * smoothstep();
    }

    /// A cosine, and the film seen at it, if there is one.
    struct At {
        R c;
        film_detail::Film<R> film;
        bool filmed;
    };
    /// Only backward needs a film of weight 0.
    At at(R c, bool backward = false) const {
        if (backward ? !(x_ > R(0)) : vanishes(w_)) return {c, {}, false};
        return {c,
                film_detail::Film<R>::of(layers_.iridescence_ior, layers_.iridescence_thickness, c),
                true};
    }

    Coating coating(const At& at) const { return mixed(pair(f0_, at)); }
    Vec3<R> metal(const At& at) const {
        const Pair of = pair(layers_.base_color, at);
        return of.plain + w_ * (of.film - of.plain);
    }
    R left_diffuse(R c) const { return mixed(bound(c)).left; }

    void coating_backward(const At& at, const Vec3<R>& d_F, R d_left, GltfLayers<R>& d,
                          R& d_c) const {
        const Pair of = pair(f0_, at), d_of = mixed_backward(of, d_F, d_left, d);
        Vec3<R> d_f0(R(0));
        pair_backward(f0_, at, of, d_of, d_f0, d, d_c);
        f0_backward(d_f0, d);
    }
    void metal_backward(const At& at, const Vec3<R>& d_F, GltfLayers<R>& d, R& d_c) const {
        const Pair of = pair(layers_.base_color, at);
        weight_backward(dot(d_F, of.film - of.plain), d);
        pair_backward(layers_.base_color, at, of, {d_F * (R(1) - w_), d_F * w_}, d.base_color, d,
                      d_c);
    }
    void left_diffuse_backward(R c, R d_left, GltfLayers<R>& d) const {
        const Pair of = bound(c), d_of = mixed_backward(of, Vec3<R>(R(0)), d_left, d);
        Vec3<R> d_f0(R(0));
        schlick_backward(R(slant) * c, d_of.plain, d_f0);
        if (x_ > R(0))
            thin_film_bound_backward(f0_, layers_.iridescence_ior, R(slant) * c,
                                     unclamped(of.film, d_of.film), d_f0, d.iridescence_ior);
        f0_backward(d_f0, d);
    }

private:
    /// Without and with a film; alike where there is none.
    struct Pair {
        Vec3<R> plain, film;
    };

    const GltfLayers<R>& layers_;
    Vec3<R> f0_;
    R x_, w_;

    [[nodiscard]] R smoothstep() const { return x_ * x_ * (R(3) - R(2) * x_); }
    static Vec3<R> at_most_one(Vec3<R> film) {
        for (int k = 0; k < 3; ++k)
            if (film[k] > R(1)) film[k] = R(1);
        return film;
    }
    /// The derivative with respect to a film that is held at 1.
    static Vec3<R> unclamped(const Vec3<R>& film, Vec3<R> d_film) {
        for (int k = 0; k < 3; ++k)
            if (!(film[k] < R(1))) d_film[k] = R(0);
        return d_film;
    }
    Pair pair(const Vec3<R>& f0, const At& at) const {
        const Vec3<R> plain = schlick(f0, at.c);
        if (!at.filmed) return {plain, plain};
        const Vec3<R> film = film_detail::reflectance(at.film, f0);
        return {plain, conserving ? at_most_one(film) : film};
    }
    Pair bound(R c) const {
        const Vec3<R> plain = schlick(f0_, R(slant) * c);
        if (!(x_ > R(0))) return {plain, plain};
        return {plain, at_most_one(thin_film_bound(f0_, layers_.iridescence_ior, R(slant) * c))};
    }
    Coating mixed(const Pair& of) const {
        const R most = (R(1) - w_) * of.plain[largest_channel(of.plain)] +
                       w_ * of.film[largest_channel(of.film)];
        return {layers_.specular_factor * (of.plain + w_ * (of.film - of.plain)),
                R(1) - layers_.specular_factor * most};
    }

    Pair mixed_backward(const Pair& of, const Vec3<R>& d_F, R d_left, GltfLayers<R>& d) const {
        const int plain = largest_channel(of.plain), film = largest_channel(of.film);
        const R specular = layers_.specular_factor;
        const R most = (R(1) - w_) * of.plain[plain] + w_ * of.film[film];
        d.specular_factor += dot(d_F, of.plain + w_ * (of.film - of.plain)) - d_left * most;
        weight_backward(
            specular * (dot(d_F, of.film - of.plain) + d_left * (of.plain[plain] - of.film[film])),
            d);
        Pair d_of{d_F * (specular * (R(1) - w_)), d_F * (specular * w_)};
        d_of.plain[plain] -= d_left * specular * (R(1) - w_);
        d_of.film[film] -= d_left * specular * w_;
        return d_of;
    }
    void weight_backward(R d_w, GltfLayers<R>& d) const {
        d.iridescence_factor += d_w * smoothstep();
        d.iridescence_thickness +=
            d_w * layers_.iridescence_factor * R(6) * x_ * (R(1) - x_) * R(1 / least_thickness);
    }
    void pair_backward(const Vec3<R>& f0, const At& at, const Pair& of, const Pair& d_of,
                       Vec3<R>& d_f0, GltfLayers<R>& d, R& d_c) const {
        schlick_backward(at.c, d_of.plain, d_f0);
        const R m = R(1) - at.c;
        d_c -= dot(d_of.plain, Vec3<R>(R(1)) - f0) * R(5) * (m * m) * (m * m);
        if (!at.filmed) return;
        const Vec3<R> d_film = conserving ? unclamped(of.film, d_of.film) : d_of.film;
        film_detail::reflectance_backward(at.film, f0, d_film, d_f0, d.iridescence_ior,
                                          d.iridescence_thickness, d_c);
    }
    void f0_backward(const Vec3<R>& d_f0, GltfLayers<R>& d) const {
        const R s = schlick_f0(layers_.eta);
        R d_s = R(0);
        for (int k = 0; k < 3; ++k) {
            if (!(s * layers_.specular_color_factor[k] < R(1))) continue;
            d.specular_color_factor[k] += d_f0[k] * s;
            d_s += d_f0[k] * layers_.specular_color_factor[k];
        }
        schlick_f0_backward(layers_.eta, d_s, d.eta);
    }
};

}  // namespace photograd
