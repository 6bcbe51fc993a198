// The fused march through a sparse grid: forward, records of its adjoint, and their sums by brick.
#pragma once

#include "kernels/cell_block.inl"

namespace photograd::PHOTOGRAD_ISA {

template <int Degree>
static std::int64_t sparse_sh_forward(const MarchSparseShArgs& a, std::int64_t begin,
                                      std::int64_t end) {
    const Quadrature form = static_cast<Quadrature>(a.quadrature);
    RayTotals<float> totals[march_chunk];
    alignas(64) float basis[march_chunk][sh_basis_stride];
    for (std::int64_t ray = begin; ray < end; ++ray)
        sh_basis_by_channel<Degree>(a.rays.directions + 3 * ray, basis[ray - begin]);
    const std::int64_t looked_up = walk_cells(a, begin, end, [&](int i, CellBlock& b) {
        evaluate_cells<Degree>(a, basis[i], b);
        composite(form, b.sigma_t, b.rgb, b.t, a.dt, totals[i]);
        return totals[i].tau;
    });
    for (std::int64_t ray = begin; ray < end; ++ray) write_outputs(totals[ray - begin], ray, a.out);
    return looked_up;
}

// d[c][i]: adjoint of raw color and raw density, zero where nothing is visible.
static inline void differentiate_cells(const MarchSparseShArgs& a, const CellBlock& b,
                                       RayCotangents<float>& ray, Lanes<float>* d) {
    differentiate_block(a, b, ray, d);
    for (int c = 0; c < 4; ++c)
        for (int i = 0; i < lane_count; ++i) d[c][i] = b.visible[i] ? d[c][i] : 0.0f;
}

static inline void background_backward(const CellBlock& b, const Lanes<float>* d, const float* Y3,
                                       int count, double* d_background) {
    float total[4];
    for (int c = 0; c < 4; ++c) {
        Lanes<float> part;
        for (int i = 0; i < lane_count; ++i) part[i] = b.missing[i] * d[c][i];
        total[c] = sum(part);
    }
    d_background[0] += static_cast<double>(total[3]);
    for (int j = 0; j < count; ++j)
        d_background[1 + j] += static_cast<double>(Y3[j]) * static_cast<double>(total[j % 3]);
}

// Where the next record of each ray goes: rays advance together, but each has its room to itself.
struct RecordEnds {
    CellRecord<float>* next[march_chunk];
    CellRecord<float>* first[march_chunk];

    RecordEnds(const MarchSparseShArgs& a, CellRecord<float>* records, std::int64_t begin,
               std::int64_t end) {
        for (std::int64_t ray = begin; ray < end; ++ray) {
            first[ray - begin] = next[ray - begin] = records;
            records += larger(a.rays.samples[ray], 0);
        }
    }
    void count(std::int64_t rays, std::int32_t* found) const {
        for (std::int64_t i = 0; i < rays; ++i)
            found[i] = static_cast<std::int32_t>(next[i] - first[i]);
    }
};

template <int Degree>
static void sparse_sh_backward(const MarchSparseShArgs& a, const MarchSparseShBackward& back,
                               std::int64_t begin, std::int64_t end) {
    RayCotangents<float> cotangents[march_chunk];
    float* basis = back.basis + (begin - back.first_ray) * sh_basis_stride;
    for (std::int64_t ray = begin; ray < end; ++ray) {
        cotangents[ray - begin] = start_cotangents(a.out, back.adjoint, ray);
        sh_basis_by_channel<Degree>(a.rays.directions + 3 * ray,
                                    basis + (ray - begin) * sh_basis_stride);
    }
    RecordEnds ends(a, back.records, begin, end);
    walk_cells(a, begin, end, [&](int i, CellBlock& b) {
        const float* Y3 = basis + i * sh_basis_stride;
        evaluate_cells<Degree>(a, Y3, b);
        Lanes<float> d[4] = {};
        differentiate_cells(a, b, cotangents[i], d);
        bool lacks = false;
        for (int j = 0; j < lane_count; ++j) {
            lacks |= b.visible[j] && b.missing[j] > 0.0f;
            if (!b.visible[j]) continue;
            *ends.next[i]++ = {{b.q[0][j], b.q[1][j], b.q[2][j]},
                               static_cast<std::uint32_t>(begin - back.first_ray + i),
                               {d[0][j], d[1][j], d[2][j], d[3][j]}};
        }
        if (lacks) background_backward(b, d, Y3, 3 * sh_count(Degree), back.d_background);
        return cotangents[i].tau;
    });
    ends.count(end - begin, back.found);
}

// Weight of every sample, as d[0] of a record: what pruning asks for. Colors are not needed.
static void march_sparse_sh_weights(const MarchSparseShArgs& a, const MarchSparseShBackward& back,
                                    std::int64_t begin, std::int64_t end) {
    const Quadrature form = static_cast<Quadrature>(a.quadrature);
    float tau[march_chunk] = {};
    RecordEnds ends(a, back.records, begin, end);
    walk_cells(a, begin, end, [&](int i, CellBlock& b) {
        activate_lanes(static_cast<Activation>(a.density_activation), b.raw[3], b.sigma_t);
        for (int j = 0; j < lane_count; ++j)
            b.sigma_t[j] = b.visible[j] ? a.density_scale * b.sigma_t[j] : 0.0f;
        const SampleWeights<float> found = composite_weights(form, tau[i], b.sigma_t, a.dt);
        for (int j = 0; j < lane_count; ++j)
            if (b.visible[j])
                *ends.next[i]++ = {
                    {b.q[0][j], b.q[1][j], b.q[2][j]}, 0, {found.w[j], 0.0f, 0.0f, 0.0f}};
        tau[i] = found.tau_end;
        return tau[i];
    });
    ends.count(end - begin, back.found);
}

static std::int64_t march_sparse_sh_forward(const MarchSparseShArgs& a, std::int64_t begin,
                                            std::int64_t end) {
    std::int64_t result = 0;
    with_sh_degree(a.degree, [&]<int D>() { result = sparse_sh_forward<D>(a, begin, end); });
    return result;
}

static void march_sparse_sh_backward(const MarchSparseShArgs& a, const MarchSparseShBackward& back,
                                     std::int64_t begin, std::int64_t end) {
    with_sh_degree(a.degree, [&]<int D>() { sparse_sh_backward<D>(a, back, begin, end); });
}

}  // namespace photograd::PHOTOGRAD_ISA
