// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/solvers/motion_prediction.h>

namespace Exemplar
{
  MotionPrediction::MotionPrediction(const FreeDofs    &free_dofs,
                                     const Handles     &handles,
                                     const unsigned int order)
      : free_dofs(free_dofs), handles(handles), order(order),
        velocities(free_dofs.exchange(), order)
  {
  }

  void
  MotionPrediction::predict(const State &accepted, const double step_size, State &trial)
  {
    free_dofs.gather(accepted.velocities, velocity);
    velocities.add(velocity);
    velocities.predict(velocity);
    free_dofs.add(step_size, velocity, trial.positions);
    handles.move(trial.time, trial.positions);
  }
} // namespace Exemplar
