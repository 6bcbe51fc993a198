// Rays through an octree whose leaves hold one density and one set of spherical-harmonic
// coefficients each [Yu2021], and the adjoint. Everything is constant in a leaf, so that emission
// and absorption along a ray need no quadrature:
//
//   s_k     = sigma_k (t1_k - t0_k)                    leaf k between t0_k and t1_k
//   w_k     = exp(-s_0 - ... - s_{k-1}) (1 - exp(-s_k))
//   color   = sum_k w_k rgb_k,  depth = sum_k w_k (t0_k + t1_k) / 2,  T = exp(-sum_k s_k)
//
//   v_k     = <d_color, rgb_k> + d_depth (t0_k + t1_k) / 2
//   d_s_k   = exp(-s_0 - ... - s_k) v_k - sum_{j>k} w_j v_j - d_T T
//   d_sigma = (t1 - t0) d_s
//   d_t1    = sigma d_s + w d_depth / 2,   d_t0 = -sigma d_s + w d_depth / 2
//
// As in ops/composite.h, the sum over later leaves is what the whole ray has left. A ray leaves a
// box through the plane x_a = c at t = (c - o_a) / d_a, so dt/do_a = -1 / d_a, dt/dd_a = -t / d_a:
// the camera adjoint is exact. A ray that begins inside of its first leaf enters it at t = 0.
#pragma once

#include <algorithm>
#include <atomic>
#include <limits>
#include <vector>

#include "photograd/core/real.h"
#include "photograd/core/scatter.h"
#include "photograd/grid/octree.h"
#include "photograd/ops/activation.h"
#include "photograd/ops/sh.h"
#include "photograd/render/march/chunks.h"

namespace photograd {

/// sigma_t = density_scale softplus(density), rgb = sigmoid(sum_k Y_k(direction) sh_k).
template <Real R>
struct OctreeSh {
    const SpatialTree<3>* tree;
    const std::int32_t* row;  // (L,) of each leaf; -1 for empty ones
    const R* density;         // (N,) raw
    const R* sh;              // (N, K, 3)
    std::int64_t rows;        // N
    int degree;
    R density_scale;  // 1/m
};

/// Rays of unit direction, in meters, and the same in cells: t is in meters in both.
template <Real R>
struct TreeRays {
    std::int64_t count;
    const R *origins, *directions;  // (R, 3) in cells
    const R* unit;                  // (R, 3) directions in the world
    double cell[3];                 // sides of a cell in meters
};

namespace octree_sh {

inline constexpr std::int64_t slab_rays = 1 << 15;
inline constexpr int most_coefficients = sh_count(sh_max_degree);

template <Real R>
struct Segment {
    std::int32_t leaf, row;
    R t0, t1, sigma_t;
    R weight, behind;  // transmittance behind it
    [[nodiscard]] R middle() const { return (t0 + t1) / R(2); }
};

/// visit(segment) front to back, until less than `stop` is left of the ray; returns what is left.
template <Real R, class Visit>
R walk(const OctreeSh<R>& field, const R* origin, const R* direction, R stop, Visit&& visit) {
    R front = R(1);
    const auto meet = [&](std::int32_t leaf, R t0, R t1) {
        const std::int32_t row = field.row[leaf];
        if (row < 0) return true;
        const R sigma_t = field.density_scale * softplus(field.density[row]);
        const R alpha = -expm1(-sigma_t * (t1 - t0)), weight = front * alpha;
        front *= R(1) - alpha;
        visit(Segment<R>{leaf, row, t0, t1, sigma_t, weight, front});
        return front > stop;
    };
    field.tree->traverse(origin, direction, R(0), std::numeric_limits<R>::infinity(), meet);
    return front;
}

template <int Degree, Real R>
void color_of(const OctreeSh<R>& field, std::int32_t row, const R* Y, R* rgb) {
    constexpr int count = sh_count(Degree);
    const R* c = field.sh + std::int64_t(row) * count * 3;
    // Four lanes, which a compiler makes a vector of; the fourth is dropped. It is the next
    // coefficient's first channel, which the last coefficient does not have.
    R raw[4] = {R(0), R(0), R(0), R(0)};
    for (int k = 0; k + 1 < count; ++k)
        for (int a = 0; a < 4; ++a) raw[a] += Y[k] * c[3 * k + a];
    for (int a = 0; a < 3; ++a) raw[a] += Y[count - 1] * c[3 * (count - 1) + a];
    for (int a = 0; a < 4; ++a) raw[a] = sigmoid(raw[a]);
    std::copy_n(raw, 3, rgb);
}

/// Colors of segments, which wait until their coefficients have come into the cache.
template <int Degree, Real R>
class DelayedColors {
public:
    DelayedColors(const OctreeSh<R>& field, const R* Y) : field_(field), Y_(Y) {}

    void add(std::int32_t row, R weight) {
        if (count_ == room) add_up();
        constexpr int floats = 3 * sh_count(Degree), line = 64 / sizeof(R);
        const R* c = field_.sh + std::int64_t(row) * floats;
        for (int at = 0; at < floats; at += line) __builtin_prefetch(c + at);
        __builtin_prefetch(c + floats - 1);
        rows_[count_] = row;
        weights_[count_++] = weight;
    }
    /// Writes the sum of weight times color, front to back.
    void finish(R* color) {
        add_up();
        std::copy_n(sum_, 3, color);
    }

private:
    static constexpr int room = 32;

    void add_up() {
        for (int i = 0; i < count_; ++i) {
            R rgb[3];
            color_of<Degree>(field_, rows_[i], Y_, rgb);
            for (int a = 0; a < 3; ++a) sum_[a] += weights_[i] * rgb[a];
        }
        count_ = 0;
    }

    const OctreeSh<R>& field_;
    const R* Y_;
    std::int32_t rows_[room];
    R weights_[room], sum_[3] = {R(0), R(0), R(0)};
    int count_ = 0;
};

template <class Visit>
void with_degree(int degree, Visit&& visit) {
    if (degree == sh_max_degree)
        visit.template operator()<sh_max_degree>();
    else
        with_sh_degree(degree, visit);
}

/// What a segment of a ray adds to its row.
template <Real R>
struct Record {
    std::uint32_t row, ray;  // of the slab
    R d_density, d_raw[3];
};

/// Adds up records, those of a row in the order of the rays, in double precision.
template <int Degree, Real R>
void add_up(const OctreeSh<R>& field, const std::vector<Record<R>>& records,
            const std::vector<R>& basis, R* d_density, R* d_sh) {
    constexpr int count = sh_count(Degree);
    std::vector<std::uint32_t> owner(records.size());
    for (std::size_t i = 0; i < records.size(); ++i) owner[i] = records[i].row;
    OwnerBins bins;
    bin_by_owner(owner, static_cast<int>(field.rows), bins);
    constexpr std::int64_t at_once = 1024;
    parallel_for((field.rows + at_once - 1) / at_once, [&](std::int64_t part) {
        const std::int64_t end = std::min(field.rows, (part + 1) * at_once);
        for (std::int64_t row = part * at_once; row < end; ++row) {
            const std::uint32_t first = bins.begin[static_cast<std::size_t>(row)],
                                last = bins.begin[static_cast<std::size_t>(row) + 1];
            if (first == last) continue;
            double density = 0.0, sums[3 * count] = {};
            for (std::uint32_t i = first; i < last; ++i) {
                const Record<R>& r = records[bins.order[i]];
                const R* Y = basis.data() + std::size_t(r.ray) * count;
                density += double(r.d_density);
                for (int k = 0; k < count; ++k)
                    for (int a = 0; a < 3; ++a)
                        sums[3 * k + a] += double(Y[k]) * double(r.d_raw[a]);
            }
            d_density[row] += static_cast<R>(density);
            for (int n = 0; n < 3 * count; ++n)
                d_sh[row * 3 * count + n] += static_cast<R>(sums[n]);
        }
    });
}

/// How the borders of a ray's segments move with it.
template <Real R>
struct BorderMotion {
    const TreeRays<R>& rays;
    std::vector<LeafBox<3>> boxes;

    BorderMotion(const TreeRays<R>& of, const SpatialTree<3>& tree) : rays(of) {
        boxes.resize(static_cast<std::size_t>(tree.leaf_count()));
        tree.for_each_leaf([&](std::int32_t leaf, const LeafBox<3>& box) {
            boxes[static_cast<std::size_t>(leaf)] = box;
        });
    }
    void add(std::int64_t ray, const Segment<R>& segment, R d_t0, R d_t1, double* d_o,
             double* d_d) const {
        const R *o = rays.origins + 3 * ray, *d = rays.directions + 3 * ray;
        const LeafBox<3>& box = boxes[static_cast<std::size_t>(segment.leaf)];
        R enter = -std::numeric_limits<R>::infinity(), leave = -enter;
        int in = 0, out = 0;
        for (int a = 0; a < 3; ++a) {
            if (d[a] == R(0)) continue;
            const R low = (R(box.lower[a]) - o[a]) / d[a],
                    high = (R(box.lower[a] + box.side) - o[a]) / d[a];
            if (std::min(low, high) > enter) enter = std::min(low, high), in = a;
            if (std::max(low, high) < leave) leave = std::max(low, high), out = a;
        }
        if (segment.t0 > R(0)) move(ray, in, enter, d_t0, d_o, d_d);
        move(ray, out, leave, d_t1, d_o, d_d);
    }

private:
    void move(std::int64_t ray, int axis, R t, R d_t, double* d_o, double* d_d) const {
        const double speed = double(rays.directions[3 * ray + axis]) * rays.cell[axis];
        const double d_plane = -double(d_t) / speed;
        d_o[axis] += d_plane;
        d_d[axis] += d_plane * double(t);
    }
};

template <Real R>
struct TreeAdjoint {
    MarchAdjoint<R> image;
    R *d_density, *d_sh;
};

/// The adjoint of one ray; its records go to `to`, and its basis to Y.
template <int Degree, Real R>
void backward_ray(const OctreeSh<R>& field, const TreeRays<R>& rays, R stop,
                  const MarchOutputs<R>& out, const MarchAdjoint<R>& d,
                  const BorderMotion<R>* borders, std::int64_t ray, std::uint32_t in_slab, R* Y,
                  std::vector<Record<R>>& to) {
    constexpr int count = sh_count(Degree);
    const R *way = rays.unit + 3 * ray, *d_color = d.d_color + 3 * ray;
    sh_basis<Degree>(way[0], way[1], way[2], Y);
    const R d_depth = d.d_depth[ray], end = -(d.d_transmittance[ray] * out.transmittance[ray]);
    R left = d_depth * out.depth[ray], d_Y[count] = {};
    for (int a = 0; a < 3; ++a) left += d_color[a] * out.color[3 * ray + a];
    double d_o[3] = {}, d_d[3] = {};
    walk(field, rays.origins + 3 * ray, rays.directions + 3 * ray, stop, [&](const Segment<R>& p) {
        R rgb[3];
        color_of<Degree>(field, p.row, Y, rgb);
        R v = d_depth * p.middle();
        for (int a = 0; a < 3; ++a) v += d_color[a] * rgb[a];
        left -= p.weight * v;
        const R d_s = p.behind * v - left + end;
        Record<R> record{static_cast<std::uint32_t>(p.row), in_slab, R(0), {}};
        softplus_backward(field.density[p.row], field.density_scale * d_s * (p.t1 - p.t0),
                          record.d_density);
        for (int a = 0; a < 3; ++a)
            record.d_raw[a] = p.weight * d_color[a] * rgb[a] * (R(1) - rgb[a]);
        to.push_back(record);
        if (!borders) return;
        const R share = R(0.5) * p.weight * d_depth;
        borders->add(ray, p, share - p.sigma_t * d_s, share + p.sigma_t * d_s, d_o, d_d);
        const R* c = field.sh + std::int64_t(p.row) * count * 3;
        for (int k = 0; k < count; ++k)
            for (int a = 0; a < 3; ++a) d_Y[k] += c[3 * k + a] * record.d_raw[a];
    });
    if (!borders) return;
    R through_color[3] = {R(0), R(0), R(0)};
    sh_basis_backward<Degree>(way[0], way[1], way[2], d_Y, through_color);
    for (int a = 0; a < 3; ++a) {
        d.d_origins[3 * ray + a] += static_cast<R>(d_o[a]);
        d.d_directions[3 * ray + a] += static_cast<R>(d_d[a] + double(through_color[a]));
    }
}

}  // namespace octree_sh

template <Real R>
void march_octree_sh(const OctreeSh<R>& field, const TreeRays<R>& rays, R stop,
                     const MarchOutputs<R>& out) {
    octree_sh::with_degree(field.degree, [&]<int Degree>() {
        for_chunks(0, rays.count, [&](std::int64_t, std::int64_t begin, std::int64_t end) {
            for (std::int64_t ray = begin; ray < end; ++ray) {
                const R* d = rays.unit + 3 * ray;
                R Y[sh_count(Degree)], depth = R(0);
                sh_basis<Degree>(d[0], d[1], d[2], Y);
                octree_sh::DelayedColors<Degree, R> colors(field, Y);
                out.transmittance[ray] =
                    octree_sh::walk(field, rays.origins + 3 * ray, rays.directions + 3 * ray, stop,
                                    [&](const octree_sh::Segment<R>& p) {
                                        colors.add(p.row, p.weight);
                                        depth += p.weight * p.middle();
                                    });
                colors.finish(out.color + 3 * ray);
                out.depth[ray] = depth;
            }
        });
    });
}

/// Adds to the gradients of the parameters and, where `adjoint` has room, of the rays.
template <Real R>
void march_octree_sh_backward(const OctreeSh<R>& field, const TreeRays<R>& rays, R stop,
                              const MarchOutputs<R>& out,
                              const octree_sh::TreeAdjoint<R>& adjoint) {
    using Records = std::vector<octree_sh::Record<R>>;
    std::vector<octree_sh::BorderMotion<R>> borders;
    if (adjoint.image.d_origins) borders.emplace_back(rays, *field.tree);
    octree_sh::with_degree(field.degree, [&]<int Degree>() {
        constexpr int count = sh_count(Degree);
        for (std::int64_t first = 0; first < rays.count; first += octree_sh::slab_rays) {
            const std::int64_t last = std::min(rays.count, first + octree_sh::slab_rays);
            std::vector<Records> of_chunk(static_cast<std::size_t>(chunk_count(last - first)));
            std::vector<R> basis(static_cast<std::size_t>((last - first) * count));
            for_chunks(first, last, [&](std::int64_t chunk, std::int64_t begin, std::int64_t end) {
                for (std::int64_t ray = begin; ray < end; ++ray)
                    octree_sh::backward_ray<Degree>(field, rays, stop, out, adjoint.image,
                                                    borders.empty() ? nullptr : borders.data(), ray,
                                                    static_cast<std::uint32_t>(ray - first),
                                                    basis.data() + (ray - first) * count,
                                                    of_chunk[static_cast<std::size_t>(chunk)]);
            });
            Records records;
            for (const Records& own : of_chunk)
                records.insert(records.end(), own.begin(), own.end());
            octree_sh::add_up<Degree>(field, records, basis, adjoint.d_density, adjoint.d_sh);
        }
    });
}

/// Raises max_weight (N,) to the largest weight that each row has in one of these rays.
template <Real R>
void octree_sh_weights(const OctreeSh<R>& field, const TreeRays<R>& rays, R stop, R* max_weight) {
    for_chunks(0, rays.count, [&](std::int64_t, std::int64_t begin, std::int64_t end) {
        for (std::int64_t ray = begin; ray < end; ++ray)
            octree_sh::walk(
                field, rays.origins + 3 * ray, rays.directions + 3 * ray, stop,
                [&](const octree_sh::Segment<R>& p) {
                    std::atomic_ref<R> most(max_weight[p.row]);
                    R before = most.load(std::memory_order_relaxed);
                    while (before < p.weight && !most.compare_exchange_weak(before, p.weight)) {
                    }
                });
    });
}

}  // namespace photograd
