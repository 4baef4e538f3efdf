#pragma once
// Parallel loops over oneTBB. Results must not depend on the number of threads: each index writes its own place.

#include <cstddef>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

namespace patina {

// Limits every later parallel loop of the process to `count` threads (0 = all processors) until the limit is set anew.
void set_thread_count(int count);
int thread_count();

// Calls body(index) for begin <= index < end, each index once, in any order.
template <class Body>
void parallel_for(std::ptrdiff_t begin, std::ptrdiff_t end, const Body& body) {
    tbb::parallel_for(
        tbb::blocked_range<std::ptrdiff_t>(begin, end, 1),
        [&](const tbb::blocked_range<std::ptrdiff_t>& range) {
            for (std::ptrdiff_t index = range.begin(); index != range.end(); ++index) body(index);
        },
        tbb::simple_partitioner{});
}

}  // namespace patina
