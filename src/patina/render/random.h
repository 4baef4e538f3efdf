#pragma once
// Random numbers that depend on (pixel, sample, seed) only, so that pictures do not depend on the number of threads.

#include <cstdint>

#include "patina/render/vec.h"
#include "patina/render/wide.h"

namespace patina::render {

// The bit operations below are templates over one word (std::uint32_t) or many (WideBits).

// Mixes the bits of a 32-bit word (Mueller's constants found by Wellons' hash prospector, 2018: bias 0.17).
template <class Bits>
Bits mix_bits(Bits x) {
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

inline float unit_float(std::uint32_t bits) {
    return static_cast<float>(bits >> 8) * 0x1p-24f;
}  // [0, 1)
inline WideFloat unit_float(WideBits bits) {
    return __builtin_convertvector((WideInt)(bits >> 8), WideFloat) * 0x1p-24f;
}

template <class Bits>
Bits reverse_bits(Bits x) {
    x = (x << 16) | (x >> 16);
    x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
    x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
    return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}
#if defined(__AVX2__)
// By a table of half bytes, which a shuffle of bytes looks up.
template <>
inline WideBits reverse_bits<WideBits>(WideBits x) {
    constexpr std::uint64_t reversed_low = 0xe060a020c0408000, reversed_high = 0xf070b030d0509010;
    const __m128i table = _mm_set_epi64x(static_cast<long long>(reversed_high), static_cast<long long>(reversed_low));
    const __m128i bytes = _mm_setr_epi8(3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12);
    const WideBits low = x & 0x0f0f0f0fu, high = (x >> 4) & 0x0f0f0f0fu;
#if defined(__AVX512BW__)
    const __m512i raised = _mm512_broadcast_i32x4(table);
    const __m512i lowered = _mm512_srli_epi32(raised, 4);  // half bytes do not cross into their neighbours
    const __m512i turned =
        _mm512_or_si512(_mm512_shuffle_epi8(raised, (__m512i)low), _mm512_shuffle_epi8(lowered, (__m512i)high));
    return (WideBits)_mm512_shuffle_epi8(turned, _mm512_broadcast_i32x4(bytes));
#else
    const __m256i raised = _mm256_broadcastsi128_si256(table);
    const __m256i lowered = _mm256_srli_epi32(raised, 4);
    const __m256i turned =
        _mm256_or_si256(_mm256_shuffle_epi8(raised, (__m256i)low), _mm256_shuffle_epi8(lowered, (__m256i)high));
    return (WideBits)_mm256_shuffle_epi8(turned, _mm256_broadcastsi128_si256(bytes));
#endif
}
#endif

// Owen's nested uniform scrambling of a number whose digits are in reversed order, by hashing (Laine & Karras 2011;
// constants of Burley 2020, Practical hash-based Owen scrambling, listing 4).
template <class Bits>
Bits scramble_reversed(Bits x, Bits seed) {
    x += seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    return x ^ x * 0x8d22f6e6u;
}

// Multiplies the digits of x by Pascal's triangle modulo 2: digit j of the result is the sum of the digits i with j a
// subset of i, bit by bit (Lucas' theorem). It turns the van der Corput sequence into the second dimension of Sobol's.
template <class Bits>
Bits pascal_transform(Bits x) {
    x ^= (x >> 1) & 0x55555555u;
    x ^= (x >> 2) & 0x33333333u;
    x ^= (x >> 4) & 0x0f0f0f0fu;
    x ^= (x >> 8) & 0x00ff00ffu;
    return x ^ ((x >> 16) & 0x0000ffffu);
}

// Draw number `draw` of a path. Pairs are the Owen-scrambled (0,2)-sequence of Sobol, padded: each draw has its own
// scrambling and its own shuffled order, so draws are independent of each other and each is well stratified over the
// pixel's samples.
template <class Bits>
struct Draw {
    Bits key, index;

    Draw(Bits path_key, Bits sample, std::uint32_t draw)
        : key(mix_bits<Bits>(path_key + 0x9e3779b9u * draw)),
          // The sample's place in this draw's own order; Owen scrambling keeps every aligned block of 2^k samples one.
          index(reverse_bits<Bits>(scramble_reversed<Bits>(reverse_bits<Bits>(sample), key))) {}
    auto x() const {
        return unit_float(reverse_bits<Bits>(scramble_reversed<Bits>(index, mix_bits<Bits>(key ^ 0xa511e9b3u))));
    }
    auto y() const {
        return unit_float(reverse_bits<Bits>(
            scramble_reversed<Bits>(pascal_transform<Bits>(index), mix_bits<Bits>(key ^ 0x63d83595u))));
    }
};

// What all samples of a picture have in common.
inline std::uint32_t seed_key(std::uint64_t seed) {
    return mix_bits(static_cast<std::uint32_t>(seed) ^ mix_bits(static_cast<std::uint32_t>(seed >> 32) + 0x9e3779b9u));
}

// The stream of one path.
class Sampler {
  public:
    Sampler() = default;
    Sampler(std::uint32_t pixel, std::uint32_t sample, std::uint64_t seed)
        : key_(mix_bits(pixel ^ seed_key(seed))), sample_(sample) {}

    // Continues with draw number `draw`, so that the same decision of every path shares one stratified set.
    void seek(std::uint32_t draw) { draw_ = draw; }

    float next() { return Draw<std::uint32_t>(key_, sample_, ++draw_).x(); }
    Vec2 next2() {
        const Draw<std::uint32_t> draw(key_, sample_, ++draw_);
        return {draw.x(), draw.y()};
    }

  private:
    friend class SamplerBlock;
    std::uint32_t key_ = 0, sample_ = 0, draw_ = 0;
};

// The same draws for many paths at once, whose samplers stay where they are.
class SamplerBlock {
  public:
    void set(int lane, const Sampler& sampler) {
        key_[lane] = sampler.key_;
        sample_[lane] = sampler.sample_;
    }
    // What the first call of next() or next2() after seek(draw) gives each path.
    WideFloat next(std::uint32_t draw) const { return Draw<WideBits>(key_.load(), sample_.load(), draw + 1).x(); }
    void next2(std::uint32_t draw, FloatLanes& x, FloatLanes& y) const {
        const Draw<WideBits> wide(key_.load(), sample_.load(), draw + 1);
        x.store(wide.x());
        y.store(wide.y());
    }

  private:
    BitLanes key_, sample_;
};

}  // namespace patina::render
