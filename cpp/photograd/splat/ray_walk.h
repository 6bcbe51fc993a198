// The Gaussians along a ray, in the order of their peaks, in a fixed amount of memory.
//
// A round collects the nearest peaks behind a given one in a short sorted list; once the list is
// full, the tree skips what is farther than its last entry. Rounds repeat until the ray ends or the
// list is no longer filled [MoenneLoccoz2024]. The order is that of t, then of rows. Each ray has
// its own order, so nothing pops while a camera turns; where two peaks swap, the image has a
// discontinuity that derivatives do not include.
#pragma once

#include "photograd/splat/ray_cloud.h"

namespace photograd {

/// A Gaussian's peak on a ray.
template <class R>
struct Crossing {
    R t, raw;
    std::uint32_t row, slot;  // slot: in RayCloud::gaussians

    [[nodiscard]] bool before(const Crossing& other) const {
        return t != other.t ? t < other.t : row < other.row;
    }
};

/// The nearest crossings found so far, sorted.
template <class R>
class CrossingList {
public:
    static constexpr int capacity = 32;

    void clear() {
        count_ = 0;
        limit_ = R(3e38);
    }
    void insert(const Crossing<R>& x) {
        if (full() && !x.before(list_[count_ - 1])) return;
        int k = full() ? count_ - 1 : count_++;
        for (; k > 0 && x.before(list_[k - 1]); --k) list_[k] = list_[k - 1];
        list_[k] = x;
        if (full()) limit_ = list_[count_ - 1].t;
    }
    [[nodiscard]] bool full() const { return count_ == capacity; }
    /// Peaks beyond cannot enter the list.
    [[nodiscard]] const R& limit() const { return limit_; }
    [[nodiscard]] const Crossing<R>* begin() const { return list_; }
    [[nodiscard]] const Crossing<R>* end() const { return list_ + count_; }

private:
    int count_ = 0;
    R limit_ = R(3e38);
    Crossing<R> list_[capacity];
};

/// visit(crossing) for each Gaussian visible on the ray, nearest first, until it returns false. The
/// direction has unit length.
template <class R, class Visit>
void walk_ray(const RayCloud<R>& cloud, const R* origin, const R* direction, Visit&& visit) {
    const BoxRay<R> ray = BoxRay<R>::of(origin, direction);
    const R alpha_min = R(cloud.options.alpha_min), t_min = R(cloud.options.t_min);
    CrossingList<R> found;
    Crossing<R> last{};
    bool first_round = true;
    do {
        found.clear();
        const R t_lo = first_round ? t_min : last.t;
        cloud.tree.walk(ray, t_lo, found.limit(), [&](std::uint32_t slot) {
            const CastGaussian<R>& g = cloud.gaussians[slot];
            const RayPeak<R> peak = ray_peak(g.shape, origin, direction);
            const Crossing<R> x{peak.t, g.raw(peak), g.row, slot};
            // Comparisons are false for NaN, which numbers too large may leave.
            if (!(x.raw > R(0) && x.raw >= alpha_min && x.t >= t_min)) return;
            if (first_round || last.before(x)) found.insert(x);
        });
        for (const Crossing<R>& x : found)
            if (!visit(x)) return;
        if (found.full()) last = *(found.end() - 1);
        first_round = false;
    } while (found.full());
}

}  // namespace photograd
