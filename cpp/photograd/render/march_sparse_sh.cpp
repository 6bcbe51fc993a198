#include "photograd/render/march_sparse_sh.h"

#include "kernels/kernels.h"

namespace photograd {
namespace {

MarchSparseShArgs kernel_args(const SparseSh<float>& field, const RayBatch<float>& rays,
                              const MarchOptions& options, const RayOutputs<float>& out) {
    MarchSparseShArgs a{};
    a.cells = field.table->view();
    a.density = field.density;
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

using Kernel = std::int64_t (*)(const MarchSparseShArgs&, const MarchSparseShBackward&,
                                std::int64_t begin, std::int64_t end);

/// The records of one slab of rays and, sorted by brick, who they concern. Kept from slab to slab.
class Slab {
public:
    std::vector<float> basis;
    std::vector<CellRecord<float>> records;
    std::vector<double> lost;  // (chunks, 1 + 3 K)
    OwnerBins bins;
    std::vector<std::uint32_t> order;  // numbers of records, brick by brick

    void record(Kernel kernel, const MarchSparseShArgs& args, MarchSparseShBackward back,
                std::int64_t first, std::int64_t last, int numbers) {
        const std::int64_t chunks = (last - first + march_chunk - 1) / march_chunk;
        begin_.assign(static_cast<std::size_t>(chunks) + 1, 0);
        for (std::int64_t ray = first; ray < last; ++ray)
            begin_[static_cast<std::size_t>((ray - first) / march_chunk) + 1] += args.count[ray];
        for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
        grow(records, static_cast<std::size_t>(begin_.back()));
        grow(basis, static_cast<std::size_t>((last - first) * sh_basis_stride));
        lost.assign(static_cast<std::size_t>(chunks * numbers), 0.0);
        count_.assign(static_cast<std::size_t>(chunks), 0);
        back.first_ray = first;
        back.basis = basis.data();
        parallel_for(chunks, [&](std::int64_t chunk) {
            const auto c = static_cast<std::size_t>(chunk);
            MarchSparseShBackward own = back;
            own.records = records.data() + begin_[c];
            own.lost = lost.data() + chunk * numbers;
            const std::int64_t begin = first + chunk * march_chunk;
            count_[c] = kernel(args, own, begin, std::min(begin + march_chunk, last));
        });
    }

    /// Finds the bricks of each record and sorts by them.
    void bin(const BrickTopology& topology) {
        owners_.resize(std::max(owners_.size(), count_.size()));
        items_.resize(owners_.size());
        parallel_for(static_cast<std::int64_t>(count_.size()), [&](std::int64_t chunk) {
            const auto c = static_cast<std::size_t>(chunk);
            owners_[c].clear();
            items_[c].clear();
            for (std::int64_t r = begin_[c]; r < begin_[c] + count_[c]; ++r) {
                const float* q = records[static_cast<std::size_t>(r)].q;
                const int base[3] = {int(std::floor(q[0])), int(std::floor(q[1])),
                                     int(std::floor(q[2]))};
                std::int32_t brick[8];
                const int count = bricks_of_cell(topology, base, brick);
                for (int n = 0; n < count; ++n) {
                    owners_[c].push_back(static_cast<std::uint32_t>(brick[n]));
                    items_[c].push_back(static_cast<std::uint32_t>(r));
                }
            }
        });
        owner_.clear();
        item_.clear();
        for (std::size_t c = 0; c < count_.size(); ++c) {
            owner_.insert(owner_.end(), owners_[c].begin(), owners_[c].end());
            item_.insert(item_.end(), items_[c].begin(), items_[c].end());
        }
        bin_by_owner(owner_, topology.bricks(), bins);
        order.resize(item_.size());
        parallel_for(static_cast<std::int64_t>((item_.size() + 65535) / 65536),
                     [&](std::int64_t piece) {
                         const auto from = static_cast<std::size_t>(piece) * 65536;
                         for (std::size_t i = from; i < std::min(from + 65536, item_.size()); ++i)
                             order[i] = item_[bins.order[i]];
                     });
    }

    /// use(brick, first entry of `order`, number of entries) for every brick that has any.
    template <class Use>
    void for_bricks(const BrickTopology& topology, Use&& use) const {
        parallel_for(topology.bricks(), [&](std::int64_t brick) {
            const auto b = static_cast<std::size_t>(brick);
            if (bins.begin[b] != bins.begin[b + 1])
                use(static_cast<std::int32_t>(brick), order.data() + bins.begin[b],
                    static_cast<std::int64_t>(bins.begin[b + 1] - bins.begin[b]));
        });
    }

private:
    template <class T>
    static void grow(std::vector<T>& buffer, std::size_t size) {
        if (buffer.size() < size) buffer.resize(size);
    }

    std::vector<std::int64_t> begin_, count_;  // first record of each chunk, and how many
    std::vector<std::vector<std::uint32_t>> owners_, items_;
    std::vector<std::uint32_t> owner_, item_;
};

/// Calls use(slab) for all slabs of rays, recorded and sorted.
template <class Use>
void for_slabs(Kernel kernel, const MarchSparseShArgs& args, const MarchSparseShBackward& back,
               const SparseSh<float>& field, std::int64_t count, Use&& use) {
    // Kept from call to call: a fit would otherwise clear megabytes of fresh memory every step.
    static thread_local Slab slab;
    for (std::int64_t first = 0, last; first < count; first = last) {
        last = detail::slab_end(args.count, first, count);
        slab.record(kernel, args, back, first, last, 1 + field.numbers());
        slab.bin(field.table->topology());
        use(static_cast<const Slab&>(slab));
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
    for_slabs(
        kernel.march_sparse_sh_backward, args, back, field, rays.count, [&](const Slab& slab) {
            slab.for_bricks(topology, [&](std::int32_t brick, const std::uint32_t* order,
                                          std::int64_t count) {
                SparseShGather gather{
                    slab.records.data(),     order, count,        slab.basis.data(),
                    topology.rows_of(brick), {},    field.degree, gradients.d_density,
                    gradients.d_sh};
                std::copy_n(topology.origins().data() + 3 * std::int64_t(brick), 3, gather.origin);
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
    for_slabs(
        kernels().march_sparse_sh_weights, args, {}, field, rays.count, [&](const Slab& slab) {
            slab.for_bricks(
                topology, [&](std::int32_t brick, const std::uint32_t* order, std::int64_t count) {
                    for (std::int64_t e = 0; e < count; ++e)
                        gather_greatest(topology, brick, slab.records[order[e]], most);
                });
        });
}

}  // namespace photograd
