// The tree of one grid in a .vdb file, walked without being built.
#pragma once

#include "photograd/grid/vdb_cursor.h"

namespace photograd {

struct VdbValues {
    std::uint32_t compression;  // 1 zip, 2 only active values are stored, 4 blosc
    int channels;
    bool half;
};

/// Passes over topology and values of a tree; the bytes that it will take in memory. Throws IoError
/// if a count, a mask or the size of a block does not fit.
std::int64_t vet_vdb_tree(VdbCursor& cursor, const VdbValues& values);

}  // namespace photograd
