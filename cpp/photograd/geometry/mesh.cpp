#include "photograd/geometry/mesh.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "photograd/core/errors.h"

namespace photograd {
namespace {

std::string in_mesh(const char* what, std::size_t i, int mesh) {
    return std::string(what) + " " + std::to_string(i) + " of mesh " + std::to_string(mesh);
}

void check_vertices(std::span<const float> vertices, int mesh) {
    for (std::size_t i = 0; i < vertices.size(); ++i)
        if (!std::isfinite(vertices[i]))
            fail(ErrorKind::scene, "mesh", "vertices", "finite numbers",
                 std::to_string(vertices[i]) + " in " + in_mesh("vertex", i / 3, mesh));
}

void check_faces(std::span<const std::uint32_t> faces, std::size_t vertex_count, int mesh) {
    for (std::size_t i = 0; i < faces.size(); ++i)
        if (faces[i] >= vertex_count)
            fail(ErrorKind::scene, "mesh", "faces",
                 "vertex numbers below " + std::to_string(vertex_count),
                 std::to_string(faces[i]) + " in " + in_mesh("triangle", i / 3, mesh));
}

/// Twice the area over the longest edge squared: a shape number that no scaling changes. Below 1e-9
/// the rounding of float vertices (6e-8) decides which way the triangle faces.
bool has_area(const Mesh& mesh, std::uint32_t face) {
    const std::uint32_t* c = mesh.corners(face);
    const Vec3<double> a = mesh.vertex<double>(c[0]), b = mesh.vertex<double>(c[1]),
                       d = mesh.vertex<double>(c[2]);
    const Vec3<double> n = cross(b - a, d - a);
    const double longest = std::max({dot(b - a, b - a), dot(d - a, d - a), dot(d - b, d - b)});
    return dot(n, n) > 1e-18 * longest * longest;
}

}  // namespace

Mesh::Mesh(std::span<const float> vertices, std::span<const std::uint32_t> faces,
           std::span<const float> uv, int index)
    : vertices_(vertices.begin(), vertices.end()),
      faces_(faces.begin(), faces.end()),
      uv_(uv.begin(), uv.end()) {
    if (faces.empty())
        fail(ErrorKind::scene, "mesh", "faces", "at least one triangle",
             "none in mesh " + std::to_string(index));
    check_vertices(vertices, index);
    check_faces(faces, vertices.size() / 3, index);
    for (std::size_t i = 0; i < uv.size(); ++i)
        if (!std::isfinite(uv[i]))
            fail(ErrorKind::scene, "mesh", "uv", "finite numbers",
                 std::to_string(uv[i]) + " at " + in_mesh("vertex", i / 2, index));
    vertices_.insert(vertices_.end(), {0, 0, 0});
    std::size_t flat = 0;
    std::uint32_t first = 0;
    for (std::uint32_t f = 0; f < static_cast<std::uint32_t>(face_count()); ++f)
        if (!has_area(*this, f) && flat++ == 0) first = f;
    if (flat > 0)
        fail(ErrorKind::scene, "mesh", "faces", "triangles with an area",
             std::to_string(flat) + " without, the first is " + in_mesh("triangle", first, index),
             "remove them with photograd.geometry.mesh.drop_degenerate");
}

}  // namespace photograd
