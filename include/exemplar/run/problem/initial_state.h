// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_initial_state_h
#define exemplar_initial_state_h

#include <exemplar/body/example_weights.h>
#include <exemplar/body/fe_space.h>
#include <exemplar/body/state.h>
#include <exemplar/run/scene/initial_parameters.h>

namespace Exemplar
{
  /// The state before the first step: the rest pose or that of Initial, which must be among
  /// `poses`, with Initial/Velocity if `dynamic`; weight one on the first example, or the
  /// prescribed weights at t = 0. Throws UserError if the pose is missing.
  State
  initial_state(const InitialParameters &parameters,
                const Mesh              &mesh,
                const FESpace           &fe_space,
                const ExampleWeights    &weights,
                bool                     dynamic,
                const NamedPoses        &poses = {});
} // namespace Exemplar

#endif
