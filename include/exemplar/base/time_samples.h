// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_time_samples_h
#define exemplar_time_samples_h

#include <algorithm>
#include <cstddef>
#include <vector>

namespace Exemplar
{
  /// Between which samples a time lies: linear interpolation is (1 - share) times the one before plus share times the next.
  /// Before the first sample and after the last both are that one, and the share is 0.
  struct SamplesAround
  {
    std::size_t before, next;
    double      share;
  };

  /// `times` are ascending and not empty.
  inline SamplesAround
  samples_around(const std::vector<double> &times, const double time)
  {
    const auto after = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time)
                                                - times.begin());
    const std::size_t before = after == 0 ? 0 : after - 1, next = std::min(after, times.size() - 1);
    return { before, next,
             next > before ? (time - times[before]) / (times[next] - times[before]) : 0. };
  }
} // namespace Exemplar

#endif
