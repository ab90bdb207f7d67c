// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_long_vectors_h
#define exemplar_long_vectors_h

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace Exemplar
{
  /// Scalar product; b has as many entries as a.
  template <typename Number>
  double
  dot(const std::vector<double> &a, const Number *b)
  {
    // several sums, or the additions would wait for each other
    constexpr std::size_t n_sums      = 8;
    double                sum[n_sums] = {};
    std::size_t           i           = 0;
    for (; i + n_sums <= a.size(); i += n_sums)
      for (std::size_t k = 0; k < n_sums; ++k)
        sum[k] += a[i + k] * b[i + k];
    for (; i < a.size(); ++i)
      sum[0] += a[i] * b[i];
    return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
  }

  inline double
  dot(const std::vector<double> &a, const std::vector<double> &b)
  {
    return dot(a, b.data());
  }

  /// The greatest magnitude of numbers; a NaN counts as greater than all, and std::max would lose
  /// it.
  class MaxMagnitude
  {
  public:
    /// Include a number.
    void
    add(const double number)
    {
      // In IEEE 754 the bits of magnitudes, read as integers, are in the order of the magnitudes:
      // numbers, infinity, NaNs. Integers are compared in a cycle, and no NaN needs a branch.
      std::uint64_t bits;
      std::memcpy(&bits, &number, sizeof bits);
      maximum = std::max(maximum, bits & ~sign_bit);
    }

    /// 0 if there were no numbers.
    double
    value() const
    {
      double magnitude;
      std::memcpy(&magnitude, &maximum, sizeof magnitude);
      return magnitude;
    }

  private:
    static constexpr std::uint64_t sign_bit = std::uint64_t(1) << 63;
    std::uint64_t                  maximum  = 0;
  };

  /// max |a_i|, or NaN if one of them is.
  template <typename Iterator>
  double
  max_entry(Iterator entry, const Iterator end)
  {
    MaxMagnitude maximum;
    for (; entry != end; ++entry)
      maximum.add(*entry);
    return maximum.value();
  }

  inline double
  max_entry(const std::vector<double> &a)
  {
    return max_entry(a.begin(), a.end());
  }

  /// The greater of two numbers, or NaN if one of them is: std::max would lose a NaN in b.
  inline double
  max_or_nan(const double a, const double b)
  {
    return b <= a || a != a ? a : b;
  }

  /// The smaller of two numbers, or NaN if one of them is.
  inline double
  min_or_nan(const double a, const double b)
  {
    return b >= a || a != a ? a : b;
  }

  /// a += factor b.
  template <typename Number>
  void
  add(std::vector<double> &a, const double factor, const Number *b)
  {
    for (std::size_t i = 0; i < a.size(); ++i)
      a[i] += factor * b[i];
  }

  inline void
  add(std::vector<double> &a, const double factor, const std::vector<double> &b)
  {
    add(a, factor, b.data());
  }
} // namespace Exemplar

#endif
