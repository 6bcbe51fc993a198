// A radiance field by networks [Mildenhall2020, Mueller2022]: density and features from the
// position, color from the features and the direction.
//
//   e = encoding(p)                       hash or frequencies, p in the unit cube of the box
//   (s, g_1 .. g_G) = density network(e)  sigma_t = scale activation(s)
//   c = color network(g, Y(-d))           rgb = activation(c), Y: spherical harmonics of the
//                                         direction towards the camera
//
// Density does not depend on the direction. Cells of an occupancy grid that are marked empty are
// skipped: nothing is evaluated there, and density is 0.
//
// Adjoint: that of the two networks, one behind the other, then of the encoding. Tables are shared
// by all rays: what a slab of rays adds to them is recorded, and added up level by level.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "photograd/core/scatter.h"
#include "photograd/field/samples.h"
#include "photograd/network/engine.h"
#include "photograd/network/frequency_encoding.h"
#include "photograd/network/hash_encoding.h"
#include "photograd/ops/sh.h"

namespace photograd {

/// Cells of the box, x fastest; 0 where a cell is empty. Without cells everything is evaluated.
struct Occupancy {
    const std::uint8_t* cells = nullptr;
    int resolution = 0;

    template <class R>
    [[nodiscard]] bool occupied(const R* unit) const {
        if (!cells) return true;
        std::int64_t index = 0;
        for (int a = 2; a >= 0; --a) {
            const int at = static_cast<int>(unit[a] * static_cast<R>(resolution));
            index = index * resolution + std::clamp(at, 0, resolution - 1);
        }
        return cells[index] != 0;
    }
};

template <Real R>
struct NeuralField {
    using Scalar = R;
    static constexpr const char* name = "neural";
    static constexpr std::int64_t chunk_rays = 256;  // so that blocks of 128 samples are full
    static constexpr int sh_degree = 3, sh_numbers = sh_count(sh_degree);

    const HashEncoding<R, 3>* hash = nullptr;  // or else
    FrequencyEncoding frequencies{3, 0};
    const R* table = nullptr;
    Network<R> density, color;
    Occupancy occupancy;
    FieldOptions options;

    [[nodiscard]] int encoded() const { return density.shape().inputs; }
    /// Features that the density network hands to the color network.
    [[nodiscard]] int features() const { return density.shape().outputs() - 1; }

    /// Up to 128 samples that are not in empty cells.
    struct Block {
        int count = 0;
        std::array<std::uint32_t, perceptron_block> group;
        std::array<std::uint8_t, perceptron_block> lane;
        std::array<R, 3 * perceptron_block> unit;
        typename Network<R>::Values density, color;
    };
    struct Cache {
        std::vector<Block> blocks;
        std::size_t used = 0;
    };
    /// Bytes of a block: what it says of its samples, and the numbers of both networks.
    [[nodiscard]] std::size_t block_bytes() const {
        return sizeof(Block) + density.workspace_bytes() + color.workspace_bytes();
    }

    void eval(const SampleBatch<R>& batch, Cache& cache, SampleValues<R>& values) const {
        collect(batch, cache);
        for (std::size_t b = 0; b < cache.used; ++b) evaluate(batch, cache.blocks[b]);
        write_values(cache, values);
    }
    /// Writes the values of the batch that eval left in `cache`.
    void write_values(const Cache& cache, SampleValues<R>& values) const {
        for (std::size_t b = 0; b < cache.used; ++b) {
            const Block& block = cache.blocks[b];
            const R *s = block.density.outputs(), *c = block.color.outputs();
            for (int i = 0; i < block.count; ++i) {
                const auto n = static_cast<std::size_t>(i);
                values.sigma_t[block.group[n]][block.lane[n]] =
                    static_cast<R>(options.density_scale) *
                    activate(options.density_activation, s[i]);
                for (int k = 0; k < 3; ++k)
                    values.rgb[k][block.group[n]][block.lane[n]] =
                        activate(options.color_activation, c[k * perceptron_block + i]);
            }
        }
    }

    /// Extinction (1/m) at points (count, 3) of the unit cube, whether marked empty or not.
    void densities(const R* unit, std::int64_t count, R* sigma_t) const {
        const std::int64_t blocks = (count + perceptron_block - 1) / perceptron_block;
        parallel_for(blocks, [&](std::int64_t b) {
            typename Network<R>::Values values;
            density.resize(values);
            const std::int64_t first = b * perceptron_block,
                               n = std::min<std::int64_t>(count - first, perceptron_block);
            encode(unit + 3 * first, static_cast<int>(n), values.inputs());
            density.forward(values, static_cast<int>(n));
            for (std::int64_t i = 0; i < n; ++i)
                sigma_t[first + i] = static_cast<R>(options.density_scale) *
                                     activate(options.density_activation, values.outputs()[i]);
        });
    }

    /// What the rays of a slab ask of the parameters.
    struct Sink {
        Sink(const NeuralField& of, R* d_table, R* d_density, R* d_color)
            : field(&of), table(d_table), density(d_density), color(d_color) {}

        struct Chunk {
            typename Network<R>::Gradient density, color;
            std::vector<double> d_density, d_color;
            std::vector<int> counts;           // of the blocks that a hash encoding records
            std::vector<R> points, d_encoded;  // (blocks, 128, 3), (blocks, encoded, 128)
        };
        const NeuralField* field;
        R *table, *density, *color;
        std::vector<Chunk> chunks;

        void begin(int count) {
            chunks.resize(static_cast<std::size_t>(count));
            for (Chunk& chunk : chunks) {
                field->density.resize(chunk.density);
                field->color.resize(chunk.color);
                chunk.d_density.assign(field->density.shape().parameters(), 0.0);
                chunk.d_color.assign(field->color.shape().parameters(), 0.0);
                chunk.counts.clear();
                chunk.points.clear();
                chunk.d_encoded.clear();
            }
        }
        void finish() {
            for (std::size_t p = 0; p < field->density.shape().parameters(); ++p)
                density[p] += total(&Chunk::d_density, p);
            for (std::size_t p = 0; p < field->color.shape().parameters(); ++p)
                color[p] += total(&Chunk::d_color, p);
            if (!field->hash) return;
            const std::vector<HashPart> parts = hash_parts(field->hash->levels());
            parallel_for(static_cast<std::int64_t>(parts.size()), [&](std::int64_t p) {
                for (const Chunk& chunk : chunks)
                    scatter(chunk, parts[static_cast<std::size_t>(p)]);
            });
        }

    private:
        void scatter(const Chunk& chunk, const HashPart& part) const {
            const std::size_t width = static_cast<std::size_t>(field->encoded());
            const R* points = chunk.points.data();
            const R* d_encoded = chunk.d_encoded.data() + field->level_offset(part.level);
            for (const int count : chunk.counts) {
                field->hash->scatter(part.level, points, count, perceptron_block, d_encoded, table,
                                     part.first, part.last);
                points += 3 * perceptron_block;
                d_encoded += width * perceptron_block;
            }
        }
        [[nodiscard]] R total(std::vector<double> Chunk::* of, std::size_t p) const {
            double sum = 0.0;
            for (const Chunk& chunk : chunks) sum += (chunk.*of)[p];
            return static_cast<R>(sum);
        }
    };

    void backward(const SampleBatch<R>& batch, const Cache& cache, const SampleValues<R>& d_values,
                  Sink& sink, int chunk, std::vector<Lanes<R>>* d_position,
                  std::vector<R>* d_direction) const {
        typename Sink::Chunk& own = sink.chunks[static_cast<std::size_t>(chunk)];
        std::vector<R> d_color(3 * perceptron_block),
            d_given(static_cast<std::size_t>(color.shape().inputs * perceptron_block)),
            d_density(static_cast<std::size_t>(density.shape().outputs() * perceptron_block)),
            d_encoded(static_cast<std::size_t>(encoded() * perceptron_block));
        for (std::size_t b = 0; b < cache.used; ++b) {
            const Block& block = cache.blocks[b];
            start_cotangents(block, d_values, d_color.data(), d_density.data());
            color.backward(block.color, block.count, d_color.data(), own.color, d_given.data());
            std::copy_n(d_given.begin(), features() * perceptron_block,
                        d_density.begin() + perceptron_block);
            if (d_direction) backward_direction(batch, block, d_given.data(), d_direction);
            density.backward(block.density, block.count, d_density.data(), own.density,
                             d_encoded.data());
            if (d_position) backward_position(block, d_encoded.data(), d_position);
            if (hash) record(block, d_encoded.data(), own);
        }
        density.flush(own.density, own.d_density);
        color.flush(own.color, own.d_color);
    }

private:
    /// Deals the samples that are not in empty cells out to blocks.
    void collect(const SampleBatch<R>& batch, Cache& cache) const {
        cache.used = 0;
        for (std::size_t g = 0; g < batch.groups(); ++g)
            for (int i = 0; i < batch.used[g]; ++i) {
                R unit[3];
                for (int a = 0; a < 3; ++a)
                    unit[a] = (batch.position[a][g][i] - static_cast<R>(options.box[0][a])) *
                              per_meter(a);
                if (!occupancy.occupied(unit)) continue;
                if (cache.used == 0 || cache.blocks[cache.used - 1].count == perceptron_block)
                    open(cache);
                Block& block = cache.blocks[cache.used - 1];
                const auto n = static_cast<std::size_t>(block.count++);
                block.group[n] = static_cast<std::uint32_t>(g);
                block.lane[n] = static_cast<std::uint8_t>(i);
                std::copy_n(unit, 3, block.unit.data() + 3 * n);
            }
    }
    void open(Cache& cache) const {
        if (cache.used == cache.blocks.size()) {
            cache.blocks.emplace_back();
            density.resize(cache.blocks.back().density);
            color.resize(cache.blocks.back().color);
        }
        cache.blocks[cache.used++].count = 0;
    }
    [[nodiscard]] R per_meter(int axis) const {
        return static_cast<R>(1.0 / (options.box[1][axis] - options.box[0][axis]));
    }

    void encode(const R* unit, int count, R* out) const {
        for (int f = 0; f < encoded(); ++f)
            std::fill(out + f * perceptron_block + count, out + (f + 1) * perceptron_block, R(0));
        if (hash)
            for (std::size_t l = 0; l < hash->levels().size(); ++l)
                hash->encode(l, table, unit, 0, count, perceptron_block, out + level_offset(l));
        else
            for (int i = 0; i < count; ++i) {
                const R p[3] = {centered(unit[3 * i]), centered(unit[3 * i + 1]),
                                centered(unit[3 * i + 2])};
                frequencies.encode(p, perceptron_block, out + i);
            }
    }
    /// Frequencies take the box as [-1, 1].
    static R centered(R unit) { return R(2) * unit - R(1); }

    void evaluate(const SampleBatch<R>& batch, Block& block) const {
        encode(block.unit.data(), block.count, block.density.inputs());
        density.forward(block.density, block.count);
        R* in = block.color.inputs();
        std::copy_n(block.density.outputs() + perceptron_block, features() * perceptron_block, in);
        R* basis = in + features() * perceptron_block;
        std::fill_n(basis, sh_numbers * perceptron_block, R(0));
        for (int i = 0; i < block.count; ++i) {
            R d[3], Y[sh_numbers];
            towards_camera(batch, block.group[static_cast<std::size_t>(i)], d);
            sh_basis<sh_degree>(d[0], d[1], d[2], Y);
            for (int k = 0; k < sh_numbers; ++k) basis[k * perceptron_block + i] = Y[k];
        }
        color.forward(block.color, block.count);
    }
    static void towards_camera(const SampleBatch<R>& batch, std::uint32_t group, R* d) {
        for (int a = 0; a < 3; ++a) d[a] = -batch.direction[a][group];
    }

    /// Derivatives with respect to what the networks give; zeros for the density's features.
    void start_cotangents(const Block& block, const SampleValues<R>& d_values, R* d_color,
                          R* d_density) const {
        std::fill_n(d_color, 3 * perceptron_block, R(0));
        std::fill_n(d_density, (features() + 1) * perceptron_block, R(0));
        const R *s = block.density.outputs(), *c = block.color.outputs();
        for (int i = 0; i < block.count; ++i) {
            const auto n = static_cast<std::size_t>(i);
            activate_backward(options.density_activation, s[i],
                              static_cast<R>(options.density_scale) *
                                  d_values.sigma_t[block.group[n]][block.lane[n]],
                              d_density[i]);
            for (int k = 0; k < 3; ++k)
                activate_backward(options.color_activation, c[k * perceptron_block + i],
                                  d_values.rgb[k][block.group[n]][block.lane[n]],
                                  d_color[k * perceptron_block + i]);
        }
    }
    void backward_direction(const SampleBatch<R>& batch, const Block& block, const R* d_given,
                            std::vector<R>* d_direction) const {
        const R* d_basis = d_given + features() * perceptron_block;
        for (int i = 0; i < block.count; ++i) {
            const std::uint32_t group = block.group[static_cast<std::size_t>(i)];
            R d[3], d_Y[sh_numbers], d_d[3] = {R(0), R(0), R(0)};
            towards_camera(batch, group, d);
            for (int k = 0; k < sh_numbers; ++k) d_Y[k] = d_basis[k * perceptron_block + i];
            sh_basis_backward<sh_degree>(d[0], d[1], d[2], d_Y, d_d);
            for (int a = 0; a < 3; ++a) d_direction[a][group] -= d_d[a];
        }
    }
    void backward_position(const Block& block, const R* d_encoded,
                           std::vector<Lanes<R>>* d_position) const {
        std::array<R, 3 * perceptron_block> d_unit{};
        if (hash)
            for (std::size_t l = 0; l < hash->levels().size(); ++l)
                hash->backward_points(l, table, block.unit.data(), 0, block.count, perceptron_block,
                                      d_encoded + level_offset(l), d_unit.data());
        for (int i = 0; i < block.count; ++i) {
            const auto n = static_cast<std::size_t>(i);
            R* d = d_unit.data() + 3 * n;
            if (!hash) {
                const R* u = block.unit.data() + 3 * n;
                const R p[3] = {centered(u[0]), centered(u[1]), centered(u[2])};
                R d_p[3] = {R(0), R(0), R(0)};
                frequencies.backward(p, perceptron_block, d_encoded + i, d_p);
                for (int a = 0; a < 3; ++a) d[a] = R(2) * d_p[a];
            }
            for (int a = 0; a < 3; ++a)
                d_position[a][block.group[n]][block.lane[n]] += per_meter(a) * d[a];
        }
    }
    void record(const Block& block, const R* d_encoded, typename Sink::Chunk& own) const {
        own.counts.push_back(block.count);
        own.points.insert(own.points.end(), block.unit.begin(), block.unit.end());
        own.d_encoded.insert(own.d_encoded.end(), d_encoded,
                             d_encoded + encoded() * perceptron_block);
    }
    /// Where the features of a level begin in a block.
    [[nodiscard]] std::size_t level_offset(std::size_t level) const {
        return level * static_cast<std::size_t>(hash->features() * perceptron_block);
    }
};

}  // namespace photograd
