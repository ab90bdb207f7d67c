// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/algebra/single_precision_inverse.h>

namespace Exemplar
{
  namespace
  {
    // Nanoseconds on the machine of doc/speed.md; only their ratio matters.

    double
    factorization_cost(const FactorPanels &panels)
    {
      double operations = 0.;
      for (std::size_t s = 0; s + 1 < panels.first_column.size(); ++s)
      {
        const auto n_rows = static_cast<double>(panels.first_row[s + 1] - panels.first_row[s]);
        for (int k = 0; k < panels.first_column[s + 1] - panels.first_column[s]; ++k)
          operations += (n_rows - k) * (n_rows - k);
      }
      return 0.022 * operations + 7. * static_cast<double>(panels.values.size());
    }

    double
    iteration_cost(const FactorPanels &panels)
    {
      return 60. * static_cast<double>(panels.permutation.size())
             + 0.25 * static_cast<double>(panels.values.size());
    }
  } // namespace

  SinglePrecisionInverse::SinglePrecisionInverse(FactorPanels panels)
      : relative_cost(factorization_cost(panels) / iteration_cost(panels)),
        factor(std::move(panels))
  {
  }

  void
  SinglePrecisionInverse::apply(std::vector<double> &vector)
  {
    // of forces that shrink by ten orders of magnitude single precision would lose the last
    const double scale = max_entry(vector);
    if (scale == 0.)
      return;
    right_side.resize(vector.size());
    for (std::size_t i = 0; i < vector.size(); ++i)
      right_side[i] = static_cast<float>(vector[i] / scale);
    factor.solve(right_side);
    for (std::size_t i = 0; i < vector.size(); ++i)
      vector[i] = scale * right_side[i];
  }

  std::size_t
  SinglePrecisionInverse::memory_consumption() const
  {
    return factor.memory_consumption() + sizeof(float) * right_side.capacity();
  }
} // namespace Exemplar
