// Normal maps: pictures of normals, in the frame of the texture coordinates, after [Blinn1978].
//
// With corners p0, p1, p2 of a triangle and (b, c) the steps of (u, v) along its two edges e1, e2,
//
//   dp/du ~ c_v e1 - b_v e2,   dp/dv ~ b_u e2 - c_u e1
//       both over b_u c_v - c_u b_v, whose sign alone counts
//
// x is dp/du made perpendicular to the shading normal n, y its perpendicular against growing v. A
// normal (t_x, t_y, t_z) of the map is x t_x + y t_y + n t_z, of unit length. A path sees the bent
// surface as any other with a shading normal of its own (SurfaceSide): no light passes, and no more
// leaves than the model returns. The map is geometry and has no derivative.
#pragma once

#include "photograd/geometry/bvh.h"
#include "photograd/scene/textured.h"

namespace photograd {

/// The map's vector at a point, not of unit length.
template <class R>
Vec3<R> mapped_normal(const NormalMap& map, const Vec2<R>& uv) {
    const TextureShape& shape = map.layout.shape;
    const Vec2<R> at = map.layout.inside(uv);
    const TexelAxis<R> column = texel_axis(at.x, shape.width), row = texel_axis(at.y, shape.height);
    const TexelSteps<3> step = TexelSteps<3>::of(shape);
    const auto w = BilinearWeights<R>::of(column.fraction, row.fraction);
    const float* t =
        map.values.data() + 3 * (static_cast<std::int64_t>(row.base) * shape.width + column.base);
    Vec3<R> out;
    for (int k = 0; k < 3; ++k)
        out[k] = w.w00 * R(t[k]) + w.w01 * R(t[step.right + k]) + w.w10 * R(t[step.down + k]) +
                 w.w11 * R(t[step.down + step.right + k]);
    return out;
}

/// Along growing u and v on a triangle, of any length; 0 where the coordinates do not change.
template <class R>
struct TextureAxes {
    Vec3<R> u, v;

    static TextureAxes of(const Bvh& bvh, std::int32_t instance, std::int32_t primitive,
                          double time = 0) {
        Vec3<R> p[3];
        bvh.corners(instance, primitive, p, time);
        const Vec2<R> a = bvh.texture_point(instance, primitive, R(0), R(0)),
                      b = bvh.texture_point(instance, primitive, R(1), R(0)) - a,
                      c = bvh.texture_point(instance, primitive, R(0), R(1)) - a;
        const Vec3<R> e1 = p[1] - p[0], e2 = p[2] - p[0];
        const R sign = b.x * c.y - c.x * b.y < R(0) ? R(-1) : R(1);
        return {(e1 * c.y - e2 * b.y) * sign, (e2 * b.x - e1 * c.x) * sign};
    }
};

/// Bends `normal`, which lies on the side of `outside`; a map that would turn it away from there
/// does nothing.
template <class R>
void bend_normal(const Bvh& bvh, const NormalMap& map, std::int32_t instance,
                 std::int32_t primitive, const Vec2<R>& uv, const Vec3<R>& outside, Vec3<R>& normal,
                 double time = 0) {
    const auto axes = TextureAxes<R>::of(bvh, instance, primitive, time);
    Vec3<R> x = axes.u;
    x -= normal * dot(normal, x);
    const R size = length(x);
    if (!(size > R(0))) return;  // u is the same everywhere
    x *= R(1) / size;
    Vec3<R> y = cross(normal, x);
    if (dot(y, axes.v) > R(0)) y = -y;
    const Vec3<R> t = mapped_normal(map, uv), bent = x * t.x + y * t.y + normal * t.z;
    const R far = length(bent);
    if (far > R(1e-3) && dot(bent, outside) > R(1e-3) * far) normal = bent * (R(1) / far);
}

}  // namespace photograd
