#include "photograd/render/path/gradient_chunks.h"

#include "photograd/core/scatter.h"
#include "photograd/light/environment_gradient.h"
#include "photograd/medium/density_gradient.h"
#include "photograd/render/path/samples.h"
#include "photograd/texture/sample.h"

namespace photograd {
namespace {

// Each chunk sums up dense blocks in double; chunks are added in order. Texels and voxels are many,
// so that lookups are recorded, and scattered by the owners of texels and voxels. Both are done
// slab by slab.
constexpr std::int64_t slab_paths = 1 << 18, min_chunks = 16, max_chunks = 2048;
constexpr std::uint32_t samples_at_once = 256;  // of a pixel, where there are lookups
// A path has many lookups in a density grid, all of which are recorded: fewer paths.
constexpr std::int64_t slab_paths_in_grids = 1 << 14;
constexpr std::uint32_t samples_in_grids = 16;

/// The part of a picture whose gradients are held at a time.
struct Slabs {
    std::int64_t chunks;
    std::uint32_t samples;

    template <class R>
    Slabs(std::span<const GradientBlock<R>> blocks, std::uint32_t most, bool whole) {
        const auto any = [&](auto&& is) { return std::any_of(blocks.begin(), blocks.end(), is); };
        const bool grids =
            any([](const GradientBlock<R>& b) { return b.kind == BlockKind::voxels; });
        const bool lookups =
            any([](const GradientBlock<R>& b) { return b.kind != BlockKind::dense; });
        const std::uint32_t at_once = grids ? samples_in_grids : samples_at_once;
        samples = lookups && !whole ? std::min(at_once, most) : most;
        const std::int64_t paths = grids ? slab_paths_in_grids : slab_paths;
        chunks = lookups ? std::clamp(paths / (chunk_pixels * samples), min_chunks, max_chunks)
                         : max_chunks;
    }
};

/// Texels of an environment map: directions of all chunks in order, each texel's added by its
/// owner.
template <class R>
void scatter_directions(const PathScene<R>& scene, std::size_t light,
                        const std::vector<SceneGradient<R>>& chunks, double* d_texels) {
    std::vector<double> w, d_L;
    for (const SceneGradient<R>& of_chunk : chunks) {
        const DirectionAdjoint<R>& lookups = of_chunk.directions(light);
        w.insert(w.end(), lookups.w.begin(), lookups.w.end());
        d_L.insert(d_L.end(), lookups.d_L.begin(), lookups.d_L.end());
    }
    const auto& map = std::get<Environment<R>>(scene.lights[light].model);
    const Environment<double> wide{nullptr, map.height, Mat3<double>(map.world_from_map), nullptr};
    environment_backward(wide, w.data(), d_L.data(), static_cast<std::int64_t>(w.size() / 3),
                         d_texels);
}

/// Texels of a texture, each added by its owner (texture/texel_tile.h).
template <class R>
void scatter_texels(const PathScene<R>& scene, std::size_t t,
                    const std::vector<SceneGradient<R>>& chunks, R* d_texels) {
    TexelAdjoint<R> all;
    for (const SceneGradient<R>& of_chunk : chunks) all.append(of_chunk.texels[t]);
    const TextureLayout& layout = scene.geometry->textures.layouts[t];
    if (!all.level.empty())
        packed_levels_backward<R>(layout.mips, scene.texels[t], layout.channels, all.uv, all.level,
                                  all.d_color, d_texels);
    else if (!all.uv.empty())
        sample_backward<R>({scene.texels[t], layout.shape, layout.channels}, all.uv.data(),
                           static_cast<std::int64_t>(all.uv.size() / 2), all.d_color.data(),
                           d_texels, nullptr);
}

/// Voxels of a density grid, each added by its owner (medium/density_gradient.h).
template <class R>
void scatter_voxels(const PathScene<R>& scene, std::size_t m,
                    const std::vector<SceneGradient<R>>& chunks, double* d_values) {
    DensityAdjoint<R> all;
    for (const SceneGradient<R>& of_chunk : chunks) {
        const DensityAdjoint<R>& own = of_chunk.densities[m];
        all.world.insert(all.world.end(), own.world.begin(), own.world.end());
        all.d_density.insert(all.d_density.end(), own.d_density.begin(), own.d_density.end());
    }
    density_backward(scene.geometry->media.grids[m], all, d_values);
}

}  // namespace

template <Real R>
void add_chunks(const PathScene<R>& scene, std::int64_t pixels, std::uint32_t most, bool whole,
                const ChunkWork<R>& work, std::span<const GradientBlock<R>> blocks) {
    const std::int64_t chunks = (pixels + chunk_pixels - 1) / chunk_pixels;
    const Slabs slabs(blocks, most, whole);
    std::size_t dense = 0;
    std::vector<std::vector<double>> wide(blocks.size());  // sums of directions and voxels
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        if (blocks[b].kind == BlockKind::dense) dense += blocks[b].size();
        if (blocks[b].kind == BlockKind::directions || blocks[b].kind == BlockKind::voxels)
            wide[b].assign(blocks[b].size(), 0.0);
    }
    std::vector<double> sums(dense, 0.0);
    for (std::uint32_t done = 0; done < most; done += slabs.samples) {
        const SampleRange now{done, std::min(slabs.samples, most - done)};
        for (std::int64_t first = 0; first < chunks; first += slabs.chunks) {
            const std::int64_t count = std::min(slabs.chunks, chunks - first);
            std::vector<SceneGradient<R>> found(static_cast<std::size_t>(count));
            sum_partials<double>(count, sums, [&](std::int64_t i, std::span<double> partial) {
                const std::int64_t begin = (first + i) * chunk_pixels;
                SceneGradient<R> gradient(scene);
                work(now, begin, std::min(begin + chunk_pixels, pixels), gradient);
                double* next = partial.data();
                gradient.for_each_dense([&](R x) { *next++ += static_cast<double>(x); });
                found[static_cast<std::size_t>(i)] = std::move(gradient).lookups();
            });
            for (std::size_t b = 0; b < blocks.size(); ++b) {
                const std::size_t n = blocks[b].number;
                if (blocks[b].kind == BlockKind::directions)
                    scatter_directions(scene, n, found, wide[b].data());
                else if (blocks[b].kind == BlockKind::texels)
                    scatter_texels(scene, n, found, blocks[b].sum);
                else if (blocks[b].kind == BlockKind::voxels)
                    scatter_voxels(scene, n, found, wide[b].data());
            }
        }
    }
    const double* next = sums.data();
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        if (blocks[b].kind == BlockKind::dense)
            for (std::size_t k = 0; k < blocks[b].size(); ++k)
                blocks[b].sum[k] += static_cast<R>(*next++);
        for (std::size_t k = 0; k < wide[b].size(); ++k)
            blocks[b].sum[k] += static_cast<R>(wide[b][k]);
    }
}

template decltype(add_chunks<float>) add_chunks<float>;
template decltype(add_chunks<double>) add_chunks<double>;

}  // namespace photograd
