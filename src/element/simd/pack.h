/// A register of doubles: kWidth of them, from GCC's vector extensions (clang has them too). Included once per
/// instruction set inside that set's namespace, so that no function of it can be merged with another set's by the
/// linker.

/// kWidth lanes; arithmetic by lane.
struct Pack {
  typedef double Native __attribute__((vector_size(8 * kWidth)));
  typedef double InMemory __attribute__((vector_size(8 * kWidth), may_alias));  // doubles of an array
  typedef long long Bits __attribute__((vector_size(8 * kWidth)));

  Native v;

  Pack() = default;
  RHEXIS_INLINE Pack(Native value) : v(value) {}
  RHEXIS_INLINE Pack(double value) : v(value * (Native{} + 1.0)) {}

  /// `from` is aligned to the register.
  RHEXIS_INLINE static Pack load(const double* from) { return *reinterpret_cast<const InMemory*>(from); }
  RHEXIS_INLINE void store(double* to) const { *reinterpret_cast<InMemory*>(to) = v; }

  friend RHEXIS_INLINE Pack operator+(Pack a, Pack b) { return a.v + b.v; }
  friend RHEXIS_INLINE Pack operator-(Pack a, Pack b) { return a.v - b.v; }
  friend RHEXIS_INLINE Pack operator*(Pack a, Pack b) { return a.v * b.v; }
  friend RHEXIS_INLINE Pack operator/(Pack a, Pack b) { return a.v / b.v; }
  friend RHEXIS_INLINE Pack operator-(Pack a) { return -a.v; }
};

/// Lanes of `yes` where a < b, of `no` elsewhere (NaN compares false).
RHEXIS_INLINE Pack where_less(Pack a, Pack b, Pack yes, Pack no) {
  const Pack::Bits mask = a.v < b.v;
  return reinterpret_cast<Pack::Native>((mask & reinterpret_cast<Pack::Bits>(yes.v)) |
                                        (~mask & reinterpret_cast<Pack::Bits>(no.v)));
}

RHEXIS_INLINE Pack abs(Pack a) {
  const Pack::Bits mask = (Pack::Bits{} + 0x7fffffffffffffffLL);
  return reinterpret_cast<Pack::Native>(reinterpret_cast<Pack::Bits>(a.v) & mask);
}

/// True when a < b in every lane.
RHEXIS_INLINE bool all_less(Pack a, Pack b) {
  const Pack::Bits mask = a.v < b.v;
  long long all = -1;
  RHEXIS_UNROLL
  for (int i = 0; i < kWidth; ++i) all &= mask[i];
  return all != 0;
}

/// |x|^(-1/3) to rounding, without libm. The exponent divided by -3 on the bits gives 3%; each step of order four takes
/// the error e of x r^3 = 1 - e to 0.14 e^4.
RHEXIS_INLINE Pack inverse_cbrt(Pack x) {
  const Pack magnitude = abs(x);
  Pack::Bits third = reinterpret_cast<Pack::Bits>(magnitude.v) >> 2;  // (1/4)(1 + 1/4)(1 + 1/16)... = 1/3
  third += third >> 2;
  third += third >> 4;
  third += third >> 8;
  third += third >> 16;
  // 4/3 of the bits of 1.0, less 0.03 in the mantissa to centre the error.
  const Pack::Bits start = (Pack::Bits{} + 0x553ef0ff289dd796LL) - third;
  Pack r = reinterpret_cast<Pack::Native>(start);
  RHEXIS_UNROLL
  for (int i = 0; i < 2; ++i) {
    const Pack e = 1.0 - magnitude * (r * r * r);
    r = r + r * e * ((1.0 / 3.0) + e * ((2.0 / 9.0) + (14.0 / 81.0) * e));
  }
  return r;
}
