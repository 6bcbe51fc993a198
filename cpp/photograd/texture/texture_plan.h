// Recovering a texture from colors at points: the points are sorted by tile once, for any number of
// losses and gradients.
//
//   L(T) = 1 / (N C) sum over points i, channels c of (T(uv_i)_c - target_ic)^2
//   dL/dT(uv_i)_c = 2 / (N C) (T(uv_i)_c - target_ic)
//
// Sorted, the texels of a tile stay in the L1 cache while all its points are looked up and
// differentiated, and the points stream: position, weights and target are stored in that order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "photograd/core/scatter.h"
#include "photograd/texture/texel_tile.h"

namespace photograd {

template <Real R>
class TexturePlan {
public:
    /// Points uv (N, 2) and their colors target (N, C), in a texture of the given shape; both are
    /// copied.
    TexturePlan(const TextureShape& shape, int channels, const R* uv, const R* target,
                std::int64_t count);

    /// The loss; d_texels (H, W, C) is added to.
    double loss_and_gradient(const R* texels, R* d_texels) const;

    [[nodiscard]] const TextureShape& shape() const { return shape_; }
    [[nodiscard]] int channels() const { return channels_; }
    [[nodiscard]] std::int64_t count() const { return count_; }

private:
    template <int C>
    struct Point {
        R f, g;                          // fractions along column and row
        R target[texel_tile_stride<C>];  // padded with zeros, like the texels of a tile
        std::int32_t texel;              // upper left of the four, in the tile
    };
    template <int C>
    void sort(const OwnerBins& bins, const R* uv, const R* target);
    template <int C>
    double tile_loss(int tile, const R* texels, R* d_texels) const;

    TextureShape shape_;
    int channels_;
    std::int64_t count_;
    OwnerBins bins_;
    // Point<C>, N of them. Not a vector, which would write zeros first.
    std::unique_ptr<std::byte[]> points_;
};

}  // namespace photograd
