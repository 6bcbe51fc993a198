// How derivatives of many paths are added up: chunk by chunk of a picture's pixels, in an order that no thread changes.
#pragma once

#include <functional>

#include "photograd/render/path.h"

namespace photograd {

/// Adds the derivatives of the pixels [begin, end), of those of their samples that lie in the range.
template <Real R>
using ChunkWork = std::function<void(const SampleRange& samples, std::int64_t begin,
                                     std::int64_t end, PathGradient<R>& gradient)>;

/// Does the work for all `pixels` of up to `most` samples each and adds what it finds to `out`. What is held at a time
/// does not grow with their numbers, unless the samples of a pixel must stay together: `whole`.
template <Real R>
void add_chunks(const PathScene<R>& scene, std::int64_t pixels, std::uint32_t most, bool whole,
                const ChunkWork<R>& work, const PathDerivatives<R>& out);

}  // namespace photograd
