#include "photograd/frame/ssao.h"

#include <array>
#include <cmath>

#include "kernels/kernels.h"
#include "photograd/core/sincos.h"
#include "photograd/frame/chunk_sums.h"
#include "photograd/ops/obscurance.h"
#include "photograd/sampling/warp.h"

namespace photograd {
namespace {

/// Directions and distances of the samples, before they are turned and scaled.
template <class R>
struct Spiral {
    std::array<R, max_ssao_samples> cosine{}, sine{}, alpha{}, alpha_by_distribution{};
    std::array<R, 16> turn_cosine{}, turn_sine{};
    int count;

    Spiral(int samples, R distribution) : count(samples) {
        // Successive samples are the golden angle apart.
        constexpr double golden = 2.39996322972865332;
        for (int i = 0; i < count; ++i) {
            const auto at = static_cast<std::size_t>(i);
            const double angle = std::fmod(golden * i, 2 * pi);
            const auto [s, c] = sin_cos(R(angle > pi ? angle - 2 * pi : angle));
            cosine[at] = c, sine[at] = s;
            const R base = (R(i) + R(0.5)) / R(count);
            alpha[at] = pow(base, distribution);
            alpha_by_distribution[at] = alpha[at] * log(base);
        }
        for (std::size_t k = 0; k < 16; ++k) {
            const auto [s, c] = sin_cos(R(2 * pi * double(k) / 16 - pi));
            turn_cosine[k] = c, turn_sine[k] = s;
        }
    }
};

/// A pixel, from which its samples are taken.
template <class R>
class SampledPixel {
public:
    SampledPixel(const ScreenFrame<R>& frame, const Spiral<R>& spiral,
                 const SsaoSettings<R>& settings, std::int64_t x, std::int64_t y)
        : frame_(frame),
          spiral_(spiral),
          settings_(settings),
          x_(R(x) + R(0.5)),
          y_(R(y) + R(0.5)),
          turn_(static_cast<std::size_t>(turn_of_pixel(x, y))) {
        const std::int64_t i = y * frame.width + x;
        w_ = frame.inverse_depth[i];
        point_ = frame.ray(x_, y_) * (R(1) / w_);
        normal_ = frame.normal(i);
    }
    R sample(int i) const {
        const Tap tap = tap_of(i);
        const InverseDepth<R> at = InverseDepth<R>::at(frame_, tap.x, tap.y);
        if (!(at.value > R(0))) return R(0);
        const Vec3<R> v = frame_.ray(tap.x, tap.y) * (R(1) / at.value) - point_;
        // Below the surface: most points, and all that a bias of at least 0 leaves out as well.
        if (!(dot(v, normal_) > R(0))) return R(0);
        return obscurance(v, normal_, by());
    }
    /// Adds to d, all but the strength.
    void sample_backward(int i, R d_a, SsaoSettings<R>& d) const {
        const Tap tap = tap_of(i);
        const InverseDepth<R> at = InverseDepth<R>::at(frame_, tap.x, tap.y);
        if (!(at.value > R(0))) return;
        const R over = R(1) / at.value;
        const Vec3<R> r = frame_.ray(tap.x, tap.y);
        Vec3<R> d_v(R(0));
        Obscurance<R> d_by{R(0), R(0), R(0)};
        obscurance_backward(r * over - point_, normal_, by(), d_a, d_v, d_by);
        d.radius += d_by.radius;
        d.falloff += d_by.falloff;
        d.bias += d_by.bias;
        const R d_w = -dot(d_v, r) * over * over;
        const R d_x = d_v.x * over / frame_.fx + d_w * at.by_x;
        const R d_y = d_v.y * over / frame_.fy + d_w * at.by_y;
        const R d_reach = d_x * tap.along_x + d_y * tap.along_y;  // of radius alpha_i
        const auto k = static_cast<std::size_t>(i);
        d.radius += d_reach * spiral_.alpha[k];
        d.distribution += d_reach * settings_.radius * spiral_.alpha_by_distribution[k];
    }

private:
    struct Tap {
        R x, y, along_x, along_y;
    };
    Obscurance<R> by() const { return {settings_.radius, settings_.falloff, settings_.bias}; }
    Tap tap_of(int i) const {
        const auto k = static_cast<std::size_t>(i);
        const R c = spiral_.cosine[k] * spiral_.turn_cosine[turn_] -
                    spiral_.sine[k] * spiral_.turn_sine[turn_];
        const R s = spiral_.sine[k] * spiral_.turn_cosine[turn_] +
                    spiral_.cosine[k] * spiral_.turn_sine[turn_];
        const R along_x = w_ * frame_.fx * c, along_y = w_ * frame_.fy * s;
        const R reach = settings_.radius * spiral_.alpha[k];
        return {x_ + reach * along_x, y_ + reach * along_y, along_x, along_y};
    }

    const ScreenFrame<R>& frame_;
    const Spiral<R>& spiral_;
    const SsaoSettings<R>& settings_;
    R x_, y_, w_;
    std::size_t turn_;
    Vec3<R> point_{R(0)}, normal_{R(0)};
};

/// By lanes, in pictures whose pixels 32 bits number.
void occlude_rows(const ScreenFrame<float>& frame, const SsaoSettings<float>& settings, int samples,
                  float* out) {
    const Spiral<float> spiral(samples, settings.distribution);
    std::array<float, 16> turn_cosine{}, turn_sine{};
    for (std::size_t i = 0; i < 16; ++i) {
        const auto turn = static_cast<std::size_t>(turn_of_pixel(i % 4, i / 4));
        turn_cosine[i] = spiral.turn_cosine[turn], turn_sine[i] = spiral.turn_sine[turn];
    }
    const SsaoRows rows{frame.height,
                        frame.width,
                        frame.fx,
                        frame.fy,
                        frame.cx,
                        frame.cy,
                        frame.inverse_depth,
                        frame.normals,
                        settings.radius,
                        settings.falloff,
                        settings.bias,
                        settings.strength,
                        samples,
                        spiral.cosine.data(),
                        spiral.sine.data(),
                        spiral.alpha.data(),
                        turn_cosine.data(),
                        turn_sine.data(),
                        out};
    parallel_for(frame.height, [&](std::int64_t y) { kernels().ssao_row(rows, y); });
}

template <Real R>
void occlude_pixels(const ScreenFrame<R>& frame, const SsaoSettings<R>& settings, int samples,
                    R* out) {
    const Spiral<R> spiral(samples, settings.distribution);
    parallel_for(frame.height, [&](std::int64_t y) {
        for (std::int64_t x = 0; x < frame.width; ++x) {
            const std::int64_t i = y * frame.width + x;
            R sum = R(0);
            if (frame.inverse_depth[i] > R(0)) {
                const SampledPixel<R> pixel(frame, spiral, settings, x, y);
                for (int k = 0; k < samples; ++k) sum += pixel.sample(k);
            }
            out[i] = R(1) - settings.strength * sum / R(samples);
        }
    });
}

template <Real R>
void occlude_pixels_backward(const ScreenFrame<R>& frame, const SsaoSettings<R>& settings,
                             int samples, const R* d_out, R* d_settings) {
    const Spiral<R> spiral(samples, settings.distribution);
    add_chunk_sums(frame.height * frame.width, 5, d_settings,
                   [&](std::int64_t first, std::int64_t last, R* own) {
                       SsaoSettings<R> d{};
                       for (std::int64_t i = first; i < last; ++i) {
                           if (!(frame.inverse_depth[i] > R(0))) continue;
                           const SampledPixel<R> pixel(frame, spiral, settings, i % frame.width,
                                                       i / frame.width);
                           const R d_mean = -d_out[i] / R(samples);
                           for (int k = 0; k < samples; ++k) {
                               pixel.sample_backward(k, d_mean * settings.strength, d);
                               d.strength += d_mean * pixel.sample(k);
                           }
                       }
                       const R sums[5] = {d.radius, d.falloff, d.bias, d.distribution, d.strength};
                       for (int k = 0; k < 5; ++k) own[k] += sums[k];
                   });
}

}  // namespace

template <Real R>
void ssao(const ScreenFrame<R>& frame, const SsaoSettings<R>& settings, int samples, R* out) {
    if constexpr (std::same_as<R, float>)
        if (frame.height * frame.width < std::int64_t{1} << 31)
            return occlude_rows(frame, settings, samples, out);
    occlude_pixels(frame, settings, samples, out);
}
template <Real R>
void ssao_backward(const ScreenFrame<R>& frame, const SsaoSettings<R>& settings, int samples,
                   const R* d_out, R* d_settings) {
    occlude_pixels_backward(frame, settings, samples, d_out, d_settings);
}

template void ssao(const ScreenFrame<float>&, const SsaoSettings<float>&, int, float*);
template void ssao(const ScreenFrame<double>&, const SsaoSettings<double>&, int, double*);
template void ssao_backward(const ScreenFrame<float>&, const SsaoSettings<float>&, int,
                            const float*, float*);
template void ssao_backward(const ScreenFrame<double>&, const SsaoSettings<double>&, int,
                            const double*, double*);

}  // namespace photograd
