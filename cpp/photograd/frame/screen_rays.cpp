#include "photograd/frame/screen_rays.h"

#include "photograd/frame/chunk_sums.h"

namespace photograd {
namespace {

/// A ray's picture is a segment, on which 1 / depth is linear as well [McGuire2014].
template <class R>
struct Segment {
    R x, y, w, by_x, by_y, by_w;  // start, and from there to the end
    bool whole;                   // whether it ends where the ray does

    Segment(const ScreenFrame<R>& frame, const Vec3<R>& from, const Vec3<R>& wi, R length) {
        // Up to a hundredth of the depth of its start, a ray is before the camera.
        const R nearest = R(0.01) * from.z;
        whole = from.z + length * wi.z >= nearest;
        const R reach = whole ? length : (nearest - from.z) / wi.z;
        const Vec3<R> to = from + wi * reach;
        w = R(1) / from.z;
        x = frame.fx * from.x * w + frame.cx, y = frame.fy * from.y * w + frame.cy;
        const R end = R(1) / to.z;
        by_x = frame.fx * to.x * end + frame.cx - x;
        by_y = frame.fy * to.y * end + frame.cy - y;
        by_w = end - w;
    }
};

template <Real R>
std::int32_t follow(const ScreenFrame<R>& frame, const ScreenRays<R>& rays, std::int64_t start,
                    const Vec3<R>& wi) {
    const Segment<R> way(frame, frame.point(start), wi, rays.length);
    const R turn = (R(turn_of_pixel(start % frame.width, start / frame.width)) + R(0.5)) / R(16);
    for (int step = 0; step < rays.steps; ++step) {
        const R t = (R(step) + turn) / R(rays.steps);
        const R x = way.x + t * way.by_x, y = way.y + t * way.by_y;
        if (!(x >= R(0) && y >= R(0) && x < R(frame.width) && y < R(frame.height)))
            return ray_left_frame;
        const std::int64_t pixel =
            static_cast<std::int64_t>(y) * frame.width + static_cast<std::int64_t>(x);
        if (pixel == start || !(frame.inverse_depth[pixel] > R(0))) continue;
        // Rounding must not hide what a ray leaves.
        const R w = (way.w + t * way.by_w) * R(1 + 1e-4);
        const R shown = InverseDepth<R>::at(frame, x, y).value;
        if (!(shown > w) || R(1) / w - R(1) / shown > rays.thickness) continue;
        if (dot(frame.normal(pixel), wi) < R(0)) return static_cast<std::int32_t>(pixel);
    }
    return way.whole ? ray_missed : ray_left_frame;
}

}  // namespace

template <Real R>
void follow_screen_rays(const ScreenFrame<R>& frame, const ScreenRays<R>& rays, const R* wi,
                        std::int32_t* hit) {
    for_chunks(frame.height * frame.width,
               [&](std::int64_t, std::int64_t first, std::int64_t last) {
                   for (std::int64_t i = first; i < last; ++i) {
                       const Vec3<R> along{wi[3 * i], wi[3 * i + 1], wi[3 * i + 2]};
                       const bool shown = frame.inverse_depth[i] > R(0);
                       hit[i] = shown ? follow(frame, rays, i, along) : ray_missed;
                   }
               });
}

template void follow_screen_rays(const ScreenFrame<float>&, const ScreenRays<float>&, const float*,
                                 std::int32_t*);
template void follow_screen_rays(const ScreenFrame<double>&, const ScreenRays<double>&,
                                 const double*, std::int32_t*);

}  // namespace photograd
