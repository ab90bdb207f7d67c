// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_state_h
#define exemplar_state_h

#include <deal.II/lac/vector.h>

#include <vector>

namespace Exemplar
{
  /// What a step starts from and ends in.
  struct State
  {
    unsigned int           step = 0;
    double                 time = 0.;           ///< [s]
    dealii::Vector<double> positions;           ///< [m], by degree of freedom 3 i + c
    dealii::Vector<double> velocities;          ///< [m/s]; empty unless dynamic
    dealii::Vector<double> previous_positions;  ///< before the last step; empty unless
    dealii::Vector<double> previous_velocities; ///< the time scheme has two steps
    double                 previous_step = 0.;  ///< size of the last step [s]; 0: none
    std::vector<double>    weights;             ///< of the examples; empty without examples
    std::vector<double>    multipliers;         ///< of each region's sum of weights to find [J]
  };
} // namespace Exemplar

#endif
