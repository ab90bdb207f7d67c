// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/algebra/single_precision_inverse.h>

namespace Exemplar
{
  void
  apply_in_single_precision(MultifrontalFactor<float> &factor, std::vector<double> &columns)
  {
    const std::size_t   n = factor.get_structure().n(), n_columns = n == 0 ? 0 : columns.size() / n;
    std::vector<double> scales(n_columns);
    std::vector<float>  rounded(columns.size());
    for (std::size_t k = 0; k < n_columns; ++k)
    {
      // scaled: forces that shrink by ten orders of magnitude would underflow in single precision
      double *column = columns.data() + k * n;
      scales[k]      = max_entry(column, column + n);
      for (std::size_t i = 0; i < n && scales[k] != 0.; ++i)
        rounded[k * n + i] = static_cast<float>(column[i] / scales[k]);
    }
    factor.solve(rounded);
    for (std::size_t k = 0; k < n_columns; ++k)
      for (std::size_t i = 0; i < n; ++i)
        columns[k * n + i] = scales[k] * factor.get_scale() * rounded[k * n + i];
  }

  double
  SinglePrecisionInverse::cost_in_iterations(std::size_t /*n_columns*/) const // columns cost little
  {
    // nanoseconds on the machine of doc/measured.md, of which only the ratio matters
    const FactorStructure &structure = factor->get_structure();
    const auto             n         = static_cast<double>(structure.n()),
               n_values              = static_cast<double>(structure.n_values());
    return (0.022 * structure.n_operations + 7. * n_values) / (60. * n + 0.25 * n_values);
  }
} // namespace Exemplar
