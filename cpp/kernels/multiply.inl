// Product of two matrices, a tile of rows x columns at a time, whose sums stay in registers.
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

template <int Rows, int Registers>
static inline void multiply_tile(const MultiplyArgs& m, int row, int column) {
    const float* a = m.a + row * m.a_row;
    const float* b = m.b + column;
    float* c = m.c + row * m.c_row + column;
    Register sum[Rows][Registers];
#pragma GCC unroll 16
    for (int i = 0; i < Rows; ++i)
#pragma GCC unroll 4
        for (int j = 0; j < Registers; ++j) sum[i][j] = load(c + i * m.c_row + j * register_lanes);
    for (int k = 0; k < m.depth; ++k) {
        Register right[Registers];
#pragma GCC unroll 4
        for (int j = 0; j < Registers; ++j) right[j] = load(b + k * m.b_row + j * register_lanes);
#pragma GCC unroll 16
        for (int i = 0; i < Rows; ++i) {
            const float left = a[i * m.a_row + k * m.a_depth];
#pragma GCC unroll 4
            for (int j = 0; j < Registers; ++j)
                sum[i][j] = fused_multiply_add(left, right[j], sum[i][j]);
        }
    }
#pragma GCC unroll 16
    for (int i = 0; i < Rows; ++i)
#pragma GCC unroll 4
        for (int j = 0; j < Registers; ++j) store(sum[i][j], c + i * m.c_row + j * register_lanes);
}

// All rows of a strip of columns; what is left over in tiles of half the rows.
template <int Rows>
static inline void multiply_strip(const MultiplyArgs& m, int row, int column) {
    for (; row + Rows <= m.rows; row += Rows)
        multiply_tile<Rows, multiply_registers>(m, row, column);
    if constexpr (Rows > 1) multiply_strip<Rows / 2>(m, row, column);
}

static void multiply(const MultiplyArgs& m) {
    constexpr int strip = multiply_registers * register_lanes;
    for (int column = 0; column < m.columns; column += strip)
        multiply_strip<multiply_rows>(m, 0, column);
}

}  // namespace photograd::PHOTOGRAD_ISA
