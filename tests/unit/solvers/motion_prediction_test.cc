// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/solvers/motion_prediction.h>

#include "scene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace Exemplar::Testing
{
  namespace
  {
    constexpr double h = 0.1;

    /// The bar, held at one end and moved at the other.
    class MotionPredictionTest : public testing::Test
    {
    protected:
      MotionPredictionTest()
          : scene("set Scene = dynamic\n" + bar + drag),
            free_dofs(scene.problem.constraints.free_dofs),
            prediction(free_dofs, scene.problem.constraints.handles, 5), state(scene.problem.state)
      {
      }

      /// Where a step from the state leads whose velocities are v along x and y, and w along z.
      Vector
      predict(const double v, const double w)
      {
        for (unsigned int dof = 0; dof < state.velocities.size(); ++dof)
          state.velocities[dof] = dof % 3 < 2 ? v : w;
        State trial = state;
        trial.time += h;
        prediction.predict(state, h, trial);
        return trial.positions;
      }

      void
      oscillate(const int n_steps)
      {
        for (int step = 0; step < n_steps; ++step)
          predict(std::cos(0.2 * step), std::sin(0.2 * step));
      }

      void
      expect_free_velocity(const Vector &predicted, const double v, const double w) const
      {
        for (const unsigned int dof : free_dofs.list())
          EXPECT_NEAR((predicted[dof] - state.positions[dof]) / h, dof % 3 < 2 ? v : w, 1e-6);
      }

      Scene            scene;
      const FreeDofs  &free_dofs;
      MotionPrediction prediction;
      State            state;
    };

    TEST_F(MotionPredictionTest, GoesOnWithTheVelocityAndMovesTheHandles)
    {
      const Vector predicted = predict(0.7, -0.2);
      expect_free_velocity(predicted, 0.7, -0.2);
      Vector held = state.positions;
      scene.problem.constraints.handles.move(h, held);
      for (unsigned int dof = 0; dof < held.size(); ++dof)
        if (free_dofs.free_index(dof) == FreeDofs::held)
        {
          EXPECT_EQ(predicted[dof], held[dof]);
        }
      EXPECT_GT(max_difference(held, state.positions), 0.05); // 0.6 t of the right end
    }

    TEST_F(MotionPredictionTest, ContinuesAnOscillation)
    {
      oscillate(5);
      expect_free_velocity(predict(std::cos(1.), std::sin(1.)), std::cos(1.2), std::sin(1.2));
    }

    TEST_F(MotionPredictionTest, ForgetsWhatWasBefore)
    {
      oscillate(5);
      prediction.forget();
      expect_free_velocity(predict(0.3, 0.1), 0.3, 0.1);
    }
  } // namespace
} // namespace Exemplar::Testing
