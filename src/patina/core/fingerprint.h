#pragma once
// A short name for many texts and numbers: equal inputs have equal fingerprints.

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace patina {

// Fowler, Noll & Vo's FNV-1a of 64 bits; no protection against who wants two inputs to look alike.
class Fingerprint {
  public:
    void add(std::string_view text) {
        for (const char c : text) value_ = (value_ ^ static_cast<unsigned char>(c)) * 0x100000001b3;
    }
    void add(double value) {
        const auto bytes = std::bit_cast<std::array<char, sizeof value>>(value);
        add(std::string_view(bytes.data(), bytes.size()));
    }
    std::uint64_t value() const { return value_; }
    // 16 hexadecimal digits.
    std::string hex() const { return fmt::format("{:016x}", value_); }

  private:
    std::uint64_t value_ = 0xcbf29ce484222325;
};

}  // namespace patina
