// The numbers of a scene for path tracing, and options, as Python hands them over.
#pragma once

#include <optional>

#include "light_list.h"
#include "media_args.h"
#include "photograd/camera/pinhole.h"
#include "photograd/render/path/path.h"
#include "photograd/scene/path_scene.h"

namespace photograd {

/// (strategy, heuristic, max_depth, roulette_from, sampler, seed)
using Options = std::tuple<int, int, int, int, int, std::uint64_t>;

using Models = std::vector<std::string>;
using Arrays = std::vector<py::array>;
using MediumTuples = std::vector<MediumTuple>;

/// A scene as every function takes it that follows light through one.
struct SceneRows {
    const PathGeometry& geometry;
    const Models& models;
    const py::array& parameters;
    const py::array& emission;
    const LightTuples& lights;
    const Arrays& textures;
    const MediumTuples& media;
};

/// What is sampled, where it differs from what is evaluated (scene/path_scene.h).
struct SamplingRows {
    std::optional<py::array> parameters;
    std::optional<Arrays> textures;
    std::optional<MediumTuples> media;
};

inline std::string axes_of(const TextureLayout& layout) {
    return std::to_string(layout.shape.height) + " " + std::to_string(layout.shape.width) + " " +
           std::to_string(layout.channels);
}

/// Checked numbers of a scene, and the materials that they describe.
template <class R>
struct SceneNumbers {
    std::vector<Material<R>> materials, sampling;
    std::vector<const R*> texels, sampling_texels;
    std::vector<std::vector<R>> mips;  // all levels of textures that have them
    std::vector<AnyLight<R>> lights;
    std::vector<Medium<R>> media, sampling_media;
    PathScene<R> scene;

    SceneNumbers(ArrayArgs& args, const SceneRows& rows, const SamplingRows& other = {})
        : lights(infinite_and_delta<R>(rows.lights)),
          media(media_of<R>(rows.geometry, rows.media)) {
        const PathGeometry& geometry = rows.geometry;
        for (const std::int32_t m : geometry.material)
            if (m < 0 || m >= static_cast<std::int32_t>(rows.models.size()))
                args.range("material", "numbers below " + std::to_string(rows.models.size()),
                           std::to_string(m));
        read(args, rows.models, "parameters", rows.parameters, materials);
        if (other.parameters)
            read(args, rows.models, "sampling_parameters", *other.parameters, sampling);
        const R* e =
            args.in<R>("emission", rows.emission, std::to_string(geometry.shape_count()) + " 3");
        const std::size_t count =
            static_cast<std::size_t>(geometry.lights.infinite_and_delta_count());
        if (lights.size() != count)
            args.range("lights", std::to_string(count) + ", as when the scene was built",
                       std::to_string(lights.size()));
        scene = {&geometry, materials, other.parameters ? sampling : materials, e, lights};
        texels = texels_of(args, geometry, "textures", rows.textures);
        if (other.textures)
            sampling_texels = texels_of(args, geometry, "textures", *other.textures);
        if (other.media) sampling_media = media_of<R>(geometry, *other.media);
        scene.media = media;
        scene.sampling_media = other.media ? sampling_media : media;
        scene.texels = texels;
        scene.sampling_texels = other.textures ? sampling_texels : texels;
        for (std::size_t m = 0; m < materials.size(); ++m)
            for (const TextureUse& use : geometry.textures.of(m))
                if (use.first + use.count > materials[m].parameter_count())
                    args.range("uses", "parameters of the material", "others");
    }

private:
    std::vector<const R*> texels_of(ArrayArgs& args, const PathGeometry& geometry, const char* name,
                                    const Arrays& textures) {
        std::vector<const R*> out;
        const auto& layouts = geometry.textures.layouts;
        if (textures.size() != layouts.size())
            args.range(name, std::to_string(layouts.size()) + " textures",
                       std::to_string(textures.size()));
        for (std::size_t t = 0; t < layouts.size(); ++t) {
            out.push_back(args.in<R>(name, textures[t], axes_of(layouts[t])));
            if (layouts[t].mips.empty()) continue;
            mips.push_back(packed_levels(layouts[t].mips, out.back(), layouts[t].channels));
            out.back() = mips.back().data();
        }
        return out;
    }
    static void read(ArrayArgs& args, const Models& models, const char* name,
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

inline PathOptions options_of(const ArrayArgs& args, const Options& given) {
    const auto [strategy, heuristic, max_depth, roulette_from, sampler, seed] = given;
    if (strategy < 0 || strategy > 2 || heuristic < 0 || heuristic > 1 || sampler < 0 ||
        sampler > 1)
        args.range("options", "a strategy, a heuristic and a sampler", "others");
    if (max_depth < 1 || max_depth > 4096)
        args.range("max_depth", "1 to 4096 segments", std::to_string(max_depth));
    if (roulette_from < 0) args.range("roulette_from", "at least 0", std::to_string(roulette_from));
    return {static_cast<Strategy>(strategy),
            static_cast<Heuristic>(heuristic),
            max_depth,
            roulette_from,
            seed,
            static_cast<Sampler>(sampler)};
}

/// The axes of pictures of a camera, but for channels.
inline std::string picture_axes(const Pinhole& camera) {
    return std::to_string(camera.height) + " " + std::to_string(camera.width);
}

/// Where samples of a camera's pixels are added, "radiance" and "squares": (H, W, 3) each, float64.
inline PathSums path_sums(ArrayArgs& args, const Pinhole& camera, py::array& radiance,
                          py::array& squares, const std::string& prefix = "") {
    const std::string axes = picture_axes(camera) + " 3";
    return {args.out<double>((prefix + "radiance").c_str(), radiance, axes),
            args.out<double>((prefix + "squares").c_str(), squares, axes)};
}

}  // namespace photograd
