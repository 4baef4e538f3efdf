#include "patina/core/parallel.h"

#include <memory>

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>

#include "patina/core/contract.h"

namespace patina {

namespace {
// oneTBB's limit lives as long as this object; there is one per process because the thread pool is one per process.
std::unique_ptr<tbb::global_control> limit;
}  // namespace

void set_thread_count(int count) {
    PATINA_EXPECT(count >= 0);
    limit.reset();
    if (count > 0) limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, count);
}

int thread_count() {
    return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

}  // namespace patina
