// Building a tree: from a dense array, whose uniform blocks collapse, or from a function.
//
// A block of cells becomes one leaf if, channel by channel, its largest value exceeds its smallest
// by no more than the tolerance. The leaf holds the mean, so that no cell moves by more than the
// tolerance and the integral of each channel stays what it was: of the extinction, the optical
// depth of a block. With tolerance 0 the tree holds the array bit by bit.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "photograd/grid/octree.h"

namespace photograd {

/// What a leaf holds: C channels. A type of one's own needs the same: an element type and
/// operator[].
template <class T, int C>
using Payload = std::array<T, C>;
using Occupancy = Payload<std::uint8_t, 1>;  // 0 empty, 1 full
template <class R>
using Coefficients = Payload<R, 2>;  // sigma_a, sigma_s (1/m)
template <class R>
using Radiance = Payload<R, 3>;  // linear Rec. 709

/// A tree and a payload for each of its leaves, in the order of their numbers.
template <class P, int D = 3>
struct PayloadTree {
    SpatialTree<D> tree;
    std::vector<P> leaves;

    /// Value at a point in cells; `background` outside of the root.
    template <class R>
    [[nodiscard]] const P& at(const R* point, const P& background) const {
        const std::int32_t leaf = tree.locate(point);
        return leaf < 0 ? background : leaves[static_cast<std::size_t>(leaf)];
    }
};
template <class P>
using Octree = PayloadTree<P, 3>;
template <class P>
using Quadtree = PayloadTree<P, 2>;

/// Builds depth first: children are appended, and cut off again where their block turns out
/// uniform.
template <class P, int D>
class TreeBuilder {
    static constexpr int children = SpatialTree<D>::children;
    static constexpr int C = static_cast<int>(std::tuple_size_v<P>);
    using Element = typename P::value_type;
    using Sums = std::array<double, C>;

public:
    explicit TreeBuilder(int depth) : out_{SpatialTree<D>(depth), {}} { nodes().clear(); }

    /// values (X, Y, ..., C), row-major; cells of the root beyond them hold `background`.
    PayloadTree<P, D> from_dense(const P* values, const Cell<D>& shape, const P& background,
                                 double tolerance) {
        check(shape, tolerance);
        values_ = values;
        shape_ = shape;
        background_ = background;
        tolerance_ = tolerance;
        nodes().push_back(0);
        summarize(0, Cell<D>{}, out_.tree.side());
        return finish();
    }

    /// classify(lower, side) gives the payload of a uniform cube, or nothing: then it is cut in
    /// halves.
    template <class Classify>
    PayloadTree<P, D> from_function(Classify&& classify) {
        nodes().push_back(0);
        refine(classify, 0, Cell<D>{}, out_.tree.side());
        return finish();
    }

private:
    struct Summary {
        P low, high;
        Sums mean;
    };

    Summary summarize(std::size_t at, const Cell<D>& lower, std::int32_t side) {
        if (side == 1 || beyond(lower)) {
            const P& value = value_at(lower);
            set_leaf(at, value);
            Summary one{value, value, {}};
            for (int c = 0; c < C; ++c) one.mean[c] = static_cast<double>(value[c]);
            return one;
        }
        const std::size_t first = nodes().size(), first_leaf = out_.leaves.size();
        split(at);
        std::array<Summary, children> parts;
        for (int child = 0; child < children; ++child)
            parts[child] = summarize(first + child, corner(lower, side, child), side / 2);
        const Summary whole = combine(parts);
        if (!uniform(whole)) return whole;
        nodes().resize(first);
        out_.leaves.resize(first_leaf);
        P mean;
        for (int c = 0; c < C; ++c) mean[c] = static_cast<Element>(whole.mean[c]);
        set_leaf(at, mean);
        return whole;
    }

    static Summary combine(std::array<Summary, children>& parts) {
        Summary whole = parts[0];
        for (const Summary& part : parts)
            for (int c = 0; c < C; ++c) {
                if (part.low[c] < whole.low[c]) whole.low[c] = part.low[c];
                if (part.high[c] > whole.high[c]) whole.high[c] = part.high[c];
            }
        for (int step = 1; step < children; step *= 2)
            for (int i = 0; i < children; i += 2 * step)
                for (int c = 0; c < C; ++c)
                    parts[i].mean[c] = 0.5 * parts[i].mean[c] + 0.5 * parts[i + step].mean[c];
        // Halves are exact but for the smallest denormals, where equal values shall stay equal,
        // too.
        for (int c = 0; c < C; ++c)
            whole.mean[c] = whole.low[c] == whole.high[c] ? static_cast<double>(whole.low[c])
                                                          : parts[0].mean[c];
        return whole;
    }

    [[nodiscard]] bool uniform(const Summary& whole) const {
        for (int c = 0; c < C; ++c)
            if (!(static_cast<double>(whole.high[c]) - static_cast<double>(whole.low[c]) <=
                  tolerance_))
                return false;
        return true;
    }

    template <class Classify>
    void refine(Classify& classify, std::size_t at, const Cell<D>& lower, std::int32_t side) {
        const std::optional<P> value = classify(lower, side);
        if (value) return set_leaf(at, *value);
        if (side == 1)
            fail(ErrorKind::range, "Octree", "classify", "a value for every single cell",
                 "none for a cube of one cell", "or a larger depth");
        const std::size_t first = nodes().size();
        split(at);
        for (int child = 0; child < children; ++child)
            refine(classify, first + child, corner(lower, side, child), side / 2);
    }

    static void check(const Cell<D>& shape, double tolerance) {
        for (int a = 0; a < D; ++a)
            if (shape[a] < 1)
                fail(ErrorKind::shape, "Octree", "values", "at least one cell along each axis",
                     std::to_string(shape[a]) + " along axis " + std::to_string(a));
        if (!(tolerance >= 0.0) || !std::isfinite(tolerance))
            fail(ErrorKind::range, "Octree", "tolerance", "a finite number of at least 0",
                 std::to_string(tolerance));
        if (std::is_integral_v<Element> && tolerance != 0.0)
            fail(ErrorKind::range, "Octree", "tolerance", "0 for whole numbers, which have no mean",
                 std::to_string(tolerance), "convert to float32");
    }
    static Cell<D> corner(Cell<D> lower, std::int32_t side, int child) {
        for (int a = 0; a < D; ++a) lower[a] += (child >> a & 1) * (side / 2);
        return lower;
    }
    void split(std::size_t at) {
        const std::size_t first = nodes().size();
        if (first > std::size_t{std::numeric_limits<std::int32_t>::max()} - children)
            fail(ErrorKind::range, "Octree", "nodes", "fewer than 2^31 nodes", "more",
                 "use a larger tolerance or a smaller depth");
        nodes()[at] = static_cast<std::int32_t>(first);
        nodes().resize(first + children);
    }
    void set_leaf(std::size_t at, const P& value) {
        nodes()[at] = ~static_cast<std::int32_t>(out_.leaves.size());
        out_.leaves.push_back(value);
    }
    [[nodiscard]] bool beyond(const Cell<D>& lower) const {
        for (int a = 0; a < D; ++a)
            if (lower[a] >= shape_[a]) return true;
        return false;
    }
    [[nodiscard]] const P& value_at(const Cell<D>& cell) const {
        if (beyond(cell)) return background_;
        std::size_t index = 0;
        for (int a = 0; a < D; ++a)
            index = index * static_cast<std::size_t>(shape_[a]) + static_cast<std::size_t>(cell[a]);
        return values_[index];
    }
    PayloadTree<P, D> finish() {
        out_.tree.leaf_count_ = static_cast<std::int32_t>(out_.leaves.size());
        nodes().shrink_to_fit();
        out_.leaves.shrink_to_fit();
        return std::move(out_);
    }
    std::vector<std::int32_t>& nodes() { return out_.tree.nodes_; }

    PayloadTree<P, D> out_;
    const P* values_ = nullptr;
    Cell<D> shape_{};
    P background_{};
    double tolerance_ = 0.0;
};

/// Levels that a root needs to cover `shape`.
template <int D>
int depth_for(const Cell<D>& shape) {
    int depth = 0;
    for (int a = 0; a < D; ++a)
        while (depth < 30 && (std::int32_t{1} << depth) < shape[a]) ++depth;
    return depth;
}

template <class P, int D>
PayloadTree<P, D> tree_from_dense(const P* values, const Cell<D>& shape, const P& background,
                                  double tolerance) {
    return TreeBuilder<P, D>(depth_for<D>(shape)).from_dense(values, shape, background, tolerance);
}

template <class P, int D, class Classify>
PayloadTree<P, D> tree_from_function(int depth, Classify&& classify) {
    return TreeBuilder<P, D>(depth).from_function(classify);
}

}  // namespace photograd
