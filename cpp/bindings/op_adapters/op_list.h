// The ops as flat functions R^n -> R^m, for the proofs.
//
// An adapter gives an op a fixed, small size, lists its differentiable inputs as named groups, and
// says where to sample them. Everything in `Ops` is then bound, stubbed and proved (finite
// differences, Taylor remainder, dot product with dual numbers, accumulation, mutants) without
// another line. The functions that users call on arrays of any size are in bindings/bind_ops.cpp.
#pragma once

#include <array>

#include "diffusion_op_list.h"
#include "facet_op_list.h"
#include "frame_op_list.h"
#include "input_group.h"
#include "photograd/core/params.h"
#include "photograd/ops/bilinear.h"
#include "photograd/ops/cell_blend.h"
#include "photograd/ops/composite.h"
#include "photograd/ops/sh.h"
#include "photograd/ops/sh_batch.h"
#include "photograd/ops/trilinear.h"
#include "raster_op_list.h"
#include "ray_op_list.h"
#include "sdf_op_list.h"
#include "splat_op_list.h"

namespace photograd {

template <Activation Kind>
struct ActivationOp {
    static constexpr const char* name = Kind == Activation::relu       ? "relu"
                                        : Kind == Activation::softplus ? "softplus"
                                        : Kind == Activation::exp      ? "exponential"
                                                                       : "sigmoid";
    // relu has a kink at 0, where no derivative exists; it is proved on its live side.
    static constexpr std::array<InputGroup, 1> inputs{
        {{"x", 3, Kind == Activation::relu ? 0.1 : -6.0, 6.0}}};
    static constexpr int outputs = 3;

    template <class R>
    static void forward(const R* x, R* y) {
        for (int i = 0; i < 3; ++i) y[i] = activate(Kind, x[i]);
    }
    template <class R>
    static void backward(const R* x, const R* d_y, R* d_x) {
        for (int i = 0; i < 3; ++i) activate_backward(Kind, x[i], d_y[i], d_x[i]);
    }
};

/// Values of a 3 x 4 x 2 grid with 2 channels, and a position in voxels: inside of one cell, or,
/// with the zero border, half a voxel outside of the grid on every axis. At a cell face the slope
/// jumps, and differences would be meaningless there.
template <Border Outside>
struct TrilinearOp {
    static constexpr const char* name =
        Outside == Border::clamp ? "trilinear" : "trilinear_zero_border";
    static constexpr GridShape shape{3, 4, 2};
    static constexpr int channels = 2;
    static constexpr int values = 3 * 4 * 2 * channels;
    static constexpr double lo = Outside == Border::clamp ? 0.1 : -0.9;
    static constexpr std::array<InputGroup, 2> inputs{
        {{"values", values, -1, 1}, {"q", 3, lo, lo + 0.8}}};
    static constexpr int outputs = channels;

    template <class R>
    static void weights(const R* q, AxisWeights<R>* a) {
        const int n[3] = {shape.x, shape.y, shape.z};
        for (int k = 0; k < 3; ++k) a[k] = axis_weights(q[k], n[k], Outside);
    }
    template <class R>
    static void forward(const R* in, R* out) {
        AxisWeights<R> a[3];
        weights(in + values, a);
        trilinear<R, channels>(in, shape, a[0], a[1], a[2], out);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        AxisWeights<R> a[3];
        weights(in + values, a);
        trilinear_backward<R, channels>(shape, a[0], a[1], a[2], d_out, d_in);
        trilinear_position_backward<R, channels>(in, shape, a[0], a[1], a[2], d_out, d_in + values);
    }
};

/// Eight corners with 2 channels, out of order in memory, and a point in their cell.
struct CellBlendOp {
    static constexpr const char* name = "cell_blend";
    static constexpr int channels = 2, values = 8 * channels;
    static constexpr std::array<InputGroup, 2> inputs{
        {{"corners", values, -1, 1}, {"fraction", 3, 0.1, 0.9}}};
    static constexpr int outputs = channels;
    static constexpr int order[8] = {5, 0, 3, 7, 1, 6, 2, 4};

    template <class R>
    static void forward(const R* in, R* out) {
        const R* corner[8];
        for (int n = 0; n < 8; ++n) corner[n] = in + order[n] * channels;
        cell_blend(corner, CellWeights<R>::of(in + values), channels, out);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        const CellWeights<R> w = CellWeights<R>::of(in + values);
        const R* corner[8];
        for (int n = 0; n < 8; ++n) {
            corner[n] = in + order[n] * channels;
            cell_blend_backward(n, w, channels, d_out, d_in + order[n] * channels);
        }
        cell_blend_fraction_backward(corner, w, channels, d_out, d_in + values);
    }
};

/// A color of two channels from a direction and its coefficients, to the highest degree. The
/// direction need not be of unit length: the polynomials are defined everywhere.
struct ShColorOp {
    static constexpr const char* name = "sh_color";
    static constexpr int degree = sh_max_degree, channels = 2;
    static constexpr int coefficients = sh_count(degree) * channels;
    static constexpr std::array<InputGroup, 2> inputs{
        {{"coefficients", coefficients, -1, 1}, {"direction", 3, 0.2, 0.9}}};
    static constexpr int outputs = channels;

    template <class R>
    static void forward(const R* in, R* out) {
        const R* d = in + coefficients;
        R Y[sh_count(degree)];
        sh_basis<degree>(d[0], d[1], d[2], Y);
        sh_color<degree, channels>(Y, in, out);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        const R* d = in + coefficients;
        R Y[sh_count(degree)], d_Y[sh_count(degree)] = {};
        sh_basis<degree>(d[0], d[1], d[2], Y);
        sh_color_backward<degree, channels>(Y, in, d_out, d_Y, d_in);
        sh_basis_backward<degree>(d[0], d[1], d[2], d_Y, d_in + coefficients);
    }
};

/// Colors of two points, each with coefficients and a direction of its own.
struct ShColorsOp {
    static constexpr const char* name = "sh_colors";
    static constexpr int degree = 2, channels = 3, points = 2;
    static constexpr int coefficients = points * sh_count(degree) * channels;
    static constexpr std::array<InputGroup, 2> inputs{
        {{"coefficients", coefficients, -1, 1}, {"directions", 3 * points, 0.2, 0.9}}};
    static constexpr int outputs = points * channels;

    template <class R>
    static void forward(const R* in, R* out) {
        sh_colors<degree, channels>(ShRows<R>{points, in + coefficients, in}, out);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        sh_colors_backward<degree, channels>(ShRows<R>{points, in + coefficients, in}, d_out,
                                             d_in + coefficients, d_in);
    }
};

/// Texels with 2 channels and a point in texture coordinates. Inside: a texture of 3 rows and 4
/// columns, the point within one cell. At the left border: 12 rows and 3 columns, the point left of
/// the first centers, where u is clamped and v is not.
template <bool AtBorder>
struct BilinearOp {
    static constexpr const char* name = AtBorder ? "bilinear_border" : "bilinear";
    static constexpr TextureShape shape = AtBorder ? TextureShape{12, 3} : TextureShape{3, 4};
    static constexpr int channels = 2;
    static constexpr int texels = shape.height * shape.width * channels;
    static constexpr double lo = AtBorder ? 0.05 : 0.4, hi = AtBorder ? 0.12 : 0.48;
    static constexpr std::array<InputGroup, 2> inputs{
        {{"texels", texels, -1, 1}, {"uv", 2, lo, hi}}};
    static constexpr int outputs = channels;

    template <class R>
    static void forward(const R* in, R* out) {
        const R* uv = in + texels;
        bilinear<R, channels>(in, shape, texel_axis(uv[0], shape.width),
                              texel_axis(uv[1], shape.height), out);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        const TexelAxis<R> column = texel_axis(in[texels], shape.width);
        const TexelAxis<R> row = texel_axis(in[texels + 1], shape.height);
        bilinear_backward<R, channels>(shape, column, row, d_out, d_in);
        bilinear_uv_backward<R, channels>(in, shape, column, row, d_out, d_in + texels);
    }
};

/// A ray of two sub-blocks over a background; outputs color, opacity, depth.
template <Quadrature Form>
struct CompositeOp {
    static constexpr const char* name =
        Form == Quadrature::alpha ? "composite" : "composite_riemann";
    static constexpr int blocks = 2;
    static constexpr int samples = blocks * lane_count;
    static constexpr std::array<InputGroup, 3> inputs{
        {{"sigma_t", samples, 0.05, 2.0}, {"rgb", 3 * samples, 0, 1}, {"background", 3, 0, 1}}};
    static constexpr int outputs = 5;
    static constexpr double dt = 0.13;

    template <class R>
    static void load(const R* in, int block, Lanes<R>& sigma_t, Lanes<R>* rgb, Lanes<R>& t) {
        for (int i = 0; i < lane_count; ++i) {
            const int k = block * lane_count + i;
            sigma_t[i] = in[k];
            for (int c = 0; c < 3; ++c) rgb[c][i] = in[samples + 3 * k + c];
            t[i] = R((k + 0.5) * dt);
        }
    }
    template <class R>
    static RayTotals<R> totals(const R* in) {
        RayTotals<R> totals;
        for (int b = 0; b < blocks; ++b) {
            Lanes<R> sigma_t, rgb[3], t;
            load(in, b, sigma_t, rgb, t);
            composite(Form, sigma_t, rgb, t, R(dt), totals);
        }
        return totals;
    }
    template <class R>
    static void forward(const R* in, R* out) {
        const RayTotals<R> ray = totals(in);
        const R end = exp(-ray.tau);
        for (int c = 0; c < 3; ++c) out[c] = sum(ray.color[c]) + end * in[4 * samples + c];
        out[3] = -expm1(-ray.tau);
        out[4] = sum(ray.depth);
    }
    template <class R>
    static void backward(const R* in, const R* d_out, R* d_in) {
        const RayTotals<R> ray = totals(in);
        const R* background = in + 4 * samples;
        const R end = exp(-ray.tau);
        RayCotangents<R> back{{d_out[0], d_out[1], d_out[2]}, d_out[4], R(0), R(0)};
        R d_end = d_out[3];
        back.remainder = d_out[4] * sum(ray.depth);
        for (int c = 0; c < 3; ++c) {
            d_end -= d_out[c] * background[c];
            back.remainder += d_out[c] * sum(ray.color[c]);
            d_in[4 * samples + c] += d_out[c] * end;
        }
        back.end_term = d_end * end;
        for (int b = 0; b < blocks; ++b) {
            Lanes<R> sigma_t, rgb[3], t;
            Lanes<R> d_sigma_t = {}, d_rgb[3] = {};
            load(in, b, sigma_t, rgb, t);
            composite_backward(Form, sigma_t, rgb, t, R(dt), back, d_sigma_t, d_rgb);
            for (int i = 0; i < lane_count; ++i) {
                const int k = b * lane_count + i;
                d_in[k] += d_sigma_t[i];
                for (int c = 0; c < 3; ++c) d_in[samples + 3 * k + c] += d_rgb[c][i];
            }
        }
    }
};

using Ops = TypeList<
    ActivationOp<Activation::relu>, ActivationOp<Activation::softplus>,
    ActivationOp<Activation::exp>, ActivationOp<Activation::sigmoid>, BilinearOp<false>,
    BilinearOp<true>, TrilinearOp<Border::clamp>, TrilinearOp<Border::zero>, CellBlendOp, ShColorOp,
    ShColorsOp, CompositeOp<Quadrature::alpha>, CompositeOp<Quadrature::riemann>, CovarianceOp,
    ProjectionOp<false>, ProjectionOp<true>, ConicOp, SplatColorOp, SplatBlendOp, RayGaussianOp,
    RayColorOp, RayBlendOp, ErfOp, SchlickOp, IndexOp, DielectricOp<false>, DielectricOp<true>,
    ConductorOp, GgxOp, GgxFastOp, BeckmannOp, CharlieOp, Gtr1Op, RefractOp, ThinFilmOp,
    PrincipledOp, SdfSphereOp, SdfPlaneOp, SdfTorusOp, SdfBoxOp<false>, SdfBoxOp<true>,
    SdfCapsuleOp, SmoothUnionOp, ToShapeOp, RaySphereOp<false>, RaySphereOp<true>, DipoleOp,
    NormalizedDiffusionOp<DiffusionFit::searchlight>, NormalizedDiffusionOp<DiffusionFit::diffuse>,
    NormalizedDiffusionOp<DiffusionFit::diffuse_free_path>, ScreenPointOp, ReinhardOp, AcesFitOp,
    AgxContrastOp<true>, AgxContrastOp<false>, AgxColorOp, ObscuranceOp>;

}  // namespace photograd
