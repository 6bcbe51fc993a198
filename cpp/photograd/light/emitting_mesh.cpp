#include "photograd/light/emitting_mesh.h"

#include <cmath>
#include <limits>
#include <string>

#include "photograd/core/errors.h"
#include "photograd/sampling/triangle_warp.h"

namespace photograd {
namespace {

void check_arrays(std::span<const double> vertices, std::span<const std::uint32_t> faces) {
    const auto refuse = [](const char* argument, const char* expected, const std::string& got) {
        fail(ErrorKind::scene, "EmittingMesh", argument, expected, got);
    };
    if (faces.empty()) refuse("faces", "at least one", "none");
    for (std::size_t i = 0; i < vertices.size(); ++i)
        if (!std::isfinite(vertices[i]))
            refuse("vertices", "finite numbers",
                   "NaN or infinity in vertex " + std::to_string(i / 3));
    for (std::size_t i = 0; i < faces.size(); ++i)
        if (faces[i] >= vertices.size() / 3)
            refuse("faces", "numbers of vertices",
                   std::to_string(faces[i]) + " in face " + std::to_string(i / 3) +
                       " of a mesh of " + std::to_string(vertices.size() / 3) + " vertices");
}

}  // namespace

EmittingMesh::EmittingMesh(std::span<const double> vertices, std::span<const std::uint32_t> faces) {
    check_arrays(vertices, faces);
    const auto vertex = [&](std::uint32_t i) {
        const double* v = &vertices[3 * static_cast<std::size_t>(i)];
        return Vec3<double>(v[0], v[1], v[2]);
    };
    std::vector<double> areas;
    for (std::size_t i = 0; i + 2 < faces.size(); i += 3) {
        const Vec3<double> a = vertex(faces[i]), ab = vertex(faces[i + 1]) - a,
                           ac = vertex(faces[i + 2]) - a, n = cross(ab, ac);
        const double twice = length(n);
        // Also refuses edges whose squares overflow.
        if (!(twice > 0.0) || !(twice < std::numeric_limits<double>::max()))
            fail(ErrorKind::scene, "EmittingMesh", "faces", "faces with an area",
                 "none in face " + std::to_string(i / 3), "remove it, it can give no light");
        areas.push_back(0.5 * twice);
        faces_.push_back({a, ab, ac, n * (1 / twice)});
    }
    choice_ = Distribution1D(areas);
}

EmittingMesh::Place EmittingMesh::sample(const Vec2<double>& u2) const {
    const Choice choice = choice_.sample(u2.x);
    const Vec2<double> q = square_to_triangle(Vec2<double>(choice.rest, u2.y));
    const Face& on = face(choice.index);
    return {choice.index, on.a + q.x * on.ab + q.y * on.ac};
}

EmittingMesh::Meeting EmittingMesh::meet(const Vec3<double>& point, const Vec3<double>& w) const {
    constexpr double hair = 1e-12;  // no line passes between two neighbours
    Meeting first{-1, std::numeric_limits<double>::infinity(), 0.0};
    for (std::int64_t i = 0; i < face_count(); ++i) {
        const Face& on = face(i);
        const auto at = triangle_point(Ray<double>{point, w}, on.a, on.a + on.ab, on.a + on.ac);
        const bool inside = at.u >= -hair && at.v >= -hair && at.u + at.v <= 1 + hair;
        if (inside && at.t > 0 && at.t < first.t) first = {i, at.t, -dot(w, on.normal)};
    }
    return first;
}

}  // namespace photograd
