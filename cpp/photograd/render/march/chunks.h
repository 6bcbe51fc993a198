// How rays are cut into pieces: chunks that one task marches, and slabs whose samples fit into
// memory. The pieces do not depend on the number of threads.
#pragma once

#include <algorithm>

#include "photograd/core/parallel.h"
#include "photograd/ops/march_data.h"

namespace photograd {

inline constexpr std::int64_t march_slab_samples = 1 << 20;

inline std::int64_t chunk_count(std::int64_t rays, std::int64_t size = march_chunk) {
    return (rays + size - 1) / size;
}

/// visit(chunk, begin, end) in parallel for rays [first, last), `size` of them at a time.
template <class Visit>
void for_chunks(std::int64_t first, std::int64_t last, Visit&& visit,
                std::int64_t size = march_chunk) {
    parallel_for(chunk_count(last - first, size), [&](std::int64_t chunk) {
        const std::int64_t begin = first + chunk * size;
        visit(chunk, begin, std::min(begin + size, last));
    });
}

/// visit(first, last) for slabs of at most march_slab_samples samples, each of at least one chunk
/// of rays.
template <class Visit>
void for_slabs(const std::int32_t* samples, std::int64_t count, Visit&& visit) {
    for (std::int64_t first = 0, last = 0; first < count; first = last) {
        std::int64_t total = 0;
        while (last < count &&
               (last < first + march_chunk || total + samples[last] <= march_slab_samples))
            total += samples[last++];
        visit(first, last);
    }
}

}  // namespace photograd
