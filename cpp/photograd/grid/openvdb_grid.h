// OpenVDB behind grid/sparse_grid.h: for sparse_grid.cpp and vdb_file.cpp, the only two files that
// see it.
#pragma once

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "photograd/grid/sparse_grid.h"

namespace photograd {

struct SparseGrid::Impl {
    openvdb::GridBase::Ptr grid;  // a FloatGrid or a Vec3SGrid
};

/// use(grid) with the grid's real type.
template <class Use>
auto with_grid(const std::shared_ptr<SparseGrid::Impl>& impl, Use&& use) {
    if (const auto scalar = openvdb::gridPtrCast<openvdb::FloatGrid>(impl->grid))
        return use(*scalar);
    return use(*openvdb::gridPtrCast<openvdb::Vec3SGrid>(impl->grid));
}

template <class Value>
inline constexpr int channels_of = std::is_same_v<Value, float> ? 1 : 3;

template <class Value>
Value load(const float* from) {
    if constexpr (std::is_same_v<Value, float>)
        return *from;
    else
        return Value(from);
}
template <class Value>
void store(const Value& value, float* to) {
    if constexpr (std::is_same_v<Value, float>)
        *to = value;
    else
        std::copy_n(value.asPointer(), 3, to);
}

/// The largest difference of two values in any channel.
template <class Value>
float distance(const Value& a, const Value& b) {
    if constexpr (std::is_same_v<Value, float>)
        return std::abs(a - b);
    else
        return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

/// Metadata as plain values; types without a counterpart as OpenVDB prints them.
MetaTable table_of(const openvdb::MetaMap& map);
void set_meta(openvdb::MetaMap& map, const std::string& key, const MetaValue& value);
/// Affine, finite, and far enough from singular.
bool invertible(const openvdb::math::Transform& transform);

}  // namespace photograd
