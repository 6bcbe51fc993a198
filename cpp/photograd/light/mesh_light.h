// A glowing mesh: one triangle is drawn in proportion to its area, then a point of it, so that all
// points of the mesh are alike.
//
//   L(point, w) = radiance where w meets a front first;   dL/dradiance = 1 there
//   density = (1 / area of all) r^2 / cos
//
// The density is that of a point, seen or not: where the mesh hides a part of itself, samples of
// that part are blocked like those behind any other thing, and the tracer says so. What a ray meets
// first has the density of `hit_pdf`.
#pragma once

#include "photograd/light/area_light.h"
#include "photograd/light/emitting_mesh.h"

namespace photograd {

/// A view: the mesh belongs to the caller.
template <class R>
struct MeshLight {
    Vec3<R> radiance{R(1)};
    const EmittingMesh* mesh = nullptr;

    static constexpr const char* name = "mesh";
    static constexpr LightKind kind = LightKind::area;
    static constexpr auto params =
        describe(p("radiance", &MeshLight::radiance, 0.0, 10.0, "W/(m^2 sr)"));

    [[nodiscard]] LightFault fault() const {
        return mesh ? LightFault{} : LightFault{"mesh", "a mesh"};
    }
    Vec3<R> L(const Vec3<R>& point, const Vec3<R>& w) const {
        return meet(point, w).cosine > 0 ? radiance : Vec3<R>(R(0));
    }
    void L_backward(const Vec3<R>& point, const Vec3<R>& w, const Vec3<R>& d_L,
                    MeshLight& d_self) const {
        if (meet(point, w).cosine > 0) d_self.radiance += d_L;
    }

    LightSample<R> sample(const Vec3<R>& point, const Vec2<R>& u2) const {
        const auto place = mesh->sample({double(u2.x), double(u2.y)});
        const Vec3<double> to = place.position - Vec3<double>(point),
                           n = mesh->face(place.face).normal;
        return sample_area_light(Vec3<R>(to), Vec3<R>(n), R(1 / mesh->area()), radiance);
    }
    R pdf(const Vec3<R>& point, const Vec3<R>& w) const {
        const auto at = meet(point, w);
        return at.cosine > 0 ? hit_pdf(R(at.t), R(at.cosine)) : R(0);
    }
    /// The same for a tracer that knows the distance and the cosine at the face that was hit.
    [[nodiscard]] R hit_pdf(R distance, R cosine) const {
        if (!(cosine > R(0))) return R(0);
        return solid_angle_density(R(1 / mesh->area()), distance * distance, cosine);
    }

private:
    [[nodiscard]] EmittingMesh::Meeting meet(const Vec3<R>& point, const Vec3<R>& w) const {
        if constexpr (Real<R>)
            return mesh->meet(Vec3<double>(point), Vec3<double>(w));
        else  // the place of the mesh is constant
            return mesh->meet({point.x.value, point.y.value, point.z.value},
                              {w.x.value, w.y.value, w.z.value});
    }
};

static_assert(AreaLight<MeshLight>);

}  // namespace photograd
