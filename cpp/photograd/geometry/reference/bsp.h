// A binary space partition: polygons in an order in which none hides a later one, from any eye
// point [Fuchs1980].
//
// The plane of one polygon halves space, and with it all others; those that it crosses are cut in
// two. Seen from one side, nothing on the far side can hide what lies on the near side. Both halves
// are treated alike, until every polygon lies in the plane of a node.
#pragma once

#include <cstdint>
#include <vector>

#include "photograd/geometry/mesh.h"

namespace photograd {

/// Convex and flat, with the number of the triangle that it is a part of.
struct BspPolygon {
    std::vector<Vec3<double>> points;
    std::int32_t face;
};

/// Points with dot(normal, p) > offset lie in front.
struct BspPlane {
    Vec3<double> normal;
    double offset;

    [[nodiscard]] double height(const Vec3<double>& p) const { return dot(normal, p) - offset; }
};

/// Polygons first .. first + count - 1 lie in the plane; a child is -1 where there is nothing.
struct BspNode {
    BspPlane plane;
    std::int32_t front, back, first, count, depth;
};

struct BspOptions {
    int candidates;    // polygons whose planes are tried at each node
    int max_polygons;  // cutting ends with an error there
};

class BspTree {
public:
    /// Refuses (RangeError) options that are not positive, and meshes that fall into more polygons
    /// than the options allow.
    BspTree(const Mesh& mesh, const BspOptions& options);

    /// Numbers of all polygons, those that may be hidden first; order (polygon_count(),).
    void back_to_front(const Vec3<double>& eye, std::uint32_t* order) const;

    [[nodiscard]] std::int64_t polygon_count() const {
        return static_cast<std::int64_t>(polygons_.size());
    }
    [[nodiscard]] const std::vector<BspPolygon>& polygons() const { return polygons_; }
    [[nodiscard]] const std::vector<BspNode>& nodes() const { return nodes_; }

private:
    std::vector<BspPolygon> polygons_;
    std::vector<BspNode> nodes_;
};

}  // namespace photograd
