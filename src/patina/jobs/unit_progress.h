#pragma once
// Progress of units that are worked on in parallel and tell how far each has come.

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "patina/core/progress.h"

namespace patina::jobs {

// Thread-safe. A stage without a name is not reported.
class UnitProgress {
  public:
    UnitProgress(const JobControl& control, std::string stage, std::size_t units)
        : control_(control), stage_(std::move(stage)), share_(units, 0.0) {}

    // `share` of a unit is done, 0 to 1.
    void tell(std::size_t unit, double share, const std::string& detail) {
        const std::lock_guard lock(mutex_);
        share_[unit] = share;
        std::int64_t done = 0;
        double part = 0.0;
        for (const double each : share_)
            if (each == 1.0)
                ++done;
            else
                part += each;
        if (!stage_.empty()) control_.report({stage_, done, std::ssize(share_), detail, part});
    }

  private:
    const JobControl& control_;
    std::string stage_;
    std::vector<double> share_;
    std::mutex mutex_;
};

}  // namespace patina::jobs
