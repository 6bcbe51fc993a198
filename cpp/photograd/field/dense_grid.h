// Dense RGBA grid: raw color and raw density at the centers of X x Y x Z voxels that fill a box.
//
//   q       = (p - lo) / (hi - lo) * n - 1/2            voxel coordinate, voxel i at q = i
//   raw     = trilinear(values, q)                      4 channels: r, g, b, density
//   sigma_t = density_scale density_activation(raw[3]),  rgb = color_activation(raw[0..2])
//
// The adjoint runs the chain backwards: d_raw = activation' (d_sigma_t, d_rgb), then each of the
// eight corners gets its trilinear weight times d_raw, through the brick owners of grid/brick.h.
#pragma once

#include <algorithm>
#include <array>
#include <numeric>

#include "photograd/core/errors.h"
#include "photograd/core/scatter.h"
#include "photograd/field/samples.h"
#include "photograd/grid/brick.h"

namespace photograd {

template <Real R>
struct DenseGrid {
    using Scalar = R;
    static constexpr const char* name = "dense_grid";
    static constexpr const char* axes = "X Y Z 4";
    static constexpr int channels = 4;

    const R* values = nullptr;  // (X, Y, Z, 4)
    GridShape shape{};
    R lo[3]{}, scale[3]{}, density_scale{};
    FieldOptions options;

    static const char* expected() { return "at least two voxels along every axis"; }
    static bool fits(const std::int64_t* shape) {
        return std::min({shape[0], shape[1], shape[2]}) >= 2;
    }

    static DenseGrid over(const R* values, const std::int64_t* shape, const FieldOptions& options) {
        DenseGrid grid;
        grid.values = values;
        grid.shape = {static_cast<int>(shape[0]), static_cast<int>(shape[1]),
                      static_cast<int>(shape[2])};
        grid.options = options;
        grid.density_scale = static_cast<R>(options.density_scale);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double extent = options.box[1][axis] - options.box[0][axis];
            grid.lo[axis] = static_cast<R>(options.box[0][axis]);
            grid.scale[axis] = static_cast<R>(static_cast<double>(shape[axis]) / extent);
        }
        return grid;
    }

    struct Weights {
        AxisWeights<R> x, y, z;
    };
    [[nodiscard]] Weights weights(R x, R y, R z) const {
        return {axis_weights((x - lo[0]) * scale[0] - R(0.5), shape.x, options.border),
                axis_weights((y - lo[1]) * scale[1] - R(0.5), shape.y, options.border),
                axis_weights((z - lo[2]) * scale[2] - R(0.5), shape.z, options.border)};
    }

    struct Cache {
        std::vector<std::array<Lanes<R>, channels>> raw;
    };

    void eval(const SampleBatch<R>& batch, Cache& cache, SampleValues<R>& out) const {
        cache.raw.resize(batch.groups());
        for (std::size_t g = 0; g < batch.groups(); ++g) {
            for (int i = 0; i < lane_count; ++i) {
                const Weights w = weights(batch.position[0][g][i], batch.position[1][g][i],
                                          batch.position[2][g][i]);
                R raw[channels];
                trilinear<R, channels>(values, shape, w.x, w.y, w.z, raw);
                for (std::size_t c = 0; c < channels; ++c) cache.raw[g][c][i] = raw[c];
                out.sigma_t[g][i] = density_scale * activate(options.density_activation, raw[3]);
                for (int c = 0; c < 3; ++c)
                    out.rgb[c][g][i] = activate(options.color_activation, raw[c]);
            }
        }
    }

    /// Contributions of a slab of rays, chunk by chunk in the order of the walk; finish() hands
    /// them to their owners.
    struct Sink {
        struct Contribution {
            std::uint32_t owner;
            std::array<R, 3> position;
            std::array<R, channels> d_raw;
        };

        Sink(const DenseGrid& field, R* d_values) : grid(field), gradient(d_values) {}

        const DenseGrid& grid;
        R* gradient;  // (X, Y, Z, 4), added to
        std::vector<std::vector<Contribution>> chunks;

        void begin(int chunk_count) { chunks.assign(static_cast<std::size_t>(chunk_count), {}); }
        void finish();
    };

    /// Adds parameter gradients to `sink` and, where asked, dL/d position to d_position[axis].
    void backward(const SampleBatch<R>& batch, const Cache& cache, const SampleValues<R>& d_out,
                  Sink& sink, int chunk, std::vector<Lanes<R>>* d_position,
                  std::vector<R>* /*d_direction*/) const {
        const int extent[3] = {shape.x, shape.y, shape.z};
        const BrickLayout layout = BrickLayout::of(extent);
        for (std::size_t g = 0; g < batch.groups(); ++g) {
            for (int i = 0; i < batch.used[g]; ++i) {
                const std::array<R, 3> at{batch.position[0][g][i], batch.position[1][g][i],
                                          batch.position[2][g][i]};
                std::array<R, channels> d_raw{};
                for (std::size_t c = 0; c < 3; ++c)
                    activate_backward(options.color_activation, cache.raw[g][c][i],
                                      d_out.rgb[c][g][i], d_raw[c]);
                activate_backward(options.density_activation, cache.raw[g][3][i],
                                  density_scale * d_out.sigma_t[g][i], d_raw[3]);
                const Weights w = weights(at[0], at[1], at[2]);
                const int owner = layout.owner(w.x.base, w.y.base, w.z.base);
                sink.chunks[static_cast<std::size_t>(chunk)].push_back(
                    {static_cast<std::uint32_t>(owner), at, d_raw});
                if (d_position) {
                    R d_q[3] = {R(0), R(0), R(0)};
                    trilinear_position_backward<R, channels>(values, shape, w.x, w.y, w.z,
                                                             d_raw.data(), d_q);
                    for (int axis = 0; axis < 3; ++axis)
                        d_position[axis][g][i] += d_q[axis] * scale[axis];
                }
            }
        }
    }
};

template <Real R>
void DenseGrid<R>::Sink::finish() {
    const int extent[3] = {grid.shape.x, grid.shape.y, grid.shape.z};
    const BrickLayout layout = BrickLayout::of(extent);
    std::vector<Contribution> samples;
    for (const auto& chunk : chunks) samples.insert(samples.end(), chunk.begin(), chunk.end());
    std::vector<std::uint32_t> items(samples.size());
    std::iota(items.begin(), items.end(), 0u);
    OwnerBins bins;
    bin_by_owner(items, layout.count(), [&](std::uint32_t s) { return samples[s].owner; }, bins);
    for (int color = 0; color < brick_colors; ++color)
        parallel_for(layout.count(), [&](std::int64_t brick) {
            const auto k = static_cast<std::size_t>(brick);
            if (layout.color(static_cast<int>(brick)) != color ||
                bins.begin[k] == bins.begin[k + 1])
                return;
            std::vector<R> halo(static_cast<std::size_t>(brick_halo_voxels * channels), R(0));
            int corner[3];
            layout.corner(static_cast<int>(brick), corner);
            for (std::uint32_t j = bins.begin[k]; j < bins.begin[k + 1]; ++j) {
                const Contribution& s = samples[bins.order[j]];
                Weights w = grid.weights(s.position[0], s.position[1], s.position[2]);
                w.x.base -= corner[0];
                w.y.base -= corner[1];
                w.z.base -= corner[2];
                trilinear_backward<R, channels>({brick_halo_side, brick_halo_side, brick_halo_side},
                                                w.x, w.y, w.z, s.d_raw.data(), halo.data());
            }
            flush_halo<R, channels>(layout, static_cast<int>(brick), halo.data(), gradient);
        });
}

static_assert(Field<DenseGrid<float>> && Field<DenseGrid<double>>);

}  // namespace photograd
