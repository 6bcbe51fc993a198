// The ray of one sample of a pixel, at its moment of the shutter.
#pragma once

#include "photograd/camera/thin_lens.h"
#include "photograd/core/random.h"
#include "photograd/render/path/options.h"
#include "photograd/sampling/dimensions.h"
#include "photograd/sampling/warp.h"

namespace photograd {

inline RandomKey key_of(const PathOptions& options, std::int64_t pixel, std::uint32_t sample) {
    return {options.seed, 0, static_cast<std::uint32_t>(pixel), sample};
}

/// When the path sees the world: from 0, when the shutter opens, to 1, when it closes [Cook1984].
/// A function of the key, so that camera, surfaces and media agree on it.
inline double sample_time(const RandomKey& key, PathSampler& sampler) {
    return uniform_from<double>(sampler(key, dimensions::shutter_block)[dimensions::shutter]);
}

/// Uniform over the pixel.
template <class R>
Ray<R> camera_ray(const Pinhole& camera, const RandomKey& key, const Philox4& words) {
    const std::int64_t column = key.pixel % static_cast<std::uint32_t>(camera.width),
                       row = key.pixel / static_cast<std::uint32_t>(camera.width);
    return camera.ray(R(column) + uniform_from<R>(words[dimensions::film_x]),
                      R(row) + uniform_from<R>(words[dimensions::film_y]));
}
/// Uniform over the pixel and the lens.
template <class R>
Ray<R> camera_ray(const ThinLens& camera, const RandomKey& key, const Philox4& words) {
    if (!(camera.radius > 0)) return camera_ray<R>(static_cast<const Pinhole&>(camera), key, words);
    const std::int64_t column = key.pixel % static_cast<std::uint32_t>(camera.width),
                       row = key.pixel / static_cast<std::uint32_t>(camera.width);
    const Vec2<R> u2(uniform_from<R>(words[dimensions::lens_u]),
                     uniform_from<R>(words[dimensions::lens_v]));
    return camera.ray(R(column) + uniform_from<R>(words[dimensions::film_x]),
                      R(row) + uniform_from<R>(words[dimensions::film_y]), square_to_disk(u2));
}

template <class R>
Ray<R> sample_ray(const ThinLens& camera, const RandomKey& key, PathSampler& sampler) {
    const Philox4 words = sampler(key, dimensions::camera_block);
    if (!camera.motion.moves) return camera_ray<R>(camera, key, words);
    return camera_ray<R>(camera.at(sample_time(key, sampler)), key, words);
}

}  // namespace photograd
