// Tiles of 16 x 16 cells: the unit in which gradients of a texture are accumulated.
//
// A cell is the square between four texel centers; each point lies in one cell, whose tile is its
// owner. The owner accumulates into a private copy of 17 x 17 texels (a cell's far texels may
// belong to the next tile), small enough for the L1 cache; the copy is a texture of its own, served
// by the same op (ops/bilinear.h). Tiles overlap by one row and one column and are flushed in four
// colors, by the parity of their coordinates: two tiles of one color share no texel, and the
// additions to a texel come in the order of the colors on any number of threads.
#pragma once

#include <algorithm>

#include "photograd/core/parallel.h"
#include "photograd/core/scatter.h"
#include "photograd/texture/image.h"

namespace photograd {

inline constexpr int texel_tile_cells = 16;
inline constexpr TextureShape texel_tile_shape{texel_tile_cells + 1, texel_tile_cells + 1};

/// Scalars from texel to texel in a tile: three channels are padded to four, which are lanes.
template <int C>
inline constexpr int texel_tile_stride = C == 3 ? 4 : C;

template <class R, int C>
struct alignas(64) TexelTile {
    R texels[texel_tile_shape.height * texel_tile_shape.width * texel_tile_stride<C>];
};

/// How a texture is covered by tiles.
struct TextureTiles {
    TextureShape shape;
    int rows, columns;

    static TextureTiles of(const TextureShape& shape) {
        const auto tiles = [](int texels) {
            return (std::max(texels - 1, 1) + texel_tile_cells - 1) / texel_tile_cells;
        };
        return {shape, tiles(shape.height), tiles(shape.width)};
    }
    [[nodiscard]] int count() const { return rows * columns; }
    [[nodiscard]] int owner(int row, int column) const {
        return row / texel_tile_cells * columns + column / texel_tile_cells;
    }
    [[nodiscard]] int first_row(int tile) const { return tile / columns * texel_tile_cells; }
    [[nodiscard]] int first_column(int tile) const { return tile % columns * texel_tile_cells; }
    [[nodiscard]] int color(int tile) const {
        return (tile / columns % 2) * 2 + tile % columns % 2;
    }

    /// Calls visit(texel of the texture, texel of the tile) for those of the tile that exist.
    template <class Visit>
    void for_each_texel(int tile, Visit&& visit) const {
        const int top = first_row(tile), left = first_column(tile);
        const int height = std::min(texel_tile_shape.height, shape.height - top);
        const int width = std::min(texel_tile_shape.width, shape.width - left);
        for (int i = 0; i < height; ++i)
            for (int j = 0; j < width; ++j)
                visit(static_cast<long long>(top + i) * shape.width + left + j,
                      i * texel_tile_shape.width + j);
    }
};

/// Copies a tile's texels; what lies beyond the texture, and the padding, is left alone.
template <class R, int C>
void load_texel_tile(const TextureTiles& tiles, int tile, const R* texels, TexelTile<R, C>& out) {
    tiles.for_each_texel(tile, [&](long long from, int to) {
        for (int c = 0; c < C; ++c)
            out.texels[to * texel_tile_stride<C> + c] = texels[from * C + c];
    });
}

/// texels (H, W, C) += tile.
template <class R, int C>
void flush_texel_tile(const TextureTiles& tiles, int tile, const TexelTile<R, C>& in, R* texels) {
    tiles.for_each_texel(tile, [&](long long to, int from) {
        for (int c = 0; c < C; ++c)
            texels[to * C + c] += in.texels[from * texel_tile_stride<C> + c];
    });
}

/// Calls work(tile) once for each tile that owns anything, tiles of one color in parallel.
template <class Work>
void for_each_owner(const TextureTiles& tiles, const OwnerBins& bins, Work&& work) {
    for (int color = 0; color < 4; ++color) {
        std::vector<int> owners;
        for (int tile = 0; tile < tiles.count(); ++tile) {
            const auto k = static_cast<std::size_t>(tile);
            if (tiles.color(tile) == color && bins.begin[k] != bins.begin[k + 1])
                owners.push_back(tile);
        }
        parallel_for(static_cast<std::int64_t>(owners.size()),
                     [&](std::int64_t i) { work(owners[static_cast<std::size_t>(i)]); });
    }
}

}  // namespace photograd
