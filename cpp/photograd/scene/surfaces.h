// The albedo of every surface of a scene, as one flat array of colours.
//
// A mesh's share of the array is one colour, a colour for each vertex, or the texels of a texture, row by
// row from the top. A lookup is a short list of taps: entries of the array and their weights. Value and
// adjoint walk the same list,
//   albedo = sum_i w_i values[i],     d_values[i] += w_i d_albedo.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "photograd/geometry/bvh.h"

namespace photograd {

enum class AlbedoKind : int { constant = 0, vertices = 1, texture = 2 };

/// Where a mesh's colours lie in the array, and how they are laid out.
struct AlbedoLayout {
    AlbedoKind kind;
    std::int64_t first;
    int width, height;  // of a texture
    [[nodiscard]] std::int64_t count(const Mesh& mesh) const {
        if (kind == AlbedoKind::constant) return 1;
        return kind == AlbedoKind::vertices ? mesh.vertex_count()
                                            : static_cast<std::int64_t>(width) * height;
    }
};

template <class R>
struct AlbedoTaps {
    std::int64_t entry[4];
    R weight[4];
    int count = 0;

    void add(std::int64_t at, R w) {
        entry[count] = at;
        weight[count++] = w;
    }
};

/// Bilinear taps of a texture at (u, v), v down, texel centres at (i + 1/2) / n, clamped at the border.
template <class R>
AlbedoTaps<R> texture_taps(const AlbedoLayout& layout, const Vec2<R>& uv) {
    const auto along = [](R coordinate, int n, int& low, int& high, R& fraction) {
        const R place = coordinate * R(n) - R(0.5);
        const R q = place > R(0) ? std::min(place, R(n - 1)) : R(0);  // of NaN, 0
        low = std::min(static_cast<int>(q), n - 1);
        high = std::min(low + 1, n - 1);
        fraction = q - R(low);
    };
    int left, right, top, bottom;
    R x, y;
    along(uv.x, layout.width, left, right, x);
    along(uv.y, layout.height, top, bottom, y);
    const auto texel = [&](int row, int column) {
        return layout.first + static_cast<std::int64_t>(row) * layout.width + column;
    };
    AlbedoTaps<R> taps;
    taps.add(texel(top, left), (R(1) - y) * (R(1) - x));
    taps.add(texel(top, right), (R(1) - y) * x);
    taps.add(texel(bottom, left), y * (R(1) - x));
    taps.add(texel(bottom, right), y * x);
    return taps;
}

/// The taps of a hit: which entries of the albedo array colour the point (u, v) of a triangle.
template <class R>
AlbedoTaps<R> albedo_taps(const Bvh& bvh, std::span<const AlbedoLayout> layouts,
                          std::int32_t instance, std::int32_t primitive, R u, R v) {
    const int mesh = bvh.instances()[static_cast<std::size_t>(instance)].mesh;
    const AlbedoLayout& layout = layouts[static_cast<std::size_t>(mesh)];
    AlbedoTaps<R> taps;
    if (layout.kind == AlbedoKind::texture)
        return texture_taps(layout, bvh.texture_point(instance, primitive, u, v));
    if (layout.kind == AlbedoKind::constant) {
        taps.add(layout.first, R(1));
        return taps;
    }
    const std::uint32_t* corner =
        bvh.mesh_of(instance).corners(static_cast<std::uint32_t>(primitive));
    const R weight[3] = {R(1) - u - v, u, v};
    for (int k = 0; k < 3; ++k) taps.add(layout.first + corner[k], weight[k]);
    return taps;
}

template <class R>
Vec3<R> look_up(const AlbedoTaps<R>& taps, const R* values) {
    Vec3<R> albedo(R(0));
    for (int k = 0; k < taps.count; ++k)
        for (int c = 0; c < 3; ++c) albedo[c] += taps.weight[k] * values[3 * taps.entry[k] + c];
    return albedo;
}

}  // namespace photograd
