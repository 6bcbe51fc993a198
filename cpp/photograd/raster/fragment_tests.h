// The fixed tests that a fragment passes before it is seen: face, depth, stencil, with the rules
// and names of Vulkan and OpenGL. (The frustum needs no test of its own: a point outside of the
// image or of [near, far] is no fragment.)
#pragma once

#include <algorithm>
#include <cstdint>

namespace photograd {

enum class Compare : int {
    never,
    less,
    equal,
    less_equal,
    greater,
    not_equal,
    greater_equal,
    always
};

template <class T>
bool passes(Compare compare, T value, T stored) {
    switch (compare) {
        case Compare::never: return false;
        case Compare::less: return value < stored;
        case Compare::equal: return value == stored;
        case Compare::less_equal: return value <= stored;
        case Compare::greater: return value > stored;
        case Compare::not_equal: return value != stored;
        case Compare::greater_equal: return value >= stored;
        case Compare::always: break;
    }
    return true;
}

enum class StencilOp : int {
    keep,
    zero,
    replace,
    increment_clamp,
    decrement_clamp,
    invert,
    increment_wrap,
    decrement_wrap
};

/// What the operation makes of the stored value, before the write mask.
inline std::uint8_t stencil_result(StencilOp op, std::uint8_t stored, std::uint8_t reference) {
    const int s = stored;
    switch (op) {
        case StencilOp::keep: break;
        case StencilOp::zero: return 0;
        case StencilOp::replace: return reference;
        case StencilOp::increment_clamp: return static_cast<std::uint8_t>(std::min(s + 1, 255));
        case StencilOp::decrement_clamp: return static_cast<std::uint8_t>(std::max(s - 1, 0));
        case StencilOp::invert: return static_cast<std::uint8_t>(~s);
        case StencilOp::increment_wrap: return static_cast<std::uint8_t>(s + 1);
        case StencilOp::decrement_wrap: return static_cast<std::uint8_t>(s - 1);
    }
    return stored;
}

struct StencilRules {
    Compare compare = Compare::always;  // (reference & read_mask) against (stored & read_mask)
    std::uint8_t reference = 0, read_mask = 255, write_mask = 255;
    StencilOp fail = StencilOp::keep, depth_fail = StencilOp::keep, pass = StencilOp::keep;

    [[nodiscard]] bool allows(std::uint8_t stored) const {
        return passes(compare, static_cast<std::uint8_t>(reference & read_mask),
                      static_cast<std::uint8_t>(stored & read_mask));
    }
    void apply(StencilOp op, std::uint8_t& stored) const {
        const std::uint8_t made = stencil_result(op, stored, reference);
        stored = static_cast<std::uint8_t>((stored & ~write_mask) | (made & write_mask));
    }
};

enum class Cull : int { none, back, front };

struct FragmentRules {
    Cull cull = Cull::none;
    Compare depth = Compare::less;
    bool depth_write = true;
    double near = 0, far = 0;
    StencilRules stencil;
};

}  // namespace photograd
