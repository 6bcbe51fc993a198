// A scene: placed meshes, each with a diffuse albedo whose values lie in one flat table of colours.
//
// The table (A, 3) is what is differentiated; the scene only knows which rows a point of a surface mixes.
#pragma once

#include <memory>

#include "photograd/geometry/bvh.h"
#include "photograd/texture/bilinear.h"

namespace photograd {

enum class AlbedoKind : int { constant = 0, vertices = 1, faces = 2, texture = 3 };

/// How a mesh finds its albedo: rows [first, first + count) of the table.
struct AlbedoLayout {
    AlbedoKind kind = AlbedoKind::constant;
    std::int64_t first = 0;
    int width = 0, height = 0;  // of a texture
};

class Scene {
public:
    /// One layout a mesh. Refuses (SceneError) textures without coordinates or below 2 x 2 texels.
    Scene(std::shared_ptr<const Bvh> bvh, std::vector<AlbedoLayout> layouts);

    [[nodiscard]] const Bvh& bvh() const { return *bvh_; }
    /// Number of rows of the table of colours.
    [[nodiscard]] std::int64_t colors() const { return colors_; }

    /// The rows, and their weights, that make up the albedo at barycentrics (u, v) of a triangle.
    template <class R>
    [[nodiscard]] Footprint<R> albedo_at(std::int32_t instance, std::int32_t primitive, R u, R v) const {
        const int mesh = bvh_->instances()[static_cast<std::size_t>(instance)].mesh;
        const AlbedoLayout& layout = layouts_[static_cast<std::size_t>(mesh)];
        Footprint<R> print{{layout.first, layout.first, layout.first, layout.first}, {R(1)}};
        if (layout.kind == AlbedoKind::faces) {
            print.texel[0] += primitive;
        } else if (layout.kind == AlbedoKind::vertices) {
            const std::uint32_t* c =
                bvh_->meshes()[static_cast<std::size_t>(mesh)].corners(static_cast<std::uint32_t>(primitive));
            for (std::size_t k = 0; k < 3; ++k) print.texel[k] += c[k];
            print.weight = {R(1) - u - v, u, v, R(0)};
        } else if (layout.kind == AlbedoKind::texture) {
            print = bilinear_footprint(bvh_->texture_point(instance, primitive, u, v), layout.width,
                                       layout.height);
            for (std::int64_t& texel : print.texel) texel += layout.first;
        }
        return print;
    }

private:
    std::shared_ptr<const Bvh> bvh_;
    std::vector<AlbedoLayout> layouts_;
    std::int64_t colors_ = 0;
};

/// The albedo itself, from the table `colors` (A, 3).
template <class R>
Vec3<R> mix_colors(const Footprint<R>& print, const R* colors) {
    Vec3<R> sum(R(0));
    for (std::size_t k = 0; k < 4; ++k) {
        const R* c = colors + 3 * print.texel[k];
        sum += print.weight[k] * Vec3<R>(c[0], c[1], c[2]);
    }
    return sum;
}

}  // namespace photograd
