#include "photograd/geometry/bvh_limits.h"

#include <algorithm>
#include <cmath>

#include "photograd/core/errors.h"
#include "photograd/core/world_limit.h"

namespace photograd {
namespace {

[[noreturn]] void refuse_size(const char* argument, double size, const std::string& where) {
    fail(ErrorKind::scene, "bvh", argument,
         "all of the scene within " + number_text(world_limit) + " m of the origin",
         number_text(size) + " m in " + where);
}

/// The least |determinant| while `it` moves; 0 if it turns inside out. It is a cubic in the time:
/// the least lies at an end or where the derivative vanishes.
double least_determinant(const Instance& it) {
    const auto at = [&](double time) { return it.at(time).determinant(); };
    const double d0 = at(0);
    if (!it.moves) return std::abs(d0);
    const double d1 = at(1.0 / 3), d2 = at(2.0 / 3), d3 = at(1);
    const double a = 4.5 * (d3 - 3 * d2 + 3 * d1 - d0), b = 4.5 * (2 * d0 - 5 * d1 + 4 * d2 - d3),
                 c = 0.5 * (-11 * d0 + 18 * d1 - 9 * d2 + 2 * d3);
    double least = std::min(std::abs(d0), std::abs(d3));
    if (!(d0 * d3 > 0)) return 0;
    // 3 a t^2 + 2 b t + c = 0, without the cancellation of the school's formula.
    const double q = -(b + std::copysign(std::sqrt(std::max(b * b - 3 * a * c, 0.0)), b));
    for (const double time : {q / (3 * a), c / q})
        if (time > 0 && time < 1) {
            if (!(at(time) * d0 > 0)) return 0;
            least = std::min(least, std::abs(at(time)));
        }
    constexpr double rounding = 1e-9;  // of the ends; less may be 0 at a time beside this one
    return least > rounding * std::max(std::abs(d0), std::abs(d3)) ? least : 0;
}

}  // namespace

void check_spheres(const std::vector<Sphere>& spheres) {
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        const Sphere& s = spheres[i];
        const std::string name = "sphere " + std::to_string(i);
        if (!std::isfinite(s.x + s.y + s.z + s.radius) || !(s.radius > 0))
            fail(ErrorKind::scene, "bvh", "spheres", "finite centers and radii above 0",
                 "radius " + std::to_string(s.radius) + " in " + name);
        const double size =
            double(std::max({std::abs(s.x), std::abs(s.y), std::abs(s.z)})) + double(s.radius);
        if (!(size <= world_limit)) refuse_size("spheres", size, name);
    }
}

Vec3<double> extent_of(const Mesh& mesh) {
    Vec3<double> extent(0);
    for (std::int64_t v = 0; v < mesh.vertex_count(); ++v)
        for (int k = 0; k < 3; ++k)
            extent[k] = std::max(extent[k], std::abs(double(mesh.vertex_data()[3 * v + k])));
    return extent;
}

void check_transform(const char* argument, const Affine& transform, const Vec3<double>& extent,
                     const std::string& name) {
    for (int i = 0; i < 3; ++i) {
        const double* row = transform.m.data() + 4 * i;
        double size = std::abs(row[3]);
        for (int k = 0; k < 3; ++k) size += std::abs(row[k]) * extent[k];
        if (!(size <= world_limit)) refuse_size(argument, size, name);
    }
}

double reach_into(const Instance& it, const std::string& name) {
    constexpr double embree_limit = 1e18, least_normal = 1e-36;
    double largest = 0, shift = 0;
    for (std::size_t i = 0; i < 12; ++i) {
        const double m = std::abs(it.world_from_object.m[i]), n = std::abs(it.closing.m[i]);
        double& to = i % 4 == 3 ? shift : largest;
        to = std::max({to, m, it.moves ? n : 0.0});
    }
    const double determinant = least_determinant(it);
    const double reach = embree_limit * determinant / (6 * largest * largest) - shift;
    if (!(determinant >= least_normal && determinant <= 1 / least_normal && reach > 0))
        fail(ErrorKind::scene, "bvh", "world_from_object",
             it.moves ? "matrices that can be inverted in float32 while the shutter is open"
                      : "matrices that can be inverted in float32",
             "a determinant of " + number_text(determinant) + " in " + name,
             "scale by less, or the vertices themselves");
    return reach;
}

void check_reach(double reach, const Box& bounds) {
    double size = 0;
    for (int k = 0; k < 3; ++k)
        size = std::max({size, double(std::abs(bounds.lo[k])), double(std::abs(bounds.hi[k]))});
    if (!(reach >= 4 * size))
        fail(ErrorKind::scene, "bvh", "world_from_object",
             "matrices under which rays from anywhere in the scene stay within Embree's range",
             "a scene of " + number_text(size) + " m and a reach of " + number_text(reach) + " m",
             "scale by less, or the vertices themselves");
}

}  // namespace photograd
