// A bounding volume hierarchy, built from the top by the surface area heuristic.
//
// What a node costs is one test of its box, and, for each half, the chance that a line that meets
// the node meets the half (the ratio of their areas) times the triangles in there [Goldsmith1987]:
//
//   C = 1 + A_left / A n_left + A_right / A n_right        a leaf costs n
//
// Not all 2^n halves are tried, but planes across each axis: centroids fall into `bins` slices, and
// the borders of slices are the candidates [Wald2007].
#pragma once

#include <cstdint>
#include <vector>

#include "photograd/geometry/mesh.h"
#include "photograd/geometry/reference/aabb.h"

namespace photograd {

/// A leaf has count > 0 and holds order[first] .. order[first + count - 1]; of any other node, the
/// left child is the next node in the list and `right` the number of the other one.
struct BvhNode {
    Aabb box;
    std::int32_t first, count, right, depth;
};

struct BvhOptions {
    int leaf_size;  // no leaf is larger, unless the centroids coincide or the tree is at its depth
    int bins;
    int max_depth;
};

struct BvhTree {
    static constexpr int deepest = 64;
    std::vector<BvhNode> nodes;        // the root first
    std::vector<std::uint32_t> order;  // triangles, those of a leaf side by side
};

/// Refuses (RangeError) options outside of 1 <= leaf_size, 2 <= bins <= 256, 0 <= max_depth <= 64.
BvhTree build_bvh(const Mesh& mesh, const BvhOptions& options);

}  // namespace photograd
