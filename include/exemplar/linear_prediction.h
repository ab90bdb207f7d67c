// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_linear_prediction_h
#define exemplar_linear_prediction_h

#include <deque>
#include <vector>

namespace Exemplar
{
  /// The next vector of a sequence, `history` with the newest first: the combination of all
  /// but the oldest that, one place earlier, comes closest to the newest, sum_j a_j v_(n-j)
  /// with |v_n - sum_j a_j v_(n-1-j)| least. Polynomials and damped oscillations in time are
  /// continued exactly, as far as the history is long enough. A history of one is constant;
  /// it must not be empty.
  std::vector<double>
  predict_next(const std::deque<std::vector<double>> &history);
} // namespace Exemplar

#endif
