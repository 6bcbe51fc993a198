// Product of two matrices, a tile of rows x columns at a time, whose sums stay in registers.
//
// A strip of columns of the right matrix is copied together first: rows that are a power of two
// apart would share few sets of the first-level cache. A left matrix that is used often, such as
// weights, is packed tile by tile, so that the loop reads both one number behind the other.
//
// Each sum runs over k in rising order with fused multiply-adds, whatever the tile's size, so all
// instruction sets give the same bits.
#pragma once

#include "kernels/multiply.h"
#include "photograd/core/fused.h"

namespace photograd::PHOTOGRAD_ISA {

// Sums of a tile, with one register for a row of the right matrix, fill the registers: 32 of
// AVX-512, 16 of the others.
inline constexpr int multiply_rows = register_lanes == 16 ? 8 : register_lanes == 8 ? 6 : 2;
inline constexpr int multiply_registers = 2;
inline constexpr int multiply_strip = multiply_registers * register_lanes;
// Rows of the right matrix whose strip takes half of the first-level cache.
inline constexpr int multiply_depth = 4096 / multiply_strip;
// With fewer rows on the left a strip is not worth copying.
inline constexpr int multiply_few = 2 * multiply_rows;

// Writes a[m * a_row + k * a_depth] tile by tile, of a tile the numbers of one k side by side.
static void pack_rows(const float* a, std::int64_t a_row, std::int64_t a_depth, int rows, int depth,
                      float* to) {
    for (int row = 0; row < rows; row += multiply_rows) {
        const int n = smaller(multiply_rows, rows - row);
        for (int k = 0; k < depth; ++k)
            for (int i = 0; i < n; ++i) *to++ = a[(row + i) * a_row + k * a_depth];
    }
}

// Adds the product of `Rows` rows and a strip of columns to c, for `depth` numbers k.
template <int Rows, bool Packed>
static inline void multiply_tile(const float* a, std::int64_t a_row, int depth, const float* b,
                                 std::int64_t b_row, float* c, std::int64_t c_row) {
    Register sum[Rows][multiply_registers];
#pragma GCC unroll 16
    for (int i = 0; i < Rows; ++i)
#pragma GCC unroll 4
        for (int j = 0; j < multiply_registers; ++j)
            sum[i][j] = load(c + i * c_row + j * register_lanes);
    for (int k = 0; k < depth; ++k) {
        Register right[multiply_registers];
#pragma GCC unroll 4
        for (int j = 0; j < multiply_registers; ++j) right[j] = load(b + j * register_lanes);
#pragma GCC unroll 16
        for (int i = 0; i < Rows; ++i) {
            const float left = Packed ? a[i] : a[i * a_row];
#pragma GCC unroll 4
            for (int j = 0; j < multiply_registers; ++j)
                sum[i][j] = fused_multiply_add(left, right[j], sum[i][j]);
        }
        a += Packed ? Rows : 1;
        b += b_row;
    }
#pragma GCC unroll 16
    for (int i = 0; i < Rows; ++i)
#pragma GCC unroll 4
        for (int j = 0; j < multiply_registers; ++j)
            store(sum[i][j], c + i * c_row + j * register_lanes);
}

// The last rows, fewer than a tile has.
template <int Rows, bool Packed>
static inline void multiply_last(int rows, const float* a, std::int64_t a_row, int depth,
                                 const float* b, std::int64_t b_row, float* c, std::int64_t c_row) {
    if constexpr (Rows > 0) {
        if (rows == Rows) return multiply_tile<Rows, Packed>(a, a_row, depth, b, b_row, c, c_row);
        multiply_last<Rows - 1, Packed>(rows, a, a_row, depth, b, b_row, c, c_row);
    }
}

// All rows of a strip of columns, numbers [k, k + depth) of each sum.
template <bool Packed>
static inline void multiply_rows_of_strip(const MultiplyArgs& m, int k, int depth, const float* b,
                                          std::int64_t b_row, float* c) {
    int row = 0;
    const auto left = [&](int height) {
        return Packed ? m.a + std::int64_t{row} * m.depth + k * height : m.a + row * m.a_row + k;
    };
    for (; row + multiply_rows <= m.rows; row += multiply_rows)
        multiply_tile<multiply_rows, Packed>(left(multiply_rows), m.a_row, depth, b, b_row,
                                             c + row * m.c_row, m.c_row);
    const int rest = m.rows - row;
    multiply_last<multiply_rows - 1, Packed>(rest, left(rest), m.a_row, depth, b, b_row,
                                             c + row * m.c_row, m.c_row);
}

static void multiply(const MultiplyArgs& m) {
    alignas(64) float strip[multiply_depth * multiply_strip];
    for (int column = 0; column < m.columns; column += multiply_strip)
        for (int k = 0; k < m.depth; k += multiply_depth) {
            const int depth = smaller(multiply_depth, m.depth - k);
            const float* b = m.b + k * m.b_row + column;
            std::int64_t b_row = m.b_row;
            if (m.rows >= multiply_few) {
                for (int i = 0; i < depth; ++i)
                    for (int j = 0; j < multiply_strip; j += register_lanes)
                        store(load(b + i * m.b_row + j), strip + i * multiply_strip + j);
                b = strip;
                b_row = multiply_strip;
            }
            if (m.a_row == 0)
                multiply_rows_of_strip<true>(m, k, depth, b, b_row, m.c + column);
            else
                multiply_rows_of_strip<false>(m, k, depth, b, b_row, m.c + column);
        }
}

}  // namespace photograd::PHOTOGRAD_ISA
