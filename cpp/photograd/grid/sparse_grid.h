// Sparse grids: values on the integer lattice, of which only the active ones are stored one by one.
//
// OpenVDB keeps the topology and reads and writes the files: a root that maps to two levels of
// inner nodes (32^3 and 16^3 children) and to leaves of 8^3 voxels [Museth2013]. openvdb_grid.h is
// the only file that includes it. It is built for growing and pruning, not for hot loops: those run
// on brick_field.h, made from the leaves of a grid in their order and written back in the same
// order.
//
// Voxel (i, j, k) has its value at the index-space point (i, j, k), the middle of its voxel. A grid
// has one channel (float) or three (vectors). Edits and reads of one grid must not overlap in time.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace photograd {

using MetaValue = std::variant<bool, std::int64_t, double, std::string>;
using MetaTable = std::map<std::string, MetaValue>;

struct SparseStatistics {
    std::int64_t active_voxels;  // those inside of active tiles included
    std::int64_t active_tiles;   // nodes of one active value, stored once
    std::int64_t leaves;
    std::int64_t memory;                             // bytes
    std::array<std::array<std::int32_t, 3>, 2> box;  // lowest voxel, and one past the highest
    float min, max;                                  // over active values and channels; 0 if none
};

/// The leaves of a grid, in the order that numbers the bricks of a brick field.
struct SparseLeaves {
    std::vector<std::int32_t> origins;  // (B, 3) lowest voxel
    std::vector<std::uint8_t> active;   // (B, 8, 8, 8) 1 where active
};

class SparseGrid {
public:
    struct Impl;
    explicit SparseGrid(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}

    /// Values (X, Y, Z, C) at voxels origin + (x, y, z). Active is what differs from `background`
    /// (C) by more than `tolerance` in any channel.
    static SparseGrid from_dense(const float* values, std::array<int, 3> shape, int channels,
                                 std::array<int, 3> origin, const float* background,
                                 float tolerance);

    [[nodiscard]] SparseGrid copy() const;
    [[nodiscard]] int channels() const;
    [[nodiscard]] std::vector<float> background() const;
    [[nodiscard]] std::string name() const;
    void rename(const std::string& name);
    [[nodiscard]] MetaTable metadata() const;
    void set_metadata(const std::string& key, const MetaValue& value);
    /// Row by row, for column vectors.
    [[nodiscard]] std::array<double, 16> world_from_index() const;
    void set_world_from_index(const std::array<double, 16>& matrix);
    [[nodiscard]] SparseStatistics statistics() const;

    /// out (X, Y, Z, C): the values at voxels origin + (x, y, z), background included.
    void to_dense(std::array<int, 3> shape, std::array<int, 3> origin, float* out) const;
    /// out (N, C) and active (N) at voxels (N, 3).
    void values_at(const std::int32_t* voxels, std::int64_t count, float* out,
                   std::uint8_t* active) const;
    /// Writes values (N, C) to voxels (N, 3) and activates them.
    void activate(const std::int32_t* voxels, const float* values, std::int64_t count);
    /// Trilinear values (N, C) at index-space points (N, 3), by OpenVDB's own BoxSampler: the
    /// reference.
    void sample(const double* points, std::int64_t count, float* out) const;

    /// Deactivates what differs from the background by at most `tolerance`, and drops empty nodes.
    void prune(float tolerance);
    /// Activates every voxel within `steps` of an active one along each axis. Values stay.
    void dilate(int steps);
    /// Replaces active tiles by leaves, so that every active voxel is in a leaf.
    void voxelize();

    [[nodiscard]] SparseLeaves leaves() const;
    /// The active values of all leaves, (N, C), leaf after leaf.
    [[nodiscard]] std::vector<float> leaf_values() const;
    void set_leaf_values(std::span<const float> values);
    /// Deactivates the voxels of leaf_values() where keep (N) is 0; they get the background.
    void keep(std::span<const std::uint8_t> keep);

private:
    friend struct VdbFile;
    std::shared_ptr<Impl> impl_;
};

struct VdbFile {
    std::vector<SparseGrid> grids;
    MetaTable metadata;

    /// Throws IoError for a damaged file, grids that are neither float nor vec3s, transforms that
    /// cannot be inverted, values that are not finite, and grids that need more than `memory_limit`
    /// bytes.
    static VdbFile read(const std::string& path, std::int64_t memory_limit);
    /// `half`: values in half precision, or, if not given, as each grid was read.
    void write(const std::string& path, std::optional<bool> half) const;
};

}  // namespace photograd
