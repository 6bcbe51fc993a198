// Rays that meet Gaussians and spheres as flat functions, for the proofs (see op_list.h).
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "input_group.h"
#include "photograd/ops/ray_sphere.h"
#include "photograd/splat/ray_blend.h"
#include "photograd/splat/ray_color.h"
#include "photograd/splat/ray_gaussian.h"
#include "sdf_op_list.h"

namespace photograd {

/// A ray from near the origin along z, neither of unit length nor through the mean, 3 in front;
/// outputs q and t.
struct RayGaussianOp {
    static constexpr const char* name = "ray_gaussian";
    static constexpr std::array<InputGroup, 5> inputs{{{"origin", 3, -0.3, 0.3},
                                                       {"direction", 3, -0.2, 0.2},
                                                       {"mean", 3, -0.3, 0.3},
                                                       {"quat", 4, 0.2, 1.5},
                                                       {"log_scale", 3, -1, 0.5}}};
    static constexpr int outputs = 2;

    template <class R>
    struct Setup {
        R direction[3], mean[3];
        GaussianAxes<R> axes;
        RayGaussian<R> shape;
        RayPeak<R> peak;
        explicit Setup(const R* in) {
            for (int i = 0; i < 3; ++i) {
                direction[i] = in[3 + i] + R(i == 2 ? 1.3 : 0.0);
                mean[i] = in[6 + i] + R(i == 2 ? 3 : 0);
            }
            axes = GaussianAxes<R>::of(in + 9, in + 13);
            shape = RayGaussian<R>::of(mean, axes);
            peak = ray_peak(shape, in, direction);
        }
    };
    template <class R>
    static void forward(const R* in, R* out) {
        const Setup<R> at(in);
        out[0] = at.peak.q;
        out[1] = at.peak.t;
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        const Setup<R> at(in);
        R d_strain[6] = {};
        ray_peak_backward_ray(at.shape, at.peak, d_out[0], d_out[1], d_in, d_in + 3);
        ray_peak_backward_gaussian(at.shape, at.peak, d_out[0], d_out[1], d_in + 6, d_strain);
        strain_backward(at.axes, d_strain, d_in + 9, d_in + 13);
    }
};

/// A color of degree 3 in a direction of any length; no channel is held at 0.
struct RayColorOp {
    static constexpr const char* name = "ray_color";
    static constexpr int degree = 3, coefficients = sh_count(degree);
    static constexpr std::array<InputGroup, 2> inputs{
        {{"direction", 3, 0.4, 1.6}, {"sh", 3 * coefficients, -0.05, 0.05}}};
    static constexpr int outputs = 3;

    template <class R>
    static void forward(const R* in, R* out) {
        R n[3], Y[coefficients];
        unit_direction(in, n);
        sh_basis<degree>(n[0], n[1], n[2], Y);
        ray_color<degree>(Y, in + 3, out);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        R n[3], Y[coefficients], color[3], d_Y[coefficients] = {}, d_n[3] = {};
        const R inverse = unit_direction(in, n);
        sh_basis<degree>(n[0], n[1], n[2], Y);
        ray_color<degree>(Y, in + 3, color);
        ray_color_backward_ray<degree>(in + 3, color, d_out, d_Y);
        ray_color_backward_gaussian<degree>(Y, color, d_out, d_in + 3);
        sh_basis_backward<degree>(n[0], n[1], n[2], d_Y, d_n);
        unit_direction_backward(n, inverse, d_n, d_in);
    }
};

/// Three crossings and a background; outputs color, opacity, depth.
struct RayBlendOp {
    static constexpr const char* name = "ray_blend";
    static constexpr int crossings = 3;
    static constexpr std::array<InputGroup, 4> inputs{{{"raw", crossings, 0.1, 0.9},
                                                       {"color", 3 * crossings, 0, 1},
                                                       {"t", crossings, 1, 2},
                                                       {"background", 3, 0, 1}}};
    static constexpr int outputs = 5;

    template <class R>
    static constexpr RayCutoffs<R> cut{R(0), R(1), R(0)};

    template <class R>
    static RaySums<R> sums(const R* in) {
        RaySums<R> ray;
        for (int k = 0; k < crossings; ++k)
            blend_crossing(cut<R>, in[k], in + crossings + 3 * k, in[4 * crossings + k], ray);
        return ray;
    }
    template <class R>
    static void forward(const R* in, R* out) {
        const RaySums<R> ray = sums(in);
        for (int c = 0; c < 3; ++c) out[c] = ray.color[c] + ray.T * in[5 * crossings + c];
        out[3] = R(1) - ray.T;
        out[4] = ray.depth;
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        R out[outputs];
        forward(in, out);
        const R end = R(1) - out[3];
        RayBack<R> back{
            {d_out[0], d_out[1], d_out[2]}, d_out[4], d_out[4] * out[4] - d_out[3] * end};
        for (int c = 0; c < 3; ++c) {
            back.remainder += d_out[c] * out[c];
            d_in[5 * crossings + c] += d_out[c] * end;
        }
        for (int k = 0; k < crossings; ++k) {
            CrossingAdjoint<R> d{};
            blend_crossing_backward(cut<R>, in[k], in + crossings + 3 * k, in[4 * crossings + k],
                                    back, d);
            d_in[k] += d.d_raw;
            for (int c = 0; c < 3; ++c) d_in[crossings + 3 * k + c] += d.w * d_out[c];
            d_in[4 * crossings + k] += d.d_t;
        }
    }
};

/// A ray about the diagonal, not of unit length, that meets a sphere in front of it, or leaves the
/// one that it starts in. Outputs t, position, normal; of a miss, t is infinite and the rest 0.
template <bool Inside>
struct RaySphereOp {
    static constexpr const char* name = Inside ? "ray_sphere_inside" : "ray_sphere";
    static constexpr std::array<InputGroup, 4> inputs{
        {{"origin", 3, -0.1, 0.1},
         {"direction", 3, 0.9, 1.1},
         {"center", 3, Inside ? -0.2 : 2.0, Inside ? 0.2 : 2.2},
         {"radius", 1, 1.0, 1.5}}};
    static constexpr int outputs = 7;

    template <class R>
    static void forward(const R* in, R* out) {
        const Ray<R> ray{vec_at(in), vec_at(in + 3)};
        const auto found = ray_sphere(ray, vec_at(in + 6), in[9], R(0));
        std::fill_n(out, outputs, R(0));
        out[0] = found ? found->t : R(std::numeric_limits<double>::infinity());
        if (!found) return;
        add_vec(found->position, out + 1);
        add_vec(found->normal, out + 4);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        const Ray<R> ray{vec_at(in), vec_at(in + 3)};
        const Vec3<R> center = vec_at(in + 6);
        const auto found = ray_sphere(ray, center, in[9], R(0));
        if (!found) return;
        Ray<R> d_ray{Vec3<R>(R(0)), Vec3<R>(R(0))};
        Vec3<R> d_center(R(0));
        ray_sphere_backward(ray, center, in[9], *found,
                            {d_out[0], vec_at(d_out + 1), vec_at(d_out + 4)}, d_ray, d_center,
                            d_in[9]);
        add_vec(d_ray.origin, d_in);
        add_vec(d_ray.direction, d_in + 3);
        add_vec(d_center, d_in + 6);
    }
};

}  // namespace photograd
