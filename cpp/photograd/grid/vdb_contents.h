// The table of contents of a .vdb file, read and vetted before OpenVDB sees the file.
//
// OpenVDB trusts what a file states: a damaged one makes it set aside gigabytes or write past the
// end of its buffers. Here every length and every mask is compared with the bytes that there are,
// and the memory that the grids will need is known before any of it is taken. [Museth2013]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace photograd {

struct VdbEntry {
    std::string name;         // without the mark that OpenVDB appends to a repeated name
    std::string type;         // "Tree_float_5_4_3" or "Tree_vec3s_5_4_3"
    std::int64_t memory = 0;  // bytes that its tree will take
};

/// Throws IoError, in the name of `function`: no .vdb, another version, grids that are neither
/// float nor vec3s or whose transform is not affine, anything cut off or inconsistent.
std::vector<VdbEntry> vdb_contents(std::string_view bytes, std::string_view function,
                                   std::string_view path);

}  // namespace photograd
