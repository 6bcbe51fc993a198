// Product of two matrices of float: what the kernel gets. Plain data only, because every
// instruction set's translation unit includes it. network/product.h says what is calculated.
#pragma once

#include <cstdint>

namespace photograd {

struct MultiplyArgs {
    int rows, columns, depth;  // columns is a multiple of 32
    const float* a;            // a[m * a_row + k * a_depth]
    std::int64_t a_row, a_depth;
    const float* b;  // b[k * b_row + n]
    std::int64_t b_row;
    float* c;  // c[m * c_row + n], added to
    std::int64_t c_row;
};

}  // namespace photograd
