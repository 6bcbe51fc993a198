#include "photograd/frame/horizon.h"

#include <cmath>

#include "photograd/core/atan.h"
#include "photograd/core/sincos.h"
#include "photograd/frame/chunk_sums.h"
#include "photograd/sampling/warp.h"

namespace photograd {
namespace {

template <class R>
R angle_of_cosine(R c) {
    c = std::clamp(c, R(-1), R(1));
    return polar_angle(std::sqrt(R(1) - c * c), c);
}

/// What a slice shows of the sky, and would without occluders.
template <class R>
struct Slice {
    R visible, open;
};

template <class R>
class Pixel {
public:
    Pixel(const ScreenFrame<R>& frame, const HorizonSettings<R>& settings, std::int64_t i)
        : frame_(frame), settings_(settings), x_(R(i % frame.width) + R(0.5)) {
        y_ = R(i / frame.width) + R(0.5);
        point_ = frame.point(i);
        viewer_ = normalize(point_ * R(-1));
        normal_ = frame.normal(i);
        turn_ = (R(turn_of_pixel(i % frame.width, i / frame.width)) + R(0.5)) / R(16);
    }
    /// c, s: a direction of the picture.
    [[nodiscard]] Slice<R> slice(R c, R s) const {
        // Along the picture, and across the line of sight.
        const Vec3<R> along = normalize(Vec3<R>{c, s, R(0)} - viewer_ * dot({c, s, R(0)}, viewer_));
        const Vec3<R> across = cross(along, viewer_);
        const Vec3<R> projected = normal_ - across * dot(normal_, across);
        const R p = length(projected);
        if (!(p > R(1e-6))) return {R(0), R(0)};
        const R n = polar_angle(dot(projected, along), dot(projected, viewer_));
        const auto [sin_n, cos_n] = sin_cos(n);
        const R quarter = R(pi / 2);
        const R after = std::min(angle_of_cosine(horizon(c, s, cosine(n + quarter))), n + quarter);
        const R before =
            std::min(angle_of_cosine(horizon(-c, -s, cosine(quarter - n))), quarter - n);
        const auto part = [&](R h) {
            return (cos_n + R(2) * h * sin_n - cosine(R(2) * h - n)) / R(4);
        };
        return {p * (part(after) + part(-before)), p * (cos_n + n * sin_n)};
    }

private:
    static R cosine(R angle) {
        if (angle > R(pi)) angle -= R(2 * pi);
        if (angle < R(-pi)) angle += R(2 * pi);
        return sin_cos(angle).cos;
    }
    /// The largest cosine with the direction towards the viewer, at least `lowest`.
    R horizon(R c, R s, R lowest) const {
        R highest = lowest;
        const R reach = settings_.radius / point_.z;
        for (int step = 0; step < settings_.steps; ++step) {
            const R fraction = (R(step) + turn_) / R(settings_.steps);
            const R t = reach * fraction * fraction;  // gathered at the pixel
            // One pixel further at least: the surface itself hides nothing.
            const R x = x_ + c * std::max(t * frame_.fx, R(1));
            const R y = y_ + s * std::max(t * frame_.fy, R(1));
            if (!(x >= R(0) && y >= R(0) && x < R(frame_.width) && y < R(frame_.height))) break;
            const R w = InverseDepth<R>::at(frame_, x, y).value;
            if (!(w > R(0))) continue;
            const Vec3<R> v = frame_.ray(x, y) * (R(1) / w) - point_;
            const R distance = length(v);
            if (!(distance < settings_.radius)) continue;
            const R found = dot(v, viewer_) / distance;
            const R fades = settings_.falloff * settings_.radius;
            const R part =
                fades > R(0) ? std::min((settings_.radius - distance) / fades, R(1)) : R(1);
            highest = std::max(highest, lowest + part * (found - lowest));
        }
        return highest;
    }

    const ScreenFrame<R>& frame_;
    const HorizonSettings<R>& settings_;
    R x_, y_, turn_;
    Vec3<R> point_{R(0)}, viewer_{R(0)}, normal_{R(0)};
};

}  // namespace

template <Real R>
void horizon_occlusion(const ScreenFrame<R>& frame, const HorizonSettings<R>& settings, R* out) {
    const auto one = [&](std::int64_t i) {
        if (!(frame.inverse_depth[i] > R(0))) return R(1);
        const Pixel<R> pixel(frame, settings, i);
        const R turn = R(turn_of_pixel(i % frame.width, i / frame.width)) / R(16);
        R visible = R(0), open = R(0);
        for (int k = 0; k < settings.slices; ++k) {
            const auto [s, c] = sin_cos(R(pi) * (R(k) + turn) / R(settings.slices));
            const Slice<R> found = pixel.slice(c, s);
            visible += found.visible, open += found.open;
        }
        return open > R(0) ? std::clamp(visible / open, R(0), R(1)) : R(1);
    };
    for_chunks(frame.height * frame.width,
               [&](std::int64_t, std::int64_t first, std::int64_t last) {
                   for (std::int64_t i = first; i < last; ++i) out[i] = one(i);
               });
}

template void horizon_occlusion(const ScreenFrame<float>&, const HorizonSettings<float>&, float*);
template void horizon_occlusion(const ScreenFrame<double>&, const HorizonSettings<double>&,
                                double*);

}  // namespace photograd
