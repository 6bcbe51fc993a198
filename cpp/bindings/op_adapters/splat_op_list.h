// The ops of Gaussian splatting as flat functions, for the proofs (see op_list.h).
#pragma once

#include <algorithm>
#include <array>

#include "input_group.h"
#include "photograd/splat/conic.h"
#include "photograd/splat/covariance.h"
#include "photograd/splat/projection.h"
#include "photograd/splat/row_blend.h"
#include "photograd/splat/splat_color.h"

namespace photograd {

/// Quaternions of any length.
struct CovarianceOp {
    static constexpr const char* name = "gaussian_covariance";
    static constexpr std::array<InputGroup, 2> inputs{
        {{"quat", 4, 0.2, 1.5}, {"log_scale", 3, -1, 0.5}}};
    static constexpr int outputs = 6;

    template <class R>
    static void forward(const R* in, R* out) {
        covariance(GaussianAxes<R>::of(in, in + 4), out);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        covariance_backward(GaussianAxes<R>::of(in, in + 4), d_out, d_in, d_in + 4);
    }
};

/// A mean 3 in front of a camera that is turned and moved a little: within the field of view, or
/// held by both limits, on the right and above.
template <bool Held>
struct ProjectionOp {
    static constexpr const char* name = Held ? "splat_projection_held" : "splat_projection";
    static constexpr std::array<InputGroup, 3> inputs{
        {{"mean", 3, -0.3, 0.3}, {"cov", 6, -0.5, 0.5}, {"view", 12, -0.1, 0.1}}};
    static constexpr int outputs = 6;

    template <class R>
    struct Setup {
        SplatLens<R> lens{R(1.5), R(1.25), R(0.3), R(-0.2), {R(-0.5), R(0.5)}, {R(-0.5), R(0.5)}};
        R view[12], mean[3];
        explicit Setup(const R* in) {
            for (int i = 0; i < 12; ++i) view[i] = in[9 + i] + R(i % 5 == 0 ? 1 : 0);
            view[11] = view[11] + R(3);
            for (int i = 0; i < 3; ++i) mean[i] = in[i];
            if (Held) mean[0] = mean[0] + R(3);
            if (Held) mean[1] = mean[1] - R(3);
        }
    };
    template <class R>
    static void forward(const R* in, R* out) {
        const Setup<R> at(in);
        const SplatProjection<R> p = project_gaussian(at.lens, at.view, at.mean, in + 3);
        std::copy_n(p.mean2d, 2, out);
        out[2] = p.t[2];
        std::copy_n(p.cov2d, 3, out + 3);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        const Setup<R> at(in);
        const SplatProjection<R> p = project_gaussian(at.lens, at.view, at.mean, in + 3);
        project_gaussian_backward(at.lens, at.view, at.mean, in + 3, p, d_out, d_out[2], d_out + 3,
                                  d_in, d_in + 3, d_in + 9);
    }
};

/// Conic and compensation of a screen covariance.
struct ConicOp {
    static constexpr const char* name = "splat_conic";
    static constexpr std::array<InputGroup, 2> inputs{
        {{"diagonal", 2, 0.8, 2}, {"off_diagonal", 1, -0.5, 0.5}}};
    static constexpr int outputs = 4;
    static constexpr double low_pass = 0.3;

    template <class R>
    static void forward(const R* in, R* out) {
        const R cov2d[3] = {in[0], in[2], in[1]};
        const Conic<R> conic = conic_of(cov2d, R(low_pass));
        std::copy_n(conic.abc, 3, out);
        out[3] = conic.compensation;
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        const R cov2d[3] = {in[0], in[2], in[1]};
        R d_cov2d[3] = {};
        conic_backward(cov2d, conic_of(cov2d, R(low_pass)), d_out, d_out[3], d_cov2d);
        d_in[0] += d_cov2d[0];
        d_in[1] += d_cov2d[2];
        d_in[2] += d_cov2d[1];
    }
};

/// A color of degree 3; the mean is at least 1 away from the eye, and no channel is held at 0.
struct SplatColorOp {
    static constexpr const char* name = "splat_color";
    static constexpr std::array<InputGroup, 3> inputs{
        {{"eye", 3, -0.3, 0.3}, {"mean", 3, 0.8, 1.6}, {"sh", 48, -0.05, 0.05}}};
    static constexpr int outputs = 3;

    template <class R>
    static void forward(const R* in, R* out) {
        splat_color<3>(in, in + 3, in + 6, out);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        R color[3];
        splat_color<3>(in, in + 3, in + 6, color);
        splat_color_backward<3>(in, in + 3, in + 6, color, d_out, d_in, d_in + 3, d_in + 6);
    }
};

/// Three splats over two rows of pixels and a background; outputs color, opacity, depth of each
/// pixel.
struct SplatBlendOp {
    static constexpr const char* name = "splat_blend";
    static constexpr int splats = 3, rows = 2, pixels = rows * lane_count;
    static constexpr std::array<InputGroup, 6> inputs{{{"center", 2 * splats, -1, 1},
                                                       {"conic", 3 * splats, -0.02, 0.02},
                                                       {"alpha", splats, 0.3, 0.9},
                                                       {"color", 3 * splats, 0, 1},
                                                       {"z", splats, 1, 2},
                                                       {"background", 3, 0, 1}}};
    static constexpr int outputs = 5 * pixels;

    template <class R>
    static constexpr SplatCutoffs<R> cut{R(0), R(1), R(0), 0};

    template <class R>
    static ScreenSplat<R> splat(const R* in, int k) {
        ScreenSplat<R> s{};
        s.x = in[2 * k] + R(4 + 3 * k);
        s.y = in[2 * k + 1] + R(1);
        const R* conic = in + 2 * splats + 3 * k;
        s.conic[0] = conic[0] + R(0.1);
        s.conic[1] = conic[1] + R(0.02);
        s.conic[2] = conic[2] + R(0.2);
        s.opacity = in[5 * splats + k];
        for (int c = 0; c < 3; ++c) s.color[c] = in[6 * splats + 3 * k + c];
        s.depth = in[9 * splats + k];
        s.x1 = lane_count;
        s.y1 = rows;
        return s;
    }
    template <class R>
    static void start(PixelRow<R>& row) {
        row.T = row.live = Lanes<R>::filled(R(1));
    }
    template <class R>
    static void forward(const R* in, R* out) {
        for (int y = 0; y < rows; ++y) {
            PixelRow<R> row;
            RowSums<R> sums{};
            start(row);
            for (int k = 0; k < splats; ++k) blend_row(splat(in, k), cut<R>, 0, y, row, sums);
            for (int i = 0; i < lane_count; ++i, out += 5) {
                for (int c = 0; c < 3; ++c)
                    out[c] = sums.color[c][i] + row.T[i] * in[10 * splats + c];
                out[3] = R(1) - row.T[i];
                out[4] = sums.depth[i];
            }
        }
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        R out[outputs];
        forward(in, out);
        PixelRow<R> row[rows];
        RowCotangents<R> back[rows];
        for (int y = 0; y < rows; ++y) {
            start(row[y]);
            for (int i = 0; i < lane_count; ++i) {
                const R* o = out + 5 * (y * lane_count + i);
                const R* d = d_out + 5 * (y * lane_count + i);
                const R end = R(1) - o[3];
                back[y].remainder[i] = d[4] * o[4] - d[3] * end;
                back[y].d_depth[i] = d[4];
                for (int c = 0; c < 3; ++c) {
                    back[y].d_color[c][i] = d[c];
                    back[y].remainder[i] += d[c] * o[c];
                    d_in[10 * splats + c] += d[c] * end;
                }
            }
        }
        for (int k = 0; k < splats; ++k) {
            const ScreenSplat<R> s = splat(in, k);
            SplatSums<R> sums{};
            for (int y = 0; y < rows; ++y)
                blend_row_backward(s, cut<R>, 0, y, row[y], back[y], sums);
            R d[partial_count];
            splat_partials(s, sums, d);
            for (int i = 0; i < 2; ++i) d_in[2 * k + i] += d[partial_x + i];
            for (int i = 0; i < 3; ++i) d_in[2 * splats + 3 * k + i] += d[partial_a + i];
            d_in[5 * splats + k] += d[partial_opacity];
            for (int c = 0; c < 3; ++c) d_in[6 * splats + 3 * k + c] += d[partial_red + c];
            d_in[9 * splats + k] += d[partial_depth];
        }
    }
};

}  // namespace photograd
