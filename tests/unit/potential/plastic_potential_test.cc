// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/incremental_potential.h>

#include "scene.h"
#include "stencil.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

// The whole potential of a step of a body that remembers what has yielded.

namespace Exemplar::Testing
{
  namespace
  {
    constexpr double step_size = 0.05;

    std::string
    yielding_bar(const std::string &model, const std::string &fibres)
    {
      return "set Scene = dynamic\n" + bar + drag + examples(two_poses + "set Energy = blended\n")
             + "subsection Model\n" + model
             + "end\nsubsection Time\n set Step = 0.05\n set Stiffness damping = 0.1\nend\n"
               "subsection Material\n set Young's modulus = 1\n set Yield stress = 0.02\n"
               "set Kinematic hardening = 0.1\n set Isotropic hardening = 0.05\n"
               "set Flow viscosity = 0.001\n"
             + fibres + "end\n";
    }

    /// A step of such a body that has made some before, at other positions than its end.
    struct Step
    {
      Step(const std::string &model, const std::string &fibres)
          : scene(yielding_bar(model, fibres)), p(scene.problem)
      {
        for (int step = 0; step < 3; ++step)
          EXPECT_TRUE(is_success(p.advance().status));
        EXPECT_GT(p.cells().get_field().dissipated_energy(), 0.);
        p.potential.begin_step(p.state, step_size);
        p.potential.set_time(p.state.time + step_size, p.state);
        state = p.state;
        std::mt19937                     generator(3);
        std::normal_distribution<double> normal;
        for (const unsigned int dof : p.potential.get_free_dofs().list())
          state.positions[dof] += 0.02 * normal(generator);
        state.weights = { 0.5, 0.3, 0.2 };
      }

      Evaluation
      at(const double h, const Vector &direction)
      {
        State moved = state;
        moved.positions.add(h, direction);
        Evaluation evaluation;
        p.potential.evaluate(moved, RotationUse::update, evaluation);
        return evaluation;
      }

      Scene    scene;
      Problem &p;
      State    state;
    };

    void
    expect_derivatives(const std::string &model, const std::string &fibres = "")
    {
      Step                step(model, fibres);
      const auto         &free_dofs = step.p.potential.get_free_dofs();
      const auto         &free      = free_dofs.list();
      std::mt19937        generator(4);
      const Evaluation    here = step.at(0., Vector(step.state.positions.size()));
      std::vector<double> matrix(step.p.potential.get_tangent().get_pattern().n_values()), columns;
      step.p.potential.get_tangent().assemble(step.state.positions, step.state.weights, 0., matrix,
                                              columns);
      const SymmetricPattern &pattern = step.p.potential.get_tangent().get_pattern();
      for (int sample = 0; sample < 5; ++sample)
      {
        Vector u(step.state.positions.size());
        for (const unsigned int dof : free)
          u[dof] = std::normal_distribution<double>()(generator);
        const auto    at = [&](const double h) { return step.at(h, u); };
        const Stencil around(at);
        EXPECT_NEAR(here.gradient * u,
                    around.derivative([](const Evaluation &e) { return e.potential; }),
                    1e-7 * here.gradient.l2_norm() * u.l2_norm());
        Vector product(u.size());
        for (unsigned int j = 0; j < free.size(); ++j)
          for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k)
          {
            const unsigned int i = pattern.row[k];
            product[free[i]] += matrix[k] * u[free[j]];
            if (i != j)
              product[free[j]] += matrix[k] * u[free[i]];
          }
        const Vector difference = around.derivative_of_gradient();
        for (const unsigned int dof : free)
          EXPECT_NEAR(product[dof], difference[dof], 1e-7 * product.linfty_norm());
      }
    }

    TEST(PlasticPotential, ItsDerivativesKnowWhatCellsRememberAndTheDamping)
    {
      expect_derivatives("set Dilatation = cells\n");
      expect_derivatives("set Dilatation = patches\n");
      expect_derivatives("set Element = P2\n");
    }

    TEST(PlasticPotential, ItsDerivativesKnowFibresInWhatYields)
    {
      const std::string fibres
          = "set Fibre stiffness = 3\n set Fibre direction = 1; 0.3*x; 0.5-z\n";
      expect_derivatives("set Dilatation = cells\n", fibres);
      expect_derivatives("set Dilatation = patches\n", fibres);
      expect_derivatives("set Element = P2\n", fibres);
    }
  } // namespace
} // namespace Exemplar::Testing
