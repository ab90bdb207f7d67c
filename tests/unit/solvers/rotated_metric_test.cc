// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/solvers/contact_columns.h>
#include <exemplar/solvers/rotated_metric.h>

#include "body.h"
#include "scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace Exemplar::Testing
{
  namespace
  {
    /// The metric of a body with examples where it was made, and the system that it was made of.
    class MetricWithWeights : public testing::Test
    {
    protected:
      explicit MetricWithWeights(const std::string &rule = "free")
          : scene("set Scene = dynamic\n" + bar + drag
                  + examples("set Pose functions = " + twist(60.)
                             + " | 1.2*x; 0.9*y; z\n set Weights = " + rule + "\n")),
            p(scene.problem), metric(p.constraints.free_dofs), state(p.state)
      {
        p.potential.begin_step(state, 0.1);
        p.potential.set_time(0.1, state);
        p.constraints.handles.move(0.1, state.positions);
        state.weights = { 0.4, 0.35, 0.25 };
        p.potential.evaluate(state, RotationUse::update, evaluation);
        p.system.factorize(state.positions, state.weights, 1.);
        p.cells().get_field().node_rotations(rotations);
        metric.reinit(p.system.bordered(), inverse_columns(p.system.bordered()), rotations);
        metric.rotate(rotations);
      }

      /// The step and its changes of the weights by the metric.
      std::pair<std::vector<double>, std::vector<double>>
      step_by_metric()
      {
        std::vector<double> step;
        p.constraints.free_dofs.gather(evaluation.gradient, step);
        for (double &force : step)
          force = -force;
        metric.rotate_back(step);
        const std::vector<double> changes
            = metric.find_weight_changes(step, evaluation.elastic.weight_gradient,
                                         p.examples.weights.limits_of_changes(state.weights));
        metric.add_example_forces(changes, step);
        metric.apply(step);
        metric.rotate_forth(step);
        return { step, changes };
      }

      void
      expect_the_step_of_the_system()
      {
        const BorderedVector expected = p.system.solve(state, evaluation);
        const auto [step, changes]    = step_by_metric();
        double scale                  = 0.;
        for (const double x : expected.positions)
          scale = std::max(scale, std::abs(x));
        for (std::size_t i = 0; i < step.size(); ++i)
          EXPECT_NEAR(step[i], expected.positions[i], 1e-4 * scale); // single precision
        for (std::size_t i = 0; i < changes.size(); ++i)
          EXPECT_NEAR(changes[i], expected.weights[i], 1e-4);
        EXPECT_GT(std::abs(changes[1]), 1e-3); // else it proves nothing
      }

      Scene              scene;
      Problem           &p;
      RotatedMetric      metric;
      State              state;
      Evaluation         evaluation;
      std::vector<float> rotations;
    };

    class MetricWithBoundedWeights : public MetricWithWeights
    {
    protected:
      MetricWithBoundedWeights() : MetricWithWeights("simplex") {}
    };

    TEST_F(MetricWithWeights, GivesTheStepOfTheSystemThatItWasMadeOf)
    {
      expect_the_step_of_the_system();
    }

    TEST_F(MetricWithBoundedWeights, GivesTheStepOfTheSystemThatItWasMadeOf)
    {
      expect_the_step_of_the_system();
    }

    TEST_F(MetricWithWeights, TurnsForthAndBack)
    {
      std::vector<float> turned = rotations;
      for (std::size_t k = 0; k < turned.size(); k += 9) // about z by 90 degrees
        for (int c = 0; c < 3; ++c)
        {
          turned[k + c]     = -rotations[k + 3 + c];
          turned[k + 3 + c] = rotations[k + c];
        }
      metric.rotate(turned);
      std::vector<double> vector(p.constraints.free_dofs.size()), there;
      for (std::size_t i = 0; i < vector.size(); ++i)
        vector[i] = static_cast<double>(i % 7);
      there = vector;
      metric.rotate_forth(there);
      for (std::size_t i = 0; i < vector.size(); i += 3) // all nodes are free or held as a whole
      {
        EXPECT_NEAR(there[i], -vector[i + 1], 1e-6);
        EXPECT_NEAR(there[i + 1], vector[i], 1e-6);
        EXPECT_NEAR(there[i + 2], vector[i + 2], 1e-6);
      }
      metric.rotate_back(there);
      for (std::size_t i = 0; i < vector.size(); ++i)
        EXPECT_NEAR(there[i], vector[i], 1e-5);
    }

    TEST_F(MetricWithWeights, EntriesBetweenRowsOfGapsAreThoseOfItsSolves)
    {
      const FreeDofs                  &free_dofs = p.constraints.free_dofs;
      std::mt19937                     generator(5);
      std::normal_distribution<double> normal;
      const auto                       direction = [&]
      {
        dealii::Tensor<1, 3> vector;
        for (unsigned int c = 0; c < 3; ++c)
          vector[c] = normal(generator);
        return vector / vector.norm();
      };
      const auto field = [&]
      {
        std::vector<double> vector(free_dofs.size());
        for (double &entry : vector)
          entry = normal(generator);
        return vector;
      };
      const unsigned int n_nodes = free_dofs.n_dofs() / 3;
      std::vector<Gap>   gaps(9);
      for (unsigned int g = 0; g < gaps.size(); ++g)
      {
        gaps[g].n_nodes = 1 + g % 3;
        gaps[g].nodes   = { { 7 * g % n_nodes, (5 * g + 1) % n_nodes, (3 * g + 2) % n_nodes, 0 } };
        gaps[g].coefficients    = { { 0.5, 0.3, 0.2, 0. } };
        gaps[g].normal          = direction();
        gaps[g].friction_normal = direction();
        gaps[g].stiffness = gaps[g].width = gaps[g].slip_width = 1.;
        gaps[g].friction                                       = g % 2;
      }
      const GapEnergies  rows(gaps);
      std::vector<float> turned = rotations; // by an angle that grows along the bar
      for (unsigned int node = 0; node < n_nodes; ++node)
        for (int c = 0; c < 3; ++c)
        {
          const double angle   = 0.01 * node;
          turned[9 * node + c] = std::cos(angle) * rotations[9 * node + c]
                                 - std::sin(angle) * rotations[9 * node + 3 + c];
          turned[9 * node + 3 + c] = std::sin(angle) * rotations[9 * node + c]
                                     + std::cos(angle) * rotations[9 * node + 3 + c];
        }
      metric.rotate(turned);
      Lbfgs lbfgs(free_dofs.exchange());
      for (unsigned int pair = 0; pair < 2; ++pair)
      {
        std::vector<double> s = field(), y = s;
        metric.apply(s);
        ASSERT_TRUE(lbfgs.add_pair(s, y));
      }
      const LbfgsCorrection correction
          = lbfgs.correction([this](std::vector<double> &vector) { metric.apply(vector); });
      ContactColumns                   columns(free_dofs, metric);
      const dealii::FullMatrix<double> W     = columns.between_rows(rows, correction);
      double                           scale = 0.;
      for (std::size_t r = 0; r < rows.n_rows(); ++r)
        scale = std::max(scale, W(r, r));
      for (std::size_t r = 0; r < rows.n_rows(); ++r)
      {
        Vector              unit(free_dofs.n_dofs()), there(free_dofs.n_dofs());
        std::vector<double> by_row(rows.n_rows()), response;
        by_row[r] = 1.;
        rows.add_forces(by_row, unit);
        free_dofs.gather(unit, response);
        metric.rotate_back(response);
        lbfgs.before(response);
        metric.apply(response);
        lbfgs.after(response);
        metric.rotate_forth(response);
        free_dofs.add(1., response, there);
        const std::vector<double> expected = rows.changes(there);
        for (std::size_t s = 0; s < rows.n_rows(); ++s)
        {
          EXPECT_NEAR(W(s, r), expected[s], 1e-5 * scale); // single precision
          EXPECT_EQ(W(s, r), W(r, s));
        }
      }
    }

    TEST_F(MetricWithWeights, IsEmptyWhenItIsCleared)
    {
      EXPECT_FALSE(metric.empty());
      EXPECT_EQ(metric.schur_complement().m(), 3u);
      EXPECT_GT(metric.memory_consumption(), 0u);
      metric.clear();
      EXPECT_TRUE(metric.empty());
    }
  } // namespace
} // namespace Exemplar::Testing
