// Accumulation into shared gradients, the only way it is done. No atomics: an atomic float sum
// depends on who comes first. Three schemes, all with the same bits for any number of threads:
//
//   bin_by_owner   contributions are sorted by the owner of their target (a brick, a texel, a
//                  Gaussian) in a stable order; one task per owner adds its own in that order
//   one table per task  (a hash level): the caller's loop, nothing to share
//   sum_partials   parameters that every ray touches (network weights, pose, background): a fixed
//                  number of chunks each sum in double, and the chunks are added in order
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "photograd/core/parallel.h"

namespace photograd {

/// Contributions grouped by owner: those of owner k are order[begin[k]] .. order[begin[k + 1] - 1].
struct OwnerBins {
    std::vector<std::uint32_t> begin;
    std::vector<std::uint32_t> order;
};

/// Stable counting sort of the contributions i in `items` by owner_of(i) in [0, owners).
/// `items` lists contribution numbers in their fixed order; buffers of `bins` are reused.
template <class OwnerOf>
void bin_by_owner(std::span<const std::uint32_t> items, int owners, OwnerOf&& owner_of,
                  OwnerBins& bins) {
    bins.begin.assign(static_cast<std::size_t>(owners) + 2, 0);
    bins.order.resize(items.size());
    for (const std::uint32_t i : items) ++bins.begin[owner_of(i) + 2];
    for (std::size_t k = 2; k < bins.begin.size(); ++k) bins.begin[k] += bins.begin[k - 1];
    // begin[k + 1] walks from the start of owner k to its end, which is the start of owner k + 1.
    for (const std::uint32_t i : items) bins.order[bins.begin[owner_of(i) + 1]++] = i;
    bins.begin.pop_back();
}

/// bin_by_owner of all contributions 0, 1, ..., with owner[i] of each, on all threads: pieces of
/// fixed size count their contributions and then write them to their slots.
inline void bin_by_owner(std::span<const std::uint32_t> owner, int owners, OwnerBins& bins) {
    const std::size_t kinds = static_cast<std::size_t>(owners), n = owner.size();
    // No smaller than the number of owners, so that all counts together are no longer than `owner`.
    const std::size_t piece = std::max<std::size_t>(kinds, 1 << 16);
    const std::size_t pieces = (n + piece - 1) / piece;
    std::vector<std::uint32_t> next(pieces * kinds, 0);  // of piece p for owner k: at p * kinds + k
    const auto for_pieces = [&](auto&& visit) {
        parallel_for(static_cast<std::int64_t>(pieces), [&](std::int64_t p) {
            const std::size_t begin = static_cast<std::size_t>(p) * piece;
            std::uint32_t* own = next.data() + static_cast<std::size_t>(p) * kinds;
            for (std::size_t i = begin; i < std::min(begin + piece, n); ++i) visit(own, i);
        });
    };
    for_pieces([&](std::uint32_t* own, std::size_t i) { ++own[owner[i]]; });
    bins.begin.assign(kinds + 1, 0);
    std::uint32_t slot = 0;
    for (std::size_t k = 0; k < kinds; ++k) {
        bins.begin[k] = slot;
        for (std::size_t p = 0; p < pieces; ++p) slot += std::exchange(next[p * kinds + k], slot);
    }
    bins.begin[kinds] = slot;
    bins.order.resize(n);
    for_pieces([&](std::uint32_t* own, std::size_t i) {
        bins.order[own[owner[i]]++] = static_cast<std::uint32_t>(i);
    });
}

/// total[p] += sum over chunks, in order, of partial[p], which add(chunk, partial) adds to zeros.
template <class R, class Add>
void sum_partials(std::int64_t chunks, std::span<R> total, Add&& add) {
    const std::size_t size = total.size();
    std::vector<double> partials(static_cast<std::size_t>(chunks) * size, 0.0);
    parallel_for(chunks, [&](std::int64_t chunk) {
        add(chunk,
            std::span<double>(partials).subspan(static_cast<std::size_t>(chunk) * size, size));
    });
    for (std::size_t p = 0; p < size; ++p) {
        double sum = 0.0;
        for (std::size_t chunk = 0; chunk < static_cast<std::size_t>(chunks); ++chunk)
            sum += partials[chunk * size + p];
        total[p] += static_cast<R>(sum);
    }
}

}  // namespace photograd
