// All layers of a glTF material at once, nested as Appendix B of [Khronos2021] and the extensions
// [Khronos2022] nest them: clearcoat over sheen over the blend of metal and dielectric.
//
//   f = passage (color_s DV_s + sheen f_base) + coat S DV_c
//       passage, sheen: gltf_layered_covers.h
//       DV_s Charlie's: sheen.h          DV_c: GGX of coat_roughness
//       S: of o_z, as KHR_materials_clearcoat prints it; of <wo, wh> in the conserving variant
//   f_base = (1 - metalness) f_d + metalness F_m DV
//   f_d = F DV + (1 - transmission) left_d base_color / pi                both directions above
//         transmission left base_color through                                         below
//       F, left, F_m of <wo, wh>: gltf_layered_fresnel.h            DV: gltf_layered_facets.h
//       left_d = left; conserving: left_diffuse(o_z) left_diffuse(i_z)
//
// Below the surface there are two kinds. A sheet (gltf_layered) is alike on both sides, and light
// that passes is scattered by its roughness alone: through = DV of wi mirrored to wo's side. The
// boundary of a body (gltf_layered_volume, KHR_materials_volume) refracts, each channel by its own
// index (KHR_materials_dispersion): through = K DV. Its layers are outside: seen from inside it
// mirrors transmission F DV, and what enters or leaves passes the layers once. There F is that of
// the cosine outside,
//
//   c^2 = 1 - index^2 (1 - <wo, wh>^2),   c = 0 under total reflection,
//
// so that both directions of one path have one F. What is absorbed inside belongs to the medium.
//
// With its defaults, gltf_layered is gltf.h; with one layer, gltf_specular.h, gltf_sheen.h,
// gltf_iridescence.h or gltf_transmission.h. clearcoat.h differs: there light passes the coat
// twice. The printed formula is not reciprocal because of the coat, and not energy-conserving, like
// gltf.h: white returned at most 1.91 of the light, a volume 1.83 (smooth, at the horizon; no more
// than F = 1.28 under a film and a base layer of 0.933 are possible). The conserving variant is
// reciprocal, and returned at most 1.00, which is matt white without a coating.
//
//   df/dpassage = color_s DV_s + sheen f_base     df/dsheen = passage f_base     df/dcoat += S DV_c
//   df_base/dmetalness = F_m DV - f_d
//   df_d/dtransmission = -left_d base_color / pi above, left base_color through below
//   df_d/dbase_color = (1 - transmission) left_d / pi above, transmission left through below
//   dc/dindex = -index (1 - <wo, wh>^2) / c
//
// Samples go to the coat, to the fibers, and to the base in proportion to what each may reflect;
// all ways of the base get some, because the derivatives need them.
#pragma once

#include "photograd/bsdf/gltf_layered_covers.h"
#include "photograd/bsdf/gltf_layered_facets.h"
#include "photograd/bsdf/gltf_layered_fresnel.h"
#include "photograd/ops/dispersion.h"

namespace photograd {

template <class R, bool volume, bool conserving>
struct GltfLayeredModel : GltfLayers<R> {
    using Layers = GltfLayers<R>;
    using Sides = LayeredSides<R>;
    using Fresnel = LayeredFresnel<conserving, R>;
    using Facets = LayeredFacets<R>;
    using Covers = LayeredCovers<conserving, R>;

    static constexpr const char* name =
        volume ? (conserving ? "gltf_layered_volume_conserving" : "gltf_layered_volume")
               : (conserving ? "gltf_layered_conserving" : "gltf_layered");
    static constexpr EnergyClaim energy =
        conserving ? EnergyClaim{Energy::lossy, 1.0} : EnergyClaim{Energy::gains, 2.25};
    static constexpr bool reciprocal = conserving, transmits = true;
    static constexpr auto params = [] {
        if constexpr (volume)
            return Layers::described_volume(0.1, 1.2);
        else
            return Layers::described(least_roughness, 1.0);
    }();

    Vec3<R> f(const Vec3<R>& wo, const Vec3<R>& wi) const {
        const Sides s(wo, wi);
        if (!s.possible) return Vec3<R>(R(0));
        if (volume && s.below && s.mirrored) return mirrored_inside(s);
        if (!s.mirrored) {
            if (vanishes(passing())) return Vec3<R>(R(0));
            const Covers covers = covers_of(s, false);
            return through(s) * (covers.coat() * covers.sheen());
        }
        const Covers covers = covers_of(s, false);
        Vec3<R> below = covers.sheen() * base(s);
        if (!vanishes(this->sheen_color_factor)) below += fibers().f(lifted(s.o), lifted(s.i));
        Vec3<R> out = covers.coat() * below;
        if (!vanishes(this->coat)) out += Vec3<R>(this->coat * coat_reflectance(s) * coat_lobe(s));
        return out;
    }
    void f_backward(const Vec3<R>& wo, const Vec3<R>& wi, const Vec3<R>& d_f,
                    GltfLayeredModel& d) const {
        const Sides s(wo, wi);
        if (!s.possible) return;
        if (volume && s.below && s.mirrored) return mirrored_inside_backward(s, d_f, d);
        const Covers covers = covers_of(s, true);
        const R passage = covers.coat(), sheen = covers.sheen();
        if (!s.mirrored) {
            const R d_both = dot(d_f, through(s));
            through_backward(s, d_f * (passage * sheen), d);
            return covers.backward(d_both * sheen, d_both * passage, d);
        }
        const R on_base = dot(d_f, base(s)),
                on_fibers = dot(d_f, fibers().f(lifted(s.o), lifted(s.i)));
        covers.backward(on_fibers + sheen * on_base, passage * on_base, d);
        base_backward(s, d_f * (passage * sheen), d);
        Sheen<R> d_fibers{Vec3<R>(R(0)), R(0)};
        fibers().f_backward(lifted(s.o), lifted(s.i), d_f * passage, d_fibers);
        d.sheen_color_factor += d_fibers.color;
        d.sheen_roughness_factor += d_fibers.roughness;
        const R all = d_f.x + d_f.y + d_f.z, F = coat_reflectance(s);
        d.coat += all * F * coat_lobe(s);
        ggx_lobe_backward(s.o, s.i, this->coat_roughness, all * this->coat * F, d.coat_roughness);
    }

    Vec3<R> sample(const Vec3<R>& wo, Vec2<R> u2) const {
        const R side = wo.z > R(0) ? R(1) : R(-1);
        const Vec3<R> i = sample_above(Vec3<R>(wo.x, wo.y, wo.z * side), side < R(0), u2);
        return {i.x, i.y, i.z * side};
    }
    R pdf(const Vec3<R>& wo, const Vec3<R>& wi) const {
        const Sides s(wo, wi);
        if (!s.possible) return R(0);
        const bool inside = volume && s.below;
        const R to_coat = inside ? R(0) : coat_share();
        const R to_fibers = inside ? R(0) : (R(1) - to_coat) * fiber_share(s.o.z);
        const R to_base = R(1) - to_coat - to_fibers;
        if (!s.mirrored) return to_base * through_share(s.o.z, inside) * through_pdf(s);
        const R diffuse = inside ? R(0) : diffuse_share();
        const R facets = R(1) - through_share(s.o.z, inside) - diffuse;
        R density = to_base * (diffuse * cosine_hemisphere_pdf(s.i) + facets * facet_pdf(s.o, s.i));
        if (inside) return density;
        return density + to_coat * ggx_lobe_pdf(s.o, s.i, this->coat_roughness) +
               to_fibers * fibers().pdf(s.o, s.i);
    }
    Vec3<R> index_inside() const {
        if constexpr (volume)
            return channel_indices(this->eta, this->dispersion);
        else
            return Vec3<R>(R(1));
    }

private:
    Sheen<R> fibers() const { return {this->sheen_color_factor, this->sheen_roughness_factor}; }
    /// In the horizon itself the fit of the fibers' masking grows without bound.
    static Vec3<R> lifted(const Vec3<R>& w) { return {w.x, w.y, larger(w.z, R(1e-5))}; }
    [[nodiscard]] R rest() const { return R(1) - this->metalness; }
    [[nodiscard]] R passing() const { return rest() * this->transmission; }
    [[nodiscard]] R index_ahead(const Sides& s, int channel) const {
        return s.below ? R(1) / index_inside()[channel] : index_inside()[channel];
    }
    Covers covers_of(const Sides& s, bool backward) const {
        if (!volume || s.mirrored) return Covers(*this, s.o.z, s.i_above().z, true, backward);
        const R outside = s.below ? s.i_above().z : s.o.z;
        return Covers(*this, outside, outside, false, backward);
    }
    R coat_reflectance(const Sides& s) const {
        return Covers::coat_fresnel(conserving ? dot(s.o, half_vector(s.o, s.i)) : s.o.z);
    }
    R coat_lobe(const Sides& s) const { return ggx_lobe(s.o, s.i, this->coat_roughness); }
    R left_diffuse(const Fresnel& fresnel, const Sides& s, R left) const {
        if constexpr (conserving)
            return fresnel.left_diffuse(s.o.z) * fresnel.left_diffuse(s.i.z);
        else
            return left;
    }

    // Mirrored outside.
    Vec3<R> base(const Sides& s) const {
        const Facets facets(*this);
        const Fresnel fresnel(*this);
        const Vec3<R> h = half_vector(s.o, s.i);
        const R DV = facets.lobe(facets.turned(s.o), facets.turned(s.i), facets.turned(h));
        const typename Fresnel::At at = fresnel.at(dot(s.o, h));
        Vec3<R> out(R(0));
        if (!vanishes(rest())) {
            const typename Fresnel::Coating coating = fresnel.coating(at);
            const R left = left_diffuse(fresnel, s, coating.left);
            const R diffuse = left * (R(1) - this->transmission) * R(1 / pi);
            out += rest() * (this->base_color * diffuse + coating.F * DV);
        }
        if (!vanishes(this->metalness)) out += this->metalness * (fresnel.metal(at) * DV);
        return out;
    }
    void base_backward(const Sides& s, const Vec3<R>& d_base, Layers& d) const {
        const Facets facets(*this);
        const Fresnel fresnel(*this);
        const Vec3<R> h = half_vector(s.o, s.i);
        const typename Fresnel::At at = fresnel.at(dot(s.o, h), true);
        const typename Fresnel::Coating coating = fresnel.coating(at);
        const Vec3<R> metal = fresnel.metal(at);
        const Vec3<R> o = facets.turned(s.o), i = facets.turned(s.i), th = facets.turned(h);
        const R DV = facets.lobe(o, i, th), opaque = R(1) - this->transmission;
        const R left = left_diffuse(fresnel, s, coating.left),
                on_color = dot(d_base, this->base_color);
        d.metalness += dot(d_base, (metal - coating.F) * DV) - on_color * left * opaque * R(1 / pi);
        d.transmission -= rest() * left * on_color * R(1 / pi);
        d.base_color += d_base * (rest() * opaque * left * R(1 / pi));
        const R d_left = rest() * opaque * on_color * R(1 / pi);
        if (conserving) {
            fresnel.left_diffuse_backward(s.o.z, d_left * fresnel.left_diffuse(s.i.z), d);
            fresnel.left_diffuse_backward(s.i.z, d_left * fresnel.left_diffuse(s.o.z), d);
        }
        R fixed_cosine = R(0);
        fresnel.coating_backward(at, d_base * (rest() * DV), conserving ? R(0) : d_left, d,
                                 fixed_cosine);
        fresnel.metal_backward(at, d_base * (this->metalness * DV), d, fixed_cosine);
        const R d_DV = rest() * dot(d_base, coating.F) + this->metalness * dot(d_base, metal);
        facets.lobe_backward(o, i, th, d_DV, d);
    }

    // Below the surface, without the layers above. Sheets:
    Vec3<R> through(const Sides& s) const {
        const R part = passing();
        if constexpr (volume) {
            Vec3<R> out(R(0));
            for (int k = 0; k < 3; ++k)
                out[k] = k > 0 && vanishes(this->dispersion) ? out[0] : refracted(s, k);
            return this->base_color * out * part;
        } else {
            const Facets facets(*this);
            const Vec3<R> i = s.i_above(), h = half_vector(s.o, i);
            const R DV = facets.lobe(facets.turned(s.o), facets.turned(i), facets.turned(h));
            const Fresnel fresnel(*this);
            return this->base_color * (part * fresnel.coating(fresnel.at(dot(s.o, h))).left * DV);
        }
    }
    void through_backward(const Sides& s, const Vec3<R>& d_through, Layers& d) const {
        if constexpr (volume) {
            Vec3<R> d_index(R(0));
            for (int k = 0; k < 3; ++k) d_index[k] = refracted_backward(s, k, d_through[k], d);
            channel_indices_backward(this->eta, this->dispersion, d_index, d.eta, d.dispersion);
        } else {
            const Facets facets(*this);
            const Fresnel fresnel(*this);
            const Vec3<R> i = s.i_above(), h = half_vector(s.o, i);
            const Vec3<R> o = facets.turned(s.o), ti = facets.turned(i), th = facets.turned(h);
            const typename Fresnel::At at = fresnel.at(dot(s.o, h), true);
            const R DV = facets.lobe(o, ti, th), left = fresnel.coating(at).left;
            const R part = passing(), on_color = dot(d_through, this->base_color);
            d.base_color += d_through * (part * left * DV);
            d.metalness -= this->transmission * left * DV * on_color;
            d.transmission += rest() * left * DV * on_color;
            R fixed_cosine = R(0);
            fresnel.coating_backward(at, Vec3<R>(R(0)), part * DV * on_color, d, fixed_cosine);
            facets.lobe_backward(o, ti, th, part * left * on_color, d);
        }
    }
    // Bodies, one channel:
    R refracted(const Sides& s, int channel) const {
        const Facets facets(*this);
        const Vec3<R> o = facets.turned(s.o), i = facets.turned(s.i);
        const RefractingFacet<R> facet(o, i, index_ahead(s, channel));
        if (!facet.possible) return R(0);
        const Fresnel fresnel(*this);
        const R left = fresnel.coating(fresnel.at(s.below ? -facet.b : facet.a)).left;
        return left * facet.K() * facets.lobe(o, facets.turned(s.i_above()), facet.h);
    }
    /// Adds all but dL/dindex, which is returned.
    R refracted_backward(const Sides& s, int channel, R d_through, Layers& d) const {
        const Facets facets(*this);
        const Fresnel fresnel(*this);
        const Vec3<R> o = facets.turned(s.o), i = facets.turned(s.i);
        const Vec3<R> above = facets.turned(s.i_above());
        const RefractingFacet<R> facet(o, i, index_ahead(s, channel));
        if (!facet.possible) return R(0);
        const typename Fresnel::At at = fresnel.at(s.below ? -facet.b : facet.a, true);
        const R left = fresnel.coating(at).left, K = facet.K();
        const R DV = facets.lobe(o, above, facet.h), value = left * K * DV;
        const R color = this->base_color[channel], part = passing();
        d.base_color[channel] += d_through * part * value;
        d.metalness -= d_through * this->transmission * color * value;
        d.transmission += d_through * rest() * color * value;
        const R d_value = d_through * part * color;
        R d_c = R(0);
        fresnel.coating_backward(at, Vec3<R>(R(0)), d_value * K * DV, d, d_c);
        const Vec3<R> d_h = facets.lobe_backward(o, above, facet.h, d_value * left * K, d);
        const R d_e = facet.backward(o, i, d_h, s.below ? R(0) : d_c, s.below ? -d_c : R(0),
                                     d_value * left * DV);
        return s.below ? -d_e * (facet.e * facet.e) : d_e;
    }

    /// Cosine outside of what a facet mirrors inside, 0 under total reflection.
    R cosine_outside(R cosine, int channel) const {
        const R c2 = refracted_cos_squared(R(1) / index_inside()[channel], cosine);
        return c2 > R(0) ? sqrt(c2) : R(0);
    }
    Vec3<R> mirrored_inside(const Sides& s) const {
        if (vanishes(passing())) return Vec3<R>(R(0));
        const Facets facets(*this);
        const Fresnel fresnel(*this);
        const Vec3<R> h = half_vector(s.o, s.i);
        const R DV = facets.lobe(facets.turned(s.o), facets.turned(s.i), facets.turned(h));
        Vec3<R> F = fresnel.coating(fresnel.at(cosine_outside(dot(s.o, h), 0))).F;
        if (!vanishes(this->dispersion))
            for (int k = 1; k < 3; ++k)
                F[k] = fresnel.coating(fresnel.at(cosine_outside(dot(s.o, h), k))).F[k];
        return F * (passing() * DV);
    }
    void mirrored_inside_backward(const Sides& s, const Vec3<R>& d_f, Layers& d) const {
        const Facets facets(*this);
        const Fresnel fresnel(*this);
        const Vec3<R> h = half_vector(s.o, s.i), th = facets.turned(h);
        const Vec3<R> o = facets.turned(s.o), i = facets.turned(s.i);
        const R a = dot(s.o, h), DV = facets.lobe(o, i, th), part = passing();
        Vec3<R> d_index(R(0));
        R on_F = R(0);
        for (int k = 0; k < 3; ++k) {
            const R c = cosine_outside(a, k);
            const typename Fresnel::At at = fresnel.at(c, true);
            on_F += d_f[k] * fresnel.coating(at).F[k];
            Vec3<R> d_F(R(0));
            d_F[k] = d_f[k] * part * DV;
            R d_c = R(0);
            fresnel.coating_backward(at, d_F, R(0), d, d_c);
            if (c > R(0)) d_index[k] = -d_c * index_inside()[k] * (R(1) - a * a) / c;
        }
        channel_indices_backward(this->eta, this->dispersion, d_index, d.eta, d.dispersion);
        d.metalness -= this->transmission * DV * on_F;
        d.transmission += rest() * DV * on_F;
        facets.lobe_backward(o, i, th, part * on_F, d);
    }

    // Shares of the samples: of all, the coat; of the others, the fibers; of the rest, by way.
    [[nodiscard]] R coat_share() const { return R(0.4) * this->coat; }
    R fiber_share(R cosine) const {
        const Vec3<R>& color = this->sheen_color_factor;
        if (vanishes(color)) return R(0);
        const R albedo = SheenAlbedo<R>::of(cosine, this->sheen_roughness_factor).value;
        return R(0.8) * color[largest_channel(color)] * larger(albedo, R(0));
    }
    R through_share(R cosine, bool inside) const {
        if (inside) return R(0.75) - R(0.5) * fresnel_dielectric(R(1) / index_inside()[1], cosine);
        return R(0.05) + R(0.6) * rest() * this->transmission;
    }
    [[nodiscard]] R diffuse_share() const {
        return R(0.05) + R(0.4) * rest() * (R(1) - this->transmission);
    }
    R facet_pdf(const Vec3<R>& o, const Vec3<R>& i) const {
        const Facets facets(*this);
        const Vec3<R> to = facets.turned(o), h = half_vector(to, facets.turned(i));
        return reflected_pdf(to, h, facets.pdf(to, h));
    }
    R through_pdf(const Sides& s) const {
        if constexpr (!volume) return facet_pdf(s.o, s.i_above());
        const Facets facets(*this);
        const Vec3<R> o = facets.turned(s.o), i = facets.turned(s.i);
        const int channels = vanishes(this->dispersion) ? 1 : 3;
        R sum = R(0);
        for (int k = 0; k < channels; ++k) {
            const RefractingFacet<R> facet(o, i, index_ahead(s, k));
            if (facet.possible) sum += facets.pdf(o, facet.h) * facet.density();
        }
        return sum / R(channels);
    }
    /// wo is above, `below` whether it was not. A facet that sends light to the wrong side loses
    /// it: a direction in the horizon, of no density.
    Vec3<R> sample_above(const Vec3<R>& o, bool below, Vec2<R> u2) const {
        const Vec3<R> invalid(R(1), R(0), R(0));
        const bool inside = volume && below;
        Vec3<R> i(R(0));
        if (!inside && take_first(coat_share(), u2)) {
            i = sample_ggx_lobe(o, this->coat_roughness, u2);
        } else if (!inside && take_first(fiber_share(o.z), u2)) {
            i = fibers().sample(o, u2);
        } else if (!inside && take_first(diffuse_share(), u2)) {
            i = square_to_cosine_hemisphere(u2);
        } else {
            const R others = inside ? R(1) : R(1) - diffuse_share();
            const bool through = take_first(through_share(o.z, inside) / others, u2);
            if (through && volume) return sample_refracted(o, below, u2);
            const Facets facets(*this);
            i = reflect(o, facets.turned_back(facets.sample(facets.turned(o), u2)));
            if (!(i.z > R(0))) return invalid;
            return {i.x, i.y, through ? -i.z : i.z};
        }
        return i.z > R(0) ? i : invalid;
    }
    Vec3<R> sample_refracted(const Vec3<R>& o, bool below, Vec2<R> u2) const {
        int channel = 0;
        while (channel < 2 && !take_first(R(1) / R(3 - channel), u2)) ++channel;
        const R index = index_inside()[channel], e = below ? R(1) / index : index;
        const Facets facets(*this);
        const Vec3<R> h = facets.turned_back(facets.sample(facets.turned(o), u2));
        const R a = dot(o, h), t2 = refracted_cos_squared(e, a);
        if (!(t2 > R(0))) return {R(1), R(0), R(0)};
        const Vec3<R> i = h * (a / e - sqrt(t2)) - o * (R(1) / e);
        return i.z < R(0) ? i : Vec3<R>(R(1), R(0), R(0));
    }
};

template <class R>
using GltfLayered = GltfLayeredModel<R, false, false>;
template <class R>
using GltfLayeredConserving = GltfLayeredModel<R, false, true>;
template <class R>
using GltfLayeredVolume = GltfLayeredModel<R, true, false>;
template <class R>
using GltfLayeredVolumeConserving = GltfLayeredModel<R, true, true>;

static_assert(Bsdf<GltfLayered> && Bsdf<GltfLayeredConserving>);
static_assert(Bsdf<GltfLayeredVolume> && Bsdf<GltfLayeredVolumeConserving>);

}  // namespace photograd
