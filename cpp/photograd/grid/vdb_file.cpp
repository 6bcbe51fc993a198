// Files of sparse grids, and what is kept with them.
#include <openvdb/io/Stream.h>

#include <fstream>
#include <sstream>

#include "photograd/core/errors.h"
#include "photograd/grid/openvdb_grid.h"
#include "photograd/grid/vdb_contents.h"

namespace photograd {
namespace {

constexpr float largest_half = 65504.0F;

bool finite(const openvdb::GridBase::Ptr& any) {
    return with_grid(std::make_shared<SparseGrid::Impl>(SparseGrid::Impl{any}), [](auto& grid) {
        using Value = typename std::decay_t<decltype(grid)>::ValueType;
        const auto good = [](const Value& v) { return std::isfinite(distance(v, Value(0.0F))); };
        if (!good(grid.background())) return false;
        for (auto at = grid.tree().cbeginValueAll(); at; ++at)
            if (!good(*at)) return false;
        return true;
    });
}

}  // namespace

MetaTable table_of(const openvdb::MetaMap& map) {
    MetaTable table;
    for (auto entry = map.beginMeta(); entry != map.endMeta(); ++entry) {
        const auto& [key, value] = *entry;
        if (const auto* b = dynamic_cast<const openvdb::BoolMetadata*>(value.get()))
            table[key] = b->value();
        else if (const auto* i = dynamic_cast<const openvdb::Int32Metadata*>(value.get()))
            table[key] = std::int64_t(i->value());
        else if (const auto* l = dynamic_cast<const openvdb::Int64Metadata*>(value.get()))
            table[key] = std::int64_t(l->value());
        else if (const auto* f = dynamic_cast<const openvdb::FloatMetadata*>(value.get()))
            table[key] = double(f->value());
        else if (const auto* d = dynamic_cast<const openvdb::DoubleMetadata*>(value.get()))
            table[key] = d->value();
        else
            table[key] = value->str();
    }
    return table;
}

void set_meta(openvdb::MetaMap& map, const std::string& key, const MetaValue& value) {
    map.removeMeta(key);  // it may have had another type
    std::visit(
        [&](const auto& v) {
            using Value = std::decay_t<decltype(v)>;
            map.insertMeta(key, openvdb::TypedMetadata<Value>(v));
        },
        value);
}

VdbFile VdbFile::read(const std::string& path, std::int64_t memory_limit) {
    constexpr const char* function = "read_vdb";
    std::ifstream file(path, std::ios::binary);
    if (!file) fail(ErrorKind::io, function, path, "a file that can be read", "none");
    std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    std::int64_t memory = 0;
    for (const VdbEntry& entry : vdb_contents(bytes, function, path)) memory += entry.memory;
    if (memory > memory_limit)
        fail(ErrorKind::io, function, path,
             "grids that fit into " + std::to_string(memory_limit) + " bytes",
             "grids of " + std::to_string(memory) + " bytes",
             "raise memory_limit, or write a coarser grid");
    // A table for reading piece by piece, with lengths of its own. Under another type OpenVDB only
    // skips it.
    constexpr std::string_view table("\x0d\0\0\0__delayedload", 17);
    for (auto at = bytes.find(table); at != std::string::npos; at = bytes.find(table, at))
        bytes[at + table.size() - 1] = '-';
    try {
        openvdb::initialize();
        std::istringstream in(std::move(bytes), std::ios::binary);
        // OpenVDB does not look whether a read succeeded; an exception stops its loops at the end.
        in.exceptions(std::ios::failbit | std::ios::badbit);
        openvdb::io::Stream stream(in, /*delayLoad=*/false);
        VdbFile out;
        out.metadata = table_of(*stream.getMetadata());
        const openvdb::GridPtrVecPtr all = stream.getGrids();
        for (const auto& grid : *all) {
            grid->removeMeta(openvdb::GridBase::META_FILE_DELAYED_LOAD);
            if (!invertible(grid->transform()))
                fail(ErrorKind::io, function, path, "affine transforms that can be inverted",
                     "grid '" + grid->getName() + "' with another");
            if (!finite(grid))
                fail(ErrorKind::io, function, path, "finite values",
                     "grid '" + grid->getName() + "' with NaN or infinity");
            out.grids.emplace_back(std::make_shared<SparseGrid::Impl>(SparseGrid::Impl{grid}));
        }
        return out;
    } catch (const Error&) {
        throw;
    } catch (const std::exception& failure) {
        fail(ErrorKind::io, function, path, "a complete .vdb file",
             std::string("'") + failure.what() + "'", "the file is cut off or damaged");
    }
}

void VdbFile::write(const std::string& path, std::optional<bool> half) const {
    openvdb::initialize();
    openvdb::GridCPtrVec out;
    for (const SparseGrid& grid : grids) {
        const openvdb::GridBase::Ptr shallow = grid.impl_->grid->copyGrid();
        if (half) shallow->setSaveFloatAsHalf(*half);
        const SparseStatistics s = grid.statistics();
        if (shallow->saveFloatAsHalf() && std::max(-s.min, s.max) > largest_half)
            fail(ErrorKind::range, "write_vdb", "half", "values up to 65504",
                 std::to_string(std::max(-s.min, s.max)), "write floats");
        out.push_back(shallow);
    }
    openvdb::MetaMap table;
    for (const auto& [key, value] : metadata) set_meta(table, key, value);
    try {
        openvdb::io::File file(path);
        file.write(out, table);
        file.close();
    } catch (const std::exception& failure) {
        fail(ErrorKind::io, "write_vdb", path, "a file that can be written", failure.what());
    }
}

}  // namespace photograd
