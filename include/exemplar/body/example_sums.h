// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_example_sums_h
#define exemplar_example_sums_h

#include <exemplar/kernels/matrix3.h>

#include <vector>

namespace Exemplar
{
  /// A sum of some of several strains, as of keys with the weight 1.
  struct AddedStrain
  {
    double                    least = 0.; ///< least eigenvalue of the sum [-]
    std::vector<unsigned int> parts;      ///< strains that shorten its direction by more than 1 %
  };

  /// The sum with the least eigenvalue, which is a corner of 0 <= w_i <= 1 because the least
  /// eigenvalue of sum_i w_i E_i is concave in w. It is looked for by turns: all strains that shorten
  /// a direction, then the direction that their sum shortens most, beginning with that of each strain.
  /// Each turn lessens the eigenvalue; the end is a local minimum.
  AddedStrain
  least_sum_of_strains(const std::vector<Matrix3<double>> &strains);
} // namespace Exemplar

#endif
