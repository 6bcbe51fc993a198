// The arrays to which derivatives of a scene are added: a dictionary from the names of its blocks
// (scene/gradient.h) to arrays of the scene's dtype.
#pragma once

#include "path_args.h"
#include "photograd/scene/gradient.h"
#include "pybind.h"

namespace photograd {

using GradientArrays = std::map<std::string, py::array>;

/// The blocks of a scene, each with its array.
template <class R>
std::vector<GradientBlock<R>> gradient_blocks_in(const std::string& function,
                                                 const PathScene<R>& scene,
                                                 GradientArrays& gradient) {
    std::vector<GradientBlock<R>> blocks = gradient_blocks(scene);
    std::string names;
    for (const auto& block : blocks) {
        if (!names.empty()) names += ", ";
        names += block.name;
    }
    if (gradient.size() != blocks.size())
        fail(ErrorKind::shape, function, "gradient", names,
             std::to_string(gradient.size()) + " arrays");
    for (auto& block : blocks) {
        const auto found = gradient.find(block.name);
        if (found == gradient.end())
            fail(ErrorKind::shape, function, "gradient", names, "no " + block.name);
        std::string axes;
        for (const std::int64_t size : block.shape) {
            if (!axes.empty()) axes += ' ';
            axes += std::to_string(size);
        }
        ArrayArgs args(function);
        block.sum = args.out<R>(block.name.c_str(), found->second, axes);
    }
    return blocks;
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
