#pragma once
// Random numbers that depend on (pixel, sample, seed) only, so that pictures do not depend on the number of threads.

#include <cstdint>

#include "patina/render/vec.h"

namespace patina::render {

// Mixes the bits of a 32-bit word (Mueller's constants found by Wellons' hash prospector, 2018: bias 0.17).
inline std::uint32_t mix_bits(std::uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

inline float unit_float(std::uint32_t bits) {
    return static_cast<float>(bits >> 8) * 0x1p-24f;
}  // [0, 1)

inline std::uint32_t reverse_bits(std::uint32_t x) {
    x = __builtin_bswap32(x);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
    x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
    return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

// Owen's nested uniform scrambling of a number whose digits are in reversed order, by hashing (Laine & Karras 2011;
// constants of Burley 2020, Practical hash-based Owen scrambling, listing 4).
inline std::uint32_t scramble_reversed(std::uint32_t x, std::uint32_t seed) {
    x += seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    return x ^ x * 0x8d22f6e6u;
}

// Multiplies the digits of x by Pascal's triangle modulo 2: digit j of the result is the sum of the digits i with j a
// subset of i, bit by bit (Lucas' theorem). It turns the van der Corput sequence into the second dimension of Sobol's.
inline std::uint32_t pascal_transform(std::uint32_t x) {
    x ^= (x >> 1) & 0x55555555u;
    x ^= (x >> 2) & 0x33333333u;
    x ^= (x >> 4) & 0x0f0f0f0fu;
    x ^= (x >> 8) & 0x00ff00ffu;
    return x ^ ((x >> 16) & 0x0000ffffu);
}

// The stream of one path. Pairs are the Owen-scrambled (0,2)-sequence of Sobol, padded: each draw has its own
// scrambling and its own shuffled order, so draws are independent of each other and each is well stratified over the
// pixel's samples.
class Sampler {
  public:
    Sampler(std::uint32_t pixel, std::uint32_t sample, std::uint64_t seed)
        : key_(mix_bits(pixel ^ mix_bits(static_cast<std::uint32_t>(seed) ^
                                         mix_bits(static_cast<std::uint32_t>(seed >> 32) + 0x9e3779b9u)))),
          sample_(sample) {}

    // Continues with draw number `draw`, so that the same decision of every path shares one stratified set.
    void seek(std::uint32_t draw) { draw_ = draw; }

    float next() {
        const std::uint32_t key = next_key();
        return unit_float(reverse_bits(scramble_reversed(shuffled_index(key), mix_bits(key ^ 0xa511e9b3u))));
    }
    Vec2 next2() {
        const std::uint32_t key = next_key(), index = shuffled_index(key);
        const std::uint32_t x = reverse_bits(scramble_reversed(index, mix_bits(key ^ 0xa511e9b3u)));
        const std::uint32_t y = reverse_bits(scramble_reversed(pascal_transform(index), mix_bits(key ^ 0x63d83595u)));
        return {unit_float(x), unit_float(y)};
    }

  private:
    std::uint32_t next_key() { return mix_bits(key_ + 0x9e3779b9u * ++draw_); }
    // The sample's place in this draw's own order; Owen scrambling keeps every aligned block of 2^k samples a block.
    std::uint32_t shuffled_index(std::uint32_t key) const {
        return reverse_bits(scramble_reversed(reverse_bits(sample_), key));
    }

    std::uint32_t key_, sample_, draw_ = 0;
};

}  // namespace patina::render
