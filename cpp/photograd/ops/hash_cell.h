// The cell of a point on a level of a hash encoding, along one axis, and the factors of the rows of
// its corners. network/hash_encoding.h has the formulas; it and the kernels take them from here.
#pragma once

#include <cstdint>

#include "photograd/core/dual.h"

namespace photograd {
inline namespace PHOTOGRAD_ISA {

inline constexpr std::uint32_t hash_primes[3] = {1u, 2654435761u, 805459861u};

template <class R>
struct HashAxis {
    int cell;  // the lower of its two corners
    R weight;  // of the upper corner; that of the lower one is 1 - weight
    R slope;   // d weight / d p
};

/// p outside of [0, 1] belongs to the border of the outermost cell, where nothing changes with p.
/// A call would keep the loops over points from becoming vectors.
template <class R>
[[gnu::always_inline]] inline HashAxis<R> hash_axis(R p, int resolution, bool smoothstep) {
    const R n = static_cast<R>(resolution);
    const R inside = smaller(larger(p, R(0)), R(1)), at = inside * n;
    const int cell = clamped(to_int(at), 0, resolution - 1);
    const R f = at - static_cast<R>(cell), rate = inside == p ? n : R(0);
    if (smoothstep) return {cell, f * f * (R(3) - R(2) * f), rate * (R(6) * f * (R(1) - f))};
    return {cell, f, rate};
}

/// By what a corner's coordinate along `axis` is multiplied: the factors of rows of a dense level
/// are added up, those of a hashed one exclusive-ored.
inline std::uint32_t hash_factor(int axis, int resolution, bool dense) {
    if (!dense) return hash_primes[axis];
    std::uint32_t stride = 1;
    for (int a = 0; a < axis; ++a) stride *= static_cast<std::uint32_t>(resolution + 1);
    return stride;
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
