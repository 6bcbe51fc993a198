// Surface points of a batch of hits.
#include <algorithm>
#include <limits>
#include <string>

#include "photograd/core/errors.h"
#include "photograd/core/parallel.h"
#include "photograd/geometry/bvh.h"

namespace photograd {

void Bvh::check_numbers(const char* function, std::span<const std::int32_t> primitive,
                        const std::int32_t* instance) const {
    for (std::size_t i = 0; i < primitive.size(); ++i) {
        if (primitive[i] < 0) continue;
        const bool known =
            instance[i] >= 0 && instance[i] < static_cast<std::int32_t>(instances_.size());
        if (!known || primitive[i] >= mesh_of(instance[i]).face_count())
            fail(ErrorKind::range, function, "primitive, instance", "numbers from trace",
                 std::to_string(primitive[i]) + ", " + std::to_string(instance[i]) + " in row " +
                     std::to_string(i));
    }
}

template <Real R>
void Bvh::surface_points(const RaySpan<R>& rays, const std::int32_t* primitive,
                         const std::int32_t* instance, const SurfaceSpan<R>& out) const {
    constexpr std::int64_t block_size = 4096;
    parallel_for((rays.count + block_size - 1) / block_size, [&](std::int64_t block) {
        const std::int64_t end = std::min(rays.count, (block + 1) * block_size);
        for (std::int64_t i = block * block_size; i < end; ++i) {
            TrianglePoint<R> p{std::numeric_limits<R>::infinity(), R(0), R(0), Vec3<R>(R(0)),
                               Vec3<R>(R(0))};
            Vec2<R> uv(R(0));
            if (primitive[i] >= 0) {
                p = surface_point(rays.ray(i), instance[i], primitive[i]);
                uv = texture_point(instance[i], primitive[i], p.u, p.v);
            }
            out.t[i] = p.t;
            for (int k = 0; k < 3; ++k) {
                out.position[3 * i + k] = p.position[k];
                out.normal[3 * i + k] = p.normal[k];
            }
            out.barycentrics[2 * i] = p.u;
            out.barycentrics[2 * i + 1] = p.v;
            out.uv[2 * i] = uv.x;
            out.uv[2 * i + 1] = uv.y;
        }
    });
}

template void Bvh::surface_points(const RaySpan<float>&, const std::int32_t*, const std::int32_t*,
                                  const SurfaceSpan<float>&) const;
template void Bvh::surface_points(const RaySpan<double>&, const std::int32_t*, const std::int32_t*,
                                  const SurfaceSpan<double>&) const;

}  // namespace photograd
