#include "photograd/render/march/march_sparse_sh.h"

#include <numeric>

#include "kernels/kernels.h"
#include "photograd/render/march/kernel_args.h"
#include "photograd/render/march/sparse_slab.h"

namespace photograd {
namespace {

/// Densities where the march looks for them. Kept from call to call, because a fit would otherwise
/// clear megabytes of fresh memory every step.
const float* spread_density(const SparseSh<float>& field) {
    static thread_local std::vector<float> spread;
    const auto size = static_cast<std::size_t>((field.table->tiles() + 1) * cell_tile_voxels);
    if (spread.size() < size) spread.resize(size);
    field.table->spread(field.density, field.background[0], spread.data());
    return spread.data();
}

MarchSparseShArgs sparse_args(const SparseSh<float>& field, const RayBatch<float>& rays,
                              const MarchOptions& options, const MarchOutputs<float>& out) {
    auto a = kernel_args<MarchSparseShArgs>(field, rays, options, out);
    a.cells = field.table->view();
    a.density = spread_density(field);
    a.sh = field.sh;
    a.background = field.background;
    a.degree = field.degree;
    a.color_offset = field.color_offset;
    a.skip = 1;
    return a;
}

/// Calls use(slab) for all slabs of rays, recorded and sorted.
template <class Use>
void for_recorded_slabs(RecordKernel kernel, const MarchSparseShArgs& args,
                        const MarchSparseShBackward& back, const SparseSh<float>& field,
                        Use&& use) {
    static thread_local SparseSlab slab;
    for_slabs(args.rays.samples, args.rays.count, [&](std::int64_t first, std::int64_t last) {
        slab.record(kernel, args, back, {first, last}, field.table->topology());
        use(static_cast<const SparseSlab&>(slab));
    });
}

}  // namespace

std::int64_t march_sparse_sh(const SparseSh<float>& field, const RayBatch<float>& rays,
                             const MarchOptions& options, const MarchOutputs<float>& out,
                             bool skip) {
    MarchSparseShArgs args = sparse_args(field, rays, options, out);
    args.skip = skip ? 1 : 0;
    std::vector<std::int64_t> looked_up(static_cast<std::size_t>(chunk_count(rays.count)));
    const Kernels& kernel = kernels();
    for_chunks(0, rays.count, [&](std::int64_t chunk, std::int64_t begin, std::int64_t end) {
        looked_up[static_cast<std::size_t>(chunk)] =
            kernel.march_sparse_sh_forward(args, begin, end);
    });
    return std::accumulate(looked_up.begin(), looked_up.end(), std::int64_t{0});
}

void march_sparse_sh_backward(const SparseSh<float>& field, const RayBatch<float>& rays,
                              const MarchOptions& options, const MarchOutputs<float>& out,
                              const MarchAdjoint<float>& adjoint,
                              const SparseShGradients<float>& gradients) {
    const MarchSparseShArgs args = sparse_args(field, rays, options, out);
    MarchSparseShBackward back{};
    back.adjoint = adjoint;
    const BrickTopology& topology = field.table->topology();
    const auto gather = [&](const SparseSlab& slab) {
        slab.for_bricks(topology, [&](std::int32_t brick, const std::uint32_t* order,
                                      std::int64_t count) {
            SparseShGather own{slab.runs.data(),        order, count,        slab.basis.data(),
                               topology.rows_of(brick), {},    field.degree, gradients.d_density,
                               gradients.d_sh};
            std::copy_n(topology.origins().data() + 3 * std::int64_t(brick), 3, own.origin);
            kernels().march_sparse_sh_gather(own);
        });
        const auto numbers = static_cast<std::size_t>(1 + field.numbers());
        for (std::size_t j = 0; j < numbers; ++j) {
            double total = 0.0;
            for (std::size_t i = j; i < slab.d_background.size(); i += numbers)
                total += slab.d_background[i];
            gradients.d_background[j] += static_cast<float>(total);
        }
    };
    for_recorded_slabs(kernels().march_sparse_sh_backward, args, back, field, gather);
}

void march_sparse_sh_weights(const SparseSh<float>& field, const RayBatch<float>& rays,
                             const MarchOptions& options, float* max_weight) {
    const MarchSparseShArgs args = sparse_args(field, rays, options, {});
    const BrickTopology& topology = field.table->topology();
    const auto gather = [&](const SparseSlab& slab) {
        slab.for_bricks(topology,
                        [&](std::int32_t brick, const std::uint32_t* order, std::int64_t count) {
                            for (std::int64_t e = 0; e < count; ++e) {
                                const CellRun& run = slab.runs[order[e]];
                                for (std::int64_t r = 0; r < run.count; ++r)
                                    gather_max(topology, brick, run.records[r], max_weight);
                            }
                        });
    };
    for_recorded_slabs(kernels().march_sparse_sh_weights, args, {}, field, gather);
}

}  // namespace photograd
