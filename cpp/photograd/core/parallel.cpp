#include "photograd/core/parallel.h"

#ifdef PHOTOGRAD_STD_THREADS

#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace photograd {
namespace {
int requested_threads = 0;
}

void detail::parallel_for_erased(std::int64_t count, LoopBody body, void* context) {
    std::atomic<std::int64_t> next{0};
    std::exception_ptr failure;
    std::mutex failure_lock;
    auto work = [&] {
        // Relaxed: acquire/release would order the bodies and hide races from the sanitizer.
        for (std::int64_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < count;) {
            try {
                body(context, i);
            } catch (...) {
                const std::lock_guard<std::mutex> guard(failure_lock);
                if (!failure) failure = std::current_exception();
            }
        }
    };
    std::vector<std::thread> pool;
    for (int k = 1; k < thread_count(); ++k) pool.emplace_back(work);
    work();
    for (std::thread& t : pool) t.join();
    if (failure) std::rethrow_exception(failure);
}

void set_thread_count(int threads) { requested_threads = threads; }

int thread_count() {
    return requested_threads > 0 ? requested_threads
                                 : static_cast<int>(std::thread::hardware_concurrency());
}

}  // namespace photograd

#else

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <memory>
#include <mutex>

namespace photograd {
namespace {
std::unique_ptr<tbb::global_control>
    limit;  // lives as long as the limit is wanted; bounds Embree too
std::mutex limit_lock;
}  // namespace

void detail::parallel_for_erased(std::int64_t count, LoopBody body, void* context) {
    // Tasks run in the floating-point mode of their caller. By default it would be that of whatever
    // used TBB first in the process, and Embree's builders flush denormal numbers to zero.
    tbb::task_group_context mode(
        tbb::task_group_context::bound,
        tbb::task_group_context::default_traits | tbb::task_group_context::fp_settings);
    tbb::parallel_for(
        tbb::blocked_range<std::int64_t>(0, count, 1),
        [=](const tbb::blocked_range<std::int64_t>& range) {
            for (std::int64_t i = range.begin(); i != range.end(); ++i) body(context, i);
        },
        tbb::simple_partitioner(), mode);
}

void set_thread_count(int threads) {
    const std::lock_guard<std::mutex> guard(limit_lock);
    limit.reset();
    if (threads > 0)
        limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                      static_cast<std::size_t>(threads));
}

int thread_count() {
    return static_cast<int>(
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

}  // namespace photograd

#endif
