#pragma once
// Counter-based random numbers: the n-th number of stream (seed, batch) is a hash of n, whoever draws it.

#include <cstdint>

namespace patina::rt::monte_carlo {

// Finalizer "variant 13" of Stafford as in SplitMix64 (Steele, Lea & Flood 2014, fig. 16).
constexpr std::uint64_t hash64(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
}

// Start and odd stride both depend on the key, so that two streams are different sequences and not shifted copies of
// one.
class RandomStream {
  public:
    RandomStream(std::uint64_t seed, std::uint64_t batch)
        : counter_(hash64(hash64(seed + 0x9e3779b97f4a7c15ull) + batch)),
          stride_(hash64(counter_ ^ 0xd1b54a32d192ed03ull) | 1u) {}

    // Uniform on (0, 1), both ends excluded.
    double uniform() {
        counter_ += stride_;
        return (static_cast<double>(hash64(counter_) >> 12) + 0.5) * 0x1p-52;
    }

  private:
    std::uint64_t counter_, stride_;
};

}  // namespace patina::rt::monte_carlo
