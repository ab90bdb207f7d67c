// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/problem/problem.h>

#include "body.h"
#include "matrices.h"
#include "scene.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    using Vector = dealii::Vector<double>;

    const std::string swing = "set Scene = dynamic\n" + bar
                              + "subsection Handles\n set Names = left\n" + held_left
                              + "end\nsubsection Initial\n set Velocity = 0; 0.5*x; -0.3*x*x\n"
                                "end\nsubsection Solver\n set Tolerance = 1e-11\nend\n";

    Vector
    combination(const std::vector<std::pair<double, const Vector *>> &terms)
    {
      Vector sum(terms[0].second->size());
      for (const auto &[factor, vector] : terms)
        sum.add(factor, *vector);
      return sum;
    }

    /// The derivative at the end of the last step that a scheme of steps h takes.
    Vector
    rate(const std::vector<Vector> &values, const double h, const bool is_bdf2)
    {
      const std::size_t n = values.size() - 1;
      if (is_bdf2 && n > 1)
        return combination(
            { { 1.5 / h, &values[n] }, { -2. / h, &values[n - 1] }, { 0.5 / h, &values[n - 2] } });
      return combination({ { 1. / h, &values[n] }, { -1. / h, &values[n - 1] } });
    }

    TEST(TimeScheme, StepsSolveTheDampedEquationOfMotion)
    {
      // M a + alpha M v + K (beta v + u) = 0 in the linear model, whose gradient is K u
      const double alpha = 3., beta = 0.004, h = 0.01;
      for (const bool is_bdf2 : { false, true })
      {
        Scene               scene(swing, { "Model/Strain=linear", "Time/Mass damping=3",
                                           "Time/Stiffness damping=0.004", "Time/Step=0.01", "Time/End=0.06",
                                           std::string("Time/Scheme=") + (is_bdf2 ? "bdf2" : "implicit euler") });
        Problem            &p = scene.problem;
        ElasticPotential    undamped({ p.parameters.model.law(), p.body.fe_space, p.body.material,
                                       p.body.cell_material, p.body.patches, p.examples.poses,
                                       p.examples.weights, p.constraints.free_dofs });
        undamped.attach(p.potential.get_tangent().get_pattern());
        std::vector<Vector> x = { p.state.positions }, v = { p.state.velocities };
        while (p.state.step < p.time_axis.n_steps())
        {
          ASSERT_TRUE(is_success(p.advance().status));
          x.push_back(p.state.positions);
          v.push_back(p.state.velocities);
          EXPECT_LT(max_difference(v.back(), rate(x, h, is_bdf2)), 1e-12);
          const Vector a        = rate(v, h, is_bdf2);
          Vector       strained = x.back();
          strained.add(beta, v.back());
          ElasticEvaluation evaluation;
          undamped.evaluate(strained, {}, evaluation);
          const Vector inertia
              = p.actions.mass->times(combination({ { 1., &a }, { alpha, &v.back() } }));
          for (const unsigned int dof : p.constraints.free_dofs.list())
            EXPECT_NEAR(inertia[dof] + evaluation.gradient[dof], 0.,
                        1e-9 * evaluation.gradient.linfty_norm());
        }
      }
    }

    TEST(TimeScheme, Bdf2DifferentiatesAParabolaExactlyForAnySteps)
    {
      const Body     body;
      TimeParameters time;
      time.scheme = TimeScheme::bdf2;
      TimeIntegrator integrator(time);
      const Vector   a = body.fe_space.rest_positions();
      const auto     x = [&](const double t) { return combination({ { t * t + 0.3 * t, &a } }); };
      const auto     v = [&](const double t) { return combination({ { 2. * t + 0.3, &a } }); };
      State          old, state;
      old.positions           = x(0.5);
      old.velocities          = v(0.5);
      old.previous_positions  = x(0.2);
      old.previous_velocities = v(0.2);
      old.previous_step       = 0.3;
      integrator.begin_step(old, 0.17);
      state.positions = x(0.67);
      integrator.end_step(old, state);
      EXPECT_LT(max_difference(state.velocities, v(0.67)), 1e-13);
      EXPECT_EQ(state.previous_step, 0.17);
    }

    TEST(TimeScheme, Orders)
    {
      const auto end_at = [](const std::string &scheme, const std::string &step)
      {
        return Scene(swing, { "Time/Scheme=" + scheme, "Time/Step=" + step, "Time/End=0.16",
                              "Material/Young's modulus=2e5" })
            .solve()
            .positions;
      };
      const Vector exact = end_at("bdf2", "0.000125");
      const auto   order = [&](const std::string &scheme)
      {
        return std::log2(max_difference(end_at(scheme, "0.002"), exact)
                         / max_difference(end_at(scheme, "0.001"), exact));
      };
      EXPECT_NEAR(order("implicit euler"), 1., 0.15);
      EXPECT_NEAR(order("bdf2"), 2., 0.2);
    }

    TEST(TimeScheme, StiffnessDampingLeavesRigidMotionAlone)
    {
      for (const CellLaw strain : { CellLaw::corotational, CellLaw::green })
      {
        const Body      body;
        const FreeDofs  free_dofs(body.fe_space.n_dofs(), {}, Exchange::serial());
        ModelParameters model;
        model.strain = strain;
        BodyPotential         elastic(body, model, {}, free_dofs);
        std::mt19937          generator(1);
        const Vector          past   = body.random_positions(generator, 0.1);
        Vector                turned = past;
        const Matrix3<double> Q      = rotation_about({ { 1., 2., 3. } }, 2.5);
        for (unsigned int node = 0; node < past.size() / 3; ++node)
        {
          const Vector3<double> x
              = Q * Vector3<double>{ { past[3 * node], past[3 * node + 1], past[3 * node + 2] } };
          for (int c = 0; c < 3; ++c)
            turned[3 * node + c] = x[c] + 1.;
        }
        ElasticEvaluation damped, undamped, deformed;
        elastic.update_rotations(turned);
        elastic.evaluate(turned, {}, undamped);
        elastic.begin_step(5., { { 1., &past } });
        elastic.evaluate(turned, {}, damped);
        EXPECT_LT(max_difference(damped.gradient, undamped.gradient),
                  1e-11 * undamped.gradient.linfty_norm());
        EXPECT_LT(damped.energy_damping, 1e-20 * undamped.energy_elastic);
        elastic.begin_step(5., { { 1., &body.fe_space.rest_positions() } });
        elastic.evaluate(turned, {}, deformed);
        EXPECT_NEAR(deformed.energy_damping, 5. * undamped.energy_elastic,
                    1e-12 * deformed.energy_damping);
      }
    }

    TEST(TimeScheme, ABodyThatDoesNotMoveIsNotDamped)
    {
      // also where cells are mirrored so that the guard acts
      const Body     body;
      const FreeDofs free_dofs(body.fe_space.n_dofs(), {}, Exchange::serial());
      BodyPotential  elastic(body, ModelParameters(), {}, free_dofs);
      Vector         x = body.fe_space.rest_positions();
      for (unsigned int node = 0; node < x.size() / 3; ++node)
        x[3 * node] *= -0.9;
      ElasticEvaluation damped, undamped;
      elastic.update_rotations(x);
      elastic.evaluate(x, {}, undamped);
      EXPECT_EQ(undamped.inverted_cells, body.fe_space.n_cells());
      elastic.begin_step(7., { { 1., &x } });
      elastic.evaluate(x, {}, damped);
      EXPECT_LT(max_difference(damped.gradient, undamped.gradient),
                1e-12 * undamped.gradient.linfty_norm());
    }

    TEST(TimeScheme, AFreeBodyWithStrongDampingFliesOn)
    {
      for (const std::string velocity : { "1; 0.3; 0", "-y; x; 0" })
      {
        Scene scene(
            "set Scene = dynamic\n" + bar + "subsection Initial\n set Velocity = " + velocity
            + "\nend\nsubsection Time\n set Step = 0.001\n set End = 0.02\n"
              "set Stiffness damping = 0.5\nend\nsubsection Solver\n set Tolerance = 1e-6\nend\n");
        const auto  before = scene.problem.actions.mass->motion_sums(scene.problem.state);
        const State state  = scene.solve();
        const auto  after  = scene.problem.actions.mass->motion_sums(state);
        EXPECT_LT((after.momentum - before.momentum).norm(), 1e-7 * (before.momentum.norm() + 1.));
        EXPECT_NEAR(after.kinetic_energy, before.kinetic_energy, 2e-2 * before.kinetic_energy);
      }
    }

    TEST(TimeScheme, AStepThatFailsGoesHalfTheWayFirst)
    {
      // too few iterations for the whole step, enough for its parts
      const std::string text = "set Scene = dynamic\n" + bar
                               + "subsection Handles\n set Names = left, right\n" + held_left
                               + "subsection right\n set Select = boundary 2\n set Motion = 2*t; "
                                 "3*t*y+2*t; 3*t*z\nend\nend\n"
                                 "subsection Time\n set Step = 0.5\n set End = 0.5\nend\n";
      Scene             whole(text), halved(text, { "Solver/Maximum iterations=4" });
      const SolveReport report = whole.problem.advance();
      ASSERT_GT(report.iterations, 4u);
      EXPECT_LT(max_difference(halved.solve().positions, whole.problem.state.positions), 1e-7);
    }

    TEST(TimeScheme, ImplicitEulerKeepsNoHistory)
    {
      Scene       scene(swing, { "Time/End=0.02" });
      const State state = scene.solve();
      EXPECT_EQ(state.previous_positions.size(), 0u);
      EXPECT_EQ(state.previous_velocities.size(), 0u);
    }
  } // namespace
} // namespace Exemplar::Testing
