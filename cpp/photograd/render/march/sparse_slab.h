// The records of one slab of rays through a sparse grid, sorted by the brick that owns them: from
// the kernel that marches to the one that accumulates.
#pragma once

#include <utility>
#include <vector>

#include "kernels/march_sparse_sh.h"
#include "photograd/core/scatter.h"
#include "photograd/grid/cell_gather.h"
#include "photograd/render/march/chunks.h"

namespace photograd {

using RecordKernel = void (*)(const MarchSparseShArgs&, const MarchSparseShBackward&,
                              std::int64_t begin, std::int64_t end);

/// Buffers are kept from slab to slab.
class SparseSlab {
public:
    std::vector<float> basis;          // (rays, sh_basis_stride)
    std::vector<double> d_background;  // (chunks, 1 + 3 K)
    std::vector<CellRun> runs;
    OwnerBins bins;  // of the runs, by brick

    /// Records rays [first, last) and sorts the runs by brick.
    void record(RecordKernel kernel, const MarchSparseShArgs& args, MarchSparseShBackward back,
                std::pair<std::int64_t, std::int64_t> rays, const BrickTopology& topology) {
        const auto [first, last] = rays;
        const std::int64_t chunks = chunk_count(last - first);
        const int numbers = 1 + 3 * sh_count(args.degree);
        if (chunks_.size() < static_cast<std::size_t>(chunks))
            chunks_.resize(static_cast<std::size_t>(chunks));
        const auto basis_size = static_cast<std::size_t>((last - first) * sh_basis_stride);
        if (basis.size() < basis_size) basis.resize(basis_size);
        d_background.assign(static_cast<std::size_t>(chunks * numbers), 0.0);
        back.first_ray = first;
        back.basis = basis.data();
        for_chunks(first, last, [&](std::int64_t chunk, std::int64_t begin, std::int64_t end) {
            MarchSparseShBackward own = back;
            own.d_background = d_background.data() + chunk * numbers;
            chunks_[static_cast<std::size_t>(chunk)].record(kernel, args, own, {begin, end},
                                                            topology);
        });
        runs.clear();
        owner_.clear();
        for (std::int64_t c = 0; c < chunks; ++c) {
            const Chunk& chunk = chunks_[static_cast<std::size_t>(c)];
            runs.insert(runs.end(), chunk.runs.begin(), chunk.runs.end());
            owner_.insert(owner_.end(), chunk.owners.begin(), chunk.owners.end());
        }
        bin_by_owner(owner_, topology.bricks(), bins);
    }

    /// use(brick, indices of its runs, their count) in parallel for every brick that has any.
    template <class Use>
    void for_bricks(const BrickTopology& topology, Use&& use) const {
        parallel_for(topology.bricks(), [&](std::int64_t brick) {
            const auto b = static_cast<std::size_t>(brick);
            if (bins.begin[b] != bins.begin[b + 1])
                use(static_cast<std::int32_t>(brick), bins.order.data() + bins.begin[b],
                    static_cast<std::int64_t>(bins.begin[b + 1] - bins.begin[b]));
        });
    }

private:
    struct Chunk {
        std::vector<CellRecord<float>> records;  // ray by ray, without gaps
        std::vector<CellRun> runs;
        std::vector<std::uint32_t> owners;  // the brick of each run

        void record(RecordKernel kernel, const MarchSparseShArgs& args, MarchSparseShBackward back,
                    std::pair<std::int64_t, std::int64_t> rays, const BrickTopology& topology) {
            // The kernel needs room for all samples of all rays; few of them lie in active cells,
            // so that what is kept is much smaller.
            static thread_local std::vector<CellRecord<float>> room;
            const auto [begin, end] = rays;
            std::int32_t found[march_chunk];
            std::int64_t samples = 0, kept = 0;
            for (std::int64_t ray = begin; ray < end; ++ray)
                samples += std::max(args.rays.samples[ray], 0);
            if (room.size() < static_cast<std::size_t>(samples))
                room.resize(static_cast<std::size_t>(samples));
            back.records = room.data();
            back.found = found;
            kernel(args, back, begin, end);
            for (std::int64_t ray = begin; ray < end; ++ray) kept += found[ray - begin];
            if (records.size() < static_cast<std::size_t>(kept))
                records.resize(static_cast<std::size_t>(kept));
            runs.clear();
            owners.clear();
            const CellRecord<float>* from = room.data();
            CellRecord<float>* to = records.data();
            for (std::int64_t ray = begin; ray < end; ++ray) {
                const std::int64_t count = found[ray - begin];
                std::copy_n(from, count, to);
                for_brick_runs(topology, to, count,
                               [&](std::int32_t brick, std::int64_t at, std::int64_t length) {
                                   owners.push_back(static_cast<std::uint32_t>(brick));
                                   runs.push_back({to + at, length});
                               });
                from += std::max(args.rays.samples[ray], 0);
                to += count;
            }
        }
    };

    std::vector<Chunk> chunks_;
    std::vector<std::uint32_t> owner_;
};

}  // namespace photograd
