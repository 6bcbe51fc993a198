// Materials whose parameters vary over a surface: each is its value times a texture, brought into
// its range.
//
//   p = clamp(value t(u, v), lo, hi)       t bilinear (ops/bilinear.h), at wrapped coordinates, or
//                                          between the levels of a mip map (texture/mip_sample.h)
//
//   dp/dvalue = t,  dp/dt = value             0 where p is cut off
//
// The derivative with respect to t goes to texels. A path tracer looks them up in no order, so it
// keeps (u, v) and dL/dt, and adds them up afterwards, texel by texel (texture/sample.h). A
// coordinate is wrapped before the lookup: texels on both sides of a seam are not mixed. The level
// follows from the footprint of a path (render/path/ray_cone.h), and is held fixed. Normal maps
// change the shading normal; they are part of the geometry, without a derivative.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "photograd/scene/material.h"
#include "photograd/texture/mip_lookup.h"
#include "photograd/texture/packed_mips.h"

namespace photograd {

enum class Wrap : int { repeat = 0, mirror = 1, clamp = 2 };

template <class R>
R wrapped(Wrap wrap, R x) {
    if (wrap == Wrap::clamp) return x;
    if (wrap == Wrap::repeat) return x - std::floor(x);
    const R y = R(0.5) * x, two = R(2) * (y - std::floor(y));
    return two > R(1) ? R(2) - two : two;
}

/// Footprint of a path on a surface, in (u, v): a parallelogram with these sides; a point if 0.
template <class R>
struct Footprint {
    Vec2<R> along{R(0)}, across{R(0)};
};

struct TextureLayout {
    TextureShape shape{1, 1};
    int channels = 1;
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    PackedMips mips{};  // none: always bilinear

    template <class R>
    [[nodiscard]] Vec2<R> inside(const Vec2<R>& uv) const {
        return {wrapped(wrap_u, uv.x), wrapped(wrap_v, uv.y)};
    }
    /// All channels at a point; `uv` as `inside` gives it.
    template <class R>
    void look_up(const R* texels, const Vec2<R>& uv, R out[max_channels]) const {
        with_channels(channels, [&](auto fixed) {
            bilinear<R, decltype(fixed)::value>(texels, shape, texel_axis(uv.x, shape.width),
                                                texel_axis(uv.y, shape.height), out);
        });
    }
    /// Level of a footprint; 0 without mip maps. rho is the longer diameter of the ellipse in it,
    /// in texels: with the sides as columns of M, the largest singular value,
    ///   2 rho^2 = |a|^2 + |c|^2 + sqrt((|a|^2 - |c|^2)^2 + 4 (a.c)^2)
    template <class R>
    [[nodiscard]] R level_of(const Footprint<R>& footprint) const {
        if (mips.empty()) return R(0);
        const double W = shape.width, H = shape.height;
        const double au = W * static_cast<double>(footprint.along.x),
                     av = H * static_cast<double>(footprint.along.y),
                     cu = W * static_cast<double>(footprint.across.x),
                     cv = H * static_cast<double>(footprint.across.y);
        const double a = au * au + av * av, c = cu * cu + cv * cv, both = au * cu + av * cv;
        return static_cast<R>(
            level_of_squared(0.5 * (a + c + std::sqrt((a - c) * (a - c) + 4 * both * both))));
    }
    /// Trilinear lookup at a level of the mip map; `texels` holds all levels.
    template <class R>
    void look_up(const R* texels, const Vec2<R>& uv, R level, R out[max_channels]) const {
        if (!(level > R(0))) return look_up(texels, uv, out);
        const LevelPair<R> pair = LevelPair<R>::of(level, mips.count());
        R fine[max_channels], coarse[max_channels];
        const auto at = [&](int k, R* color) {
            const ImageView<const R> view = mips.level(texels, k, channels);
            with_channels(channels, [&](auto fixed) {
                bilinear<R, decltype(fixed)::value>(view.texels, view.shape,
                                                    texel_axis(uv.x, view.shape.width),
                                                    texel_axis(uv.y, view.shape.height), color);
            });
        };
        at(pair.first, fine);
        at(pair.second, coarse);
        for (int c = 0; c < channels; ++c) out[c] = (R(1) - pair.t) * fine[c] + pair.t * coarse[c];
    }
};

/// `count` numbers of a material, from `first` on in their order, are scaled by channels of a
/// texture.
struct TextureUse {
    int texture, channel, first, count;
    double lo, hi;
};

/// Unit vectors (H, W, 3) along growing u, against growing v, and outwards; empty for none.
struct NormalMap {
    TextureLayout layout;
    std::vector<float> values;
};

/// A shape's radiance is scaled by three channels of a texture, from `channel` on; texture -1 for
/// none.
struct EmissionUse {
    int texture = -1, channel = 0;
};

/// The textures of a scene, without their texels.
struct SurfaceTextures {
    std::vector<TextureLayout> layouts;
    std::vector<std::vector<TextureUse>> uses;  // of each material, those of one texture together
    std::vector<NormalMap> normal_maps;         // of each material
    std::vector<bool> directed;                 // of each material: whether it is brushed along u
    std::vector<double> cutoffs;                // of each material that is a mask; others: below 0
    std::vector<EmissionUse> emission;          // of each shape

    [[nodiscard]] double cutoff(std::size_t material) const {
        return material < cutoffs.size() ? cutoffs[material] : -1.0;
    }
    /// The texture of what a shape emits, or null.
    [[nodiscard]] const EmissionUse* emission_texture(std::size_t shape) const {
        return shape < emission.size() && emission[shape].texture >= 0 ? &emission[shape] : nullptr;
    }
    [[nodiscard]] std::span<const TextureUse> of(std::size_t material) const {
        return material < uses.size() ? std::span<const TextureUse>(uses[material])
                                      : std::span<const TextureUse>();
    }
    [[nodiscard]] bool any_mips() const {
        return std::any_of(layouts.begin(), layouts.end(),
                           [](const TextureLayout& layout) { return !layout.mips.empty(); });
    }
    [[nodiscard]] bool is_directed(std::size_t material) const {
        return material < directed.size() && directed[material];
    }
    /// The normal map of a material, or null.
    [[nodiscard]] const NormalMap* bends(std::size_t material) const {
        return material < normal_maps.size() && !normal_maps[material].values.empty()
                   ? &normal_maps[material]
                   : nullptr;
    }
};

/// Lookups of one texture and their derivatives: uv (N, 2), d_color (N, C); level (N,), where it
/// has mip maps.
template <class R>
struct TexelAdjoint {
    std::vector<R> uv, d_color, level;

    void start(const TextureLayout& layout, const Vec2<R>& at, R at_level) {
        uv.insert(uv.end(), {at.x, at.y});
        d_color.resize(d_color.size() + static_cast<std::size_t>(layout.channels), R(0));
        if (!layout.mips.empty()) level.push_back(at_level);
    }
    /// dL/dt of the last lookup.
    R* last(const TextureLayout& layout) {
        return &d_color[d_color.size() - static_cast<std::size_t>(layout.channels)];
    }
    void append(const TexelAdjoint& other) {
        uv.insert(uv.end(), other.uv.begin(), other.uv.end());
        d_color.insert(d_color.end(), other.d_color.begin(), other.d_color.end());
        level.insert(level.end(), other.level.begin(), other.level.end());
    }
};

/// The material as it is at one point, or over the footprint around it.
template <Real R>
Material<R> textured(const Material<R>& base, std::span<const TextureUse> uses,
                     const SurfaceTextures& textures, std::span<const R* const> texels,
                     const Vec2<R>& uv, const Footprint<R>& footprint = {}) {
    Material<R> own = base;
    for (const TextureUse& use : uses) {
        const auto t = static_cast<std::size_t>(use.texture);
        const TextureLayout& layout = textures.layouts[t];
        R color[max_channels];
        layout.look_up(texels[t], layout.inside(uv), layout.level_of(footprint), color);
        for (int i = 0; i < use.count; ++i) {
            R& p = own.number(use.first + i);
            p = std::clamp(p * color[use.channel + i], R(use.lo), R(use.hi));
        }
    }
    return own;
}

/// Adds to d_base and to d_texels (one a texture) for d_own, the derivative with respect to the
/// material at the point.
template <Real R>
void textured_backward(const Material<R>& base, std::span<const TextureUse> uses,
                       const SurfaceTextures& textures, std::span<const R* const> texels,
                       const Vec2<R>& uv, const Footprint<R>& footprint, const Material<R>& d_own,
                       Material<R>& d_base, std::vector<TexelAdjoint<R>>& d_texels) {
    R value[max_parameters], d_row[max_parameters], sum[max_parameters];
    base.get(value);
    d_own.get(d_row);
    int last = -1;
    for (const TextureUse& use : uses) {
        const auto t = static_cast<std::size_t>(use.texture);
        const TextureLayout& layout = textures.layouts[t];
        const Vec2<R> at = layout.inside(uv);
        const R level = layout.level_of(footprint);
        R color[max_channels];
        layout.look_up(texels[t], at, level, color);
        if (use.texture != last) d_texels[t].start(layout, at, level);
        last = use.texture;
        R* d_color = d_texels[t].last(layout);
        for (int i = 0; i < use.count; ++i) {
            const int k = use.first + i, c = use.channel + i;
            const R p = value[k] * color[c];
            const R d = p < R(use.lo) || p > R(use.hi) ? R(0) : d_row[k];
            d_color[c] += d * value[k];
            d_row[k] = d * color[c];
        }
    }
    d_base.get(sum);
    for (int k = 0; k < d_base.parameter_count(); ++k) sum[k] += d_row[k];
    d_base.set(sum);
}

}  // namespace photograd
