// Threads. The only door to TBB (parallel.cpp includes it, nothing else does).
//
// Work is cut into pieces that do not depend on the number of threads; a piece writes only what it
// owns. Results are therefore the same bits for any thread count. With PHOTOGRAD_STD_THREADS the
// same interface runs on std::thread, for the thread sanitizer, which cannot see into an
// uninstrumented TBB.
#pragma once

#include <cstdint>
#include <type_traits>

namespace photograd {

namespace detail {
using LoopBody = void (*)(void* context, std::int64_t index);
void parallel_for_erased(std::int64_t count, LoopBody body, void* context);
}  // namespace detail

/// Calls body(i) for i in [0, count), in any order and on any thread. Exceptions reach the caller.
template <class Body>
void parallel_for(std::int64_t count, Body&& body) {
    detail::parallel_for_erased(
        count,
        [](void* context, std::int64_t i) {
            (*static_cast<std::remove_reference_t<Body>*>(context))(i);
        },
        &body);
}

/// Upper limit on threads for everything in the process (0 restores the default: all cores).
void set_thread_count(int threads);
[[nodiscard]] int thread_count();

}  // namespace photograd
