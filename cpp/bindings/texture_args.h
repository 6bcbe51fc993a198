// What a scene knows of textures, as Python gives it.
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
    if (height < 1 || width < 1 || channels < 1 || channels > max_channels)
        args.range("layouts", "textures (H, W, 1 to 4)", "others");
    if (u < 0 || u > 2 || v < 0 || v > 2) args.range("wrap", "0 to 2", "others");
    const TextureShape shape{height, width};
    return {shape, channels, static_cast<Wrap>(u), static_cast<Wrap>(v),
            mips ? PackedMips::of(shape) : PackedMips{}};
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
                first < 0 || count < 1 || first + count > max_parameters ||
                channel + count > out.layouts[static_cast<std::size_t>(texture)].channels)
                args.range("uses", "channels of textures that are there", "others");
            out.uses.back().push_back({texture, channel, first, count, lo, hi});
        }
    }
    for (const auto& [texture, channel] : emission) {
        if (texture >= static_cast<int>(layouts.size()) || channel < 0 ||
            (texture >= 0 && channel + 3 > out.layouts[static_cast<std::size_t>(texture)].channels))
            args.range("emission", "three channels of a texture that is there", "others");
        out.emission.push_back({texture, channel});
    }
    for (const std::optional<BentNormals>& given : normal_maps) {
        NormalMap map;
        if (given) {
            const auto& [values, u, v] = *given;
            ArrayArgs own("PathTracer");
            const float* n = own.in<float>("normal_maps", values, "H W 3");
            const auto H = static_cast<int>(own.size("H")), W = static_cast<int>(own.size("W"));
            map.layout = layout_of(own, {H, W, 3, u, v, false});
            map.values.assign(n, n + 3 * map.layout.shape.texels());
        }
        out.normal_maps.push_back(std::move(map));
    }
    geometry.textures = std::move(out);
}

}  // namespace photograd
