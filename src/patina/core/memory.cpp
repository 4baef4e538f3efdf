#include "patina/core/memory.h"

#include <cstdlib>  // defines __GLIBC__

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace patina {

void keep_freed_memory() {
#ifdef __GLIBC__
    constexpr int most_that_glibc_takes = 32 << 20;
    ::mallopt(M_MMAP_THRESHOLD, most_that_glibc_takes);
    ::mallopt(M_TRIM_THRESHOLD, 1 << 30);
    ::mallopt(M_TOP_PAD, 4 << 20);
#endif
}

}  // namespace patina
