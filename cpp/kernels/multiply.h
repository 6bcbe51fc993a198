// Product of two matrices of float: what the kernel gets. Plain data only, because every
// instruction set's translation unit includes it. The product of a and b is added to c.
#pragma once

#include <cstdint>

namespace photograd {

struct MultiplyArgs {
    int rows, columns, depth;  // columns is a multiple of 32
    const float* a;            // packed by pack_rows where a_row is 0, else a[m * a_row + k]
    std::int64_t a_row;
    const float* b;  // b[k * b_row + n]
    std::int64_t b_row;
    float* c;  // c[m * c_row + n], added to
    std::int64_t c_row;
};

}  // namespace photograd
