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
    /// Both must outlive the object; `order`: of how many velocities it makes the next one, 1 to
    /// LinearPrediction::max_order.
    MotionPrediction(const FreeDofs &free_dofs, const Handles &handles, unsigned int order);

    /// Put `trial`, which is at the positions of `accepted` but has the time of the step's end,
    /// where the last velocities lead in a step of length h [s]. To be called once a step.
    void
    predict(const State &accepted, double step_size, State &trial);

    /// Undo the last predict(), whose step is abandoned: the same velocity is added when that step is made.
    void
    take_back()
    {
      velocities.take_back();
    }

    void
    forget()
    {
      velocities = LinearPrediction(free_dofs.exchange(), order);
    }

    std::size_t
    memory_consumption() const
    {
      return velocities.memory_consumption();
    }

    /// For checkpoints: of the whole body.
    template <typename Archive>
    void
    save(Archive &archive) const
    {
      std::deque<std::vector<double>> history = velocities.vectors();
      for (std::vector<double> &vector : history)
        vector = free_dofs.whole(vector);
      archive &history;
    }

    template <typename Archive>
    void
    load(Archive &archive)
    {
      std::deque<std::vector<double>> history;
      archive                        &history;
      for (std::vector<double> &vector : history)
        vector = free_dofs.part(vector);
      velocities.restore(std::move(history));
    }

  private:
    const FreeDofs  &free_dofs;
    const Handles   &handles;
    unsigned int     order;
    LinearPrediction velocities; ///< of the last steps, by free degree of freedom

    std::vector<double> velocity; ///< memory of predict()
  };
} // namespace Exemplar

#endif
