// The arrays to which derivatives of paths are added, as Python hands them over.
#pragma once

#include "path_args.h"
#include "photograd/render/path.h"

namespace photograd {

/// Each array is shaped like what it is the derivative by.
struct DerivativeRows {
    py::array& parameters;
    py::array& emission;
    Arrays &lights, &textures, &media;
    std::vector<std::optional<py::array>>& densities;
};

template <class R>
struct DerivativeArrays {
    std::vector<R*> lights, textures;
    MediaOutputs<R> media;
    R *parameters, *emission;

    DerivativeArrays(ArrayArgs& args, const SceneRows& of, const SceneNumbers<R>& numbers,
                     const DerivativeRows& d)
        : lights(light_derivatives<R>(of.lights, d.lights)),
          media(of.geometry, numbers.media, d.media, d.densities),
          parameters(args.out<R>("d_parameters", d.parameters, "P")),
          emission(args.out<R>("d_emission", d.emission,
                               std::to_string(of.geometry.shape_count()) + " 3")) {
        const auto& layouts = of.geometry.textures.layouts;
        if (d.textures.size() != layouts.size())
            args.range("d_textures", std::to_string(layouts.size()) + " textures",
                       std::to_string(d.textures.size()));
        for (std::size_t t = 0; t < layouts.size(); ++t)
            textures.push_back(args.out<R>("d_textures", d.textures[t], axes_of(layouts[t])));
    }
    [[nodiscard]] PathDerivatives<R> spans() const {
        return {parameters, emission, lights, textures, media.rows, media.densities};
    }
};

/// The axes of pictures of a camera, but for channels.
inline std::string picture_axes(const ThinLens& camera) {
    return std::to_string(camera.height) + " " + std::to_string(camera.width);
}

/// Numbers of samples (H, W), at least 1 each; null for None.
inline const std::uint32_t* sample_counts(ArrayArgs& args, std::uint32_t spp,
                                          const std::optional<py::array>& counts,
                                          const ThinLens& camera) {
    if (spp < 1) args.range("spp", "at least 1 sample", "0");
    if (!counts) return nullptr;
    const auto* own = args.in<std::uint32_t>("counts", *counts, picture_axes(camera));
    if (*std::min_element(own, own + std::int64_t{camera.height} * camera.width) < 1)
        args.range("counts", "at least 1 sample of each pixel", "0");
    return own;
}

}  // namespace photograd
