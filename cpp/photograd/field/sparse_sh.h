// Plenoxels: density and spherical-harmonic color at the active voxels of a sparse grid
// [FridovichKeil2022].
//
//   q       = (p - lo) / voxel - 1/2                       voxel i has its value at q = i
//   raw     = sum_n w_n density_n                          over the 8 corners of the cell of q
//   color_c = offset + sum_n w_n p_nc,  p_nc = sum_k Y_k(d) sh_nkc
//   sigma_t = density_scale density_activation(raw),   rgb = color_activation(color)
//
// A corner without a row reads the background. A cell without any row is vacuum: sigma_t = 0,
// whatever the background says, so that a march may skip it without changing a bit.
//
//   d_density_n += w_n d_raw,    d_sh_nkc += w_n Y_k d_color_c
//   d_q_axis     = sum_n (d w_n / d q_axis) (d_raw density_n + sum_c d_color_c p_nc)
//   d_Y_k        = sum_c d_color_c sum_n w_n sh_nkc,   and from there d_direction (ops/sh.h)
//
// Topology is held constant: the gradient of corners without a row goes to d_background. The color
// of a sample whose density is cut off by relu is not computed: it has no weight, and its
// derivatives vanish.
#pragma once

#include <array>

#include "photograd/core/scatter.h"
#include "photograd/field/samples.h"
#include "photograd/grid/cell_gather.h"
#include "photograd/ops/sh_blend.h"

namespace photograd {

template <Real R>
struct SparseSh {
    using Scalar = R;
    static constexpr const char* name = "sparse_sh";
    static constexpr int max_numbers = 3 * sh_count(3);

    const CellTable* table = nullptr;
    const R* density = nullptr;     // (N,)
    const R* sh = nullptr;          // (N, K, 3)
    const R* background = nullptr;  // (1 + 3 K,) density, coefficients
    int degree = 0;
    R lo[3]{}, scale[3]{}, density_scale{}, color_offset{};
    FieldOptions options;

    [[nodiscard]] int numbers() const { return 3 * sh_count(degree); }

    /// Sets density_scale, lo and scale from the options; the rest is set by the caller.
    void fit_to_box() {
        density_scale = static_cast<R>(options.density_scale);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double extent = options.box[1][axis] - options.box[0][axis];
            lo[axis] = static_cast<R>(options.box[0][axis]);
            scale[axis] = static_cast<R>(table->shape()[axis] / extent);
        }
    }

    /// Rows of the corners of a cell, no_row where nothing is active; false in vacuum.
    bool rows(const int* base, std::int32_t* row) const {
        const CellView view = table->view();
        const int entry = tile_entry(view, base[0], base[1], base[2]);
        const std::int32_t tile = entry < 0 ? 0 : std::max(view.top[entry], 0);
        const std::int32_t* at = view.rows + std::int64_t(tile) * cell_tile_voxels +
                                 offset_in_tile(base[0], base[1], base[2]);
        bool any = false;
        for (int n = 0; n < 8; ++n) {
            row[n] = at[corner_offset(n)];
            any |= row[n] >= 0;
        }
        return any;
    }

    /// Sample i of group g with all that its value needs.
    struct Lookup {
        CellPoint<R> at;
        R q[3], w[8], density[8];
        const R* corner[8];
        R missing = R(0);  // weight of the corners without a row
        bool any;
    };
    Lookup look_up(const SampleBatch<R>& batch, std::size_t g, int i) const {
        Lookup found;
        for (int axis = 0; axis < 3; ++axis)
            found.q[axis] = (batch.position[axis][g][i] - lo[axis]) * scale[axis] - R(0.5);
        found.at = CellPoint<R>::of(found.q);
        std::int32_t row[8];
        found.any = rows(found.at.base, row);
        for (int n = 0; n < 8; ++n) {
            const bool here = row[n] >= 0;
            found.w[n] = found.at.weights.corner(n);
            found.density[n] = here ? density[row[n]] : background[0];
            found.corner[n] = here ? sh + std::int64_t(row[n]) * numbers() : background + 1;
            found.missing = found.missing + (here ? R(0) : found.w[n]);
        }
        return found;
    }
    [[nodiscard]] bool is_cut(R raw) const {
        return options.density_activation == Activation::relu && raw <= R(0);
    }
    void basis(const SampleBatch<R>& batch, std::size_t g, R* Y3) const {
        const R d[3] = {batch.direction[0][g], batch.direction[1][g], batch.direction[2][g]};
        with_sh_degree(degree, [&]<int D>() { sh_basis_by_channel<D>(d, Y3); });
    }

    struct Cache {
        std::vector<std::array<Lanes<R>, 4>> raw;           // color with its offset, raw density
        std::vector<std::array<bool, lane_count>> visible;  // neither vacuum nor cut off
    };

    void eval(const SampleBatch<R>& batch, Cache& cache, SampleValues<R>& out) const {
        cache.raw.assign(batch.groups(), {});
        cache.visible.assign(batch.groups(), {});
        for (std::size_t g = 0; g < batch.groups(); ++g) {
            R Y3[max_numbers];
            basis(batch, g, Y3);
            for (int i = 0; i < lane_count; ++i) {
                const Lookup found = look_up(batch, g, i);
                R raw = R(0);
                for (int n = 0; n < 8; ++n) raw = raw + found.w[n] * found.density[n];
                if (!found.any || is_cut(raw)) continue;  // all values of the batch begin as 0
                R color[3];
                blend_colors(found, Y3, color);
                const auto lane = static_cast<std::size_t>(i);
                cache.visible[g][lane] = true;
                cache.raw[g][3][i] = raw;
                out.sigma_t[g][i] = density_scale * activate(options.density_activation, raw);
                for (std::size_t c = 0; c < 3; ++c) {
                    cache.raw[g][c][i] = color_offset + color[c];
                    out.rgb[c][g][i] = activate(options.color_activation, cache.raw[g][c][i]);
                }
            }
        }
    }

    /// Contributions of a slab, chunk by chunk in the order of the walk; finish() adds them up by
    /// owner.
    struct Sink {
        Sink(const SparseSh& its_field, const SparseShGradients<R>& its_gradients)
            : field(its_field), gradients(its_gradients) {}

        struct Chunk {
            std::vector<CellRecord<R>> records;             // `ray` is the number within the chunk
            std::vector<std::array<R, max_numbers>> basis;  // of each ray
            std::array<double, 1 + max_numbers> d_background{};
        };
        const SparseSh& field;
        SparseShGradients<R> gradients;
        std::vector<Chunk> chunks;

        void begin(int count) { chunks.assign(static_cast<std::size_t>(count), {}); }
        void finish();
    };

    /// Adds to `sink` and, where asked, to d_position[axis] and d_direction[axis].
    void backward(const SampleBatch<R>& batch, const Cache& cache, const SampleValues<R>& d_out,
                  Sink& sink, int chunk, std::vector<Lanes<R>>* d_position,
                  std::vector<R>* d_direction) const {
        typename Sink::Chunk& to = sink.chunks[static_cast<std::size_t>(chunk)];
        for (std::size_t g = 0; g < batch.groups(); ++g) {
            const std::size_t ray = batch.ray[g];
            if (to.basis.size() <= ray) to.basis.resize(ray + 1);
            R* Y3 = to.basis[ray].data();
            basis(batch, g, Y3);
            Lanes<R> d_missing[4] = {};  // of the corners without a row
            R d_Y[sh_count(3)] = {};
            for (int i = 0; i < batch.used[g]; ++i) {
                if (!cache.visible[g][static_cast<std::size_t>(i)]) continue;
                R d[4] = {};
                for (std::size_t c = 0; c < 3; ++c)
                    activate_backward(options.color_activation, cache.raw[g][c][i],
                                      d_out.rgb[c][g][i], d[c]);
                activate_backward(options.density_activation, cache.raw[g][3][i],
                                  density_scale * d_out.sigma_t[g][i], d[3]);
                const Lookup found = look_up(batch, g, i);
                to.records.push_back(
                    {{found.q[0], found.q[1], found.q[2]}, batch.ray[g], {d[0], d[1], d[2], d[3]}});
                for (int c = 0; c < 4; ++c) d_missing[c][i] = found.missing * d[c];
                if (d_position) {
                    R d_q[3] = {};
                    camera_backward(found, Y3, d, d_q, d_Y);
                    for (int axis = 0; axis < 3; ++axis)
                        d_position[axis][g][i] += d_q[axis] * scale[axis];
                }
            }
            to.d_background[0] += double(sum(d_missing[3]));
            for (int j = 0; j < numbers(); ++j)
                to.d_background[static_cast<std::size_t>(1 + j)] +=
                    double(Y3[j]) * double(sum(d_missing[j % 3]));
            if (d_direction) {
                const R x = batch.direction[0][g], y = batch.direction[1][g],
                        z = batch.direction[2][g];
                R d[3] = {};
                with_sh_degree(degree, [&]<int D>() { sh_basis_backward<D>(x, y, z, d_Y, d); });
                for (int axis = 0; axis < 3; ++axis) d_direction[axis][g] += d[axis];
            }
        }
    }

private:
    void blend_colors(const Lookup& found, const R* Y3, R* color) const {
        for (int n = 0; n < 8; ++n) {
            const R w = found.w[n];
            R p[3];
            fold_color(found.corner[n], Y3, numbers(), p);
            for (int c = 0; c < 3; ++c) color[c] = n == 0 ? w * p[c] : color[c] + w * p[c];
        }
    }
    /// Adds d_q (3,) and d_Y (K,) of one sample.
    void camera_backward(const Lookup& found, const R* Y3, const R* d, R* d_q, R* d_Y) const {
        for (int n = 0; n < 8; ++n) {
            R p[3];
            fold_color(found.corner[n], Y3, numbers(), p);
            R d_weight = d[3] * found.density[n];
            for (int c = 0; c < 3; ++c) d_weight += d[c] * p[c];
            found.at.weights.corner_backward(n, d_weight, d_q);
        }
        R b[max_numbers];
        blend_corners(found.corner, found.w, numbers(), b);
        for (int j = 0; j < numbers(); ++j) d_Y[j / 3] += d[j % 3] * b[j];
    }
};

template <Real R>
void SparseSh<R>::Sink::finish() {
    const BrickTopology& topology = field.table->topology();
    const int numbers = field.numbers();
    struct Run {
        std::uint32_t chunk;
        std::int64_t first, count;
    };
    std::vector<Run> runs;
    std::vector<std::uint32_t> owner;
    for (std::uint32_t c = 0; c < chunks.size(); ++c) {
        auto& records = chunks[c].records;
        const auto by_ray = [](const auto& a, const auto& b) { return a.ray < b.ray; };
        std::stable_sort(records.begin(), records.end(), by_ray);
        for (auto from = records.begin(), to = from; from != records.end(); from = to) {
            to = std::upper_bound(from, records.end(), *from, by_ray);
            for_brick_runs(topology, &*from, to - from,
                           [&](std::int32_t brick, std::int64_t first, std::int64_t count) {
                               owner.push_back(static_cast<std::uint32_t>(brick));
                               runs.push_back({c, from - records.begin() + first, count});
                           });
        }
    }
    OwnerBins bins;
    bin_by_owner(owner, topology.bricks(), bins);
    parallel_for(topology.bricks(), [&](std::int64_t brick) {
        const auto b = static_cast<std::size_t>(brick);
        for (std::uint32_t j = bins.begin[b]; j < bins.begin[b + 1]; ++j) {
            const Run& run = runs[bins.order[j]];
            const Chunk& from = chunks[run.chunk];
            const CellRecord<R>* records = from.records.data() + run.first;
            gather_run(topology, static_cast<std::int32_t>(brick), records, run.count,
                       from.basis[records->ray].data(), numbers, gradients);
        }
    });
    for (int j = 0; j < 1 + numbers; ++j) {
        double total = 0.0;
        for (const Chunk& chunk : chunks) total += chunk.d_background[static_cast<std::size_t>(j)];
        gradients.d_background[j] += static_cast<R>(total);
    }
}

static_assert(Field<SparseSh<float>> && Field<SparseSh<double>>);

}  // namespace photograd
