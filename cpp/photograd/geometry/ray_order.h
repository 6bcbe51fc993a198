// The order in which a batch of rays is traced.
//
// Neighboring camera rays visit the same nodes of a bounding volume hierarchy, so sixteen of them
// share one traversal. Rays after a bounce do not, and most of their time goes into waiting for
// nodes that have left the cache. Tracing them in an order in which consecutive rays lie close to
// each other as *lines* brings the nodes back while they are still there [Pharr1997].
#pragma once

#include <cstdint>
#include <memory>

#include "photograd/core/ray.h"
#include "photograd/core/real.h"

namespace photograd {

struct Box {
    Vec3<float> lo, hi;
};

/// Rays as flat arrays (R, 3).
template <class R>
struct RaySpan {
    const R* origins;
    const R* directions;
    std::int64_t count;

    [[nodiscard]] Ray<R> ray(std::int64_t i) const {
        const R *o = origins + 3 * i, *d = directions + 3 * i;
        return {{o[0], o[1], o[2]}, {d[0], d[1], d[2]}};
    }
};

/// Whether sixteen consecutive rays mostly run side by side, by up to 256 groups of the batch.
template <Real R>
bool runs_side_by_side(const RaySpan<R>& rays, const Box& scene);

/// Puts rays into an order; keeps its memory from one batch to the next.
class LineOrder {
public:
    /// A permutation of the rays, a function of the rays alone: the order of a 30-bit key that
    /// interleaves, from coarse to fine, the cell in which a ray starts with the cell in which it
    /// leaves the scene's box. Valid until the next call.
    template <Real R>
    const std::uint32_t* sort(const RaySpan<R>& rays, const Box& scene);

private:
    struct Keyed {
        std::uint32_t key, ray;
    };
    template <class Put>
    static void radix_pass(const Keyed* in, std::int64_t n, int shift, Put&& put);

    // Not vectors, which would write zeros first.
    std::int64_t capacity_ = 0;
    std::unique_ptr<Keyed[]> first_, second_;
    std::unique_ptr<std::uint32_t[]> order_;
};

}  // namespace photograd
