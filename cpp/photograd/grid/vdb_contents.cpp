#include "photograd/grid/vdb_contents.h"

#include <utility>

#include "photograd/grid/vdb_cursor.h"
#include "photograd/grid/vdb_tree.h"

namespace photograd {
namespace {

constexpr std::int64_t vdb_magic = 0x56444220;  // " BDV" in the order of the bytes
constexpr std::uint32_t oldest_version = 222, newest_version = 224;

/// Bytes of a value of OpenVDB's type, or 0 where the length is its own.
std::size_t size_of_type(std::string_view type) {
    static constexpr std::pair<std::string_view, std::size_t> sizes[] = {
        {"bool", 1},   {"int32", 4},  {"int64", 8},  {"float", 4},  {"double", 8}, {"vec2i", 8},
        {"vec2s", 8},  {"vec2d", 16}, {"vec3i", 12}, {"vec3s", 12}, {"vec3d", 24}, {"vec4i", 16},
        {"vec4s", 16}, {"vec4d", 32}, {"mat4s", 64}, {"mat4d", 128}};
    for (const auto& [name, size] : sizes)
        if (name == type) return size;
    return 0;
}

/// Passes over a table of metadata; whether it says that values are in half precision, else `half`.
bool pass_metadata(VdbCursor& cursor, bool half) {
    const auto count = cursor.take<std::uint32_t>();
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::string_view name = cursor.take_text();
        const std::string_view type = cursor.take_text();
        const std::string_view value = cursor.take_text();
        const std::size_t size = size_of_type(type);
        cursor.require(size == 0 || size == value.size(), "metadata of the size of their type");
        if (name == "is_saved_as_half_float" && type == "bool") half = value[0] != 0;
    }
    return half;
}

/// The map from index space to the world: a name and doubles.
void pass_transform(VdbCursor& cursor) {
    const std::string_view kind = cursor.take_text();
    std::size_t doubles = 0;
    if (kind == "AffineMap" || kind == "UnitaryMap")
        doubles = 16;
    else if (kind == "ScaleMap" || kind == "UniformScaleMap")
        doubles = 15;
    else if (kind == "ScaleTranslateMap" || kind == "UniformScaleTranslateMap")
        doubles = 18;
    else if (kind == "TranslationMap")
        doubles = 3;
    else
        cursor.refuse("an affine transform that can be inverted", "a " + std::string(kind),
                      "resample the grid");
    cursor.take_bytes(doubles * sizeof(double));
}

void pass_header(VdbCursor& cursor) {
    if (cursor.take<std::int64_t>() != vdb_magic)
        cursor.refuse("a .vdb file", "one that begins differently");
    const auto version = cursor.take<std::uint32_t>();
    if (version < oldest_version || version > newest_version)
        cursor.refuse("version 222 to 224 of the .vdb format", std::to_string(version),
                      "write the file again with OpenVDB 3 to 10");
    cursor.take<std::uint64_t>();  // version of the library
    if (cursor.take<char>() == 0)
        cursor.refuse("a file that says where its grids are", "one written to a stream",
                      "write it again to a file");
    cursor.take_bytes(36);  // a random identifier, as text
}

}  // namespace

std::vector<VdbEntry> vdb_contents(std::string_view bytes, std::string_view function,
                                   std::string_view path) {
    VdbCursor cursor(bytes, function, path);
    if (bytes.empty()) cursor.refuse("a .vdb file", "an empty file");
    pass_header(cursor);
    pass_metadata(cursor, false);
    const auto count = cursor.take<std::int32_t>();
    std::vector<VdbEntry> entries;
    for (std::int32_t i = 0; i < count; ++i) {
        VdbEntry entry;
        entry.name = cursor.take_text();
        entry.name = entry.name.substr(0, entry.name.find('\x1e'));
        entry.type = cursor.take_text();
        cursor.require(cursor.take_text().empty(), "a tree for each grid");
        const auto begin = cursor.take<std::int64_t>();
        cursor.take<std::int64_t>();  // where the values start
        const auto end = cursor.take<std::int64_t>();
        const bool half = entry.type.ends_with("_HalfFloat");
        if (half) entry.type.resize(entry.type.size() - 10);
        if (entry.type != "Tree_float_5_4_3" && entry.type != "Tree_vec3s_5_4_3")
            cursor.refuse("grids of float or vec3s",
                          "grid '" + entry.name + "' of type " + entry.type,
                          "convert it with OpenVDB");
        cursor.seek(begin);
        const auto compression = cursor.take<std::uint32_t>();
        cursor.require(pass_metadata(cursor, half) == half, "one precision");
        pass_transform(cursor);
        const int channels = entry.type == "Tree_float_5_4_3" ? 1 : 3;
        entry.memory = vet_vdb_tree(cursor, {compression, channels, half});
        entries.push_back(std::move(entry));
        cursor.seek(end);
    }
    return entries;
}

}  // namespace photograd
