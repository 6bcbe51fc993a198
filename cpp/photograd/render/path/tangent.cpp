#include "photograd/render/path/tangent.h"

#include "photograd/light/any_light_tangent.h"
#include "photograd/medium/any_phase_tangent.h"
#include "photograd/render/path/adjoint.h"
#include "photograd/render/path/samples.h"
#include "photograd/scene/material_tangent.h"

namespace photograd {
namespace {

bool any_of(const double* numbers, std::int64_t count) {
    return std::any_of(numbers, numbers + count, [](double x) { return x != 0; });
}

/// t(x) of one event: the derivatives of event_backward, each times how its parameter changes.
Vec3<double> event_tangent(const PathScene<double>& scene, const PathScene<double>& along,
                           const MediumEvent<double>& event) {
    const auto m = static_cast<std::size_t>(event.medium);
    const Medium<double>&medium = scene.media[m], &change = along.media[m];
    if (event.kind == EventKind::transmit) return -change.sigma_t * event.value * event.length;
    const double rho = event.density;
    const double d_rho =
        medium.density ? density_at(scene.geometry->media.grids[m], change.density, event.position)
                       : 0.0;
    const Vec3<double> d_sigma = (change.sigma_t * rho + medium.sigma_t * d_rho) * event.length;
    if (event.kind == EventKind::null_collision) return -d_sigma;
    return change.albedo * medium.sigma_t * (rho * event.length) + medium.albedo * d_sigma;
}

/// A value and its change.
struct Dual3 {
    Vec3<double> value{0.0}, tangent{0.0};
};

/// L and its directional derivative along `along`, a scene of the same geometry that holds the
/// tangents of the numbers of `scene`.
class RadianceTangent {
public:
    RadianceTangent(const PathScene<double>& scene, const PathScene<double>& along)
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

    [[nodiscard]] Dual3 radiance(const Path<double>& path) const {
        Dual3 L;
        for (std::size_t k = path.vertices.size(); k-- > 0;) {
            const PathVertex<double>& v = path.vertices[k];
            const Dual3 Lo = outgoing(path, v, L);
            const Vec3<double>& T = v.arrival.product.value;
            L.value = Lo.value * (T * v.arrival.weight);
            L.tangent =
                (Lo.tangent * T + Lo.value * product(path, v.arrival.product)) * v.arrival.weight;
        }
        return L;
    }

private:
    /// A material at one point, and how it changes there.
    struct PointMaterial {
        Material<double> value, change;
    };
    [[nodiscard]] PointMaterial at(std::size_t material, const Vec2<double>& uv,
                                   const Footprint<double>& footprint) const {
        const SurfaceTextures& textures = scene_.geometry->textures;
        const std::span<const TextureUse> uses = textures.of(material);
        const Material<double>&base = scene_.materials[material],
              &along = along_.materials[material];
        if (uses.empty()) return {base, along};
        return {textured(base, uses, textures, scene_.texels, uv, footprint),
                textured_tangent(base, along, uses, textures, scene_.texels, along_.texels, uv,
                                 footprint)};
    }
    [[nodiscard]] Vec3<double> emission(std::int32_t shape, const Vec2<double>& uv,
                                        const Vec3<double>& direction) const {
        if (shape >= 0) {
            const EmissionUse* use =
                scene_.geometry->textures.emission_texture(static_cast<std::size_t>(shape));
            if (use == nullptr) return along_.emitted(shape);
            return along_.emitted(shape) * scene_.emission_factor(*use, uv) +
                   scene_.emitted(shape) * along_.emission_factor(*use, uv);
        }
        Vec3<double> sum(0);
        for (const std::int32_t i : scene_.geometry->lights.at_infinity()) {
            const auto k = static_cast<std::size_t>(i);
            sum += background_tangent(scene_.lights[k], along_.lights[k], direction);
        }
        return sum;
    }
    [[nodiscard]] Vec3<double> emitter(const EmitterSample<double>& nee) const {
        if (nee.shape != SceneLights::delta) return emission(nee.shape, nee.uv, nee.direction);
        const auto k = static_cast<std::size_t>(nee.light);
        return delta_tangent(scene_.lights[k], along_.lights[k], nee.point);
    }
    [[nodiscard]] double alpha_transmittance(const Path<double>& path,
                                             const EmitterSample<double>& nee) const {
        double t = 0;
        for (std::int32_t i = nee.occluders.first; i < nee.occluders.last; ++i) {
            const Occluder<double>& one = path.occluders[static_cast<std::size_t>(i)];
            const auto m = static_cast<std::size_t>(one.material);
            if (moving_[m])
                t += at(m, one.uv, {}).change.alpha * d_transmittance(path, nee.occluders, i);
        }
        return t;
    }
    [[nodiscard]] Vec3<double> product(const Path<double>& path,
                                       const EventProduct<double>& of) const {
        Vec3<double> t(0);
        for (std::int32_t i = of.events.first; i < of.events.last; ++i) {
            const MediumEvent<double>& event = path.events[static_cast<std::size_t>(i)];
            t = t * event.value + event.before * event_tangent(scene_, along_, event);
        }
        return t;
    }
    /// T^l L^l without occluders; 0 without a sample.
    [[nodiscard]] Dual3 direct(const Path<double>& path, const EmitterSample<double>& nee) const {
        if (!(nee.weight > 0)) return {};
        const Vec3<double> T = nee.shadow.value;
        return {nee.Le * T, emitter(nee) * T + nee.Le * product(path, nee.shadow)};
    }
    /// t(f) Li s + t(f^l) T^l L^l w^l, at a surface and at a scattering event.
    [[nodiscard]] Vec3<double> reflected(const PathVertex<double>& v, const PointMaterial& material,
                                         const Vec3<double>& Li, const Vec3<double>& direct) const {
        Vec3<double> t(0);
        if (v.weight > 0 && v.kind == VertexKind::surface)
            t += value_tangent(material.value, material.change, v.wo, v.wi, v.lobe) * Li * v.weight;
        if (v.nee.weight > 0)
            t += value_tangent(material.value, material.change, v.wo, v.nee.wi, -1) * direct *
                 (v.nee.weight * v.nee.alpha_transmittance);
        return t;
    }
    [[nodiscard]] Vec3<double> scattered(const PathVertex<double>& v, const Vec3<double>& Li,
                                         const Vec3<double>& direct) const {
        const auto m = static_cast<std::size_t>(v.medium);
        const auto t = [&](const Vec3<double>& wi) {
            return phase_tangent(*scene_.media[m].phase, *along_.media[m].phase,
                                 dot(v.direction, wi));
        };
        Vec3<double> sum(0);
        if (v.weight > 0) sum += Li * (t(v.wi) * v.weight);
        if (v.nee.weight > 0)
            sum += direct * (t(v.nee.wi) * v.nee.weight * v.nee.alpha_transmittance);
        return sum;
    }
    [[nodiscard]] Dual3 outgoing(const Path<double>& path, const PathVertex<double>& v,
                                 const Dual3& Li) const {
        const Vec3<double> U = scattered_radiance(v, Li.value);
        const Dual3 lit = direct(path, v.nee);
        Vec3<double> t = Li.tangent * (v.f * v.weight);
        double d_opacity = 0;
        if (v.shape >= 0) {
            const auto m = static_cast<std::size_t>(
                scene_.geometry->material[static_cast<std::size_t>(v.shape)]);
            if (moving_[m]) {
                const PointMaterial material = at(m, v.uv, v.footprint);
                t += reflected(v, material, Li.value, lit.value);
                d_opacity = v.d_opacity * material.change.alpha;
            }
        } else if (v.kind == VertexKind::medium) {
            t += scattered(v, Li.value, lit.value);
        }
        if (v.nee.weight > 0)
            t += v.nee.f *
                 (lit.tangent * v.nee.alpha_transmittance +
                  lit.value * alpha_transmittance(path, v.nee)) *
                 v.nee.weight;
        if (v.emission_weight > 0) t += emission(v.shape, v.uv, v.direction) * v.emission_weight;
        return {U * v.opacity_weight, t * v.opacity_weight + U * d_opacity};
    }

    const PathScene<double>&scene_, &along_;
    std::vector<bool> moving_;  // of each material: whether anything of it changes
};

}  // namespace

void trace_paths_tangent(const PathScene<double>& scene, const PathScene<double>& along,
                         const ThinLens& camera, const PathOptions& options,
                         const SampleRange& samples, const PathSums& picture,
                         const PathSums& tangent) {
    const RadianceTangent both(scene, along);
    for_each_chunk(camera, [&](std::int64_t begin, std::int64_t end) {
        for_each_path<double>(scene, camera, options, samples, {}, false, begin, end,
                              [&](std::int64_t pixel, const Path<double>& path) {
                                  const Dual3 L = both.radiance(path);
                                  picture.add(pixel, L.value);
                                  tangent.add(pixel, L.tangent);
                              });
    });
}

}  // namespace photograd
