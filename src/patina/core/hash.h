#pragma once
// A hash for telling contents apart; not for secrets.

#include <cstdint>
#include <string_view>

namespace patina {

// Fowler, Noll & Vo's FNV-1a of 64 bits. Long contents go in piece by piece: pass the result of the piece before.
constexpr std::uint64_t fnv1a_64(std::string_view bytes, std::uint64_t before = 14695981039346656037ull) {
    for (const char c : bytes) before = (before ^ static_cast<unsigned char>(c)) * 1099511628211ull;
    return before;
}

}  // namespace patina
