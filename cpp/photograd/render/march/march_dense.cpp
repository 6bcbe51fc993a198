#include "photograd/render/march/march_dense.h"

#include "kernels/kernels.h"
#include "photograd/core/scatter.h"
#include "photograd/render/march/kernel_args.h"

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

MarchDenseArgs dense_args(const DenseGrid<float>& grid, const RayBatch<float>& rays,
                          const MarchOptions& options, const MarchOutputs<float>& out) {
    auto a = kernel_args<MarchDenseArgs>(grid, rays, options, out);
    a.values = grid.values;
    a.shape[0] = grid.shape.x;
    a.shape[1] = grid.shape.y;
    a.shape[2] = grid.shape.z;
    a.border = static_cast<int>(grid.options.border);
    return a;
}

/// Scratch of one slab, kept from slab to slab.
struct Slab {
    std::vector<float> d_raw;
    std::vector<BrickRun> runs;
    std::vector<std::uint32_t> items;  // the runs that exist, in ray order
    OwnerBins bins;
};

/// Runs of all rays of the slab, chunk by chunk: a chunk's runs start at the number of its first
/// sample.
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
    const std::int64_t chunks = chunk_count(last - first);
    std::vector<std::int64_t> count(static_cast<std::size_t>(chunks));
    const auto run_begin = [&](std::int64_t chunk) {
        return offset[static_cast<std::size_t>(chunk * march_chunk)];
    };
    for_chunks(first, last, [&](std::int64_t chunk, std::int64_t begin, std::int64_t end) {
        count[static_cast<std::size_t>(chunk)] = kernel.march_dense_backward(
            args, back, begin, end, slab.runs.data() + run_begin(chunk));
    });
    slab.items.clear();
    for (std::int64_t chunk = 0; chunk < chunks; ++chunk)
        for (std::int64_t i = 0; i < count[static_cast<std::size_t>(chunk)]; ++i)
            slab.items.push_back(static_cast<std::uint32_t>(run_begin(chunk) + i));
}

/// One task per brick adds the brick's runs into a halo, and the halo to the gradient.
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
            alignas(64) float halo[brick_halo_voxels * 4] = {};
            kernel.march_dense_gather(args, slab.runs.data(), slab.bins.order.data() + begin,
                                      end - begin, slab.d_raw.data(), halo);
            flush_halo<float, 4>(layout, brick, halo, d_values);
        });
}

}  // namespace

void march_dense(const DenseGrid<float>& grid, const RayBatch<float>& rays,
                 const MarchOptions& options, const MarchOutputs<float>& out) {
    const MarchDenseArgs args = dense_args(grid, rays, options, out);
    const Kernels& kernel = kernels();
    for_chunks(0, rays.count, [&](std::int64_t, std::int64_t begin, std::int64_t end) {
        kernel.march_dense_forward(args, begin, end);
    });
}

void march_dense_backward(const DenseGrid<float>& grid, const RayBatch<float>& rays,
                          const MarchOptions& options, const MarchOutputs<float>& out,
                          const MarchAdjoint<float>& adjoint, float* d_values) {
    const MarchDenseArgs args = dense_args(grid, rays, options, out);
    const Kernels& kernel = kernels();
    const BrickLayout layout = BrickLayout::of(args.shape);
    MarchDenseBackward back{};
    back.adjoint = adjoint;
    // Kept from call to call: a fit would otherwise clear megabytes of fresh memory every step.
    static thread_local Slab slab;
    for_slabs(rays.samples, rays.count, [&](std::int64_t first, std::int64_t last) {
        const std::vector<std::int64_t> offset = sample_offsets(rays.samples, first, last);
        if (offset.back() == 0) return;
        record_slab(kernel, args, back, offset, first, last, slab);
        gather_slab(kernel, args, layout, slab, d_values);
    });
}

}  // namespace photograd
