// Random numbers: an Owen-scrambled Sobol' sequence for points on a source, and a small stream for resampling.
//
// Everything is a pure function of its seed: the same on every machine, in every thread, in every order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>

namespace gnomon {

/// Avalanches 64 bits: number x of the SplitMix64 stream (Steele, Lea, Flood 2014).
constexpr std::uint64_t mixBits(std::uint64_t x) {
  x = (x + 1u) * 0x9e3779b97f4a7c15u;  // near inputs must start far apart: the finaliser alone leaves them dependent
  x = (x ^ (x >> 30u)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27u)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31u);
}

/// Seed of one pixel's sequence. `stream` tells uses apart: the halves of a reference, lights, techniques.
constexpr std::uint32_t pixelSeed(std::uint32_t x, std::uint32_t y, std::uint32_t stream) {
  return static_cast<std::uint32_t>(mixBits(mixBits((std::uint64_t{y} << 32u) | x) ^ stream) >> 32u);
}

constexpr std::uint32_t reverseBits(std::uint32_t x) {
  x = ((x & 0x55555555u) << 1u) | ((x >> 1u) & 0x55555555u);
  x = ((x & 0x33333333u) << 2u) | ((x >> 2u) & 0x33333333u);
  x = ((x & 0x0f0f0f0fu) << 4u) | ((x >> 4u) & 0x0f0f0f0fu);
  x = ((x & 0x00ff00ffu) << 8u) | ((x >> 8u) & 0x00ff00ffu);
  return (x << 16u) | (x >> 16u);
}

/// A (0,2)-sequence in base 2: the first two dimensions of Sobol', each scrambled as Owen (1995) by a hash in the manner of
/// Laine and Karras (2011) and Burley (2020). Each aligned run of 2^k points has exactly one in every elementary interval
/// of area 2^-k; each single point is uniform over seeds, so any integral's estimate is unbiased; its variance falls as
/// n^-1.5 across a straight edge. Make one object a pixel and ask it for points 0, 1, 2...
class SobolOwen2 {
 public:
  constexpr explicit SobolOwen2(std::uint32_t seed)
      : first_(mixBits(seed)), second_(mixBits(first_ ^ 0x6a09e667f3bcc908u)) {}  // any constant: two unrelated trees

  /// Both coordinates as fractions of 2^32.
  constexpr glm::uvec2 bits(std::uint32_t index) const {
    return {reverseBits(nestedScramble(index, first_)), reverseBits(nestedScramble(pascal(index), second_))};
  }

  /// In the open square (0,1)^2: centres of 2^-32 cells, exact in double.
  glm::dvec2 operator()(std::uint32_t index) const {
    const glm::uvec2 b = bits(index);
    return {(b.x + 0.5) * 0x1p-32, (b.y + 0.5) * 0x1p-32};
  }

 private:
  /// Sobol's second dimension with its digits reversed. Its generator matrix is Pascal's triangle modulo 2, so digit i is the
  /// sum of the index bits j with C(j, i) odd, which are the j whose bits contain those of i (Lucas): a superset sum.
  static constexpr std::uint32_t pascal(std::uint32_t x) {
    x ^= (x & 0xaaaaaaaau) >> 1u;
    x ^= (x & 0xccccccccu) >> 2u;
    x ^= (x & 0xf0f0f0f0u) >> 4u;
    x ^= (x & 0xff00ff00u) >> 8u;
    return x ^ (x >> 16u);
  }

  /// Owen's scramble on reversed digits: each bit is flipped by a function of the lower bits alone, because sums, products
  /// with odd numbers and x ^= x * even carry only upwards. The odd product comes from the seed: with the sum alone
  /// (Laine and Karras) the flips of two sibling nodes would be tied to their parent's. Even constants: Burley 2020.
  static constexpr std::uint32_t nestedScramble(std::uint32_t x, std::uint64_t seed) {
    x += static_cast<std::uint32_t>(seed);
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x *= static_cast<std::uint32_t>(seed >> 32u) | 1u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return x;
  }

  std::uint64_t first_;
  std::uint64_t second_;
};

/// One point of SobolOwen2(seed), where there is no place to keep the object.
inline glm::dvec2 sobolOwen2(std::uint32_t index, std::uint32_t seed) {
  return SobolOwen2(seed)(index);
}

/// A stream of independent numbers (SplitMix64) for bootstraps and tests.
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed);
  std::uint64_t next() { return mixBits(counter_++); }
  /// In [0,1).
  double uniform() { return static_cast<double>(next() >> 11u) * 0x1p-53; }
  /// In [0,count); count > 0.
  std::size_t below(std::size_t count);
  /// Standard normal.
  double normal();

 private:
  std::uint64_t counter_;
};

}  // namespace gnomon
