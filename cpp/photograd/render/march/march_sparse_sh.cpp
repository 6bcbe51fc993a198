#include "photograd/render/march/march_sparse_sh.h"

#include "kernels/kernels.h"
#include "photograd/render/march/sparse_slab.h"

namespace photograd {
namespace {

/// Densities where the march looks for them. Kept from call to call, because a fit would otherwise clear
/// megabytes of fresh memory every step.
const float* spread_density(const SparseSh<float>& field) {
    static thread_local std::vector<float> spread;
    const auto size = static_cast<std::size_t>((field.table->tiles() + 1) * cell_tile_voxels);
    if (spread.size() < size) spread.resize(size);
    field.table->spread(field.density, field.background[0], spread.data());
    return spread.data();
}

MarchSparseShArgs kernel_args(const SparseSh<float>& field, const RayBatch<float>& rays,
                              const MarchOptions& options, const RayOutputs<float>& out) {
    MarchSparseShArgs a{};
    a.cells = field.table->view();
    a.density = spread_density(field);
    a.sh = field.sh;
    a.background = field.background;
    a.degree = field.degree;
    std::copy_n(field.lo, 3, a.lo);
    std::copy_n(field.scale, 3, a.scale);
    a.density_activation = static_cast<int>(field.options.density_activation);
    a.color_activation = static_cast<int>(field.options.color_activation);
    a.quadrature = static_cast<int>(options.quadrature);
    a.density_scale = field.density_scale;
    a.color_offset = field.color_offset;
    a.dt = static_cast<float>(options.dt);
    a.tau_stop = static_cast<float>(options.tau_stop());
    a.skip = 1;
    a.origins = rays.origins;
    a.directions = rays.directions;
    a.t0 = rays.t0;
    a.count = rays.samples;
    a.color = out.color;
    a.transmittance = out.transmittance;
    a.depth = out.depth;
    return a;
}

/// Calls use(slab) for all slabs of rays, recorded and sorted.
template <class Use>
void for_slabs(RecordKernel kernel, const MarchSparseShArgs& args,
               const MarchSparseShBackward& back, const SparseSh<float>& field, std::int64_t count,
               Use&& use) {
    static thread_local SparseSlab slab;
    for (std::int64_t first = 0, last; first < count; first = last) {
        last = detail::slab_end(args.count, first, count);
        slab.record(kernel, args, back, {first, last}, field.table->topology());
        use(static_cast<const SparseSlab&>(slab));
    }
}

}  // namespace

std::int64_t march_sparse_sh(const SparseSh<float>& field, const RayBatch<float>& rays,
                             const MarchOptions& options, const RayOutputs<float>& out, bool skip) {
    MarchSparseShArgs args = kernel_args(field, rays, options, out);
    args.skip = skip ? 1 : 0;
    const std::int64_t chunks = (rays.count + march_chunk - 1) / march_chunk;
    std::vector<std::int64_t> looked_up(static_cast<std::size_t>(chunks));
    const Kernels& kernel = kernels();
    parallel_for(chunks, [&](std::int64_t chunk) {
        const std::int64_t begin = chunk * march_chunk;
        looked_up[static_cast<std::size_t>(chunk)] =
            kernel.march_sparse_sh_forward(args, begin, std::min(begin + march_chunk, rays.count));
    });
    std::int64_t total = 0;
    for (const std::int64_t one : looked_up) total += one;
    return total;
}

void march_sparse_sh_backward(const SparseSh<float>& field, const RayBatch<float>& rays,
                              const MarchOptions& options, const RayOutputs<float>& out,
                              const RayAdjoints<float>& adjoints,
                              const SparseShGradients<float>& gradients) {
    const MarchSparseShArgs args = kernel_args(field, rays, options, out);
    MarchSparseShBackward back{};
    back.d_color = adjoints.d_color;
    back.d_depth = adjoints.d_depth;
    back.d_transmittance = adjoints.d_transmittance;
    const BrickTopology& topology = field.table->topology();
    const int numbers = 1 + field.numbers();
    const Kernels& kernel = kernels();
    for_slabs(kernel.march_sparse_sh_backward, args, back, field, rays.count,
              [&](const SparseSlab& slab) {
                  slab.for_bricks(topology, [&](std::int32_t brick, const std::uint32_t* order,
                                                std::int64_t count) {
                      SparseShGather gather{
                          slab.runs.data(),        order, count,        slab.basis.data(),
                          topology.rows_of(brick), {},    field.degree, gradients.d_density,
                          gradients.d_sh};
                      std::copy_n(topology.origins().data() + 3 * std::int64_t(brick), 3,
                                  gather.origin);
                      kernel.march_sparse_sh_gather(gather);
                  });
                  for (int j = 0; j < numbers; ++j) {
                      double total = 0.0;
                      for (auto i = static_cast<std::size_t>(j); i < slab.lost.size();
                           i += static_cast<std::size_t>(numbers))
                          total += slab.lost[i];
                      gradients.d_background[j] += static_cast<float>(total);
                  }
              });
}

void march_sparse_sh_weights(const SparseSh<float>& field, const RayBatch<float>& rays,
                             const MarchOptions& options, float* most) {
    const MarchSparseShArgs args = kernel_args(field, rays, options, {});
    const BrickTopology& topology = field.table->topology();
    for_slabs(kernels().march_sparse_sh_weights, args, {}, field, rays.count,
              [&](const SparseSlab& slab) {
                  slab.for_bricks(topology, [&](std::int32_t brick, const std::uint32_t* order,
                                                std::int64_t count) {
                      for (std::int64_t e = 0; e < count; ++e) {
                          const CellRun& run = slab.runs[order[e]];
                          for (std::int64_t r = 0; r < run.count; ++r)
                              gather_greatest(topology, brick, run.records[r], most);
                      }
                  });
              });
}

}  // namespace photograd
