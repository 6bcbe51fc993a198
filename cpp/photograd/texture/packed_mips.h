// The levels of one texture, contiguous in memory: for a renderer that looks textures up in any
// order. Level 0 comes first, so that a reader without levels gets the texture itself.
#pragma once

#include "photograd/texture/mip_chain.h"
#include "photograd/texture/mip_sample.h"

namespace photograd {

/// Where the levels lie; none for a texture that has none.
struct PackedMips {
    std::vector<TextureShape> shapes;
    std::vector<std::int64_t> first;  // texel of each level

    static PackedMips of(const TextureShape& shape) {
        PackedMips out;
        out.shapes = mip_shapes(shape);
        std::int64_t texels = 0;
        for (const TextureShape& s : out.shapes) {
            out.first.push_back(texels);
            texels += s.texels();
        }
        return out;
    }
    [[nodiscard]] bool empty() const { return shapes.empty(); }
    [[nodiscard]] int count() const { return static_cast<int>(shapes.size()); }
    [[nodiscard]] std::int64_t texels() const { return first.back() + shapes.back().texels(); }

    template <class T>
    [[nodiscard]] ImageView<T> level(T* packed, int k, int channels) const {
        const auto i = static_cast<std::size_t>(k);
        return {packed + first[i] * channels, shapes[i], channels};
    }
};

/// All levels of `texels` (H, W, C).
template <Real R>
std::vector<R> packed_levels(const PackedMips& mips, const R* texels, int channels);

/// d_texels (H, W, C) += adjoint of lookups uv (N, 2) at levels (N,) with d_color (N, C).
template <Real R>
void packed_levels_backward(const PackedMips& mips, const R* packed, int channels,
                            std::span<const R> uv, std::span<const R> level,
                            std::span<const R> d_color, R* d_texels);

}  // namespace photograd
