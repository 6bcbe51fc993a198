// What lies over the base of a layered glTF material: the fibers of KHR_materials_sheen, and above
// them the coat of KHR_materials_clearcoat [Khronos2022]. Both take from the base what they
// reflect.
//
//   coat    S(c) = 0.04 + 0.96 (1 - c)^5,   passage(c) = 1 - coat S(c)
//           printed      passage of the viewer's side alone
//           conserving   passage in times passage out, c replaced by 0.85 c: gltf_layered_fresnel.h
//   sheen   1 - max(color) E     E: the larger one of both directions outside, ops/charlie_albedo.h
//           conserving: E + 0.005, the error of the fit, and never below 0
//
// Of light that enters a volume or leaves it, one direction is outside, and each layer is passed
// once.
//
//   dpassage/dcoat = -S(c)     dsheen/dcolor = -E for the largest channel (a kink where two are)
//   dsheen/dsheen_roughness = -max(color) dE/dsheen_roughness
#pragma once

#include "photograd/bsdf/gltf_layers.h"
#include "photograd/bsdf/sheen.h"
#include "photograd/ops/charlie_albedo.h"
#include "photograd/ops/fresnel_schlick.h"

namespace photograd {

template <bool conserving, class R>
class LayeredCovers {
public:
    static constexpr double coat_f0 = 0.04, slant = 0.85, fit_error = 0.005;

    /// Cosines outside: the viewer's and the light's, or the one that is, twice. Only backward
    /// needs the albedo of black sheen.
    LayeredCovers(const GltfLayers<R>& layers, R viewer, R light, bool both, bool backward = false)
        : layers_(layers), viewer_(viewer), light_(light), both_coats_(conserving && both) {
        coat_ = passage(viewer_) * (both_coats_ ? passage(light_) : R(1));
        most_ = largest_channel(layers.sheen_color_factor);
        if (!backward && vanishes(layers.sheen_color_factor)) return;
        albedo_ = SheenAlbedo<R>::of(viewer, layers.sheen_roughness_factor);
        if (both) {
            const auto other = SheenAlbedo<R>::of(light, layers.sheen_roughness_factor);
            if (!(albedo_.value > other.value)) albedo_ = other;
        }
        if (conserving) albedo_.value += R(fit_error);
        sheen_ = R(1) - layers.sheen_color_factor[most_] * albedo_.value;
        clamped_ = conserving && sheen_ < R(0);
        if (clamped_) sheen_ = R(0);
    }

    static R coat_fresnel(R c) { return schlick(R(coat_f0), R(1), c); }
    /// Left of the light by the coat, and by the sheen.
    [[nodiscard]] R coat() const { return coat_; }
    [[nodiscard]] R sheen() const { return sheen_; }

    void backward(R d_coat, R d_sheen, GltfLayers<R>& d) const {
        const R first = passage(viewer_), second = both_coats_ ? passage(light_) : R(1);
        d.coat -= d_coat * second * S(viewer_);
        if (both_coats_) d.coat -= d_coat * first * S(light_);
        if (clamped_) return;
        const R most = layers_.sheen_color_factor[most_];
        d.sheen_color_factor[most_] -= d_sheen * albedo_.value;
        d.sheen_roughness_factor -= d_sheen * most * albedo_.slope;
    }

private:
    const GltfLayers<R>& layers_;
    R viewer_, light_, coat_{R(1)}, sheen_{R(1)};
    SheenAlbedo<R> albedo_{R(0), R(0)};
    bool both_coats_, clamped_ = false;
    int most_ = 0;

    static R S(R c) { return coat_fresnel(conserving ? R(slant) * c : c); }
    [[nodiscard]] R passage(R c) const { return R(1) - layers_.coat * S(c); }
};

}  // namespace photograd
