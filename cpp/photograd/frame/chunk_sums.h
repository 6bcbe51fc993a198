// Loops over the pixels of a frame, and sums over all of them that are the same bits on any number
// of threads.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "photograd/core/parallel.h"

namespace photograd {

/// visit(chunk, first, last) for chunks of the items [0, count).
template <class Visit>
void for_chunks(std::int64_t count, Visit&& visit) {
    constexpr std::int64_t size = 2048;
    parallel_for((count + size - 1) / size, [&](std::int64_t chunk) {
        visit(chunk, chunk * size, std::min(count, (chunk + 1) * size));
    });
}

/// sums (width) += what visit(first, last, own) adds to the sums of its chunk; in their order.
template <class R, class Visit>
void add_chunk_sums(std::int64_t count, int width, R* sums, Visit&& visit) {
    const auto columns = static_cast<std::size_t>(width);
    std::vector<R> own((static_cast<std::size_t>(count) / 2048 + 1) * columns, R(0));
    for_chunks(count, [&](std::int64_t chunk, std::int64_t first, std::int64_t last) {
        visit(first, last, own.data() + static_cast<std::size_t>(chunk) * columns);
    });
    for (std::size_t i = 0; i < own.size(); ++i) sums[i % columns] += own[i];
}

}  // namespace photograd
