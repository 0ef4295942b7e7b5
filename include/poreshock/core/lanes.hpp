#pragma once
// Eight doubles that move together: one node of the background grid, one cache line, or one number
// of eight nodes. The width is fixed, so every instruction set does the same arithmetic lane by
// lane.

#include <cmath>
#ifdef __FMA__
#include <immintrin.h>
#endif

namespace poreshock {

/// Four doubles with element-wise + - * /; may lie at any address of a double.
typedef double HalfLanes __attribute__((vector_size(32), aligned(8)));

inline constexpr int lane_count = 8;

#ifdef __AVX512F__

/// Eight of them.
typedef double Lanes __attribute__((vector_size(64), aligned(8)));

inline HalfLanes low_half(const Lanes& x) {
  return __builtin_shufflevector(x, x, 0, 1, 2, 3);
}

inline HalfLanes high_half(const Lanes& x) {
  return __builtin_shufflevector(x, x, 4, 5, 6, 7);
}

inline Lanes join(const HalfLanes& low, const HalfLanes& high) {
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}

#else

/// Eight of them where no register is as wide: as one vector they would live in memory only.
struct [[gnu::may_alias]] Lanes {  // like vectors, it aliases doubles
  HalfLanes low, high;

  /// Not set, like a vector of the compiler.
  constexpr Lanes() = default;
  constexpr Lanes(const HalfLanes& first, const HalfLanes& second) : low(first), high(second) {}
  // Written out: the compiler copies structs in pieces, for which loads of a half would wait.
  constexpr Lanes(const Lanes& x) : low(x.low), high(x.high) {}
  constexpr Lanes& operator=(const Lanes& x) {
    low = x.low, high = x.high;
    return *this;
  }
  /// Lanes that are not given are 0.
  constexpr Lanes(double x0, double x1, double x2 = 0.0, double x3 = 0.0, double x4 = 0.0,
                  double x5 = 0.0, double x6 = 0.0, double x7 = 0.0)
      : low{x0, x1, x2, x3}, high{x4, x5, x6, x7} {}

  double& operator[](int k) { return reinterpret_cast<double*>(this)[k]; }
  const double& operator[](int k) const { return reinterpret_cast<const double*>(this)[k]; }

  friend constexpr Lanes operator+(const Lanes& a, const Lanes& b) {
    return {a.low + b.low, a.high + b.high};
  }
  friend constexpr Lanes operator-(const Lanes& a, const Lanes& b) {
    return {a.low - b.low, a.high - b.high};
  }
  friend constexpr Lanes operator*(const Lanes& a, const Lanes& b) {
    return {a.low * b.low, a.high * b.high};
  }
  friend constexpr Lanes operator-(double a, const Lanes& b) { return {a - b.low, a - b.high}; }
  friend constexpr Lanes operator*(double a, const Lanes& b) { return {a * b.low, a * b.high}; }
  friend constexpr Lanes operator*(const Lanes& a, double b) { return {a.low * b, a.high * b}; }
  friend constexpr Lanes operator-(const Lanes& a, double b) { return {a.low - b, a.high - b}; }
  friend constexpr Lanes operator/(const Lanes& a, double b) { return {a.low / b, a.high / b}; }
  friend constexpr Lanes operator/(const Lanes& a, const Lanes& b) {
    return {a.low / b.low, a.high / b.high};
  }
  constexpr Lanes& operator+=(double b) { return *this = Lanes(low + b, high + b); }
  constexpr Lanes& operator+=(const Lanes& b) { return *this = *this + b; }
  constexpr Lanes& operator*=(double b) { return *this = *this * b; }
};

inline HalfLanes low_half(const Lanes& x) {
  return x.low;
}

inline HalfLanes high_half(const Lanes& x) {
  return x.high;
}

inline Lanes join(const HalfLanes& low, const HalfLanes& high) {
  return {low, high};
}

#endif

/// The larger of two numbers, lane by lane.
inline HalfLanes larger(const HalfLanes& a, const HalfLanes& b) {
  return a < b ? b : a;
}

/// x where a and b differ, else y, lane by lane.
inline HalfLanes where_differ(const HalfLanes& a, const HalfLanes& b, const HalfLanes& x,
                              const HalfLanes& y) {
  return a != b ? x : y;
}

/// x where a is less than b, else y, lane by lane.
inline HalfLanes where_less(const HalfLanes& a, const HalfLanes& b, const HalfLanes& x,
                            const HalfLanes& y) {
  return a < b ? x : y;
}

inline Lanes larger(const Lanes& a, const Lanes& b) {
#ifdef __AVX512F__
  return a < b ? b : a;
#else
  return {larger(a.low, b.low), larger(a.high, b.high)};
#endif
}

inline Lanes where_differ(const Lanes& a, const Lanes& b, const Lanes& x, const Lanes& y) {
#ifdef __AVX512F__
  return a != b ? x : y;
#else
  return {where_differ(a.low, b.low, x.low, y.low), where_differ(a.high, b.high, x.high, y.high)};
#endif
}

inline Lanes where_less(const Lanes& a, const Lanes& b, const Lanes& x, const Lanes& y) {
#ifdef __AVX512F__
  return a < b ? x : y;
#else
  return {where_less(a.low, b.low, x.low, y.low), where_less(a.high, b.high, x.high, y.high)};
#endif
}

/// Bit k is set where lane k of a is less than that of b.
inline unsigned bits_less(const Lanes& a, const Lanes& b) {
#if defined(__AVX512F__)
  return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ);
#elif defined(__FMA__)
  const auto bits = [](const HalfLanes& x, const HalfLanes& y) {
    return static_cast<unsigned>(_mm256_movemask_pd(_mm256_cmp_pd(x, y, _CMP_LT_OQ)));
  };
  return bits(low_half(a), low_half(b)) | bits(high_half(a), high_half(b)) << 4;
#else
  unsigned bits = 0;
  for (int k = 0; k < lane_count; ++k) bits |= (a[k] < b[k] ? 1u : 0u) << k;
  return bits;
#endif
}

/// Bits of the first `count` lanes.
inline unsigned first_bits(int count) {
  return (1u << count) - 1u;
}

/// The square root, lane by lane.
inline Lanes square_root(const Lanes& x) {
#if defined(__AVX512F__)
  return _mm512_maskz_sqrt_pd(0xff, x);  // without a mask GCC warns of its header
#elif defined(__FMA__)
  return join(_mm256_sqrt_pd(low_half(x)), _mm256_sqrt_pd(high_half(x)));
#else
  Lanes result;
  for (int k = 0; k < lane_count; ++k) result[k] = std::sqrt(x[k]);
  return result;
#endif
}

/// a b + c rounded once, lane by lane. The result is the same without the instruction; the compiler
/// does not find it by itself in every loop.
inline Lanes fused(const Lanes& a, const Lanes& b, const Lanes& c) {
#if defined(__AVX512F__)
  return _mm512_fmadd_pd(a, b, c);
#elif defined(__FMA__)
  return join(_mm256_fmadd_pd(low_half(a), low_half(b), low_half(c)),
              _mm256_fmadd_pd(high_half(a), high_half(b), high_half(c)));
#else
  Lanes result;
  for (int k = 0; k < lane_count; ++k) result[k] = std::fma(a[k], b[k], c[k]);
  return result;
#endif
}

/// The same with one factor for all lanes.
inline Lanes fused(double a, const Lanes& b, const Lanes& c) {
  return fused(a - Lanes{}, b, c);
}
inline HalfLanes fused(double a, const HalfLanes& b, const HalfLanes& c) {
#ifdef __FMA__
  return _mm256_fmadd_pd(a - HalfLanes{}, b, c);
#else
  HalfLanes result{};
  for (int k = 0; k < lane_count / 2; ++k) result[k] = std::fma(a, b[k], c[k]);
  return result;
#endif
}

/// Turns four vectors of four numbers.
inline void transpose_halves(HalfLanes& a, HalfLanes& b, HalfLanes& c, HalfLanes& d) {
  const HalfLanes even_ab = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  const HalfLanes odd_ab = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const HalfLanes even_cd = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const HalfLanes odd_cd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(even_ab, even_cd, 0, 1, 4, 5);
  b = __builtin_shufflevector(odd_ab, odd_cd, 0, 1, 4, 5);
  c = __builtin_shufflevector(even_ab, even_cd, 2, 3, 6, 7);
  d = __builtin_shufflevector(odd_ab, odd_cd, 2, 3, 6, 7);
}

/// Turns eight vectors of one number each into eight vectors of one node each, and back.
inline void transpose(Lanes* x) {
#ifdef __AVX512F__
  Lanes y[lane_count];
  for (int k = 0; k < lane_count; k += 2) {
    y[k] = __builtin_shufflevector(x[k], x[k + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    y[k + 1] = __builtin_shufflevector(x[k], x[k + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  for (int k = 0; k < lane_count; k += 4) {
    for (int j = k; j < k + 2; ++j) {
      x[j] = __builtin_shufflevector(y[j], y[j + 2], 0, 1, 8, 9, 4, 5, 12, 13);
      x[j + 2] = __builtin_shufflevector(y[j], y[j + 2], 2, 3, 10, 11, 6, 7, 14, 15);
    }
  }
  for (int k = 0; k < lane_count / 2; ++k) {
    const Lanes low = x[k], high = x[k + 4];
    x[k] = __builtin_shufflevector(low, high, 0, 1, 2, 3, 8, 9, 10, 11);
    x[k + 4] = __builtin_shufflevector(low, high, 4, 5, 6, 7, 12, 13, 14, 15);
  }
#else
  transpose_halves(x[0].low, x[1].low, x[2].low, x[3].low);
  transpose_halves(x[4].high, x[5].high, x[6].high, x[7].high);
  transpose_halves(x[0].high, x[1].high, x[2].high, x[3].high);
  transpose_halves(x[4].low, x[5].low, x[6].low, x[7].low);
  for (int k = 0; k < lane_count / 2; ++k) {
    // Not std::swap: a template argument forgets that the lanes may lie at any address.
    const HalfLanes high = x[k].high;
    x[k].high = x[k + 4].low;
    x[k + 4].low = high;
  }
#endif
}

}  // namespace poreshock
