// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_long_vectors_h
#define exemplar_long_vectors_h

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace Exemplar
{
  /// With as many entries of b as a has.
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

  /// The greater of two numbers; a NaN is the greatest, which std::max may pass over.
  inline double
  max_or_nan(const double a, const double b)
  {
    return a > b || std::isnan(a) ? a : b;
  }

  /// max |a_i|.
  inline double
  max_entry(const std::vector<double> &a)
  {
    double greatest = 0.;
    for (const double entry : a)
      greatest = std::max(greatest, std::abs(entry));
    return greatest;
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
