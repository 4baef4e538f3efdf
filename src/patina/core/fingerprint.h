#pragma once
// A short name for many texts and numbers: equal inputs have equal fingerprints.

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "patina/core/hash.h"

namespace patina {

class Fingerprint {
  public:
    void add(std::string_view text) { value_ = fnv1a_64(text, value_); }
    void add(double value) {
        const auto bytes = std::bit_cast<std::array<char, sizeof value>>(value);
        add(std::string_view(bytes.data(), bytes.size()));
    }
    std::uint64_t value() const { return value_; }
    // 16 hexadecimal digits.
    std::string hex() const { return fmt::format("{:016x}", value_); }

  private:
    std::uint64_t value_ = fnv1a_64({});
};

}  // namespace patina
