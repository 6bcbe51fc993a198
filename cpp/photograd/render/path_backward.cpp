#include <vector>

#include "photograd/core/scatter.h"
#include "photograd/light/environment_gradient.h"
#include "photograd/medium/density_gradient.h"
#include "photograd/render/path_chunks.h"
#include "photograd/render/path_samples.h"
#include "photograd/render/volume_path.h"
#include "photograd/texture/sample.h"

namespace photograd {
namespace {

// Each chunk sums up in double what has few parameters; chunks are added in order. Texels are many, so that directions
// in which maps were seen are kept, and scattered by the owners of texels. Both are done slab by slab.
constexpr std::int64_t slab_paths = 1 << 18, fewest_chunks = 16, most_chunks = 2048;
constexpr std::uint32_t samples_at_once = 256;  // of a pixel, where there are maps
// A path looks into a grid of densities at many points, all of which are kept: fewer paths.
constexpr std::int64_t slab_paths_in_grids = 1 << 14;
constexpr std::uint32_t samples_in_grids = 16;

/// What of a chunk goes to texels: of maps, for each light of the list, of textures, and of media's grids.
template <class R>
struct Seen {
    std::vector<SeenDirections<R>> directions;
    std::vector<TexelAdjoint<R>> lookups;
    std::vector<DensityAdjoint<R>> densities;
};

template <class R>
bool is_map(const AnyLight<R>& light) {
    return std::holds_alternative<Environment<R>>(light.model);
}

/// Derivatives of everything but texels, as one row: materials, emission, lights, media.
template <class R>
class DerivativeRow {
public:
    explicit DerivativeRow(const PathScene<R>& scene)
        : emission_(3 * scene.geometry->shape_count()), sums_(emission_, 0.0) {
        PathGradient<R> zero(scene);
        std::size_t parameters = 0;
        for (const Material<R>& m : zero.materials)
            parameters += static_cast<std::size_t>(m.parameter_count());
        for (auto& light : zero.lights) for_each_number(light, [&](R) { ++parameters; });
        for (Medium<R>& medium : zero.media) medium.for_each([&](R) { ++parameters; });
        sums_.resize(emission_ + parameters, 0.0);
    }
    [[nodiscard]] std::span<double> sums() { return sums_; }

    static void put(PathGradient<R>& from, double* to) {
        for (const Material<R>& m : from.materials) {
            m.add_to(to);
            to += m.parameter_count();
        }
        for (const Vec3<R>& v : from.emission)
            for (int c = 0; c < 3; ++c) *to++ += static_cast<double>(v[c]);
        for (auto& light : from.lights)
            for_each_number(light, [&](R x) { *to++ += static_cast<double>(x); });
        for (Medium<R>& medium : from.media)
            medium.for_each([&](R x) { *to++ += static_cast<double>(x); });
    }
    void add_to(const PathScene<R>& scene, const PathDerivatives<R>& out) const {
        const double* next = sums_.data();
        const auto take = [&](R* to, std::size_t count) {
            for (std::size_t k = 0; k < count; ++k) to[k] += static_cast<R>(*next++);
        };
        std::size_t parameters = 0;
        for (const Material<R>& m : scene.materials)
            parameters += static_cast<std::size_t>(m.parameter_count());
        take(out.parameters, parameters);
        take(out.emission, emission_);
        for (std::size_t i = 0; i < scene.lights.size(); ++i) {
            auto zero = zero_gradient(scene.lights[i]);
            std::size_t count = 0;
            for_each_number(zero, [&](R) { ++count; });
            take(out.lights[i], count);
        }
        for (std::size_t i = 0; i < scene.media.size(); ++i)
            take(out.media[i], static_cast<std::size_t>(scene.media[i].parameter_count()));
    }

private:
    template <class Visit>
    static void for_each_number(AnyLightGradient<R>& any, Visit&& visit) {
        std::visit(
            [&]<class L>(L& light) {
                if constexpr (requires { L::params; }) for_each_scalar(visit, light);
            },
            any.model);
    }

    std::size_t emission_;
    std::vector<double> sums_;
};

/// The texels' part of a slab: directions of all chunks in order, each texel's added by its owner.
template <class R>
void scatter_directions(const Environment<R>& map, std::size_t light,
                        const std::vector<Seen<R>>& chunks, std::vector<double>& d_texels) {
    std::vector<double> w, d_L;
    for (const Seen<R>& of_chunk : chunks) {
        const SeenDirections<R>& seen = of_chunk.directions[light];
        w.insert(w.end(), seen.w.begin(), seen.w.end());
        d_L.insert(d_L.end(), seen.d_L.begin(), seen.d_L.end());
    }
    const Environment<double> wide{nullptr, map.height, Mat3<double>(map.world_from_map), nullptr};
    environment_backward(wide, w.data(), d_L.data(), static_cast<std::int64_t>(w.size() / 3),
                         d_texels.data());
}

/// The same of textures, by the owners of their texels (texture/tile.h).
template <class R>
void scatter_lookups(const PathScene<R>& scene, const std::vector<Seen<R>>& chunks,
                     std::span<R* const> d_textures) {
    for (std::size_t t = 0; t < d_textures.size(); ++t) {
        TexelAdjoint<R> all;
        for (const Seen<R>& of_chunk : chunks) all.append(of_chunk.lookups[t]);
        const TextureLayout& layout = scene.geometry->textures.layouts[t];
        if (!all.level.empty())
            packed_levels_backward<R>(layout.mips, scene.texels[t], layout.channels, all.uv,
                                      all.level, all.d_color, d_textures[t]);
        else if (!all.uv.empty())
            sample_backward<R>({scene.texels[t], layout.shape, layout.channels}, all.uv.data(),
                               static_cast<std::int64_t>(all.uv.size() / 2), all.d_color.data(),
                               d_textures[t], nullptr);
    }
}

/// The same of media's grids, by the owners of their voxels (medium/density_gradient.h).
template <class R>
void scatter_densities(const PathScene<R>& scene, const std::vector<Seen<R>>& chunks,
                       std::vector<std::vector<double>>& d_densities) {
    for (std::size_t m = 0; m < d_densities.size(); ++m) {
        if (d_densities[m].empty()) continue;
        DensityAdjoint<R> all;
        for (const Seen<R>& of_chunk : chunks) {
            const DensityAdjoint<R>& own = of_chunk.densities[m];
            all.world.insert(all.world.end(), own.world.begin(), own.world.end());
            all.d_density.insert(all.d_density.end(), own.d_density.begin(), own.d_density.end());
        }
        density_backward(scene.geometry->media.grids[m], all, d_densities[m].data());
    }
}

/// Adds one chunk's derivatives to `row` and returns what goes to texels.
template <class R>
Seen<R> chunk_backward(const PathScene<R>& scene, const ChunkWork<R>& work,
                       const SampleRange& samples, std::int64_t begin, std::int64_t end,
                       double* row) {
    PathGradient<R> gradient(scene);
    work(samples, begin, end, gradient);
    DerivativeRow<R>::put(gradient, row);
    Seen<R> seen{std::vector<SeenDirections<R>>(scene.lights.size()), std::move(gradient.texels),
                 std::move(gradient.densities)};
    for (std::size_t i = 0; i < seen.directions.size(); ++i)
        if (is_map(scene.lights[i]))
            seen.directions[i] = std::move(std::get<SeenDirections<R>>(gradient.lights[i].model));
    return seen;
}

}  // namespace

template <Real R>
void add_chunks(const PathScene<R>& scene, std::int64_t pixels, std::uint32_t most, bool whole,
                const ChunkWork<R>& work, const PathDerivatives<R>& out) {
    const std::int64_t chunks = (pixels + chunk_pixels - 1) / chunk_pixels;
    DerivativeRow<R> row(scene);
    std::vector<std::vector<double>> texels(scene.lights.size());
    bool maps = !out.textures.empty();  // or textures: something that has texels
    for (std::size_t i = 0; i < texels.size(); ++i)
        if (const auto* map = std::get_if<Environment<R>>(&scene.lights[i].model)) {
            const auto height = static_cast<std::size_t>(map->height);
            texels[i].assign(6 * height * height, 0.0);
            maps = true;
        }
    std::vector<std::vector<double>> densities(scene.media.size());
    bool grids = false;
    for (std::size_t m = 0; m < densities.size(); ++m)
        if (scene.media[m].density) {
            const auto voxels = scene.geometry->media.grids[m].shape.size();
            densities[m].assign(static_cast<std::size_t>(voxels), 0.0);
            maps = grids = true;
        }
    const std::uint32_t at_once = grids ? samples_in_grids : samples_at_once;
    const std::uint32_t batch = maps && !whole ? std::min(at_once, most) : most;
    const std::int64_t paths = grids ? slab_paths_in_grids : slab_paths;
    const std::int64_t slab =
        maps ? std::clamp(paths / (chunk_pixels * batch), fewest_chunks, most_chunks) : most_chunks;
    for (std::uint32_t done = 0; done < most; done += batch) {
        const SampleRange now{done, std::min(batch, most - done)};
        for (std::int64_t first = 0; first < chunks; first += slab) {
            const std::int64_t count = std::min(slab, chunks - first);
            std::vector<Seen<R>> seen(static_cast<std::size_t>(count));
            sum_partials<double>(count, row.sums(), [&](std::int64_t i, std::span<double> partial) {
                const std::int64_t begin = (first + i) * chunk_pixels;
                seen[static_cast<std::size_t>(i)] =
                    chunk_backward(scene, work, now, begin, std::min(begin + chunk_pixels, pixels),
                                   partial.data());
            });
            for (std::size_t k = 0; k < texels.size(); ++k)
                if (const auto* map = std::get_if<Environment<R>>(&scene.lights[k].model))
                    scatter_directions(*map, k, seen, texels[k]);
            scatter_lookups(scene, seen, out.textures);
            scatter_densities(scene, seen, densities);
        }
    }
    row.add_to(scene, out);
    for (std::size_t i = 0; i < texels.size(); ++i)
        for (std::size_t k = 0; k < texels[i].size(); ++k)
            out.lights[i][k] += static_cast<R>(texels[i][k]);
    for (std::size_t m = 0; m < densities.size(); ++m)
        for (std::size_t k = 0; k < densities[m].size(); ++k)
            out.densities[m][k] += static_cast<R>(densities[m][k]);
}

template <Real R>
void trace_paths_backward(const PathScene<R>& scene, const ThinLens& camera,
                          const PathOptions& options, std::uint32_t spp,
                          const std::uint32_t* own_counts, const double* d_image,
                          const PathDerivatives<R>& out) {
    const std::int64_t pixels = static_cast<std::int64_t>(camera.width) * camera.height;
    const SampleCounts counts{own_counts, spp};
    const auto d_radiance = [&](std::int64_t pixel) {
        const double* d = d_image + 3 * pixel;
        const double share = 1.0 / counts.of(pixel);
        return Vec3<R>(R(d[0] * share), R(d[1] * share), R(d[2] * share));
    };
    const auto work = [&](const SampleRange& samples, std::int64_t begin, std::int64_t end,
                          PathGradient<R>& gradient) {
        std::vector<Vec3<R>> ahead(static_cast<std::size_t>(options.max_depth));
        if (scene.geometry->media.any())
            for_each_volume_path<R>(
                scene, camera, options, samples, counts, false, begin, end,
                [&](std::int64_t pixel, const Path<R>& path, const MediaTrail<R>& trail) {
                    gather_through<R>(path, trail, ahead.data());
                    gather_through_backward<R>(scene, path, trail, ahead.data(), d_radiance(pixel),
                                               gradient);
                });
        else
            for_each_path(scene, camera, options, samples, counts, false, begin, end,
                          [&](std::int64_t pixel, const Path<R>& path) {
                              gather<R>(path, ahead.data());
                              gather_backward<R>(scene, path, ahead.data(), d_radiance(pixel),
                                                 gradient);
                          });
    };
    add_chunks<R>(scene, pixels, counts.most_of(0, pixels), false, work, out);
}

template void add_chunks(const PathScene<float>&, std::int64_t, std::uint32_t, bool,
                         const ChunkWork<float>&, const PathDerivatives<float>&);
template void add_chunks(const PathScene<double>&, std::int64_t, std::uint32_t, bool,
                         const ChunkWork<double>&, const PathDerivatives<double>&);
template void trace_paths_backward(const PathScene<float>&, const ThinLens&, const PathOptions&,
                                   std::uint32_t, const std::uint32_t*, const double*,
                                   const PathDerivatives<float>&);
template void trace_paths_backward(const PathScene<double>&, const ThinLens&, const PathOptions&,
                                   std::uint32_t, const std::uint32_t*, const double*,
                                   const PathDerivatives<double>&);

}  // namespace photograd
