// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/problem/finiteness.h>
#include <exemplar/run/problem/initial_state.h>

#include "body.h"
#include "expect_contains.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace Exemplar::Testing
{
  namespace
  {
    class InitialStateTest : public testing::Test
    {
    protected:
      State
      state(const bool is_dynamic, const Body &of = Body(box_mesh(4., 2, 1))) const
      {
        return initial_state(parameters, of.mesh, of.fe_space,
                             *of.examples(ExampleParameters()).weights, is_dynamic, poses);
      }

      const Body        body = Body(box_mesh(4., 2, 1));
      InitialParameters parameters;
      NamedPoses        poses;
    };

    TEST_F(InitialStateTest, IsAtRestUnlessAnotherIsAskedFor)
    {
      EXPECT_EQ(state(false).positions, body.fe_space.rest_positions());
      EXPECT_EQ(state(false).velocities.size(), 0u); // statics have none
      EXPECT_EQ(state(true).velocities.linfty_norm(), 0.);
      EXPECT_EQ(state(true).velocities.size(), body.fe_space.n_dofs());
      EXPECT_TRUE(state(true).weights.empty());
    }

    TEST_F(InitialStateTest, FollowsFormulasOfTheRestPose)
    {
      parameters.pose_function = "2*x; y+x; z-1";
      parameters.velocity      = "0; x*z; -y";
      const Body  quadratic(box_mesh(4., 2, 1), MaterialParameters(), Element::P2);
      const State start = state(true, quadratic);
      const auto &rest  = quadratic.fe_space.rest_positions();
      for (unsigned int i = 0; i < rest.size(); i += 3)
      {
        EXPECT_EQ(start.positions[i], 2. * rest[i]);
        EXPECT_EQ(start.positions[i + 1], rest[i + 1] + rest[i]);
        EXPECT_EQ(start.positions[i + 2], rest[i + 2] - 1.);
        EXPECT_EQ(start.velocities[i], 0.);
        EXPECT_EQ(start.velocities[i + 1], rest[i] * rest[i + 2]);
        EXPECT_EQ(start.velocities[i + 2], -rest[i + 1]);
      }
    }

    TEST_F(InitialStateTest, TakesANamedPose)
    {
      parameters.pose = "crouched";
      for (const dealii::Point<3> &x : body.mesh.get_nodes())
        poses["crouched"].emplace_back(x[0], 0.5 * x[1], x[2] + 3.);
      const State start = state(false);
      const auto &rest  = body.fe_space.rest_positions();
      for (unsigned int i = 0; i < rest.size(); i += 3)
      {
        EXPECT_EQ(start.positions[i + 1], 0.5 * rest[i + 1]);
        EXPECT_EQ(start.positions[i + 2], rest[i + 2] + 3.);
      }
      poses["crouched"].pop_back();
      EXPECT_THROW(state(false), UserError);
    }

    TEST_F(InitialStateTest, UnknownWeightsBeginWithTheFirstExample)
    {
      ExampleParameters example_parameters;
      example_parameters.pose_functions = twist(60.);
      const Examples examples           = body.examples(example_parameters);
      const State    start
          = initial_state(parameters, body.mesh, body.fe_space, *examples.weights, false);
      EXPECT_EQ(start.weights, (std::vector<double>{ 1., 0. }));
      EXPECT_EQ(start.multipliers, (std::vector<double>{ 0. }));
    }

    TEST(Finiteness, NamesWhatIsNone)
    {
      const double none = std::nan(""), infinite = std::numeric_limits<double>::infinity();
      State        good;
      good.positions.reinit(6);
      good.velocities.reinit(6);
      good.weights = good.multipliers = { 0.5 };
      const auto name                 = [&](const std::function<void(State &, Evaluation &)> &spoil)
      {
        State      state = good;
        Evaluation evaluation;
        spoil(state, evaluation);
        return what_is_not_finite(state, evaluation);
      };
      EXPECT_EQ(name([](State &, Evaluation &) {}), "");
      EXPECT_EQ(name([&](State &state, Evaluation &) { state.positions[5] = none; }), "positions");
      // of which the square is no number
      EXPECT_EQ(name([&](State &state, Evaluation &) { state.positions[5] = 1e155; }), "positions");
      EXPECT_EQ(name([&](State &state, Evaluation &) { state.velocities[0] = -infinite; }),
                "velocities");
      EXPECT_EQ(name([&](State &state, Evaluation &) { state.weights[0] = none; }), "weights");
      EXPECT_EQ(name([&](State &state, Evaluation &) { state.multipliers[0] = none; }), "weights");
      EXPECT_EQ(name([&](State &, Evaluation &at) { at.potential = infinite; }), "energies");
      EXPECT_EQ(name([&](State &, Evaluation &at) { at.elastic.energy_elastic = none; }),
                "energies");
      EXPECT_EQ(name([&](State &, Evaluation &at) { at.elastic.min_det_F = none; }),
                "ratios of volumes");
      const CellResults cells{ { 1., 2. }, { 1., 1. }, { 0., 0. } };
      CellResults       spoilt = cells;
      EXPECT_EQ(what_is_not_finite(cells), "");
      spoilt.von_mises_stress[1] = none;
      EXPECT_EQ(what_is_not_finite(spoilt), "stresses");
      spoilt.strain_energy_density[0] = infinite;
      EXPECT_EQ(what_is_not_finite(spoilt), "densities of energy");
    }

    TEST(Finiteness, LooksAtTheWholeFrame)
    {
      Frame good;
      good.positions.reinit(6);
      good.cells  = { { 1., 2. }, { 1., 1. }, { 0., 0. } };
      good.fields = { { "contact_force", Vector(6) } };
      EXPECT_EQ(what_is_not_finite(good), "");
      Frame spoilt               = good;
      spoilt.fields[0].values[5] = std::nan("");
      EXPECT_EQ(what_is_not_finite(spoilt), "values of contact_force");
      spoilt              = good;
      spoilt.positions[2] = std::numeric_limits<double>::infinity();
      EXPECT_EQ(what_is_not_finite(spoilt), "positions");
      spoilt                           = good;
      spoilt.cells.von_mises_stress[1] = std::nan("");
      EXPECT_EQ(what_is_not_finite(spoilt), "stresses");
    }
  } // namespace
} // namespace Exemplar::Testing
