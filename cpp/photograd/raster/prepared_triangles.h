// Triangles of one view, set up and listed by tile: what the rasterizer and its queries share.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "photograd/raster/triangle.h"

namespace photograd {

inline constexpr int raster_tile = 16;  // pixels along an edge of a tile

/// The mesh and its vertices in homogeneous pixels; none of the arrays is held.
struct ScreenMesh {
    std::span<const double> positions;     // (V, 3) = (z x, z y, z)
    std::span<const std::uint32_t> faces;  // (F, 3)
    int width, height;
    const bool* face_mask = nullptr;  // null, or which faces (F,) there are

    [[nodiscard]] std::int64_t face_count() const {
        return static_cast<std::int64_t>(faces.size() / 3);
    }
    [[nodiscard]] Vec3<double> corner(std::uint32_t face, int i) const {
        const double* v =
            &positions[3 * std::size_t{faces[3 * std::size_t{face} + static_cast<std::size_t>(i)]}];
        return {v[0], v[1], v[2]};
    }
    [[nodiscard]] TriangleEdges<double> edges(std::uint32_t face) const {
        return TriangleEdges<double>::of(corner(face, 0), corner(face, 1), corner(face, 2));
    }
};

/// A triangle with its lines turned so that its inside is where all three are positive.
struct ScreenTriangle {
    TriangleEdges<double> edges;
    double least[3];     // a point lies inside where each w_i is greater than least[i]
    int x0, x1, y0, y1;  // pixels that it may cover: [x0, x1) x [y0, y1)
    std::uint32_t face;
    bool front;

    /// The depth at a point that the triangle covers; a negative number where it does not.
    [[nodiscard]] double depth_at(double x, double y) const {
        const auto& e = edges.line;
        const double w0 = e[0].x * x + (e[0].y * y + e[0].z);
        const double w1 = e[1].x * x + (e[1].y * y + e[1].z);
        const double w2 = e[2].x * x + (e[2].y * y + e[2].z);
        const bool inside = (w0 > least[0]) & (w1 > least[1]) & (w2 > least[2]);
        return inside ? edges.det / (w0 + w1 + w2) : -1.0;
    }
};

/// Which points of a triangle are asked for: centers of pixels alone, or any.
enum class Reach { centers, anywhere };

/// Faces of each tile in the order of their numbers.
class PreparedTriangles {
public:
    /// Of triangles without an area in the image, beyond `near`, or outside of the image nothing
    /// is kept. Throws RangeError for more pairs of triangle and tile than 32 bits number.
    PreparedTriangles(const ScreenMesh& mesh, double near, Reach reach);

    [[nodiscard]] int columns() const { return columns_; }
    [[nodiscard]] int rows() const { return rows_; }
    [[nodiscard]] const ScreenTriangle& triangle(std::uint32_t slot) const {
        return triangles_[slot];
    }
    /// Their slots, for `triangle`.
    [[nodiscard]] std::span<const std::uint32_t> in_tile(std::size_t tile) const {
        return std::span(listed_).subspan(begin_[tile], begin_[tile + 1] - begin_[tile]);
    }
    /// The nearest face within [near, far] at points (x, y) of the image, or -1; and its depth.
    void nearest(std::span<const double> points, double near, double far, std::int32_t* face,
                 double* depth) const;
    /// How many faces within [near, depth[i]] lie at point i.
    void count(std::span<const double> points, double near, const double* depth,
               std::int32_t* counts) const;

private:
    /// visit(i, face, z) for each face at a point, in the order of their numbers.
    template <class Visit>
    void at_points(std::span<const double> points, Visit&& visit) const;

    int width_, height_, columns_, rows_;
    // Those that may be seen, with gaps that are not written: each piece of the list of faces fills
    // the slots from its first face on.
    std::unique_ptr<ScreenTriangle[]> triangles_;
    std::vector<std::uint32_t> begin_;  // by tile, one more at the end
    std::vector<std::uint32_t> listed_;
};

}  // namespace photograd
