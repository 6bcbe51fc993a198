// One level of a hash encoding at many points, float: what the kernels get. Plain data only,
// because every instruction set's translation unit includes it. network/hash_encoding.h has the
// formulas; both agree bit for bit.
//
// Features lie feature by feature: feature f of sample s at [f * stride + s].
#pragma once

#include <cstdint>

namespace photograd {

struct HashLevelArgs {
    int dimensions, features, resolution;
    bool smoothstep;
    std::uint32_t mask;  // rows - 1 of a hashed level, 0 of a dense one
    std::uint32_t rows;
    const float* points;  // (N, dimensions)
};

struct HashEncode {
    HashLevelArgs level;
    const float* table;  // of the level
    float* features;
    std::int64_t stride;
};

struct HashScatter {
    HashLevelArgs level;
    const float* d_features;
    std::int64_t stride;
    float* d_table;             // of the level, added to
    std::uint32_t first, last;  // rows that are served; derivatives of the others are left out
};

struct HashPoints {
    HashLevelArgs level;
    const float *table, *d_features;
    std::int64_t stride;
    float* d_points;  // (N, dimensions), added to
};

}  // namespace photograd
