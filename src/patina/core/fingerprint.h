#pragma once
// A short name for a long text or for many numbers: equal inputs have equal fingerprints.

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace patina {

// The Fowler-Noll-Vo hash FNV-1a of 64 bits; no protection against who wants two inputs to look alike.
class Fingerprint {
  public:
    void add(std::string_view text) {
        for (const char c : text) add_byte(static_cast<unsigned char>(c));
    }
    void add(double value) {
        auto bits = std::bit_cast<std::uint64_t>(value);
        for (int k = 0; k < 8; ++k, bits >>= 8) add_byte(bits & 0xff);
    }
    std::uint64_t value() const { return value_; }
    // 16 hexadecimal digits.
    std::string hex() const { return fmt::format("{:016x}", value_); }

  private:
    void add_byte(std::uint64_t byte) { value_ = (value_ ^ byte) * 0x100000001b3; }

    std::uint64_t value_ = 0xcbf29ce484222325;
};

}  // namespace patina
