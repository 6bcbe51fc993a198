#include "photograd/scene/emitters.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "photograd/core/errors.h"
#include "photograd/sampling/warp.h"

namespace photograd {
namespace {

double triangle_area(const Bvh& bvh, std::int32_t shape, std::int32_t primitive) {
    Vec3<double> p[3];
    bvh.corners(shape, primitive, p);
    return 0.5 * length(cross(p[1] - p[0], p[2] - p[0]));
}

double mean_emission(std::span<const double> emission, std::size_t shape) {
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        const double L = emission[3 * shape + c];
        if (!(L >= 0) || !std::isfinite(L))
            fail(ErrorKind::scene, "scene", "emission", "finite radiance of at least 0",
                 std::to_string(L) + " in shape " + std::to_string(shape));
        sum += L;
    }
    return sum / 3;
}

}  // namespace

Emitters::Emitters(const Bvh& bvh, std::span<const double> emission, bool has_environment) {
    const std::size_t meshes = bvh.instances().size(), spheres = bvh.spheres().size();
    first_.assign(meshes + spheres, -1);
    double power = 0;
    const auto add = [&](std::size_t shape, std::int32_t primitive, double area, double L) {
        if (!(area > 0))
            fail(ErrorKind::scene, "scene", "emission", "lights with an area",
                 "none in primitive " + std::to_string(primitive) + " of shape " +
                     std::to_string(shape));
        if (first_[shape] < 0) first_[shape] = static_cast<std::int32_t>(pieces_.size());
        pieces_.push_back({static_cast<std::int32_t>(shape), primitive, area, area * L});
        power += area * L;
    };
    for (std::size_t shape = 0; shape < meshes + spheres; ++shape) {
        const double L = mean_emission(emission, shape);
        if (L == 0) continue;
        if (shape >= meshes) {
            const double r = static_cast<double>(bvh.spheres()[shape - meshes].radius);
            add(shape, static_cast<std::int32_t>(shape - meshes), 4 * pi * r * r, L);
            continue;
        }
        const auto id = static_cast<std::int32_t>(shape);
        const auto faces = static_cast<std::int32_t>(bvh.mesh_of(id).face_count());
        for (std::int32_t face = 0; face < faces; ++face)
            add(shape, face, triangle_area(bvh, id, face), L);
    }
    if (has_environment) environment_pmf_ = pieces_.empty() ? 1.0 : 0.5;
    double passed = 0;
    for (EmitterPiece& piece : pieces_) {
        piece.pmf *= (1 - environment_pmf_) / power;
        upper_.push_back(passed += piece.pmf);
    }
}

int Emitters::choose(double u) const {
    if (empty()) return none;
    if (u >= 1 - environment_pmf_) return environment;
    const auto at = std::upper_bound(upper_.begin(), upper_.end(), u) - upper_.begin();
    return std::min(static_cast<int>(at), static_cast<int>(pieces_.size()) - 1);
}

double Emitters::density(std::int32_t shape, std::int32_t primitive) const {
    const std::int32_t first = first_[static_cast<std::size_t>(shape)];
    if (first < 0) return 0;
    const EmitterPiece& start = pieces_[static_cast<std::size_t>(first)];
    const EmitterPiece& piece =
        pieces_[static_cast<std::size_t>(first + primitive - start.primitive)];
    return piece.pmf / piece.area;
}

template <Real R>
EmitterPoint<R> Emitters::point(const Bvh& bvh, int piece, const Vec2<R>& u2) const {
    const EmitterPiece& it = pieces_[static_cast<std::size_t>(piece)];
    if (it.shape >= bvh.sphere_instance()) {
        const Sphere& sphere = bvh.spheres()[static_cast<std::size_t>(it.primitive)];
        const Vec3<R> normal = square_to_cap(u2, R(2));
        return {sphere.center<R>() + R(sphere.radius) * normal, normal};
    }
    // The square is folded along its diagonal onto the triangle a, b, c: both halves have the same area.
    Vec3<R> p[3];
    bvh.corners(it.shape, it.primitive, p);
    const bool beyond = u2.x + u2.y > R(1);
    const R u = beyond ? R(1) - u2.x : u2.x, v = beyond ? R(1) - u2.y : u2.y;
    const Vec3<R> ab = p[1] - p[0], ac = p[2] - p[0];
    return {p[0] + u * ab + v * ac, normalize(cross(ab, ac))};
}

template EmitterPoint<float> Emitters::point(const Bvh&, int, const Vec2<float>&) const;
template EmitterPoint<double> Emitters::point(const Bvh&, int, const Vec2<double>&) const;

}  // namespace photograd
