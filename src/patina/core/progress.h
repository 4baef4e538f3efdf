#pragma once
// Progress and cancellation: what long work tells its caller, and how it is told to stop.

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

#include "patina/core/error.h"

namespace patina {

// Set from a signal handler or another thread; long work polls it between passes.
class CancelToken {
  public:
    void request_stop() { stop_.store(true, std::memory_order_relaxed); }
    bool stop_requested() const { return stop_.load(std::memory_order_relaxed); }

  private:
    std::atomic<bool> stop_{false};
};

// Throws Error(interrupted) when a stop was requested: called by long work that has nothing to show before its end.
inline void stop_if_requested(const CancelToken* cancel) {
    if (cancel && cancel->stop_requested()) throw Error(ErrorKind::interrupted, "stopped before there was a result");
}

// A snapshot of work under way.
struct ProgressReport {
    std::string stage;       // "solving", "rendering", ...
    std::int64_t done = 0;   // units finished
    std::int64_t total = 0;  // units in all; 0 when not known
    std::string detail;      // "550 nm", "64 spp, noise 0.8 %"
    double part = 0.0;       // done of the units under way, in units: with `done` it tells the time left
};

// How long work reports; called from any thread, so the receiver must be thread-safe. Empty = silent.
using ProgressCallback = std::function<void(const ProgressReport&)>;

// What a job is given besides its inputs.
struct JobControl {
    ProgressCallback progress;
    const CancelToken* cancel = nullptr;

    void report(const ProgressReport& report) const {
        if (progress) progress(report);
    }
    bool stop_requested() const { return cancel && cancel->stop_requested(); }
};

}  // namespace patina
