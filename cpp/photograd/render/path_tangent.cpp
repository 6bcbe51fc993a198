#include "photograd/render/path_tangent.h"

#include "photograd/core/parallel.h"
#include "photograd/light/any_light_tangent.h"
#include "photograd/render/path_samples.h"
#include "photograd/scene/material_tangent.h"

namespace photograd {
namespace {

bool any_of(const double* numbers, std::int64_t count) {
    return std::any_of(numbers, numbers + count, [](double x) { return x != 0; });
}

void add(const Vec3<double>& L, std::int64_t pixel, const PathSums& sums) {
    for (int c = 0; c < 3; ++c) {
        sums.radiance[3 * pixel + c] += L[c];
        sums.squares[3 * pixel + c] += L[c] * L[c];
    }
}

}  // namespace

PathTangent::PathTangent(const PathScene<double>& scene, const PathScene<double>& along)
    : scene_(scene), along_(along), moving_(along.materials.size()) {
    const SurfaceTextures& textures = scene.geometry->textures;
    for (std::size_t m = 0; m < moving_.size(); ++m) {
        double row[max_parameters];
        along.materials[m].get(row);
        bool moving = any_of(row, along.materials[m].parameter_count());
        for (const TextureUse& use : textures.of(m)) {
            const auto t = static_cast<std::size_t>(use.texture);
            const TextureLayout& layout = textures.layouts[t];
            moving = moving || any_of(along.texels[t], layout.shape.texels() * layout.channels);
        }
        moving_[m] = moving;
    }
}

Vec3<double> PathTangent::emitted(std::int32_t shape, const Vec3<double>& direction) const {
    if (shape >= 0) return along_.emitted(shape);
    Vec3<double> sum(0);
    for (const std::int32_t i : scene_.geometry->lights.at_infinity()) {
        const auto k = static_cast<std::size_t>(i);
        sum += background_tangent(scene_.lights[k], along_.lights[k], direction);
    }
    return sum;
}

Vec3<double> PathTangent::sent(const LightVertex<double>& light) const {
    if (light.shape != SceneLights::delta) return emitted(light.shape, light.direction);
    const auto k = static_cast<std::size_t>(light.listed);
    return delta_tangent(scene_.lights[k], along_.lights[k], light.point);
}

PathTangent::Pair PathTangent::gather(const Path<double>& path) const {
    Vec3<double> L(0), t(0);
    for (std::size_t k = path.size(); k-- > 0;) {
        const PathVertex<double>& v = path[k];
        const bool lit = v.light.weight > 0, goes_on = v.weight > 0;
        t *= v.value * v.weight;
        if (v.shape >= 0 && (lit || goes_on)) {
            const auto m = static_cast<std::size_t>(
                scene_.geometry->material[static_cast<std::size_t>(v.shape)]);
            if (moving_[m]) {
                const SurfaceTextures& textures = scene_.geometry->textures;
                const std::span<const TextureUse> uses = textures.of(m);
                Material<double> here = scene_.materials[m], change = along_.materials[m];
                if (!uses.empty()) {
                    change = textured_tangent(here, change, uses, textures, scene_.texels,
                                              along_.texels, v.uv);
                    here = textured(here, uses, textures, scene_.texels, v.uv);
                }
                if (goes_on) t += value_tangent(here, change, v.wo, v.wi, v.lobe) * L * v.weight;
                if (lit)
                    t += value_tangent(here, change, v.wo, v.light.wi, -1) * v.light.sent *
                         v.light.weight;
            }
        }
        if (lit) t += v.light.f * sent(v.light) * v.light.weight;
        if (v.emission_weight > 0) t += emitted(v.shape, v.direction) * v.emission_weight;
        L *= v.value * v.weight;
        if (lit) L += v.light.f * v.light.sent * v.light.weight;
        if (v.emission_weight > 0) L += v.emitted * v.emission_weight;
    }
    return {L, t};
}

void trace_paths_tangent(const PathScene<double>& scene, const PathScene<double>& along,
                         const ThinLens& camera, const PathOptions& options,
                         const SampleRange& samples, const PathSums& picture,
                         const PathSums& tangent) {
    const PathTangent both(scene, along);
    const std::int64_t pixels = static_cast<std::int64_t>(camera.width) * camera.height;
    parallel_for((pixels + chunk_pixels - 1) / chunk_pixels, [&](std::int64_t chunk) {
        const std::int64_t begin = chunk * chunk_pixels,
                           end = std::min(begin + chunk_pixels, pixels);
        for_each_path(scene, camera, options, samples, {}, false, begin, end,
                      [&](std::int64_t pixel, const Path<double>& path) {
                          const PathTangent::Pair found = both.gather(path);
                          add(found.value, pixel, picture);
                          add(found.tangent, pixel, tangent);
                      });
    });
}

}  // namespace photograd
