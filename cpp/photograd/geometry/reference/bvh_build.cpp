#include "photograd/geometry/reference/bvh_build.h"

#include <numeric>
#include <string>

#include "photograd/core/errors.h"

namespace photograd {
namespace {

struct Slice {
    Aabb box;
    std::int32_t count = 0;
};

/// Centroids in slices below `slice` of `axis` go left; cost is that of both halves.
struct Split {
    int axis = -1, slice = 0;
    double cost = std::numeric_limits<double>::infinity();
};

class Builder {
public:
    Builder(const Mesh& mesh, const BvhOptions& options, BvhTree& tree)
        : options_(options), tree_(tree) {
        const auto count = static_cast<std::size_t>(mesh.face_count());
        boxes_.resize(count);
        centroids_.resize(count);
        for (std::size_t f = 0; f < count; ++f) {
            const std::uint32_t* corners = mesh.corners(static_cast<std::uint32_t>(f));
            for (int k = 0; k < 3; ++k) boxes_[f].add(mesh.vertex<double>(corners[k]));
            centroids_[f] = 0.5 * (boxes_[f].lo + boxes_[f].hi);
        }
        tree_.order.resize(count);
        std::iota(tree_.order.begin(), tree_.order.end(), 0u);
    }

    void build(std::int32_t first, std::int32_t count, int depth) {
        const std::size_t here = tree_.nodes.size();
        tree_.nodes.push_back({bounds(first, count), first, count, -1, depth});
        if (count == 1 || depth == options_.max_depth) return;
        const Split split = best_split(first, count, tree_.nodes[here].box.half_area());
        if (split.axis < 0 || (count <= options_.leaf_size && split.cost >= count)) return;
        const std::int32_t left = partition(first, count, split);
        tree_.nodes[here].count = 0;
        build(first, left, depth + 1);
        tree_.nodes[here].right = static_cast<std::int32_t>(tree_.nodes.size());
        build(first + left, count - left, depth + 1);
    }

private:
    [[nodiscard]] std::uint32_t triangle(std::int32_t slot) const {
        return tree_.order[static_cast<std::size_t>(slot)];
    }
    [[nodiscard]] Aabb bounds(std::int32_t first, std::int32_t count) const {
        Aabb box;
        for (std::int32_t i = first; i < first + count; ++i) box.add(boxes_[triangle(i)]);
        return box;
    }
    [[nodiscard]] Aabb centroid_bounds(std::int32_t first, std::int32_t count) const {
        Aabb box;
        for (std::int32_t i = first; i < first + count; ++i) box.add(centroids_[triangle(i)]);
        return box;
    }
    [[nodiscard]] int slice_of(const Aabb& range, int axis, std::uint32_t f) const {
        const double share = (centroids_[f][axis] - range.lo[axis]) / (range.hi - range.lo)[axis];
        return std::min(options_.bins - 1, static_cast<int>(share * options_.bins));
    }

    [[nodiscard]] Split best_split(std::int32_t first, std::int32_t count, double area) const {
        const Aabb range = centroid_bounds(first, count);
        const auto bins = static_cast<std::size_t>(options_.bins);
        Split best;
        for (int axis = 0; axis < 3; ++axis) {
            if (!(range.lo[axis] < range.hi[axis])) continue;  // all centroids in one plane
            std::vector<Slice> slices(bins);
            for (std::int32_t i = first; i < first + count; ++i) {
                Slice& s = slices[static_cast<std::size_t>(slice_of(range, axis, triangle(i)))];
                s.box.add(boxes_[triangle(i)]);
                ++s.count;
            }
            // A sweep from the right stores what lies right of each border; one from the left
            // compares the costs.
            std::vector<double> right_cost(bins);
            Slice sum;
            for (std::size_t b = bins - 1; b > 0; --b) {
                sum.box.add(slices[b].box);
                sum.count += slices[b].count;
                right_cost[b] = sum.box.half_area() * sum.count;
            }
            sum = {};
            for (std::size_t b = 1; b < bins; ++b) {
                sum.box.add(slices[b - 1].box);
                sum.count += slices[b - 1].count;
                if (sum.count == 0 || sum.count == count) continue;
                const double cost = 1 + (sum.box.half_area() * sum.count + right_cost[b]) / area;
                if (cost < best.cost) best = {axis, static_cast<int>(b), cost};
            }
        }
        return best;
    }

    /// Sorts those that go left before the others, in their order; returns how many go left.
    std::int32_t partition(std::int32_t first, std::int32_t count, const Split& split) {
        const Aabb range = centroid_bounds(first, count);
        const auto begin = tree_.order.begin() + first;
        const auto middle = std::stable_partition(begin, begin + count, [&](std::uint32_t f) {
            return slice_of(range, split.axis, f) < split.slice;
        });
        return static_cast<std::int32_t>(middle - begin);
    }

    const BvhOptions& options_;
    BvhTree& tree_;
    std::vector<Aabb> boxes_;
    std::vector<Vec3<double>> centroids_;
};

void check(const char* argument, int value, int least, int most) {
    if (value < least || value > most)
        fail(ErrorKind::range, "ReferenceBvh", argument,
             std::to_string(least) + " to " + std::to_string(most), std::to_string(value));
}

}  // namespace

BvhTree build_bvh(const Mesh& mesh, const BvhOptions& options) {
    check("leaf_size", options.leaf_size, 1, 1 << 20);
    check("bins", options.bins, 2, 256);
    check("max_depth", options.max_depth, 0, BvhTree::deepest);
    BvhTree tree;
    Builder(mesh, options, tree).build(0, static_cast<std::int32_t>(mesh.face_count()), 0);
    return tree;
}

}  // namespace photograd
