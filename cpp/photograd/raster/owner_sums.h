// Sums of contributions by owner, for gradients: of pixels to triangles, of triangles to vertices.
#pragma once

#include <cstdint>
#include <span>

#include "photograd/core/scatter.h"

namespace photograd {

/// out[k][j] += sum of rows[i][j] over the items i that k owns, in their order; rows of `width`.
/// An item whose owner is `owners` belongs to nobody. The same bits on any number of threads.
inline void add_to_owners(std::span<const std::uint32_t> owner, std::int64_t owners,
                          const double* rows, std::int64_t width, double* out) {
    OwnerBins bins;
    bin_by_owner(owner, static_cast<int>(owners) + 1, bins);
    constexpr std::int64_t piece = 1024;
    parallel_for((owners + piece - 1) / piece, [&](std::int64_t p) {
        for (std::int64_t k = p * piece; k < std::min(owners, (p + 1) * piece); ++k) {
            const auto at = static_cast<std::size_t>(k);
            for (std::uint32_t n = bins.begin[at]; n < bins.begin[at + 1]; ++n) {
                const double* row = rows + width * std::int64_t{bins.order[n]};
                for (std::int64_t j = 0; j < width; ++j) out[width * k + j] += row[j];
            }
        }
    });
}

}  // namespace photograd
