// Values of the principled surface and their derivatives, sixteen pairs of directions at a time,
// one pair a lane.
//
// Directions lie in memory as x y z x y z ...: triples are dealt out to lanes, and values dealt
// back. Where there are many rows of parameters, sixteen rows are loaded once for all evaluations
// that take them, and their derivatives are written once: no two evaluations that run at the same
// time share a row, so nothing is sorted or locked, and the order of every sum is fixed.
#pragma once

#include "kernels/principled.h"
#include "photograd/core/lanes.h"
#include "photograd/ops/principled.h"

namespace photograd::PHOTOGRAD_ISA {

static_assert(lane_count % 4 == 0);
using PrincipledVector = float __attribute__((vector_size(16), aligned(4), may_alias));

// out[c][k] = in[3 k + c], four triples x y z x | y z x y | z x y z at a time.
static inline void deal_out(const float* in, Lanes<float>* out) {
    for (int k = 0; k < lane_count; k += 4) {
        const auto* v = reinterpret_cast<const PrincipledVector*>(in + 3 * k);
        const auto to = [&](int c) { return reinterpret_cast<PrincipledVector*>(&out[c][k]); };
        const PrincipledVector a = v[0], b = v[1], c = v[2];
        const PrincipledVector x_end = __builtin_shufflevector(b, c, 2, 2, 5, 5);
        const PrincipledVector y_start = __builtin_shufflevector(a, b, 1, 1, 4, 4);
        const PrincipledVector y_end = __builtin_shufflevector(b, c, 3, 3, 6, 6);
        const PrincipledVector z_start = __builtin_shufflevector(a, b, 2, 2, 5, 5);
        *to(0) = __builtin_shufflevector(a, x_end, 0, 3, 4, 6);
        *to(1) = __builtin_shufflevector(y_start, y_end, 0, 2, 4, 6);
        *to(2) = __builtin_shufflevector(z_start, c, 0, 2, 4, 7);
    }
}

// out[3 k + c] = in[c][k].
static inline void deal_back(const Lanes<float>* in, float* out) {
    for (int k = 0; k < lane_count; k += 4) {
        auto* v = reinterpret_cast<PrincipledVector*>(out + 3 * k);
        const auto from = [&](int c) -> const PrincipledVector& {
            return *reinterpret_cast<const PrincipledVector*>(&in[c][k]);
        };
        const PrincipledVector x = from(0), y = from(1), z = from(2);
        const PrincipledVector xy0 = __builtin_shufflevector(x, y, 0, 0, 4, 4);
        const PrincipledVector zx01 = __builtin_shufflevector(z, x, 0, 0, 5, 5);
        const PrincipledVector yz1 = __builtin_shufflevector(y, z, 1, 1, 5, 5);
        const PrincipledVector xy2 = __builtin_shufflevector(x, y, 2, 2, 6, 6);
        const PrincipledVector zx23 = __builtin_shufflevector(z, x, 2, 2, 7, 7);
        const PrincipledVector yz3 = __builtin_shufflevector(y, z, 3, 3, 7, 7);
        v[0] = __builtin_shufflevector(xy0, zx01, 0, 2, 4, 6);
        v[1] = __builtin_shufflevector(yz1, xy2, 0, 2, 4, 6);
        v[2] = __builtin_shufflevector(zx23, yz3, 0, 2, 4, 6);
    }
}

// The triples of n <= 16 rows; lanes beyond are zero.
static inline void load_triples(const float* from, int n, Lanes<float>* out) {
    if (n == lane_count) return deal_out(from, out);
    float padded[3 * lane_count] = {};
    for (int j = 0; j < 3 * n; ++j) padded[j] = from[j];
    deal_out(padded, out);
}
static inline void store_triples(const Lanes<float>* in, int n, float* to) {
    if (n == lane_count) return deal_back(in, to);
    float padded[3 * lane_count];
    deal_back(in, padded);
    for (int j = 0; j < 3 * n; ++j) to[j] = padded[j];
}

// Parameters of sixteen lanes.
struct PrincipledLanes {
    Lanes<float> base[3], metalness, roughness;
};

// n rows from `row` on; lanes beyond repeat the last. With one row in all, all lanes have it.
static inline void load_rows(const PrincipledArgs& a, std::int64_t row, int n, PrincipledLanes& p) {
    for (int i = 0; i < lane_count; ++i) {
        const float* from =
            a.parameters + principled_parameters * (a.rows == 1 ? 0 : row + smaller(i, n - 1));
        for (int c = 0; c < 3; ++c) p.base[c][i] = from[c];
        p.metalness[i] = from[3];
        p.roughness[i] = from[4];
    }
}

// Pairs of directions; one that is not above the surface is replaced by straight up, and its
// `above` is 0.
struct PrincipledPairs {
    Lanes<float> o[3], i[3], above, cosine;
};
static inline void load_pairs(const PrincipledArgs& a, std::int64_t first, int n,
                              PrincipledPairs& w) {
    load_triples(a.wo + 3 * first, n, w.o);
    load_triples(a.wi + 3 * first, n, w.i);
    for (int k = 0; k < lane_count; ++k) {
        const bool above = w.o[2][k] > 0.0f && w.i[2][k] > 0.0f;
        w.above[k] = above ? 1.0f : 0.0f;
        w.cosine[k] = a.cosine ? w.i[2][k] : 1.0f;
        for (int c = 0; c < 3; ++c) {
            w.o[c][k] = above ? w.o[c][k] : float(c == 2);
            w.i[c][k] = above ? w.i[c][k] : float(c == 2);
        }
    }
}
static inline PrincipledAngles<float> angles_of(const PrincipledPairs& w, int k) {
    return PrincipledAngles<float>::of(w.o[0][k], w.o[1][k], w.o[2][k], w.i[0][k], w.i[1][k],
                                       w.i[2][k]);
}

static inline void principled_block(const PrincipledArgs& a, const PrincipledLanes& p,
                                    std::int64_t first, int n, float* values) {
    PrincipledPairs w;
    load_pairs(a, first, n, w);
    Lanes<float> f[3];
    for (int k = 0; k < lane_count; ++k) {
        const PrincipledTerms<float> t =
            principled(angles_of(w, k), p.metalness[k], p.roughness[k]);
        const bool above = w.above[k] > 0.0f;
        for (int c = 0; c < 3; ++c) {
            const float value = p.base[c][k] * t.P + t.Q;
            f[c][k] = above ? value * w.cosine[k] : 0.0f;
        }
    }
    store_triples(f, n, values + 3 * first);
}

static inline void principled_block_backward(const PrincipledArgs& a, const PrincipledLanes& p,
                                             const float* d_values, std::int64_t first, int n,
                                             PrincipledLanes& d_p) {
    PrincipledPairs w;
    load_pairs(a, first, n, w);
    Lanes<float> d[3];
    load_triples(d_values + 3 * first, n, d);
    for (int k = 0; k < lane_count; ++k) {
        const bool above = w.above[k] > 0.0f;
        const float scale = above ? w.cosine[k] : 0.0f;
        const float r = d[0][k] * scale, g = d[1][k] * scale, b = d[2][k] * scale;
        const PrincipledAngles<float> angles = angles_of(w, k);
        const float P = principled(angles, p.metalness[k], p.roughness[k]).P;
        d_p.base[0][k] = d_p.base[0][k] + r * P;
        d_p.base[1][k] = d_p.base[1][k] + g * P;
        d_p.base[2][k] = d_p.base[2][k] + b * P;
        const float d_P = r * p.base[0][k] + g * p.base[1][k] + b * p.base[2][k];
        principled_backward(angles, p.metalness[k], p.roughness[k], d_P, r + g + b,
                            d_p.metalness[k], d_p.roughness[k]);
    }
}

// Calls visit(parameters, first evaluation, number of them) for the rows [begin, end), or, with one
// row in all, the evaluations [begin, end); done(row, number of rows) when sixteen rows have had
// all of theirs.
template <class Visit, class Done>
static inline void for_principled_blocks(const PrincipledArgs& a, std::int64_t begin,
                                         std::int64_t end, PrincipledLanes& p, Visit&& visit,
                                         Done&& done) {
    if (a.rows == 1) load_rows(a, 0, 1, p);
    for (std::int64_t row = begin; row < end; row += lane_count) {
        const int n = static_cast<int>(smaller<std::int64_t>(lane_count, end - row));
        if (a.rows == 1) {
            visit(row, n);
            continue;
        }
        load_rows(a, row, n, p);
        for (std::int64_t first = row; first < a.count; first += a.rows)
            visit(first, static_cast<int>(smaller<std::int64_t>(n, a.count - first)));
        done(row, n);
    }
}

static void principled_values(const PrincipledArgs& a, std::int64_t begin, std::int64_t end,
                              float* values) {
    PrincipledLanes p;
    for_principled_blocks(
        a, begin, end, p,
        [&](std::int64_t first, int n) { principled_block(a, p, first, n, values); },
        [](std::int64_t, int) {});
}

static void principled_values_backward(const PrincipledArgs& a, const float* d_values,
                                       std::int64_t begin, std::int64_t end, float* d_parameters) {
    PrincipledLanes p, d_p{};
    const auto put = [&](std::int64_t row, int n) {
        for (int i = 0; i < n; ++i) {
            float* to = d_parameters + principled_parameters * (row + i);
            for (int c = 0; c < 3; ++c) to[c] = to[c] + d_p.base[c][i];
            to[3] = to[3] + d_p.metalness[i];
            to[4] = to[4] + d_p.roughness[i];
        }
        d_p = {};
    };
    for_principled_blocks(
        a, begin, end, p,
        [&](std::int64_t first, int n) {
            principled_block_backward(a, p, d_values, first, n, d_p);
        },
        put);
    if (a.rows != 1) return;
    const Lanes<float>* sums[] = {&d_p.base[0], &d_p.base[1], &d_p.base[2], &d_p.metalness,
                                  &d_p.roughness};
    for (int j = 0; j < principled_parameters; ++j)
        d_parameters[j] = d_parameters[j] + sum(*sums[j]);
}

}  // namespace photograd::PHOTOGRAD_ISA
