#include "photograd/light/environment_gradient.h"

#include <algorithm>
#include <vector>

#include "photograd/core/scatter.h"

namespace photograd {
namespace {

constexpr std::int64_t slab = 1 << 17;  // directions handled at once: 8 MB of taps in float
constexpr std::int64_t chunk_directions = 4096;  // of a slab, for one task
constexpr std::int64_t texels_of_owner = 512;    // 6 KB of derivatives

template <class R>
void add_slab(const Environment<R>& environment, const R* w, const R* d_L, std::int64_t count,
              R* d_texels) {
    std::vector<EnvironmentTaps<R>> taps(static_cast<std::size_t>(count));
    std::vector<std::uint32_t> owner(4 * taps.size());
    parallel_for((count + chunk_directions - 1) / chunk_directions, [&](std::int64_t p) {
        for (std::int64_t i = p * chunk_directions; i < std::min(count, (p + 1) * chunk_directions);
             ++i) {
            const auto n = static_cast<std::size_t>(i);
            taps[n] = environment.taps({w[3 * i], w[3 * i + 1], w[3 * i + 2]});
            for (std::size_t k = 0; k < 4; ++k)
                owner[4 * n + k] = static_cast<std::uint32_t>(taps[n].texel[k] / texels_of_owner);
        }
    });
    const std::int64_t texels =
        2 * static_cast<std::int64_t>(environment.height) * environment.height;
    const auto owners = static_cast<int>((texels + texels_of_owner - 1) / texels_of_owner);
    OwnerBins bins;
    bin_by_owner(owner, owners, bins);
    parallel_for(owners, [&](std::int64_t o) {
        const auto own = static_cast<std::size_t>(o);
        for (std::size_t j = bins.begin[own]; j < bins.begin[own + 1]; ++j) {
            const std::size_t n = bins.order[j] / 4, k = bins.order[j] % 4;
            for (std::size_t c = 0; c < 3; ++c)
                d_texels[3 * taps[n].texel[k] + static_cast<std::int64_t>(c)] +=
                    taps[n].weight[k] * d_L[3 * n + c];
        }
    });
}

}  // namespace

template <Real R>
void environment_backward(const Environment<R>& environment, const R* w, const R* d_L,
                          std::int64_t count, R* d_texels) {
    for (std::int64_t begin = 0; begin < count; begin += slab)
        add_slab(environment, w + 3 * begin, d_L + 3 * begin, std::min(slab, count - begin),
                 d_texels);
}

template void environment_backward(const Environment<float>&, const float*, const float*,
                                   std::int64_t, float*);
template void environment_backward(const Environment<double>&, const double*, const double*,
                                   std::int64_t, double*);

}  // namespace photograd
