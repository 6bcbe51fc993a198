// Boxes that a ray meets between two distances: a bounding volume hierarchy, split at the median of
// the centers along the widest axis [Kay1986]. Which items are reported does not depend on the
// splits, so a caller that orders them gets the same result from any tree.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "photograd/core/dual.h"

namespace photograd {

template <class R>
struct BoxBounds {
    R lo[3], hi[3];

    void include(const BoxBounds& other) {
        for (int k = 0; k < 3; ++k) {
            lo[k] = smaller(lo[k], other.lo[k]);
            hi[k] = larger(hi[k], other.hi[k]);
        }
    }
};

/// A ray prepared for box tests. Along an axis without motion the inverse is huge instead of
/// infinite, so that 0 / 0 cannot arise; the ray is bent by 1e-30 of its length.
template <class R>
struct BoxRay {
    R origin[3], inverse[3];

    static BoxRay of(const R* origin, const R* unit_direction) {
        BoxRay out;
        for (int k = 0; k < 3; ++k) {
            const R d = unit_direction[k];
            const bool still = d < R(1e-30) && d > R(-1e-30);
            out.origin[k] = origin[k];
            out.inverse[k] = still ? R(1e30) : R(1) / d;
        }
        return out;
    }

    /// Whether the ray touches the box within [t_lo, t_hi]? Distances are widened by a thousandth,
    /// which is more than the rounding in them: a yes may be wrong, a no is right.
    [[nodiscard]] bool intersects(const BoxBounds<R>& box, R t_lo, R t_hi) const {
        R enter = R(-3e38), exit = R(3e38);
        for (int k = 0; k < 3; ++k) {
            const R a = (box.lo[k] - origin[k]) * inverse[k];
            const R b = (box.hi[k] - origin[k]) * inverse[k];
            enter = larger(enter, smaller(a, b));
            exit = smaller(exit, larger(a, b));
        }
        enter -= R(1e-3) * larger(enter, -enter);
        exit += R(1e-3) * larger(exit, -exit);
        return enter <= exit && exit >= t_lo && enter <= t_hi;
    }
};

template <class R>
class BoxTree {
public:
    BoxTree() = default;
    /// Boxes must be finite.
    explicit BoxTree(std::span<const BoxBounds<R>> boxes) : order_(boxes.size()) {
        std::iota(order_.begin(), order_.end(), 0u);
        if (!boxes.empty()) build(boxes, 0, order_.size());
    }

    /// The items in the order of the leaves.
    [[nodiscard]] std::span<const std::uint32_t> order() const { return order_; }

    /// visit(k), k an index into `order`, for every item whose leaf the ray meets between t_lo and
    /// t_hi, roughly from near to far. visit may lower t_hi.
    template <class Visit>
    void walk(const BoxRay<R>& ray, R t_lo, const R& t_hi, Visit&& visit) const {
        if (nodes_.empty()) return;
        std::uint32_t stack[64];  // the tree is halved, so 2^32 items are 32 levels
        int height = 0;
        stack[height++] = 0;
        while (height > 0) {
            const std::uint32_t at = stack[--height];
            const Node& node = nodes_[at];
            if (!ray.intersects(node.box, t_lo, t_hi)) continue;
            if (node.count > 0) {
                for (std::uint32_t k = node.first; k < node.first + node.count; ++k) visit(k);
                continue;
            }
            const bool forward = ray.inverse[node.axis] > R(0);
            stack[height++] = forward ? node.first : at + 1;
            stack[height++] = forward ? at + 1 : node.first;
        }
    }

private:
    static constexpr std::size_t leaf_size = 4;

    struct Node {
        BoxBounds<R> box;
        std::uint32_t
            first;  // of a leaf: first index into order_; else its second child, the first is next
        std::uint32_t count;  // items of a leaf; 0: not a leaf
        int axis;
    };

    void build(std::span<const BoxBounds<R>> boxes, std::size_t begin, std::size_t end) {
        const std::size_t at = nodes_.size();
        nodes_.push_back({boxes[order_[begin]], static_cast<std::uint32_t>(begin),
                          static_cast<std::uint32_t>(end - begin), 0});
        const auto center = [&](std::uint32_t item, int k) {
            return R(0.5) * boxes[item].lo[k] + R(0.5) * boxes[item].hi[k];
        };
        R lo[3] = {R(3e38), R(3e38), R(3e38)}, hi[3] = {R(-3e38), R(-3e38), R(-3e38)};
        for (std::size_t i = begin; i < end; ++i) {
            nodes_[at].box.include(boxes[order_[i]]);
            for (int k = 0; k < 3; ++k) {
                lo[k] = smaller(lo[k], center(order_[i], k));
                hi[k] = larger(hi[k], center(order_[i], k));
            }
        }
        if (end - begin <= leaf_size) return;
        int axis = 0;
        for (int k = 1; k < 3; ++k)
            if (hi[k] - lo[k] > hi[axis] - lo[axis]) axis = k;
        const auto middle = begin + (end - begin) / 2;
        const auto item = [&](std::size_t i) {
            return order_.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::nth_element(item(begin), item(middle), item(end),
                         [&](std::uint32_t a, std::uint32_t b) {
                             const R x = center(a, axis), y = center(b, axis);
                             return x != y ? x < y : a < b;
                         });
        build(boxes, begin, middle);
        nodes_[at].first = static_cast<std::uint32_t>(nodes_.size());
        nodes_[at].count = 0;
        nodes_[at].axis = axis;
        build(boxes, middle, end);
    }

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;
};

}  // namespace photograd
