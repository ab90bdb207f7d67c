// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/bordered_system.h>

#include "body.h"

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    ModelParameters
    frozen_corotation()
    {
      ModelParameters model;
      model.gradient = GradientKind::frozen;
      return model;
    }

    // doc/paper.md, 2: with q_i on the left and
    // (1-eta) R K X on the right a body at rest shrinks to (1-eta) X. Our right side
    // R K X leaves it where it is. Rollers on three faces through the origin hold it.
    TEST(ElasticPotential, ThePapersLiteralRightSideShrinksABodyAtRest)
    {
      MeshParameters    mesh = box_mesh(2., 2, 2);
      const Body        body(mesh);
      ExampleParameters parameters; // only the rest pose: q_0 = 0
      parameters.importance              = 0.5;
      const auto                examples = body.examples(parameters);
      std::vector<unsigned int> rollers;
      for (unsigned int node = 0; node < body.mesh.n_nodes(); ++node)
      {
        if (std::abs(body.mesh.get_nodes()[node][0]) < 1e-12)
          rollers.push_back(3 * node);
        for (unsigned int c = 1; c < 3; ++c)
          if (std::abs(body.mesh.get_nodes()[node][c]) < 1e-12)
            rollers.push_back(3 * node + c);
      }
      const FreeDofs free_dofs(body.fe_space.n_dofs(), rollers, Exchange::serial());
      BodyPotential  elastic(body, frozen_corotation(), examples, free_dofs);
      const auto    &rest = body.fe_space.rest_positions();
      elastic.update_rotations(rest); // R = I

      // the internal forces at x = 0 are -R K X: strain -I
      dealii::Vector<double> origin(rest.size());
      ElasticEvaluation      evaluation;
      elastic.evaluate(origin, { 1. }, evaluation);
      auto matrix = make_cholesky_operator();
      matrix->reinit(elastic.matrix_pattern);
      const WeightForm no_weights;
      const auto solver = make_block_system(std::move(matrix), no_weights, Exchange::serial());
      std::vector<double> columns;
      elastic.assemble_tangent(Tangent::convex, origin, { 1. }, solver->matrix_values(), columns);
      solver->factorize(origin);
      const auto solve = [&](const double factor)
      {
        BorderedVector unknowns;
        for (const unsigned int dof : free_dofs.list())
          unknowns.positions.push_back(-factor * evaluation.gradient[dof]);
        solver->solve(unknowns, {});
        return unknowns.positions;
      };
      const auto ours = solve(1.), printed = solve(1. - parameters.importance);
      for (unsigned int i = 0; i < free_dofs.size(); ++i)
      {
        EXPECT_NEAR(ours[i], rest[free_dofs.list()[i]], 1e-12);
        EXPECT_NEAR(printed[i], 0.5 * rest[free_dofs.list()[i]], 1e-12);
      }
    }
  } // namespace
} // namespace Exemplar::Testing
