#include "photograd/render/splat/splat.h"

#include <array>
#include <span>

#include "kernels/kernels.h"
#include "photograd/core/errors.h"
#include "photograd/render/splat/background.h"
#include "photograd/splat/cloud_check.h"
#include "photograd/splat/sort.h"
#include "photograd/splat/tile_blend.h"

namespace photograd {
namespace {

std::int64_t tasks_for(std::int64_t count) {
    return (count + splats_per_task - 1) / splats_per_task;
}

template <class R>
void blend_one(const BlendArgs<R>& args, const TilePairs& pairs, int x, int y) {
    if constexpr (std::is_same_v<R, float>)
        kernels().blend_tile(args, pairs, x, y);
    else
        blend_tile(args, pairs, x, y);
}

template <class R>
void blend_one_backward(const BlendArgs<R>& args, const BlendBackward<R>& back,
                        const TilePairs& pairs, int x, int y) {
    if constexpr (std::is_same_v<R, float>)
        kernels().blend_tile_backward(args, back, pairs, x, y);
    else
        blend_tile_backward(args, back, pairs, x, y);
}

template <class R>
BlendArgs<R> blend_args(const SplatFrame<R>& frame, const RenderedImage<R>& image) {
    const SplatOptions& o = frame.view.options;
    BlendArgs<R> args{};
    args.splats = frame.splats.data();
    args.cut = {R(o.alpha_min), R(o.alpha_max), R(o.stop), o.pass_clamped ? 1 : 0};
    std::copy_n(frame.background, 3, args.background);
    args.width = frame.view.image.width;
    args.height = frame.view.image.height;
    args.image = image;
    return args;
}

/// visit(pairs, x, y) for each tile, in parallel.
template <class R, class Visit>
void for_tiles(const SplatFrame<R>& frame, Visit&& visit) {
    const TileLists& lists = frame.lists;
    parallel_for(lists.tile_count(), [&](std::int64_t tile) {
        const int x = static_cast<int>(tile % lists.columns) * splat_tile_size;
        const int y = static_cast<int>(tile / lists.columns) * splat_tile_size;
        visit(lists.of(tile), x, y);
    });
}

/// Stage 5: each Gaussian sums its slots and differentiates its projection; view and eye in double.
template <class R>
void gather_splats(const GaussianCloud<R>& cloud, const SplatFrame<R>& frame, const R* partials,
                   const GaussianGradients<R>& out) {
    const std::vector<std::uint32_t>& slots = frame.lists.slots;
    std::array<double, 15> shared{};  // d_view[12], d_eye[3]
    const auto add = [&](std::int64_t task, std::span<double> sum) {
        const std::int64_t end = std::min(cloud.count, (task + 1) * splats_per_task);
        for (std::int64_t i = task * splats_per_task; i < end; ++i) {
            const auto row = static_cast<std::size_t>(i);
            if (slots[row] == slots[row + 1]) continue;
            R d[partial_count] = {}, own[15] = {};
            for (std::size_t slot = slots[row]; slot < slots[row + 1]; ++slot)
                for (std::size_t j = 0; j < partial_count; ++j)
                    d[j] += partials[partial_count * slot + j];
            with_sh_degree(cloud.degree, [&]<int Degree>() {
                project_splat_backward<Degree>(cloud, frame.view, i, frame.splats[row], d, out, own,
                                               own + 12);
            });
            for (std::size_t j = 0; j < 15; ++j) sum[j] += static_cast<double>(own[j]);
        }
    };
    sum_partials(tasks_for(cloud.count), std::span<double>(shared), add);
    std::array<double, 12> view{};
    std::copy_n(frame.view.view, 12, view.begin());
    eye_backward(view.data(), shared.data() + 12, shared.data());
    for (std::size_t j = 0; j < 12; ++j) out.view[j] += static_cast<R>(shared[j]);
}

}  // namespace

template <class R>
SplatFrame<R> prepare_splats(const GaussianCloud<R>& cloud, const SplatImage& image,
                             const SplatOptions& options, const R* camera_from_world,
                             const R* background) {
    SplatFrame<R> frame{SplatView<R>::of(image, options, camera_from_world), {}, {}, {}};
    std::copy_n(background, 3, frame.background);
    frame.splats.resize(static_cast<std::size_t>(cloud.count));
    std::vector<char> bad(static_cast<std::size_t>(tasks_for(cloud.count)));
    std::vector<R> depth(frame.splats.size());
    parallel_for(tasks_for(cloud.count), [&](std::int64_t task) {
        with_sh_degree(cloud.degree, [&]<int Degree>() {
            const std::int64_t end = std::min(cloud.count, (task + 1) * splats_per_task);
            for (std::int64_t i = task * splats_per_task; i < end; ++i) {
                const auto row = static_cast<std::size_t>(i);
                if (bad_group(cloud, i)) bad[static_cast<std::size_t>(task)] = 1;
                frame.splats[row] = project_splat<Degree>(cloud, frame.view, i);
                depth[row] = frame.splats[row].depth;
            }
        });
    });
    refuse_bad_rows("splat", cloud, bad, splats_per_task);
    for (std::size_t i = 0; i < frame.splats.size(); ++i)
        if (frame.splats[i].x0 < frame.splats[i].x1)
            frame.lists.sorted.push_back(static_cast<std::uint32_t>(i));
    frame.lists.sorted = sort_by_depth(std::move(frame.lists.sorted), depth.data());
    if (!number_slots(frame.splats.data(), frame.splats.size(), frame.lists.slots))
        fail(ErrorKind::range, "splat", "gaussians", "fewer than 2^31 pairs of splat and tile",
             "more", "render a smaller picture, or fewer Gaussians at a time");
    bin_splats(frame.splats.data(), image.width, image.height, frame.lists);
    return frame;
}

template <class R>
void blend_splats(const SplatFrame<R>& frame, const RenderedImage<R>& out) {
    const BlendArgs<R> args = blend_args(frame, out);
    for_tiles(frame, [&](const TilePairs& pairs, int x, int y) { blend_one(args, pairs, x, y); });
}

template <class R>
void splats_backward(const GaussianCloud<R>& cloud, const SplatFrame<R>& frame,
                     const RenderedImage<R>& image, const ImageCotangents<R>& d_image,
                     const GaussianGradients<R>& out, R* d_background) {
    const BlendArgs<R> args = blend_args(frame, image);
    std::vector<R> partials(partial_count * frame.lists.pairs.size());
    const BlendBackward<R> back{d_image, partials.data()};
    for_tiles(frame, [&](const TilePairs& pairs, int x, int y) {
        blend_one_backward(args, back, pairs, x, y);
    });
    background_backward(image, d_image.d_color, std::int64_t{args.width} * args.height, args.width,
                        d_background);
    gather_splats(cloud, frame, partials.data(), out);
}

#define PHOTOGRAD_INSTANTIATE(R)                                                      \
    template SplatFrame<R> prepare_splats(const GaussianCloud<R>&, const SplatImage&, \
                                          const SplatOptions&, const R*, const R*);   \
    template void blend_splats(const SplatFrame<R>&, const RenderedImage<R>&);        \
    template void splats_backward(const GaussianCloud<R>&, const SplatFrame<R>&,      \
                                  const RenderedImage<R>&, const ImageCotangents<R>&, \
                                  const GaussianGradients<R>&, R*);
PHOTOGRAD_INSTANTIATE(float)
PHOTOGRAD_INSTANTIATE(double)
#undef PHOTOGRAD_INSTANTIATE

}  // namespace photograd
