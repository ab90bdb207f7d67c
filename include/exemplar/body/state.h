// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_state_h
#define exemplar_state_h

#include <exemplar/body/example_weights.h>
#include <exemplar/body/fe_space.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/lac/vector.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// Subsection Initial.
  struct InitialParameters
  {
    std::string pose;
    std::string pose_function;
    std::string velocity = "0; 0; 0";

    void
    declare(dealii::ParameterHandler &prm);
  };

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

  /// The state before the first step: the rest pose or the one that Initial asks
  /// for, moving with Initial/Velocity if `dynamic`; weight one on the first
  /// example, or the prescribed weights at t = 0. `weights` may be null.
  State
  initial_state(const InitialParameters &parameters,
                const Mesh              &mesh,
                const FESpace           &fe_space,
                const ExampleWeights    *weights,
                bool                     dynamic);
} // namespace Exemplar

#endif
