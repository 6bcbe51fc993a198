// The gradient with respect to a scene, as a list of blocks: one for each array of numbers that the
// scene lets change, with the array's name, shape and the way in which its derivatives are added
// up.
//
//   dense        few numbers: each chunk of paths has a sum of its own (parameters, emission, ...)
//   directions   texels of an environment map: directions are stored and scattered by texel owners
//   texels       of a texture: lookups are stored and scattered by texel owners
//   voxels       of a density grid: lookups are stored and scattered by voxel owners
//
// A new differentiable quantity is one entry of `gradient_blocks`, its numbers in PathScene and
// SceneGradient, and its term in the adjoint and tangent of radiance (render/path/adjoint.h).
#pragma once

#include <string>
#include <vector>

#include "photograd/scene/path_scene.h"

namespace photograd {

enum class BlockKind { dense, directions, texels, voxels };

template <class R>
struct GradientBlock {
    std::string name;  // "parameters", "emission", "lights.0", "textures.0", "media.0", ...
    BlockKind kind;
    std::size_t number;  // of the light, texture or medium
    std::vector<std::int64_t> shape;
    R* sum = nullptr;  // where derivatives are added

    [[nodiscard]] std::size_t size() const {
        std::int64_t product = 1;
        for (const std::int64_t axis : shape) product *= axis;
        return static_cast<std::size_t>(product);
    }
};

/// The derivatives that some paths add up.
template <Real R>
struct SceneGradient {
    std::vector<Material<R>> materials;
    std::vector<Vec3<R>> emission;
    std::vector<AnyLightGradient<R>> lights;
    std::vector<Medium<R>> media;
    std::vector<TexelAdjoint<R>> texels;       // of each texture
    std::vector<DensityAdjoint<R>> densities;  // of each medium

    SceneGradient() = default;
    explicit SceneGradient(const PathScene<R>& scene)
        : emission(scene.geometry->shape_count(), Vec3<R>(R(0))),
          texels(scene.texels.size()),
          densities(scene.media.size()) {
        for (const Material<R>& m : scene.materials) materials.push_back(m.zero());
        for (const AnyLight<R>& light : scene.lights) lights.push_back(zero_gradient(light));
        for (const Medium<R>& m : scene.media) media.push_back(m.zero());
    }
    /// What is left when dense blocks have been added up.
    [[nodiscard]] SceneGradient lookups() && {
        SceneGradient out;
        out.lights = std::move(lights);
        out.texels = std::move(texels);
        out.densities = std::move(densities);
        return out;
    }
    /// The lookups of a block of directions.
    [[nodiscard]] const DirectionAdjoint<R>& directions(std::size_t light) const {
        return std::get<DirectionAdjoint<R>>(lights[light].model);
    }
    /// visit(x) for the numbers of all dense blocks, in the order of `gradient_blocks`.
    template <class Visit>
    void for_each_dense(Visit&& visit) {
        R row[max_parameters];
        for (const Material<R>& m : materials) {
            m.get(row);
            for (int i = 0; i < m.parameter_count(); ++i) visit(row[i]);
        }
        for (const Vec3<R>& L : emission)
            for (int c = 0; c < 3; ++c) visit(L[c]);
        for (AnyLightGradient<R>& light : lights) for_each_number(light, visit);
        for (Medium<R>& medium : media) medium.for_each(visit);
    }
    /// visit(x) for each parameter of a light; none of an environment map.
    template <class Visit>
    static void for_each_number(AnyLightGradient<R>& light, Visit&& visit) {
        std::visit(
            [&]<class L>(L& one) {
                if constexpr (requires { L::params; }) for_each_scalar(visit, one);
            },
            light.model);
    }
};

/// All blocks of a scene, dense ones in the order of `for_each_dense`.
template <Real R>
std::vector<GradientBlock<R>> gradient_blocks(const PathScene<R>& scene);

}  // namespace photograd
