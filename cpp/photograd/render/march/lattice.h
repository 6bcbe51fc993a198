// Where a ray is sampled: its span in a box, and the lattice of sample positions in that span.
//
// Samples lie at t_k = t0 + (k + 1/2) dt, k = 0 .. count - 1. With Lattice::origin, t0 is a
// multiple of dt from the ray's origin: the positions do not depend on the box, so that skipping
// empty space, or another box, leaves the samples it keeps where they were. Lattice::entry starts
// at the point of entry instead. A jitter u in [0, 1) moves a ray's lattice by (u - 1/2) dt.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "photograd/core/real.h"

namespace photograd {

enum class Lattice : int { origin = 0, entry = 1 };

template <Real R>
struct Span {
    R near, far;  // far <= near: the ray misses
};

/// Clips o + t d, t >= 0, to the box, slab by slab [Kay1986]. A ray parallel to a slab is inside of
/// it, its faces included, or misses; dividing by its zero would give NaN for a ray that runs in a
/// face.
template <Real R>
Span<R> clip_to_box(const R* origin, const R* direction, const double (*box)[3]) {
    R near = R(0), far = std::numeric_limits<R>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const R lo = static_cast<R>(box[0][axis]), hi = static_cast<R>(box[1][axis]);
        if (direction[axis] == R(0)) {
            if (origin[axis] < lo || origin[axis] > hi) return {R(0), R(0)};
            continue;
        }
        const R inverse = R(1) / direction[axis];
        const R a = (lo - origin[axis]) * inverse;
        const R b = (hi - origin[axis]) * inverse;
        near = std::fmax(near, std::fmin(a, b));
        far = std::fmin(far, std::fmax(a, b));
    }
    return {near, far};
}

/// Samples of one ray: what a chunk of rays records of them fits into memory.
inline constexpr std::int32_t max_samples = 1 << 18;

/// `count` is `max_samples` + 1 where there would be more.
template <Real R>
struct RaySamples {
    R t0;
    std::int32_t count;
};

template <Real R>
std::int32_t sample_count(R samples) {
    return static_cast<std::int32_t>(std::fmin(std::fmax(samples, R(0)), R(max_samples + 1)));
}

template <Real R>
RaySamples<R> place_samples(const Span<R>& span, R dt, Lattice lattice, R jitter) {
    if (!(span.far > span.near)) return {span.near, 0};
    const R shift = (jitter - R(0.5)) * dt;
    if (lattice == Lattice::entry) {
        const R t0 = span.near + shift;
        return {t0, sample_count(std::floor((span.far - span.near) / dt))};
    }
    // First k with (k + 1/2) dt + shift >= near, last with ... <= far.
    const R first = std::fmax(std::ceil((span.near - shift) / dt - R(0.5)), R(0));
    const R last = std::floor((span.far - shift) / dt - R(0.5));
    return {first * dt + shift, sample_count(last - first + R(1))};
}

}  // namespace photograd
