#include "photograd/render/march/march_dense.h"

#include "kernels/kernels.h"
#include "photograd/core/scatter.h"

namespace photograd {
namespace {

/// offset[i] = first sample of ray begin + i, within the slab.
std::vector<std::int64_t> sample_offsets(const std::int32_t* samples, std::int64_t begin,
                                         std::int64_t end) {
    std::vector<std::int64_t> offset(static_cast<std::size_t>(end - begin) + 1, 0);
    for (std::int64_t ray = begin; ray < end; ++ray)
        offset[static_cast<std::size_t>(ray - begin) + 1] =
            offset[static_cast<std::size_t>(ray - begin)] + samples[ray];
    return offset;
}

MarchDenseArgs kernel_args(const DenseGrid<float>& grid, const RayBatch<float>& rays,
                           const MarchOptions& options, const RayOutputs<float>& out) {
    MarchDenseArgs a{};
    a.values = grid.values;
    a.shape[0] = grid.shape.x;
    a.shape[1] = grid.shape.y;
    a.shape[2] = grid.shape.z;
    std::copy_n(grid.lo, 3, a.lo);
    std::copy_n(grid.scale, 3, a.scale);
    a.border = static_cast<int>(grid.options.border);
    a.density_activation = static_cast<int>(grid.options.density_activation);
    a.color_activation = static_cast<int>(grid.options.color_activation);
    a.density_scale = grid.density_scale;
    a.quadrature = static_cast<int>(options.quadrature);
    a.dt = static_cast<float>(options.dt);
    a.tau_stop = static_cast<float>(options.tau_stop());
    a.origins = rays.origins;
    a.directions = rays.directions;
    a.t0 = rays.t0;
    a.count = rays.samples;
    a.color = out.color;
    a.transmittance = out.transmittance;
    a.depth = out.depth;
    return a;
}

/// Scratch of one slab, kept from slab to slab.
struct Slab {
    std::vector<float> d_raw;
    std::vector<BrickRun> runs;
    std::vector<std::uint32_t> items;  // the runs that exist, in ray order
    OwnerBins bins;
};

/// Runs of all rays of the slab, chunk by chunk: a chunk's runs start at the number of its first sample.
void record_slab(const Kernels& kernel, const MarchDenseArgs& args, MarchDenseBackward& back,
                 const std::vector<std::int64_t>& offset, std::int64_t first, std::int64_t last,
                 Slab& slab) {
    const auto samples = static_cast<std::size_t>(offset.back());
    if (slab.runs.size() < samples) {
        slab.runs.resize(samples);
        slab.d_raw.resize(4 * samples);
    }
    back.sample_offset = offset.data();
    back.first_ray = first;
    back.d_raw = slab.d_raw.data();
    const std::int64_t chunks = (last - first + march_chunk - 1) / march_chunk;
    std::vector<std::int64_t> count(static_cast<std::size_t>(chunks));
    const auto run_begin = [&](std::int64_t chunk) {
        return offset[static_cast<std::size_t>(chunk * march_chunk)];
    };
    parallel_for(chunks, [&](std::int64_t chunk) {
        const std::int64_t begin = first + chunk * march_chunk;
        count[static_cast<std::size_t>(chunk)] =
            kernel.march_dense_backward(args, back, begin, std::min(begin + march_chunk, last),
                                        slab.runs.data() + run_begin(chunk));
    });
    slab.items.clear();
    for (std::int64_t chunk = 0; chunk < chunks; ++chunk)
        for (std::int64_t i = 0; i < count[static_cast<std::size_t>(chunk)]; ++i)
            slab.items.push_back(static_cast<std::uint32_t>(run_begin(chunk) + i));
}

/// One task per brick adds the brick's runs into a tile, and the tile to the gradient.
void gather_slab(const Kernels& kernel, const MarchDenseArgs& args, const BrickLayout& layout,
                 Slab& slab, float* d_values) {
    bin_by_owner(
        slab.items, layout.count(), [&](std::uint32_t i) { return slab.runs[i].brick; }, slab.bins);
    std::vector<int> bricks[brick_colors];
    for (int brick = 0; brick < layout.count(); ++brick) {
        const auto k = static_cast<std::size_t>(brick);
        if (slab.bins.begin[k] != slab.bins.begin[k + 1])
            bricks[layout.color(brick)].push_back(brick);
    }
    for (const std::vector<int>& same_color : bricks)
        parallel_for(static_cast<std::int64_t>(same_color.size()), [&](std::int64_t i) {
            const int brick = same_color[static_cast<std::size_t>(i)];
            const std::uint32_t begin = slab.bins.begin[static_cast<std::size_t>(brick)];
            const std::uint32_t end = slab.bins.begin[static_cast<std::size_t>(brick) + 1];
            alignas(64) float tile[tile_voxels * 4] = {};
            kernel.march_dense_gather(args, slab.runs.data(), slab.bins.order.data() + begin,
                                      end - begin, slab.d_raw.data(), tile);
            flush_tile<float, 4>(layout, brick, tile, d_values);
        });
}

}  // namespace

void march_dense(const DenseGrid<float>& grid, const RayBatch<float>& rays,
                 const MarchOptions& options, const RayOutputs<float>& out) {
    const MarchDenseArgs args = kernel_args(grid, rays, options, out);
    const Kernels& kernel = kernels();
    parallel_for((rays.count + march_chunk - 1) / march_chunk, [&](std::int64_t chunk) {
        const std::int64_t begin = chunk * march_chunk;
        kernel.march_dense_forward(args, begin, std::min(begin + march_chunk, rays.count));
    });
}

void march_dense_backward(const DenseGrid<float>& grid, const RayBatch<float>& rays,
                          const MarchOptions& options, const RayOutputs<float>& out,
                          const RayAdjoints<float>& adjoints, float* d_values) {
    const MarchDenseArgs args = kernel_args(grid, rays, options, out);
    const Kernels& kernel = kernels();
    const BrickLayout layout = BrickLayout::of(args.shape);
    MarchDenseBackward back{};
    back.d_color = adjoints.d_color;
    back.d_depth = adjoints.d_depth;
    back.d_transmittance = adjoints.d_transmittance;
    // Kept from call to call: a fit would otherwise clear megabytes of fresh memory every step.
    static thread_local Slab slab;
    for (std::int64_t first = 0, last; first < rays.count; first = last) {
        last = detail::slab_end(rays.samples, first, rays.count);
        const std::vector<std::int64_t> offset = sample_offsets(rays.samples, first, last);
        if (offset.back() == 0) continue;
        record_slab(kernel, args, back, offset, first, last, slab);
        gather_slab(kernel, args, layout, slab, d_values);
    }
}

}  // namespace photograd
