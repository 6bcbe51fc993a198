#include "photograd/render/splat/splat_rays.h"

#include <algorithm>

#include "photograd/render/splat/background.h"
#include "photograd/splat/project.h"
#include "photograd/splat/ray_color.h"
#include "photograd/splat/ray_walk.h"

namespace photograd {
namespace {

constexpr std::int64_t rays_per_task = 64;
constexpr std::int64_t gaussians_per_task = 256;
// A slab of the backward pass ends before the ray that would exceed these; its scratch in float is
// 20 MB of records, 12 MB to sort them, and 6 MB of rays.
constexpr std::int64_t rays_per_slab = 1 << 16;
constexpr std::uint64_t crossings_per_slab = 1 << 20;

/// A ray, normalized, with its spherical-harmonic basis.
template <int Degree, class R>
struct CastRay {
    R origin[3], direction[3], Y[sh_count(Degree)];
    R inverse_length;

    static CastRay of(const R* origin, const R* direction) {
        CastRay out;
        std::copy_n(origin, 3, out.origin);
        out.inverse_length = unit_direction(direction, out.direction);
        sh_basis<Degree>(out.direction[0], out.direction[1], out.direction[2], out.Y);
        return out;
    }
};

/// The record of a crossing for the Gaussian.
template <class R>
struct RayRecord {
    std::uint32_t row, ray;  // ray: within the slab
    CrossingAdjoint<R> d;
};

/// visit(i) for [0, count), in tasks of `size`.
template <class Visit>
void for_each_in_tasks(std::int64_t count, std::int64_t size, Visit&& visit) {
    parallel_for((count + size - 1) / size, [&](std::int64_t task) {
        const std::int64_t end = std::min(count, (task + 1) * size);
        for (std::int64_t i = task * size; i < end; ++i) visit(i);
    });
}

template <int Degree, class R>
void blend_ray(const GaussianCloud<R>& cloud, RayFrame<R>& frame, std::int64_t i,
               const RenderedImage<R>& out) {
    const auto ray = CastRay<Degree, R>::of(&frame.origins[static_cast<std::size_t>(3 * i)],
                                            &frame.directions[static_cast<std::size_t>(3 * i)]);
    const RayCutoffs<R> cut = frame.cloud.options.template cutoffs<R>();
    RaySums<R> sums;
    std::uint32_t count = 0;
    walk_ray(frame.cloud, ray.origin, ray.direction, [&](const Crossing<R>& x) {
        R color[3];
        ray_color<Degree>(ray.Y, cloud.sh + std::int64_t{3 * sh_count(Degree)} * x.row, color);
        if (!blend_crossing(cut, x.raw, color, x.t, sums)) return false;
        ++count;
        return true;
    });
    for (int c = 0; c < 3; ++c) out.color[3 * i + c] = sums.color[c] + sums.T * frame.background[c];
    out.opacity[i] = R(1) - sums.T;
    out.depth[i] = sums.depth;
    frame.crossings[static_cast<std::size_t>(i)] = count;
}

template <class R>
RayBack<R> start_back(const RenderedImage<R>& image, const ImageCotangents<R>& d, std::int64_t i) {
    const R* d_color = d.d_color + 3 * i;
    return {{d_color[0], d_color[1], d_color[2]}, d.d_depth[i], start_remainder(image, d, i)};
}

/// Derivatives with respect to a ray, summed along its walk.
template <int Degree, class R>
struct OwnDerivatives {
    R origin[3] = {}, direction[3] = {}, Y[sh_count(Degree)] = {};

    void add(const CastRay<Degree, R>& ray, const CastGaussian<R>& g, const Crossing<R>& x,
             const R* sh, const R* color, const RayBack<R>& back, const CrossingAdjoint<R>& d) {
        const RayPeak<R> peak = ray_peak(g.shape, ray.origin, ray.direction);
        ray_peak_backward_ray(g.shape, peak, R(-0.5) * x.raw * d.d_raw, d.d_t, origin, direction);
        const R d_color[3] = {d.w * back.d_color[0], d.w * back.d_color[1], d.w * back.d_color[2]};
        ray_color_backward_ray<Degree>(sh, color, d_color, Y);
    }
    void finish(const CastRay<Degree, R>& ray, R* d_origin, R* d_direction) {
        const R* n = ray.direction;
        sh_basis_backward<Degree>(n[0], n[1], n[2], Y, direction);
        for (int k = 0; k < 3; ++k) d_origin[k] += origin[k];
        unit_direction_backward(n, ray.inverse_length, direction, d_direction);
    }
};

/// Rays [begin, end) of the frame, their records in the order of rays and crossings.
template <int Degree, class R>
struct Slab {
    std::int64_t begin, end;
    std::vector<CastRay<Degree, R>> rays;
    std::vector<std::size_t> first;  // record of each ray; one more at the end
    std::vector<RayRecord<R>> records;

    static Slab from(const RayFrame<R>& frame, std::int64_t begin) {
        Slab slab{begin, begin, {}, {0}, {}};
        const auto fits = [&](std::int64_t i) {
            return i < frame.rays() && i - begin < rays_per_slab &&
                   (i == begin ||
                    slab.first.back() + frame.crossings[static_cast<std::size_t>(i)] <=
                        crossings_per_slab);
        };
        for (; fits(slab.end); ++slab.end) {
            const auto i = static_cast<std::size_t>(slab.end);
            slab.rays.push_back(
                CastRay<Degree, R>::of(&frame.origins[3 * i], &frame.directions[3 * i]));
            slab.first.push_back(slab.first.back() + frame.crossings[i]);
        }
        slab.records.resize(slab.first.back());
        return slab;
    }
};

/// The second walk of ray k of the slab.
template <int Degree, class R>
void walk_back(const GaussianCloud<R>& cloud, const RayFrame<R>& frame, RayBack<R> back,
               Slab<Degree, R>& slab, std::int64_t k, const RayGradients<R>& out) {
    const CastRay<Degree, R>& ray = slab.rays[static_cast<std::size_t>(k)];
    const RayCutoffs<R> cut = frame.cloud.options.template cutoffs<R>();
    RayRecord<R>* record = slab.records.data() + slab.first[static_cast<std::size_t>(k)];
    OwnDerivatives<Degree, R> own;
    walk_ray(frame.cloud, ray.origin, ray.direction, [&](const Crossing<R>& x) {
        const R* sh = cloud.sh + std::int64_t{3 * sh_count(Degree)} * x.row;
        R color[3];
        CrossingAdjoint<R> d;
        ray_color<Degree>(ray.Y, sh, color);
        if (!blend_crossing_backward(cut, x.raw, color, x.t, back, d)) return false;
        *record++ = {x.row, static_cast<std::uint32_t>(k), d};
        if (out.origins) own.add(ray, frame.cloud.gaussians[x.slot], x, sh, color, back, d);
        return true;
    });
    const std::int64_t i = slab.begin + k;
    if (out.origins) own.finish(ray, out.origins + 3 * i, out.directions + 3 * i);
}

/// Gaussian `row` sums its records, listed in `own`, in double.
template <int Degree, class R>
void gather_row(const GaussianCloud<R>& cloud, const Slab<Degree, R>& slab, const R* d_color,
                std::int64_t row, std::span<const std::uint32_t> own,
                const GaussianGradients<R>& out) {
    constexpr int stride = 3 * sh_count(Degree);
    const R *quat = cloud.quats + 4 * row, *log_scale = cloud.log_scales + 3 * row;
    const GaussianAxes<R> axes = GaussianAxes<R>::of(quat, log_scale);
    const CastGaussian<R> g{RayGaussian<R>::of(cloud.means + 3 * row, axes),
                            sigmoid(cloud.opacity_logits[row]), static_cast<std::uint32_t>(row)};
    const R* sh = cloud.sh + stride * row;
    double mean[3] = {}, strain[6] = {}, opacity = 0, d_sh[stride] = {};
    for (const std::uint32_t k : own) {
        const RayRecord<R>& record = slab.records[k];
        const CastRay<Degree, R>& ray = slab.rays[record.ray];
        const RayPeak<R> peak = ray_peak(g.shape, ray.origin, ray.direction);
        const R raw = g.raw(peak);
        ray_peak_backward_gaussian(g.shape, peak, R(-0.5) * raw * record.d.d_raw, record.d.d_t,
                                   mean, strain);
        opacity += static_cast<double>(raw / g.opacity * record.d.d_raw);
        const R* d_pixel = d_color + 3 * (slab.begin + record.ray);
        const R d[3] = {record.d.w * d_pixel[0], record.d.w * d_pixel[1], record.d.w * d_pixel[2]};
        R color[3];
        ray_color<Degree>(ray.Y, sh, color);
        ray_color_backward_gaussian<Degree>(ray.Y, color, d, d_sh);
    }
    R d_strain[6];
    for (int k = 0; k < 6; ++k) d_strain[k] = static_cast<R>(strain[k]);
    for (int k = 0; k < 3; ++k) out.means[3 * row + k] += static_cast<R>(mean[k]);
    for (int k = 0; k < stride; ++k) out.sh[stride * row + k] += static_cast<R>(d_sh[k]);
    sigmoid_backward(cloud.opacity_logits[row], static_cast<R>(opacity), out.opacity_logits[row]);
    strain_backward(axes, d_strain, out.quats + 4 * row, out.log_scales + 3 * row);
}

template <int Degree, class R>
void slabs_backward(const GaussianCloud<R>& cloud, const RayFrame<R>& frame,
                    const RenderedImage<R>& image, const ImageCotangents<R>& d_image,
                    const RayGradients<R>& out) {
    OwnerBins bins;
    for (std::int64_t begin = 0; begin < frame.rays();) {
        auto slab = Slab<Degree, R>::from(frame, begin);
        for_each_in_tasks(slab.end - begin, rays_per_task, [&](std::int64_t k) {
            walk_back(cloud, frame, start_back(image, d_image, begin + k), slab, k, out);
        });
        std::vector<std::uint32_t> owner(slab.records.size());
        for (std::size_t k = 0; k < owner.size(); ++k) owner[k] = slab.records[k].row;
        bin_by_owner(owner, static_cast<int>(cloud.count), bins);
        for_each_in_tasks(cloud.count, gaussians_per_task, [&](std::int64_t row) {
            const std::uint32_t* first = bins.begin.data() + row;
            if (first[0] == first[1]) return;
            const std::span<const std::uint32_t> order(bins.order);
            gather_row(cloud, slab, d_image.d_color, row,
                       order.subspan(first[0], first[1] - first[0]), out.gaussians);
        });
        begin = slab.end;
    }
}

}  // namespace

template <class R>
void blend_rays(const GaussianCloud<R>& cloud, RayFrame<R>& frame, const RenderedImage<R>& out) {
    with_sh_degree(cloud.degree, [&]<int Degree>() {
        for_each_in_tasks(frame.rays(), rays_per_task,
                          [&](std::int64_t i) { blend_ray<Degree>(cloud, frame, i, out); });
    });
}

template <class R>
void blend_rays_backward(const GaussianCloud<R>& cloud, const RayFrame<R>& frame,
                         const RenderedImage<R>& image, const ImageCotangents<R>& d_image,
                         const RayGradients<R>& out) {
    background_backward(image, d_image.d_color, frame.rays(), 4096, out.background);
    with_sh_degree(cloud.degree, [&]<int Degree>() {
        slabs_backward<Degree>(cloud, frame, image, d_image, out);
    });
}

#define PHOTOGRAD_INSTANTIATE(R)                                                              \
    template void blend_rays(const GaussianCloud<R>&, RayFrame<R>&, const RenderedImage<R>&); \
    template void blend_rays_backward(const GaussianCloud<R>&, const RayFrame<R>&,            \
                                      const RenderedImage<R>&, const ImageCotangents<R>&,     \
                                      const RayGradients<R>&);
PHOTOGRAD_INSTANTIATE(float)
PHOTOGRAD_INSTANTIATE(double)
#undef PHOTOGRAD_INSTANTIATE

}  // namespace photograd
