// A signed distance field (SDF) as a tree: shapes at the leaves, unions and placements above them.
//
// The tree says what is combined with what; the numbers (radii, positions) lie in one array beside
// it. Callers may change them and differentiate with respect to them.
#pragma once

#include <cstdint>
#include <vector>

#include "photograd/core/vec.h"

namespace photograd {

/// Below each: which numbers it takes, in their order.
enum class SdfKind : std::int32_t {
    sphere,        // radius
    plane,         // normal (3), height
    torus,         // ring, tube
    box,           // half sizes (3)
    capsule,       // half length, radius
    unite,         // of two children, as are the next three
    intersect,     //
    subtract,      // the first without the second
    smooth_unite,  // width of the seam
    place,         // of one child: quaternion (4), shift (3)
    scale,         // of one child: factor
    round,         // of one child, swollen by: radius
};
int sdf_number_count(SdfKind kind);
int sdf_child_count(SdfKind kind);

/// Children are earlier nodes, -1 where the kind takes none; `numbers` is where its own begin.
struct SdfNode {
    SdfKind kind;
    std::int32_t first, second, numbers;
};

class Sdf {
public:
    static constexpr int deepest = 256;
    /// The last node is the root. Refuses (RangeError) lists that are no tree, or one deeper than
    /// that.
    explicit Sdf(std::vector<SdfNode> nodes);

    [[nodiscard]] std::int64_t number_count() const { return number_count_; }
    [[nodiscard]] const std::vector<SdfNode>& nodes() const { return nodes_; }

    /// f(p), meters; negative inside. Of a smooth union or a difference it may understate how far
    /// the surface is, never overstate it.
    [[nodiscard]] double distance(const double* numbers, const Vec3<double>& p) const {
        return distance(root(), numbers, p);
    }
    /// Adds d_f df/dp and d_f df/dnumbers. With d_f = 1 the first is the gradient, which points out
    /// of the surface. Where two children are equally near, the derivative is that of the first.
    void backward(const double* numbers, const Vec3<double>& p, double d_f, Vec3<double>& d_p,
                  double* d_numbers) const {
        backward(root(), numbers, p, d_f, d_p, d_numbers);
    }
    /// The first fault of the numbers, or null: radii and widths must be above 0, normals and
    /// quaternions not of length 0, all finite.
    [[nodiscard]] const char* fault(const double* numbers) const;

private:
    [[nodiscard]] std::int32_t root() const { return static_cast<std::int32_t>(nodes_.size()) - 1; }
    [[nodiscard]] double distance(std::int32_t node, const double* numbers,
                                  const Vec3<double>& p) const;
    void backward(std::int32_t node, const double* numbers, const Vec3<double>& p, double d_f,
                  Vec3<double>& d_p, double* d_numbers) const;

    std::vector<SdfNode> nodes_;
    std::int64_t number_count_ = 0;
};

}  // namespace photograd
