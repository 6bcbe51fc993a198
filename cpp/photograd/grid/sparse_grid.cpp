#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/Dense.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/Morphology.h>
#include <openvdb/tools/Prune.h>

#include <limits>
#include <type_traits>

#include "photograd/core/errors.h"
#include "photograd/core/parallel.h"
#include "photograd/grid/openvdb_grid.h"

namespace photograd {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;
using openvdb::Vec3SGrid;

constexpr std::int64_t points_a_piece = 4096;

Coord coord(const std::int32_t* voxel) { return {voxel[0], voxel[1], voxel[2]}; }

/// use(first, last) on pieces of [0, count), in parallel.
template <class Use>
void in_pieces(std::int64_t count, Use&& use) {
    parallel_for((count + points_a_piece - 1) / points_a_piece, [&](std::int64_t piece) {
        use(piece * points_a_piece, std::min(count, (piece + 1) * points_a_piece));
    });
}

}  // namespace

bool invertible(const openvdb::math::Transform& transform) {
    if (!transform.isLinear()) return false;
    const openvdb::Mat4d m = transform.baseMap()->getAffineMap()->getMat4();
    const openvdb::Mat3d linear = m.getMat3();
    double size = 1;
    for (int row = 0; row < 3; ++row) size *= linear.row(row).length();
    for (int k = 0; k < 16; ++k)
        if (!std::isfinite(m.asPointer()[k])) return false;
    return size > 0 && std::abs(linear.det()) > 1e-9 * size;
}

SparseGrid SparseGrid::from_dense(const float* values, std::array<int, 3> shape, int channels,
                                  std::array<int, 3> origin, const float* background,
                                  float tolerance) {
    openvdb::initialize();
    // Made by the library, which holds all that a grid's virtual functions need.
    const auto make = [&]<class Grid>(std::type_identity<Grid>) -> openvdb::GridBase::Ptr {
        using Value = typename Grid::ValueType;
        const Value empty = load<Value>(background);
        const auto grid =
            openvdb::gridPtrCast<Grid>(openvdb::GridBase::createGrid(Grid::gridType()));
        openvdb::tools::changeBackground(grid->tree(), empty);
        auto accessor = grid->getAccessor();
        const float* from = values;
        for (int i = 0; i < shape[0]; ++i)
            for (int j = 0; j < shape[1]; ++j)
                for (int k = 0; k < shape[2]; ++k, from += channels)
                    if (distance(load<Value>(from), empty) > tolerance)
                        accessor.setValue({origin[0] + i, origin[1] + j, origin[2] + k},
                                          load<Value>(from));
        return grid;
    };
    const auto grid = channels == 1 ? make(std::type_identity<FloatGrid>())
                                    : make(std::type_identity<Vec3SGrid>());
    return SparseGrid(std::make_shared<Impl>(Impl{grid}));
}

SparseGrid SparseGrid::copy() const {
    return SparseGrid(std::make_shared<Impl>(Impl{impl_->grid->deepCopyGrid()}));
}

int SparseGrid::channels() const { return impl_->grid->isType<FloatGrid>() ? 1 : 3; }

std::vector<float> SparseGrid::background() const {
    std::vector<float> out(static_cast<std::size_t>(channels()));
    with_grid(impl_, [&](auto& grid) { store(grid.background(), out.data()); });
    return out;
}

std::string SparseGrid::name() const { return impl_->grid->getName(); }
void SparseGrid::rename(const std::string& name) { impl_->grid->setName(name); }
MetaTable SparseGrid::metadata() const { return table_of(*impl_->grid); }
void SparseGrid::set_metadata(const std::string& key, const MetaValue& value) {
    set_meta(*impl_->grid, key, value);
}

std::array<double, 16> SparseGrid::world_from_index() const {
    // OpenVDB multiplies row vectors from the left: its matrix is the transpose of ours.
    const openvdb::Mat4d m = impl_->grid->transform().baseMap()->getAffineMap()->getMat4();
    std::array<double, 16> out{};
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            out[static_cast<std::size_t>(4 * row + column)] = m(column, row);
    return out;
}

void SparseGrid::set_world_from_index(const std::array<double, 16>& matrix) {
    openvdb::Mat4d m;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            m(column, row) = matrix[static_cast<std::size_t>(4 * row + column)];
    try {
        const auto transform = openvdb::math::Transform::createLinearTransform(m);
        if (invertible(*transform)) return impl_->grid->setTransform(transform);
    } catch (const std::exception&) {  // OpenVDB's own refusal of a singular matrix
    }
    fail(ErrorKind::range, "SparseGrid", "world_from_index",
         "an affine matrix that can be inverted", "a singular one or one that is not finite");
}

SparseStatistics SparseGrid::statistics() const {
    return with_grid(impl_, [](auto& grid) {
        SparseStatistics s{};
        const auto& tree = grid.tree();
        s.active_voxels = static_cast<std::int64_t>(tree.activeVoxelCount());
        s.active_tiles = static_cast<std::int64_t>(tree.activeTileCount());
        s.leaves = static_cast<std::int64_t>(tree.leafCount());
        s.memory = static_cast<std::int64_t>(tree.memUsage());
        CoordBBox box;
        if (!tree.evalActiveVoxelBoundingBox(box)) return s;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            s.box[0][axis] = box.min()[static_cast<int>(axis)];
            s.box[1][axis] = box.max()[static_cast<int>(axis)] + 1;
        }
        s.min = std::numeric_limits<float>::infinity();
        s.max = -s.min;
        for (auto at = tree.cbeginValueOn(); at; ++at) {
            float v[3];
            store(*at, v);
            for (int c = 0; c < channels_of<std::decay_t<decltype(*at)>>; ++c) {
                s.min = std::min(s.min, v[c]);
                s.max = std::max(s.max, v[c]);
            }
        }
        return s;
    });
}

void SparseGrid::to_dense(std::array<int, 3> shape, std::array<int, 3> origin, float* out) const {
    const Coord lowest = coord(origin.data());
    const CoordBBox box(lowest, lowest + coord(shape.data()) - Coord(1));
    with_grid(impl_, [&](auto& grid) {
        using Value = typename std::decay_t<decltype(grid)>::ValueType;
        openvdb::tools::Dense<Value, openvdb::tools::LayoutZYX> dense(
            box, reinterpret_cast<Value*>(out));
        openvdb::tools::copyToDense(grid, dense);
    });
}

void SparseGrid::values_at(const std::int32_t* voxels, std::int64_t count, float* out,
                           std::uint8_t* active) const {
    with_grid(impl_, [&](auto& grid) {
        using Value = typename std::decay_t<decltype(grid)>::ValueType;
        in_pieces(count, [&](std::int64_t first, std::int64_t last) {
            const auto accessor = grid.getConstAccessor();  // one a piece: it caches its last leaf
            for (std::int64_t n = first; n < last; ++n) {
                Value value;
                active[n] = accessor.probeValue(coord(voxels + 3 * n), value) ? 1 : 0;
                store(value, out + n * channels_of<Value>);
            }
        });
    });
}

void SparseGrid::activate(const std::int32_t* voxels, const float* values, std::int64_t count) {
    with_grid(impl_, [&](auto& grid) {
        using Value = typename std::decay_t<decltype(grid)>::ValueType;
        auto accessor = grid.getAccessor();
        for (std::int64_t n = 0; n < count; ++n)
            accessor.setValue(coord(voxels + 3 * n), load<Value>(values + n * channels_of<Value>));
    });
}

void SparseGrid::sample(const double* points, std::int64_t count, float* out) const {
    with_grid(impl_, [&](auto& grid) {
        using Value = typename std::decay_t<decltype(grid)>::ValueType;
        in_pieces(count, [&](std::int64_t first, std::int64_t last) {
            const auto accessor = grid.getConstAccessor();
            for (std::int64_t n = first; n < last; ++n) {
                const openvdb::Vec3d at(points + 3 * n);
                store(openvdb::tools::BoxSampler::sample(accessor, at),
                      out + n * channels_of<Value>);
            }
        });
    });
}

void SparseGrid::prune(float tolerance) {
    with_grid(impl_, [&](auto& grid) {
        const auto empty = grid.background();
        for (auto at = grid.beginValueOn(); at; ++at)
            if (distance(*at, empty) <= tolerance) {
                at.setValue(empty);
                at.setValueOff();
            }
        openvdb::tools::pruneInactive(grid.tree());
    });
}

void SparseGrid::dilate(int steps) {
    with_grid(impl_, [&](auto& grid) {
        openvdb::tools::dilateActiveValues(grid.tree(), steps, openvdb::tools::NN_FACE_EDGE_VERTEX,
                                           openvdb::tools::EXPAND_TILES);
    });
}

void SparseGrid::voxelize() {
    with_grid(impl_, [](auto& grid) { grid.tree().voxelizeActiveTiles(); });
}

SparseLeaves SparseGrid::leaves() const {
    return with_grid(impl_, [](auto& grid) {
        SparseLeaves out;
        for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
            const Coord& origin = leaf->origin();
            out.origins.insert(out.origins.end(), origin.asPointer(), origin.asPointer() + 3);
            for (openvdb::Index k = 0; k < 512; ++k)
                out.active.push_back(leaf->isValueOn(k) ? 1 : 0);
        }
        return out;
    });
}

std::vector<float> SparseGrid::leaf_values() const {
    return with_grid(impl_, [](auto& grid) {
        constexpr std::size_t width = channels_of<typename std::decay_t<decltype(grid)>::ValueType>;
        std::vector<float> out;
        for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf)
            for (auto at = leaf->cbeginValueOn(); at; ++at) {
                out.resize(out.size() + width);
                store(*at, out.data() + out.size() - width);
            }
        return out;
    });
}

void SparseGrid::set_leaf_values(std::span<const float> values) {
    with_grid(impl_, [&](auto& grid) {
        using Value = typename std::decay_t<decltype(grid)>::ValueType;
        const float* from = values.data();
        for (auto leaf = grid.tree().beginLeaf(); leaf; ++leaf)
            for (auto at = leaf->beginValueOn(); at; ++at, from += channels_of<Value>)
                at.setValue(load<Value>(from));
    });
}

void SparseGrid::keep(std::span<const std::uint8_t> keep) {
    with_grid(impl_, [&](auto& grid) {
        const auto empty = grid.background();
        const std::uint8_t* stays = keep.data();
        for (auto leaf = grid.tree().beginLeaf(); leaf; ++leaf)
            for (auto at = leaf->beginValueOn(); at; ++at)
                if (*stays++ == 0) {
                    at.setValue(empty);
                    at.setValueOff();
                }
        openvdb::tools::pruneInactive(grid.tree());
    });
}

}  // namespace photograd
