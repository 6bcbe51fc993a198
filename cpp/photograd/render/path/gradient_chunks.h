// Sums of the derivatives of many paths: chunk by chunk of a picture's pixels, in an order that
// does not depend on threads.
#pragma once

#include <functional>

#include "photograd/render/path/path.h"

namespace photograd {

/// Adds the derivatives of the pixels [begin, end), of those of their samples that lie in the
/// range.
template <Real R>
using ChunkWork = std::function<void(const SampleRange& samples, std::int64_t begin,
                                     std::int64_t end, SceneGradient<R>& gradient)>;

/// Does the work for all `pixels` of up to `most` samples each and adds what it finds to the sums
/// of `blocks`, all blocks of the scene. Memory does not grow with their numbers, unless the
/// samples of a pixel must stay together: `whole`.
template <Real R>
void add_chunks(const PathScene<R>& scene, std::int64_t pixels, std::uint32_t most, bool whole,
                const ChunkWork<R>& work, std::span<const GradientBlock<R>> blocks);

}  // namespace photograd
