// Format, after OpenVDB's io/Compression.h and tree/: a root lists its tiles and children; a node
// holds a mask of children, a mask of active values, its values, then its children; a leaf holds a
// mask. After all topology follow, leaf by leaf in the same order, the mask again and the values.
#include "photograd/grid/vdb_tree.h"

#include <array>
#include <bit>
#include <vector>

namespace photograd {
namespace {

constexpr std::uint32_t zip = 1, active_only = 2, blosc = 4;
constexpr std::int32_t root_child_side = 4096;
constexpr std::size_t leaf_voxels = 512;

class Walk {
public:
    Walk(VdbCursor& cursor, const VdbValues& values) : cursor_(cursor), values_(values) {}

    std::int64_t run() {
        cursor_.require(cursor_.take<std::int32_t>() == 1, "one buffer of values");
        cursor_.take_bytes(value_size());  // background
        const auto tiles = cursor_.take<std::uint32_t>(), children = cursor_.take<std::uint32_t>();
        Key last{};
        for (std::uint32_t n = 0; n < tiles; ++n) {
            take_key(last, n == 0);
            cursor_.take_bytes(value_size());
            cursor_.require(cursor_.take<std::uint8_t>() <= 1, "a tile that is active or not");
        }
        for (std::uint32_t n = 0; n < children; ++n) {
            take_key(last, n == 0);
            inner(5);
        }
        for (const std::string_view mask : leaves_) {
            cursor_.require(cursor_.take_bytes(mask.size()) == mask, "the mask of the topology");
            block(leaf_voxels, mask);
        }
        return memory_;
    }

private:
    using Key = std::array<std::int32_t, 3>;

    [[nodiscard]] std::size_t value_size() const {
        return sizeof(float) * static_cast<std::size_t>(values_.channels);
    }

    /// Keys come in ascending order, so that none comes twice.
    void take_key(Key& last, bool first) {
        Key key;
        for (std::int32_t& k : key) {
            k = cursor_.take<std::int32_t>();
            cursor_.require(k % root_child_side == 0, "nodes on the lattice");
        }
        cursor_.require(first || last < key, "nodes in ascending order");
        last = key;
    }

    /// A node of (2^log2)^3 entries and all below it.
    void inner(int log2) {
        const std::size_t entries = std::size_t(1) << (3 * log2);
        const std::string_view children = cursor_.take_bytes(entries / 8);
        const std::string_view active = cursor_.take_bytes(entries / 8);
        memory_ += static_cast<std::int64_t>(entries * (8 + value_size()));
        block(entries, active);
        for (std::size_t byte = 0; byte < children.size(); ++byte) {
            const auto bits = static_cast<std::uint8_t>(children[byte]);
            cursor_.require((bits & static_cast<std::uint8_t>(active[byte])) == 0,
                            "children that are no tiles");
            for (int n = 0; n < std::popcount(bits); ++n)
                if (log2 == 5)
                    inner(4);
                else
                    leaf();
        }
    }
    void leaf() {
        leaves_.push_back(cursor_.take_bytes(leaf_voxels / 8));
        memory_ += static_cast<std::int64_t>(leaf_voxels * value_size() + 128);
    }

    /// The stored values of a node with these active ones.
    void block(std::size_t count, std::string_view active) {
        const auto kind = cursor_.take<std::uint8_t>();
        cursor_.require(kind <= 6, "one of seven kinds of blocks");
        if (kind == 2 || kind == 4) cursor_.take_bytes(value_size());   // one inactive value
        if (kind == 5) cursor_.take_bytes(2 * value_size());            // two
        if (kind >= 3 && kind <= 5) cursor_.take_bytes(active.size());  // which of them
        if ((values_.compression & active_only) != 0 && kind != 6) {
            count = 0;
            for (const char byte : active)
                count += static_cast<std::size_t>(std::popcount(static_cast<std::uint8_t>(byte)));
        }
        if (values_.half && count == 0) return;
        compressed(count * value_size() / (values_.half ? 2 : 1));
    }

    /// `size` bytes as they are, or a length and a compressed chunk; a length below zero says raw.
    void compressed(std::size_t size) {
        if ((values_.compression & (blosc | zip)) == 0) {
            cursor_.take_bytes(size);
            return;
        }
        const auto length = cursor_.take<std::int64_t>();
        if (length <= 0) {
            cursor_.require(-static_cast<double>(length) == static_cast<double>(size),
                            "blocks of the size of their node");
            cursor_.take_bytes(size);
            return;
        }
        const std::string_view chunk = cursor_.take_bytes(static_cast<std::size_t>(length));
        if ((values_.compression & blosc) == 0) return;  // zlib checks its own input
        // Blosc's header: four bytes of flags, then the sizes before, of a block, and after.
        constexpr std::size_t header = 16;
        std::uint32_t raw = 0, packed = 0;
        cursor_.require(chunk.size() >= header, "chunks with a header");
        std::memcpy(&raw, chunk.data() + 4, sizeof raw);
        std::memcpy(&packed, chunk.data() + 12, sizeof packed);
        cursor_.require(raw == size && packed == chunk.size(), "chunks of the size of their node");
    }

    VdbCursor& cursor_;
    VdbValues values_;
    std::vector<std::string_view> leaves_;  // masks, in order
    std::int64_t memory_ = 0;
};

}  // namespace

std::int64_t vet_vdb_tree(VdbCursor& cursor, const VdbValues& values) {
    return Walk(cursor, values).run();
}

}  // namespace photograd
