#include "photograd/render/path.h"

#include "photograd/core/scatter.h"
#include "photograd/render/path_walk.h"
#include "photograd/texture/sample.h"

namespace photograd {
namespace {

constexpr std::int64_t chunk_pixels = 64;  // of one task

RandomKey key_of(const PathOptions& options, std::int64_t pixel, std::uint32_t sample) {
    return {options.seed, 0, static_cast<std::uint32_t>(pixel), sample};
}

/// visit(pixel, path) for every sample of the pixels [begin, end), pixel by pixel. Lanes hold successive samples.
template <class R, class Visit>
void for_each_path(const PathScene<R>& scene, const ThinLens& camera, const PathOptions& options,
                   const SampleRange& samples, bool stop_when_black, std::int64_t begin,
                   std::int64_t end, Visit&& visit) {
    constexpr int width = RayPacket::width;
    PathWalk<R> walk(scene, options, stop_when_black);
    const std::int64_t total = (end - begin) * samples.count;
    for (std::int64_t first = 0; first < total; first += width) {
        const int count = static_cast<int>(std::min<std::int64_t>(width, total - first));
        Ray<R> rays[width];
        RandomKey keys[width];
        for (int k = 0; k < count; ++k) {
            const std::int64_t i = first + k;
            keys[k] = key_of(options, begin + i / samples.count,
                             samples.first + static_cast<std::uint32_t>(i % samples.count));
            rays[k] = camera_ray<R>(camera, keys[k]);
        }
        walk.trace(rays, keys, count);
        for (int k = 0; k < count; ++k) visit(begin + (first + k) / samples.count, walk.path(k));
    }
}

/// All derivatives of a chunk, in double, in the order materials, emission, environment.
template <class R>
void add_to(const PathGradient<R>& gradient, double* out) {
    for (const Material<R>& m : gradient.materials) {
        m.add_to(out);
        out += m.parameter_count();
    }
    const auto add = [&](const Vec3<R>& v) {
        for (int c = 0; c < 3; ++c) *out++ += static_cast<double>(v[c]);
    };
    for (const Vec3<R>& v : gradient.emission) add(v);
    add(gradient.sky.zenith);
    add(gradient.sky.horizon);
    add(gradient.sky.ground);
}

}  // namespace

template <Real R>
void trace_paths(const PathScene<R>& scene, const ThinLens& camera, const PathOptions& options,
                 const SampleRange& samples, const PathSums& sums) {
    const std::int64_t pixels = static_cast<std::int64_t>(camera.width) * camera.height;
    parallel_for((pixels + chunk_pixels - 1) / chunk_pixels, [&](std::int64_t chunk) {
        const std::int64_t begin = chunk * chunk_pixels,
                           end = std::min(begin + chunk_pixels, pixels);
        for_each_path(scene, camera, options, samples, scene.drawn_as_sampled(), begin, end,
                      [&](std::int64_t pixel, const Path<R>& path) {
                          const Vec3<R> L = gather<R>(scene, path, nullptr);
                          for (int c = 0; c < 3; ++c) {
                              const double value = static_cast<double>(L[c]);
                              sums.radiance[3 * pixel + c] += value;
                              sums.squares[3 * pixel + c] += value * value;
                          }
                      });
    });
}

namespace {

/// Pixels of a chunk, and chunks of a slab. Without textures there is one slab, of a fixed number of chunks at most, so
/// that their partial sums stay small. Textures have records of single lookups, which are added up slab by slab: about
/// 65 000 paths, whatever the number of threads.
struct Pieces {
    std::int64_t chunk, chunks, slab;

    Pieces(std::int64_t pixels, std::uint32_t samples, bool with_textures) {
        chunk = with_textures ? std::max<std::int64_t>(1, 2048 / samples)
                              : std::max(chunk_pixels, (pixels + 2047) / 2048);
        chunks = (pixels + chunk - 1) / chunk;
        slab = with_textures ? 32 : chunks;
    }
};

/// d_texels += the records of a slab, in the order of its chunks; each texel has one owner (texture/tile.h).
template <class R>
void add_texels(const SurfaceTextures& textures, std::span<const R* const> texels,
                std::vector<std::vector<TexelAdjoint<R>>>& records, std::span<R* const> d_texels) {
    for (std::size_t t = 0; t < d_texels.size(); ++t) {
        TexelAdjoint<R> all;
        for (std::vector<TexelAdjoint<R>>& of_chunk : records) {
            if (of_chunk.empty()) continue;
            const TexelAdjoint<R>& own = of_chunk[t];
            all.uv.insert(all.uv.end(), own.uv.begin(), own.uv.end());
            all.d_color.insert(all.d_color.end(), own.d_color.begin(), own.d_color.end());
        }
        const TextureLayout& layout = textures.layouts[t];
        if (!all.uv.empty())
            sample_backward<R>({texels[t], layout.shape, layout.channels}, all.uv.data(),
                               static_cast<std::int64_t>(all.uv.size() / 2), all.d_color.data(),
                               d_texels[t], nullptr);
    }
}

}  // namespace

template <Real R>
void trace_paths_backward(const PathScene<R>& scene, const ThinLens& camera,
                          const PathOptions& options, const SampleRange& samples,
                          const double* d_image, R* d_parameters, R* d_emission, R* d_sky,
                          std::span<R* const> d_texels) {
    const std::int64_t pixels = static_cast<std::int64_t>(camera.width) * camera.height;
    const Pieces pieces(pixels, samples.count, !d_texels.empty());
    std::size_t parameters = 0;
    for (const Material<R>& m : scene.materials)
        parameters += static_cast<std::size_t>(m.parameter_count());
    const std::size_t emission = 3 * scene.geometry->shape_count();
    std::vector<R> total(parameters + emission + 9, R(0));
    const double share = 1.0 / samples.count;
    for (std::int64_t start = 0; start < pieces.chunks; start += pieces.slab) {
        const std::int64_t count = std::min(pieces.slab, pieces.chunks - start);
        std::vector<std::vector<TexelAdjoint<R>>> records(static_cast<std::size_t>(count));
        sum_partials<R>(count, std::span<R>(total), [&](std::int64_t i, std::span<double> partial) {
            PathGradient<R> gradient(scene);
            std::vector<Vec3<R>> ahead(static_cast<std::size_t>(options.max_depth));
            const std::int64_t first = (start + i) * pieces.chunk;
            for_each_path(scene, camera, options, samples, false, first,
                          std::min(first + pieces.chunk, pixels),
                          [&](std::int64_t pixel, const Path<R>& path) {
                              const double* d = d_image + 3 * pixel;
                              const Vec3<R> d_L(R(d[0] * share), R(d[1] * share), R(d[2] * share));
                              gather<R>(scene, path, ahead.data());
                              gather_backward<R>(scene, path, ahead.data(), d_L, gradient);
                          });
            add_to(gradient, partial.data());
            records[static_cast<std::size_t>(i)] = std::move(gradient.texels);
        });
        add_texels<R>(scene.geometry->textures, scene.texels, records, d_texels);
    }
    const R* next = total.data();
    for (std::size_t k = 0; k < parameters; ++k) d_parameters[k] += *next++;
    for (std::size_t k = 0; k < emission; ++k) d_emission[k] += *next++;
    for (std::size_t k = 0; k < 9; ++k) d_sky[k] += *next++;
}

template <Real R>
Path<R> trace_path(const PathScene<R>& scene, const ThinLens& camera, const PathOptions& options,
                   std::uint32_t pixel, std::uint32_t sample) {
    const RandomKey key = key_of(options, pixel, sample);
    const Ray<R> ray = camera_ray<R>(camera, key);
    PathWalk<R> walk(scene, options, false);
    walk.trace(&ray, &key, 1);
    return walk.path(0);
}

template void trace_paths(const PathScene<float>&, const ThinLens&, const PathOptions&,
                          const SampleRange&, const PathSums&);
template void trace_paths(const PathScene<double>&, const ThinLens&, const PathOptions&,
                          const SampleRange&, const PathSums&);
template void trace_paths_backward(const PathScene<float>&, const ThinLens&, const PathOptions&,
                                   const SampleRange&, const double*, float*, float*, float*,
                                   std::span<float* const>);
template void trace_paths_backward(const PathScene<double>&, const ThinLens&, const PathOptions&,
                                   const SampleRange&, const double*, double*, double*, double*,
                                   std::span<double* const>);
template Path<float> trace_path(const PathScene<float>&, const ThinLens&, const PathOptions&,
                                std::uint32_t, std::uint32_t);
template Path<double> trace_path(const PathScene<double>&, const ThinLens&, const PathOptions&,
                                 std::uint32_t, std::uint32_t);

}  // namespace photograd
