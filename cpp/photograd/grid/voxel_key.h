// Integer voxels as 64-bit keys, and the hash of a key.
//
// Three coordinates of 21 bits each, shifted to be non-negative, fill 63 bits; the key is therefore
// never `no_key`, and two voxels never share one. What does not fit is refused, not wrapped around.
//
// The products with primes of [Teschner2003], which [Niessner2013] uses as well, leave the low bits
// of the hash to the low bits of the coordinates: voxels at multiples of 2^k fall into one slot of
// 2^k. Here every bit of the key reaches every bit of the hash; the constants are those of
// [Steele2014].
#pragma once

#include <array>
#include <cstdint>
#include <limits>

namespace photograd {

using Voxel = std::array<std::int32_t, 3>;
using VoxelKey = std::uint64_t;

inline constexpr int voxel_bits = 21;
inline constexpr std::int64_t voxel_limit = std::int64_t{1} << (voxel_bits - 1);
inline constexpr VoxelKey no_key = std::numeric_limits<VoxelKey>::max();

/// Whether a coordinate lies in [-2^20, 2^20).
constexpr bool packable(std::int64_t coordinate) {
    return coordinate >= -voxel_limit && coordinate < voxel_limit;
}

/// The key of a voxel whose coordinates are packable; keys are ordered like (x, y, z).
constexpr VoxelKey pack(const Voxel& voxel) {
    VoxelKey key = 0;
    for (const std::int32_t coordinate : voxel)
        key = key << voxel_bits | static_cast<VoxelKey>(coordinate + voxel_limit);
    return key;
}

constexpr Voxel unpack(VoxelKey key) {
    constexpr VoxelKey mask = (VoxelKey{1} << voxel_bits) - 1;
    Voxel voxel{};
    for (int a = 2; a >= 0; --a, key >>= voxel_bits)
        voxel[static_cast<std::size_t>(a)] =
            static_cast<std::int32_t>(static_cast<std::int64_t>(key & mask) - voxel_limit);
    return voxel;
}

/// A permutation of the 64-bit numbers.
constexpr std::uint64_t hash(VoxelKey key) {
    key = (key ^ key >> 30) * 0xBF58476D1CE4E5B9ull;
    key = (key ^ key >> 27) * 0x94D049BB133111EBull;
    return key ^ key >> 31;
}

}  // namespace photograd
