// The instruction set that this translation unit is compiled for.
//
// Everything that a kernel includes (core/exp.h, core/lanes.h, the ops) lives in an inline
// namespace that carries the name of the instruction set. A function that the compiler emitted with
// AVX-512 instructions is then a different symbol from its baseline twin, and the linker can never
// pick the wrong one for an older processor. Ordinary files see the namespace `portable`; only the
// files cpp/kernels/*_{baseline,v3,v4}.cpp define PHOTOGRAD_ISA before they include anything.
#pragma once

#ifndef PHOTOGRAD_ISA
#define PHOTOGRAD_ISA portable
#endif

// Kernel files may not pull in std containers; these three builtins replace <algorithm> and
// <cmath>.
namespace photograd {
inline namespace PHOTOGRAD_ISA {

template <class T>
constexpr T smaller(T a, T b) {
    return b < a ? b : a;
}

template <class T>
constexpr T larger(T a, T b) {
    return a < b ? b : a;
}

template <class T>
constexpr T clamped(T x, T lo, T hi) {
    return smaller(larger(x, lo), hi);
}

}  // namespace PHOTOGRAD_ISA
}  // namespace photograd
