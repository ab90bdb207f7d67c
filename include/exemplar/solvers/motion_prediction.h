// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_motion_prediction_h
#define exemplar_motion_prediction_h

#include <exemplar/algebra/free_dofs.h>
#include <exemplar/algebra/linear_prediction.h>
#include <exemplar/body/handles.h>
#include <exemplar/body/state.h>

namespace Exemplar
{
  /// Predicts the positions at the end of a step of dynamics from the velocities of the last steps.
  class MotionPrediction
  {
  public:
    /// `handles` is null without handles; both must outlive the object.
    MotionPrediction(const FreeDofs &free_dofs, const Handles *handles);

    /// Put `trial`, which is at the positions of `accepted` but has the time of the step's end,
    /// where the last velocities lead in a step of length h [s]. To be called once a step.
    void
    predict(const State &accepted, double step_size, State &trial);

    void
    forget()
    {
      velocities = LinearPrediction(free_dofs.exchange());
    }

    std::size_t
    memory_consumption() const
    {
      return velocities.memory_consumption();
    }

    /// For checkpoints.
    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      archive &velocities;
    }

  private:
    const FreeDofs  &free_dofs;
    const Handles   *handles;
    LinearPrediction velocities; ///< of the last steps, by free degree of freedom
  };
} // namespace Exemplar

#endif
