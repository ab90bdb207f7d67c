// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/single_precision_inverse.h>

namespace Exemplar
{
  double
  SinglePrecisionInverse::cost_in_iterations(std::size_t /*n_columns*/) const // columns cost little
  {
    // nanoseconds on the machine of doc/measured.md, of which only the ratio matters
    const FactorStructure &structure = factor->get_structure();
    const auto             n         = static_cast<double>(structure.n()),
               n_values              = static_cast<double>(structure.n_values());
    return (0.0065 * structure.n_operations + 2.7 * n_values + 270. * n) / (115. * n + 0.2 * n_values);
  }
} // namespace Exemplar
