// A read position in the bytes of a .vdb file, for vdb_contents.cpp and vdb_tree.cpp.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "photograd/core/errors.h"

namespace photograd {

/// Takes values off the front of the bytes; what is not there is refused.
class VdbCursor {
public:
    VdbCursor(std::string_view bytes, std::string_view function, std::string_view path)
        : bytes_(bytes), function_(function), path_(path) {}

    template <class T>
    T take() {
        T value;
        std::memcpy(&value, take_bytes(sizeof(T)).data(), sizeof(T));
        return value;
    }
    std::string_view take_bytes(std::size_t count) {
        if (count > bytes_.size() - at_)
            refuse("a complete .vdb file",
                   "one that needs " + std::to_string(count) + " bytes at offset " +
                       std::to_string(at_) + " of " + std::to_string(bytes_.size()),
                   "the file is cut off or damaged");
        const std::string_view taken = bytes_.substr(at_, count);
        at_ += count;
        return taken;
    }
    /// Refuses what a sound file cannot hold.
    void require(bool sound, std::string_view what) const {
        if (!sound) refuse(what, "something else", "the file is damaged");
    }
    std::string_view take_text() { return take_bytes(take<std::uint32_t>()); }
    void seek(std::int64_t at) {
        if (at < 0 || static_cast<std::uint64_t>(at) > bytes_.size())
            refuse("a grid inside of the file",
                   "offset " + std::to_string(at) + " of " + std::to_string(bytes_.size()),
                   "the file is cut off or damaged");
        at_ = static_cast<std::size_t>(at);
    }
    [[noreturn]] void refuse(std::string_view expected, std::string_view got,
                             std::string_view remedy = {}) const {
        fail(ErrorKind::io, function_, path_, expected, got, remedy);
    }

private:
    std::string_view bytes_, function_, path_;
    std::size_t at_ = 0;
};

}  // namespace photograd
