#pragma once
// Samples that came out as NaN or infinity: told from others, and counted with the places of the first ones.

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "patina/render/packet.h"

namespace patina::render {

inline bool all_finite(const StokesPacket& s) {
    constexpr std::int32_t exponent = 0x7f800000;  // all ones in infinities and NaN
    Mask4 bad{};
    for (int row = 0; row < 4; ++row) bad |= ((Mask4)stokes_row(s, row) & exponent) == exponent;
    return !(bad[0] | bad[1] | bad[2] | bad[3]);
}

// Thread-safe while samples are noted.
class NonFiniteSamples {
  public:
    void note(int x, int y, int sample) {
        const std::lock_guard lock(mutex_);
        ++count_;
        if (places_.size() < 8) places_.push_back(fmt::format("({}, {}) sample {}", x, y, sample));
    }
    void set(std::int64_t count, std::vector<std::string> places) {
        count_ = count;
        places_ = std::move(places);
    }
    std::int64_t count() const { return count_; }
    const std::vector<std::string>& places() const { return places_; }
    std::string text() const { return fmt::format("{}", fmt::join(places_, "; ")); }

  private:
    std::int64_t count_ = 0;
    std::mutex mutex_;
    std::vector<std::string> places_;
};

}  // namespace patina::render
