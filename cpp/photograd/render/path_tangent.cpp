#include "photograd/render/path_tangent.h"

#include "photograd/core/parallel.h"
#include "photograd/light/any_light_tangent.h"
#include "photograd/render/path_samples.h"
#include "photograd/render/volume_path.h"
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

PathTangent::Here PathTangent::at(std::size_t material, const Vec2<double>& uv,
                                  const Footprint<double>& seen) const {
    const SurfaceTextures& textures = scene_.geometry->textures;
    const std::span<const TextureUse> uses = textures.of(material);
    const Material<double>&base = scene_.materials[material], &along = along_.materials[material];
    if (uses.empty()) return {base, along};
    return {textured(base, uses, textures, scene_.texels, uv, seen),
            textured_tangent(base, along, uses, textures, scene_.texels, along_.texels, uv, seen)};
}

Vec3<double> PathTangent::emitted(std::int32_t shape, const Vec2<double>& uv,
                                  const Vec3<double>& direction) const {
    if (shape >= 0) {
        const EmissionUse* use = scene_.geometry->textures.glows(static_cast<std::size_t>(shape));
        if (use == nullptr) return along_.emitted(shape);
        return along_.emitted(shape) * scene_.glow(*use, uv) +
               scene_.emitted(shape) * along_.glow(*use, uv);
    }
    Vec3<double> sum(0);
    for (const std::int32_t i : scene_.geometry->lights.at_infinity()) {
        const auto k = static_cast<std::size_t>(i);
        sum += background_tangent(scene_.lights[k], along_.lights[k], direction);
    }
    return sum;
}

Vec3<double> PathTangent::sent(const LightVertex<double>& light) const {
    if (light.shape != SceneLights::delta) return emitted(light.shape, light.uv, light.direction);
    const auto k = static_cast<std::size_t>(light.listed);
    return delta_tangent(scene_.lights[k], along_.lights[k], light.point);
}

PathTangent::Pair PathTangent::from_light(const LightVertex<double>& light) const {
    if (!(light.weight > 0)) return {Vec3<double>(0), Vec3<double>(0)};
    return {light.sent, sent(light)};
}

/// t of what all veils leave, a product.
double PathTangent::through(const LightVertex<double>& light) const {
    double t = 0;
    for (std::size_t i = 0; i < light.veils.size(); ++i) {
        const auto m = static_cast<std::size_t>(light.veils[i].material);
        if (moving_[m]) t += at(m, light.veils[i].uv, {}).change.alpha * veil_slope(light, i);
    }
    return t;
}

/// What f and f^l add to t(U), where the material changes.
Vec3<double> PathTangent::reflected(const PathVertex<double>& v, const Here& here,
                                    const Vec3<double>& ahead, const Vec3<double>& lit) const {
    Vec3<double> t(0);
    if (v.weight > 0 && !v.passed)
        t += value_tangent(here.value, here.change, v.wo, v.wi, v.lobe) * ahead * v.weight;
    if (v.light.weight > 0)
        t += value_tangent(here.value, here.change, v.wo, v.light.wi, -1) * lit *
             (v.light.weight * v.light.through);
    return t;
}

PathTangent::Pair PathTangent::leaving(const PathVertex<double>& v, std::int32_t medium,
                                       const Pair& ahead, const Pair& lit,
                                       const Vec3<double>& U) const {
    Vec3<double> t = ahead.tangent * (v.value * v.weight);
    double d_coverage = 0;
    if (v.shape >= 0) {
        const auto m =
            static_cast<std::size_t>(scene_.geometry->material[static_cast<std::size_t>(v.shape)]);
        if (moving_[m]) {
            const Here here = at(m, v.uv, v.seen);
            t += reflected(v, here, ahead.value, lit.value);
            d_coverage = v.coverage_slope * here.change.alpha;
        }
    } else if (medium >= 0) {
        t += scattered(v, medium, ahead.value, lit.value);
    }
    if (v.light.weight > 0)
        t += v.light.f * (lit.tangent * v.light.through + lit.value * through(v.light)) *
             v.light.weight;
    if (v.emission_weight > 0) t += emitted(v.shape, v.uv, v.direction) * v.emission_weight;
    return {U * v.coverage, t * v.coverage + U * d_coverage};
}

PathTangent::Pair PathTangent::gather(const Path<double>& path) const {
    Pair L{Vec3<double>(0), Vec3<double>(0)};
    for (std::size_t k = path.size(); k-- > 0;) {
        const PathVertex<double>& v = path[k];
        L = leaving(v, MediaGeometry::vacuum, L, from_light(v.light), uncovered(v, L.value));
    }
    return L;
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
        const auto add_both = [&](std::int64_t pixel, const PathTangent::Pair& found) {
            add(found.value, pixel, picture);
            add(found.tangent, pixel, tangent);
        };
        if (scene.geometry->media.any())
            for_each_volume_path<double>(
                scene, camera, options, samples, {}, false, begin, end,
                [&](std::int64_t pixel, const Path<double>& path, const MediaTrail<double>& trail) {
                    add_both(pixel, both.gather_through(path, trail));
                });
        else
            for_each_path(scene, camera, options, samples, {}, false, begin, end,
                          [&](std::int64_t pixel, const Path<double>& path) {
                              add_both(pixel, both.gather(path));
                          });
    });
}

}  // namespace photograd
