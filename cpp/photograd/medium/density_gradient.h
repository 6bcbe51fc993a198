// Derivatives of many lookups of a density grid, added up by the owners of voxels.
//
// A lookup between the layers x = i and i + 1 of voxels belongs to owner i; an owner adds its own
// in their order. Neighboring owners share a layer, so that all with even i go first, then all with
// odd: no voxel is ever written by two at once, and the order of each voxel's sum is fixed.
#pragma once

#include "photograd/core/scatter.h"
#include "photograd/medium/density_grid.h"

namespace photograd {

/// d_values (X, Y, Z) += weight d_density of each lookup.
template <class R>
void density_backward(const DensityLayout& layout, const DensityAdjoint<R>& lookups,
                      double* d_values) {
    const std::size_t count = lookups.d_density.size();
    const int owners = layout.shape.x - 1;
    const auto taps_of = [&](std::size_t i) {
        const R* x = &lookups.world[3 * i];
        return DensityTaps<double>(layout, Vec3<double>(double(x[0]), double(x[1]), double(x[2])));
    };
    std::vector<std::uint32_t> owner(count);
    for (std::size_t i = 0; i < count; ++i) {
        const DensityTaps<double> taps = taps_of(i);
        owner[i] =
            static_cast<std::uint32_t>(taps.inside ? taps.x.base : owners);  // outside: nobody's
    }
    OwnerBins bins;
    bin_by_owner(owner, owners + 1, bins);
    for (int odd = 0; odd < 2; ++odd)
        parallel_for((owners + 1 - odd) / 2, [&](std::int64_t half) {
            const auto k = static_cast<std::size_t>(2 * half + odd);
            for (std::size_t n = bins.begin[k]; n < bins.begin[k + 1]; ++n) {
                const std::size_t i = bins.order[n];
                const DensityTaps<double> taps = taps_of(i);
                const auto d = static_cast<double>(lookups.d_density[i]);
                trilinear_backward<double, 1>(layout.shape, taps.x, taps.y, taps.z, &d, d_values);
            }
        });
}

}  // namespace photograd
