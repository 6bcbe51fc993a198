// Octrees (and quadtrees): space cut into cubes that are small only where something changes
// [Meagher1982].
//
// The root is a cube of 2^depth cells a side; a node is either a leaf or has 2^D children, the
// halves of its cube along each axis. Coordinates are in cells, so every face of every node is an
// integer, and two questions have exact answers also in floating point: which leaf holds a point
// (faces belong to the leaf above them), and which leaves a ray passes through.
//
// A ray o + t d meets the plane x = k at t = (k - o) / d. Rounding keeps order, k <= m => t(k) <=
// t(m) for d > 0, so the interval of a child, computed from integer planes, always lies in that of
// its parent. The descent below therefore finds the very leaves whose own interval [max of entries,
// min of exits] has positive length, as a search through all leaves would, and in the order of t. A
// ray that only touches an edge or a corner of a leaf spends no length in it and does not visit it.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "photograd/core/errors.h"

namespace photograd {

/// Coordinates of a cell.
template <int D>
using Cell = std::array<std::int32_t, D>;

/// Size of a tree. Level 0 is the root; a leaf of level l is 2^(depth - l) cells wide.
struct TreeStatistics {
    std::int64_t nodes = 0, leaves = 0, bytes = 0;
    std::vector<std::int64_t> leaves_per_level;
};

/// The cube of a leaf: [lower, lower + side) in cells.
template <int D>
struct LeafBox {
    Cell<D> lower;
    std::int32_t side;
};

/// Which cube is a leaf, and its number. Payloads are arrays with a row a leaf, and live elsewhere.
template <int D>
class SpatialTree {
public:
    static constexpr int children = 1 << D;
    static constexpr int max_depth = 20;
    static constexpr std::int32_t outside = -1;  // the leaf of a point outside the root

    explicit SpatialTree(int depth) : depth_(depth) {
        if (depth < 0 || depth > max_depth)
            fail(ErrorKind::range, "Octree", "depth", "0 to " + std::to_string(max_depth),
                 std::to_string(depth));
    }

    [[nodiscard]] int depth() const { return depth_; }
    [[nodiscard]] std::int32_t side() const { return std::int32_t{1} << depth_; }
    [[nodiscard]] std::int32_t leaf_count() const { return leaf_count_; }

    /// The leaf that holds `point` (in cells), or `outside`; a NaN is outside.
    template <class R>
    [[nodiscard]] std::int32_t locate(const R* point) const {
        for (int a = 0; a < D; ++a)
            if (!(point[a] >= R(0) && point[a] < R(side()))) return outside;
        Cell<D> lower{};
        std::int32_t node = nodes_[0];
        for (std::int32_t half = side() / 2; node >= 0; half /= 2) {
            int child = 0;
            for (int a = 0; a < D; ++a)
                if (point[a] >= R(lower[a] + half)) {
                    child |= 1 << a;
                    lower[a] += half;
                }
            node = nodes_[static_cast<std::size_t>(node + child)];
        }
        return ~node;
    }

    /// Calls visit(leaf, t0, t1) for the leaves that the ray spends t0 < t1 in, in the order of t,
    /// until it returns false. A ray along a face belongs to the leaf above it, as a point does.
    template <class R, class Visit>
    void traverse(const R* origin, const R* direction, R t_min, R t_max, Visit&& visit) const {
        Descent<R, std::remove_reference_t<Visit>> ray{*this, origin, direction, 0, visit};
        for (int a = 0; a < D; ++a) {
            if (direction[a] < R(0)) ray.mirrored |= 1 << a;
            if (direction[a] == R(0)) {
                if (!(origin[a] >= R(0) && origin[a] < R(side()))) return;
                continue;
            }
            const R t0 = (R(0) - origin[a]) / direction[a],
                    t1 = (R(side()) - origin[a]) / direction[a];
            const R enter = t0 < t1 ? t0 : t1, leave = t0 < t1 ? t1 : t0;
            if (enter > t_min) t_min = enter;
            if (leave < t_max) t_max = leave;
        }
        if (t_min < t_max) ray.descend(nodes_[0], Cell<D>{}, side(), t_min, t_max);
    }

    /// Calls visit(leaf, box) for all leaves, by number: along the Z curve with x fastest
    /// [Morton1966].
    template <class Visit>
    void for_each_leaf(Visit&& visit) const {
        each_leaf(0, Cell<D>{}, side(), visit);
    }

    [[nodiscard]] TreeStatistics statistics() const {
        TreeStatistics out;
        out.nodes = static_cast<std::int64_t>(nodes_.size());
        out.leaves = leaf_count_;
        out.bytes = out.nodes * static_cast<std::int64_t>(sizeof(nodes_[0]));
        out.leaves_per_level.assign(static_cast<std::size_t>(depth_) + 1, 0);
        for_each_leaf([&](std::int32_t, const LeafBox<D>& box) {
            int level = 0;
            for (std::int32_t s = box.side; s < side(); s *= 2) ++level;
            ++out.leaves_per_level[static_cast<std::size_t>(level)];
        });
        return out;
    }

private:
    template <class, int>
    friend class TreeBuilder;

    template <class R, class Visit>
    struct Descent {
        const SpatialTree& tree;
        const R *origin, *direction;
        int mirrored;  // axes along which the ray runs downwards
        Visit& visit;

        /// Visits what [t0, t1] of the ray meets below `node`; false once a visit has said stop.
        /// `far` holds the axes whose middle plane lies behind: the near half is 0 along each axis.
        bool descend(std::int32_t node, const Cell<D>& lower, std::int32_t cells, R t0,
                     R t1) const {
            if (node < 0) return visit(~node, t0, t1);
            const std::int32_t half = cells / 2;
            R middle[D];
            int far = 0;
            for (int a = 0; a < D; ++a) {
                middle[a] = crossing(a, lower[a] + half);
                if (middle[a] <= t0) far |= 1 << a;
            }
            for (;;) {
                R end = t1;
                for (int a = 0; a < D; ++a)
                    if (!(far >> a & 1) && middle[a] < end) end = middle[a];
                const int child = far ^ mirrored;
                Cell<D> corner = lower;
                for (int a = 0; a < D; ++a) corner[a] += (child >> a & 1) * half;
                if (!descend(tree.nodes_[static_cast<std::size_t>(node + child)], corner, half, t0,
                             end))
                    return false;
                if (end >= t1) return true;
                for (int a = 0; a < D; ++a)
                    if (middle[a] <= end) far |= 1 << a;
                t0 = end;
            }
        }
        /// t at the plane; for a ray along it, whether it runs above (passed long ago) or below
        /// (never).
        R crossing(int a, std::int32_t plane) const {
            constexpr R inf = std::numeric_limits<R>::infinity();
            if (direction[a] == R(0)) return origin[a] >= R(plane) ? -inf : inf;
            return (R(plane) - origin[a]) / direction[a];
        }
    };

    template <class Visit>
    void each_leaf(std::size_t at, const Cell<D>& lower, std::int32_t cells, Visit& visit) const {
        const std::int32_t node = nodes_[at];
        if (node < 0) {
            visit(~node, LeafBox<D>{lower, cells});
            return;
        }
        for (int child = 0; child < children; ++child) {
            Cell<D> corner = lower;
            for (int a = 0; a < D; ++a) corner[a] += (child >> a & 1) * (cells / 2);
            each_leaf(static_cast<std::size_t>(node + child), corner, cells / 2, visit);
        }
    }

    int depth_;
    std::int32_t leaf_count_ = 1;
    std::vector<std::int32_t> nodes_ = {~0};  // first of 2^D children, or ~leaf
};

}  // namespace photograd
