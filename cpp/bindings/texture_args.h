// The textures of a scene, as Python passes them.
#pragma once

#include <optional>
#include <string>

#include "module.h"
#include "photograd/scene/path_scene.h"

namespace photograd {

/// (H, W, C, wrap_u, wrap_v, whether it has mip maps); (texture, channel, first, count, lo, hi);
/// (values, wrap_u, wrap_v).
using Layout = std::tuple<int, int, int, int, int, bool>;
using Use = std::tuple<int, int, int, int, double, double>;
using BentNormals = std::tuple<py::array, int, int>;

inline TextureLayout layout_of(const ArrayArgs& args, const Layout& given) {
    const auto [height, width, channels, u, v, mips] = given;
    constexpr int largest_side = 1 << 16;
    if (height < 1 || width < 1 || height > largest_side || width > largest_side || channels < 1 ||
        channels > max_channels)
        args.range("layouts", "textures (H, W, 1 to 4), H and W at most 65536", "others");
    if (u < 0 || u > 2 || v < 0 || v > 2) args.range("wrap", "0 to 2", "others");
    const TextureShape shape{height, width};
    return {shape, channels, static_cast<Wrap>(u), static_cast<Wrap>(v),
            mips ? PackedMips::of(shape) : PackedMips{}};
}

/// Refuses textures on shapes that are no meshes: they have no coordinates and no triangles.
inline void check_coordinates(const ArrayArgs& args, const PathGeometry& geometry,
                              const SurfaceTextures& textures) {
    for (std::size_t s = geometry.bvh.instances().size(); s < geometry.shape_count(); ++s) {
        const auto m = static_cast<std::size_t>(geometry.material[s]);
        if (!textures.of(m).empty() || textures.bends(m) || textures.emission_texture(s))
            args.range("uses", "textures on meshes alone", "one on shape " + std::to_string(s),
                       "spheres and bodies have no texture coordinates");
    }
}

inline void set_textures(PathGeometry& geometry, const std::vector<Layout>& layouts,
                         const std::vector<std::vector<Use>>& uses,
                         const std::vector<std::optional<BentNormals>>& normal_maps,
                         const std::vector<bool>& directed, const std::vector<double>& cutoffs,
                         const std::vector<std::pair<int, int>>& emission) {
    SurfaceTextures out;
    out.directed = directed;
    out.cutoffs = cutoffs;
    ArrayArgs args("PathTracer");
    for (const Layout& given : layouts) out.layouts.push_back(layout_of(args, given));
    for (const std::vector<Use>& of_material : uses) {
        out.uses.emplace_back();
        for (const auto& [texture, channel, first, count, lo, hi] : of_material) {
            if (texture < 0 || texture >= static_cast<int>(layouts.size()) || channel < 0 ||
                first < 0 || count < 1 || count > max_parameters ||
                first > max_parameters - count || !std::isfinite(lo) || !std::isfinite(hi) ||
                channel > out.layouts[static_cast<std::size_t>(texture)].channels - count)
                args.range("uses", "channels of textures that are there", "others");
            out.uses.back().push_back({texture, channel, first, count, lo, hi});
        }
    }
    for (const auto& [texture, channel] : emission) {
        if (texture >= static_cast<int>(layouts.size()) || channel < 0 ||
            (texture >= 0 && channel > out.layouts[static_cast<std::size_t>(texture)].channels - 3))
            args.range("emission", "three channels of a texture that is there", "others");
        out.emission.push_back({texture, channel});
    }
    for (const std::optional<BentNormals>& given : normal_maps) {
        NormalMap map;
        if (given) {
            const auto& [values, u, v] = *given;
            ArrayArgs own("PathTracer");
            const float* n = own.finite<float>("normal_maps", values, "H W 3");
            const auto side = [&](const char* axis) {
                return static_cast<int>(std::min<std::int64_t>(own.size(axis), 1 << 30));
            };
            map.layout = layout_of(own, {side("H"), side("W"), 3, u, v, false});
            map.values.assign(n, n + 3 * map.layout.shape.texels());
        }
        out.normal_maps.push_back(std::move(map));
    }
    check_coordinates(args, geometry, out);
    geometry.textures = std::move(out);
}

}  // namespace photograd
