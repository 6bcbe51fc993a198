// The triangles of a mesh that glows, and the table by which one is drawn.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "photograd/core/real.h"
#include "photograd/geometry/triangle.h"
#include "photograd/sampling/distribution_1d.h"

namespace photograd {

class EmittingMesh {
public:
    /// Vertices (V, 3) in the world, faces (F, 3). Refuses (SceneError) a mesh without faces,
    /// corners that name no vertex, vertices that are not finite and faces without area: a light of
    /// none cannot be drawn from.
    EmittingMesh(std::span<const double> vertices, std::span<const std::uint32_t> faces);

    struct Face {
        Vec3<double> a, ab, ac, normal;  // a corner, two edges, unit normal by the winding
    };
    struct Place {
        std::int64_t face;
        Vec3<double> position;
    };
    /// Where the line from `point` along w first meets the mesh; face -1: nowhere.
    struct Meeting {
        std::int64_t face;
        double t, cosine;  // cosine > 0: the front was met
    };

    /// A point of the mesh, even over its area.
    [[nodiscard]] Place sample(const Vec2<double>& u2) const;
    [[nodiscard]] const Face& face(std::int64_t i) const {
        return faces_[static_cast<std::size_t>(i)];
    }
    [[nodiscard]] std::int64_t face_count() const {
        return static_cast<std::int64_t>(faces_.size());
    }
    [[nodiscard]] double area() const { return choice_.total(); }
    /// Tries all faces, one after another: for proofs and small lamps. A renderer has its own
    /// tracer.
    [[nodiscard]] Meeting meet(const Vec3<double>& point, const Vec3<double>& w) const;

private:
    std::vector<Face> faces_;
    Distribution1D choice_;  // by area
};

}  // namespace photograd
