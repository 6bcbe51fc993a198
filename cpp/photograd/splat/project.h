// Stage 1: from a Gaussian to a splat on the screen, and the adjoint.
//
// Everything that depends on one Gaussian alone: covariance, projection, conic, opacity, color, and
// the box of pixels in which it may be visible. The backward pass recomputes the forward values
// from the parameters, which is cheaper than storing them. A Gaussian behind `near`, off the screen
// or with an extent that is not representable is culled: an empty box, and derivatives of zero.
#pragma once

#include <cmath>
#include <type_traits>

#include "photograd/ops/activation.h"
#include "photograd/splat/conic.h"
#include "photograd/splat/covariance.h"
#include "photograd/splat/options.h"
#include "photograd/splat/projection.h"
#include "photograd/splat/screen_splat.h"
#include "photograd/splat/splat_color.h"

namespace photograd {

template <class R>
struct SplatView {
    SplatImage image;
    SplatOptions options;
    SplatLens<R> lens;
    R view[12];  // camera_from_world, row by row
    R eye[3];    // -W^T b

    static SplatView of(const SplatImage& image, const SplatOptions& options,
                        const R* camera_from_world) {
        SplatView out{image, options, {}, {}, {}};
        const double mx = options.frustum_margin * image.width / image.fx;
        const double my = options.frustum_margin * image.height / image.fy;
        out.lens = {R(image.fx),
                    R(image.fy),
                    R(image.cx),
                    R(image.cy),
                    {R(-image.cx / image.fx - mx), R((image.width - image.cx) / image.fx + mx)},
                    {R(-image.cy / image.fy - my), R((image.height - image.cy) / image.fy + my)}};
        for (int i = 0; i < 12; ++i) out.view[i] = camera_from_world[i];
        for (int k = 0; k < 3; ++k)
            out.eye[k] = -(out.view[k] * out.view[3] + out.view[4 + k] * out.view[7] +
                           out.view[8 + k] * out.view[11]);
        return out;
    }
};

/// First pixel whose center is at or behind x, held to [0, size].
template <class R>
int first_pixel_from(R x, int size) {
    return static_cast<int>(clamped(std::ceil(x - R(0.5)), R(0), R(size)));
}

/// Pixels that may see the splat. Two policies cut it: `extent_sigmas` exactly, per axis, and
/// alpha_min, for which the box is a little too large (the test in the pixel decides).
template <class R>
void find_box(const SplatView<R>& view, const R* cov2d, ScreenSplat<R>& s) {
    const SplatOptions& o = view.options;
    R sigmas = R(1e6);
    s.sigma_max = R(1e30);
    if (o.extent_sigmas > 0) sigmas = smaller(sigmas, R(o.extent_sigmas));
    if (o.alpha_min > 0) {
        const R faintest = s.opacity / R(o.alpha_min);
        if (!(faintest >= R(1))) return;
        s.sigma_max = R(1.01) * std::log(faintest) + R(0.05);
        sigmas = smaller(sigmas, std::sqrt(R(2) * s.sigma_max));
    }
    const R rx = sigmas * sqrt(cov2d[0] + R(o.low_pass)),
            ry = sigmas * sqrt(cov2d[2] + R(o.low_pass));
    s.x0 = first_pixel_from(s.x - rx, view.image.width);
    s.x1 = first_pixel_from(s.x + rx, view.image.width);
    s.y0 = first_pixel_from(s.y - ry, view.image.height);
    s.y1 = first_pixel_from(s.y + ry, view.image.height);
    if (s.x0 >= s.x1 || s.y0 >= s.y1) s.x0 = s.x1 = s.y0 = s.y1 = 0;
}

/// Values between a Gaussian and its splat that backward needs again.
template <class R>
struct ProjectedGaussian {
    GaussianAxes<R> axes;
    R cov3d[6];
    SplatProjection<R> p;
    Conic<R> conic;
    bool visible;
};

template <class R>
ProjectedGaussian<R> project_geometry(const GaussianCloud<R>& cloud, const SplatView<R>& view,
                                      std::int64_t i) {
    ProjectedGaussian<R> out;
    R t[3];
    const R* mean = cloud.means + 3 * i;
    view_point(view.view, mean, t);
    out.visible = t[2] >= R(view.options.near);
    if (!out.visible) return out;
    out.axes = GaussianAxes<R>::of(cloud.quats + 4 * i, cloud.log_scales + 3 * i);
    covariance(out.axes, out.cov3d);
    out.p = project_gaussian(view.lens, view.view, mean, out.cov3d);
    out.conic = conic_of(out.p.cov2d, R(view.options.low_pass));
    // Comparisons are false for NaN. A splat wider than a million pixels has a conic of nothing but
    // rounding, and its derivatives overflow; a mean so far away is nowhere near the screen.
    out.visible = out.conic.valid() && out.p.cov2d[0] + out.p.cov2d[2] < R(1e12) &&
                  std::abs(out.p.mean2d[0]) < R(1e7) && std::abs(out.p.mean2d[1]) < R(1e7);
    return out;
}

/// The splat of Gaussian i; x0 == x1 if it is culled.
template <int Degree, class R>
ScreenSplat<R> project_splat(const GaussianCloud<R>& cloud, const SplatView<R>& view,
                             std::int64_t i) {
    ScreenSplat<R> s{};
    const ProjectedGaussian<R> g = project_geometry(cloud, view, i);
    if (!g.visible) return s;
    s.x = g.p.mean2d[0];
    s.y = g.p.mean2d[1];
    for (int k = 0; k < 3; ++k) s.conic[k] = g.conic.abc[k];
    s.opacity = sigmoid(cloud.opacity_logits[i]);
    if (view.options.antialiased) s.opacity *= g.conic.compensation;
    s.depth = g.p.t[2];
    find_box(view, g.p.cov2d, s);
    if (s.x0 < s.x1)
        splat_color<Degree>(view.eye, cloud.means + 3 * i, cloud.sh + 3 * sh_count(Degree) * i,
                            s.color);
    return s;
}
/// Adds the derivatives of Gaussian i, given those of its splat, d[partial_count]; those of the
/// view and the eye to d_view[12] and d_eye[3], which all Gaussians of a task share.
template <int Degree, class R>
void project_splat_backward(const GaussianCloud<R>& cloud, const SplatView<R>& view, std::int64_t i,
                            const ScreenSplat<R>& s, const R* d, const GaussianGradients<R>& out,
                            R* d_view, R* d_eye) {
    const ProjectedGaussian<R> g = project_geometry(cloud, view, i);
    const int stride = 3 * sh_count(Degree);
    const R* mean = cloud.means + 3 * i;
    splat_color_backward<Degree>(view.eye, mean, cloud.sh + stride * i, s.color, d + partial_red,
                                 d_eye, out.means + 3 * i, out.sh + stride * i);
    R d_alpha = d[partial_opacity], d_compensation = R(0);
    if (view.options.antialiased) {
        d_compensation = d_alpha * sigmoid(cloud.opacity_logits[i]);
        d_alpha *= g.conic.compensation;
    }
    sigmoid_backward(cloud.opacity_logits[i], d_alpha, out.opacity_logits[i]);
    R d_cov2d[3] = {}, d_cov[6] = {};
    conic_backward(g.p.cov2d, g.conic, d + partial_a, d_compensation, d_cov2d);
    project_gaussian_backward(view.lens, view.view, mean, g.cov3d, g.p, d + partial_x,
                              d[partial_depth], d_cov2d, out.means + 3 * i, d_cov, d_view);
    covariance_backward(g.axes, d_cov, out.quats + 4 * i, out.log_scales + 3 * i);
    if (out.screen)
        for (int k = 0; k < 2; ++k) out.screen[2 * i + k] += d[partial_x + k];
}

/// eye = -W^T b, taken apart: d_eye to d_view.
template <class R>
void eye_backward(const R* view, const R* d_eye, R* d_view) {
    for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k) {
            d_view[4 * j + k] -= view[4 * j + 3] * d_eye[k];
            d_view[4 * j + 3] -= view[4 * j + k] * d_eye[k];
        }
}

}  // namespace photograd
