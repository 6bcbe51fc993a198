// A scene's numbers, as Python gives them for each rendering: checked, and put together with its geometry.
#pragma once

#include <optional>

#include "listed_lights.h"
#include "media_args.h"

namespace photograd {

/// (H, W, C, wrap_u, wrap_v); (texture, channel, first, count, lo, hi); (values, wrap_u, wrap_v).
using Layout = std::tuple<int, int, int, int, int>;
using Use = std::tuple<int, int, int, int, double, double>;
using BentNormals = std::tuple<py::array, int, int>;

inline TextureLayout layout_of(const ArrayArgs& args, const Layout& given) {
    const auto [height, width, channels, u, v] = given;
    if (height < 1 || width < 1 || channels < 1 || channels > max_channels)
        args.range("layouts", "textures (H, W, 1 to 4)", "others");
    if (u < 0 || u > 2 || v < 0 || v > 2) args.range("wrap", "0 to 2", "others");
    return {{height, width}, channels, static_cast<Wrap>(u), static_cast<Wrap>(v)};
}

inline void set_textures(PathGeometry& geometry, const std::vector<Layout>& layouts,
                         const std::vector<std::vector<Use>>& uses,
                         const std::vector<std::optional<BentNormals>>& normal_maps,
                         const std::vector<bool>& directed) {
    SurfaceTextures out;
    out.directed = directed;
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
    for (const std::optional<BentNormals>& given : normal_maps) {
        NormalMap map;
        if (given) {
            const auto& [values, u, v] = *given;
            ArrayArgs own("PathTracer");
            const float* n = own.in<float>("normal_maps", values, "H W 3");
            const auto H = static_cast<int>(own.size("H")), W = static_cast<int>(own.size("W"));
            map.layout = layout_of(own, {H, W, 3, u, v});
            map.values.assign(n, n + 3 * map.layout.shape.texels());
        }
        out.normal_maps.push_back(std::move(map));
    }
    geometry.textures = std::move(out);
}

inline std::string axes_of(const TextureLayout& layout) {
    return std::to_string(layout.shape.height) + " " + std::to_string(layout.shape.width) + " " +
           std::to_string(layout.channels);
}

/// Checked numbers of a scene, and the materials that they describe.
template <class R>
struct SceneNumbers {
    std::vector<Material<R>> drawn, sampling;
    std::vector<const R*> texels, sampling_texels;
    std::vector<AnyLight<R>> lights;
    std::vector<Medium<R>> media, sampling_media;
    PathScene<R> scene;

    SceneNumbers(ArrayArgs& args, const PathGeometry& geometry,
                 const std::vector<std::string>& models, const py::array& parameters,
                 const std::optional<py::array>& sampling_parameters, const py::array& emission,
                 const LightTuples& light_rows, const std::vector<py::array>& textures,
                 const std::optional<std::vector<py::array>>& sampling_textures,
                 const std::vector<MediumTuple>& media_rows,
                 const std::optional<std::vector<MediumTuple>>& sampling_media_rows)
        : lights(listed_lights<R>(light_rows)), media(media_of<R>(geometry, media_rows)) {
        for (const std::int32_t m : geometry.material)
            if (m < 0 || m >= static_cast<std::int32_t>(models.size()))
                args.range("material", "numbers below " + std::to_string(models.size()),
                           std::to_string(m));
        read(args, models, "parameters", parameters, drawn);
        if (sampling_parameters)
            read(args, models, "sampling_parameters", *sampling_parameters, sampling);
        const R* e =
            args.in<R>("emission", emission, std::to_string(geometry.shape_count()) + " 3");
        const std::size_t count = static_cast<std::size_t>(geometry.lights.listed_count());
        if (lights.size() != count)
            args.range("lights", std::to_string(count) + ", as when the scene was built",
                       std::to_string(lights.size()));
        scene = {&geometry, drawn, sampling_parameters ? sampling : drawn, e, lights};
        texels = texels_of(args, geometry, "textures", textures);
        if (sampling_textures)
            sampling_texels = texels_of(args, geometry, "textures", *sampling_textures);
        if (sampling_media_rows) sampling_media = media_of<R>(geometry, *sampling_media_rows);
        scene.media = media;
        scene.sampling_media = sampling_media_rows ? sampling_media : media;
        scene.texels = texels;
        scene.sampling_texels = sampling_textures ? sampling_texels : texels;
        for (std::size_t m = 0; m < drawn.size(); ++m)
            for (const TextureUse& use : geometry.textures.of(m))
                if (use.first + use.count > drawn[m].parameter_count())
                    args.range("uses", "parameters of the material", "others");
    }

private:
    static std::vector<const R*> texels_of(ArrayArgs& args, const PathGeometry& geometry,
                                           const char* name,
                                           const std::vector<py::array>& textures) {
        std::vector<const R*> out;
        const auto& layouts = geometry.textures.layouts;
        if (textures.size() != layouts.size())
            args.range(name, std::to_string(layouts.size()) + " textures",
                       std::to_string(textures.size()));
        for (std::size_t t = 0; t < layouts.size(); ++t)
            out.push_back(args.in<R>(name, textures[t], axes_of(layouts[t])));
        return out;
    }
    static void read(ArrayArgs& args, const std::vector<std::string>& models, const char* name,
                     const py::array& parameters, std::vector<Material<R>>& out) {
        const R* row = args.in<R>(name, parameters, "P");
        std::int64_t used = 0;
        for (const std::string& model : models) {
            // The first reading only counts; the row may end before this model's parameters do.
            static constexpr R zeros[64] = {};
            const int count = Material<R>::read(model, zeros).parameter_count();
            if (used + count > args.size("P"))
                args.range(name, "the parameters of all materials", "too few");
            out.push_back(Material<R>::read(model, row + used));
            used += count;
        }
        if (used != args.size("P")) args.range(name, std::to_string(used), "too many");
    }
};

}  // namespace photograd
