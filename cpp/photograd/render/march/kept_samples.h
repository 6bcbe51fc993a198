// What the forward pass of a march through networks keeps of its samples, so that the backward pass
// evaluates fewer of them again. The bits of both passes do not depend on it.
//
// A block of samples takes 0.8 kB (a hash grid) to 2 kB (a NeRF of 4 layers of 64) for each of its
// samples: the numbers of all layers. Each chunk of rays keeps the first batches that fit into its
// share of `kept_bytes`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "photograd/field/neural_field.h"
#include "photograd/render/march/march.h"

namespace photograd {

/// Bytes that a march keeps at most.
inline constexpr std::size_t kept_bytes = std::size_t{256} << 20;

template <Real R>
class KeptSamples {
public:
    using Field = NeuralField<R>;
    using Cache = typename Field::Cache;
    struct Batch {
        std::size_t groups;
        Cache cache;
    };
    using Chunk = std::vector<Batch>;  // its first batches

    /// Forgets everything, and makes room for the samples of `rays`: before it, nothing is kept.
    /// Only if they are one slab (chunks.h), both passes cut them into the same chunks; of more
    /// rays, nothing is kept.
    void start(const Field& field, const RayBatch<R>& rays) {
        chunks_.clear();
        density_ = field.density.shape();
        color_ = field.color.shape();
        std::int64_t total = 0;
        for (std::int64_t ray = 0; ray < rays.count; ++ray) total += rays.samples[ray];
        if (total <= march_slab_samples)
            chunks_.resize(static_cast<std::size_t>(chunk_count(rays.count, Field::chunk_rays)));
    }

    /// Looks up a chunk in the forward pass, and keeps its batches while there is room.
    struct Keeping {
        const Field& field;
        Chunk* chunk;
        std::size_t room;
        Cache cache{};

        const Cache& operator()(const SampleBatch<R>& batch, SampleValues<R>& values) {
            field.eval(batch, cache, values);
            const std::size_t size = cache.used * field.block_bytes();
            if (!chunk || size > room) {
                room = 0;
                return cache;
            }
            room -= size;
            chunk->push_back({batch.groups(), std::exchange(cache, {})});
            return chunk->back().cache;
        }
    };
    Keeping keeping(const Field& field, std::int64_t chunk) {
        if (chunks_.empty()) return {field, nullptr, 0};
        return {field, &chunks_[static_cast<std::size_t>(chunk)], kept_bytes / chunks_.size()};
    }

    /// Looks up a chunk in the backward pass: its first batches as they were kept.
    struct Replay {
        const Field& field;
        std::span<const Batch> kept;
        Cache cache{};

        const Cache& operator()(const SampleBatch<R>& batch, SampleValues<R>& values) {
            if (kept.empty() || kept.front().groups != batch.groups()) {
                kept = {};
                field.eval(batch, cache, values);
                return cache;
            }
            const Cache& found = kept.front().cache;
            kept = kept.subspan(1);
            field.write_values(found, values);
            return found;
        }
    };
    [[nodiscard]] Replay replay(const Field& field, std::int64_t chunk) const {
        const auto c = static_cast<std::size_t>(chunk);
        const bool same = density_ == field.density.shape() && color_ == field.color.shape();
        if (!same || c >= chunks_.size()) return {field, {}};
        return {field, chunks_[c]};
    }

private:
    std::vector<Chunk> chunks_;
    PerceptronShape density_, color_;
};

}  // namespace photograd
