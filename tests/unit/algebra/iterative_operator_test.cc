// SPDX-License-Identifier: GPL-3.0-or-later
#include "body.h"
#include "scene.h"

#include <exemplar/algebra/spd_operator.h>
#include <exemplar/potential/elastic_potential.h>

#include <gtest/gtest.h>

#include <cmath>

namespace Exemplar::Testing
{
  namespace
  {
    using Columns = std::vector<double>;

    class IterativeOperator : public testing::Test
    {
    protected:
      void
      SetUp() override
      {
        if (!has_iterative_operator())
          GTEST_SKIP() << "built without Trilinos";
      }
    };

    /// Degrees of freedom of the nodes at x = 0, their components below `n_components`.
    std::vector<unsigned int>
    left_end(const Mesh &mesh, const unsigned int n_components = 3)
    {
      std::vector<unsigned int> dofs;
      for (unsigned int node = 0; node < mesh.n_nodes(); ++node)
        if (mesh.get_nodes()[node][0] == 0.)
          for (unsigned int c = 0; c < n_components; ++c)
            dofs.push_back(3 * node + c);
      return dofs;
    }

    /// A bar, bent and stretched, and the matrix of its tangent.
    struct BentBar
    {
      explicit BentBar(const std::vector<unsigned int> &held,
                       const MeshParameters            &mesh = fine_mesh())
          : body(mesh), free_dofs(body.fe_space.n_dofs(), held, Exchange::serial()),
            elastic(body, ModelParameters(), {}, free_dofs),
            positions(body.fe_space.rest_positions())
      {
        for (unsigned int node = 0; node < body.mesh.n_nodes(); ++node)
        {
          const double x = positions[3 * node];
          positions[3 * node] += 0.05 * x;
          positions[3 * node + 2] += 0.1 * x * x;
        }
        elastic.update_rotations(positions);
      }

      static MeshParameters
      fine_mesh()
      {
        return box_mesh(4., 12, 3); // more than ML's coarsest level
      }

      std::unique_ptr<SpdOperator>
      iterative(const double tolerance = 1e-12) const
      {
        auto matrix = make_iterative_operator(free_dofs, tolerance);
        matrix->reinit(elastic.matrix_pattern);
        return matrix;
      }

      std::unique_ptr<SpdOperator>
      cholmod() const
      {
        auto matrix = make_cholesky_operator();
        matrix->reinit(elastic.matrix_pattern);
        return matrix;
      }

      void
      fill(SpdOperator &matrix)
      {
        Columns none;
        std::fill(matrix.values().begin(), matrix.values().end(), 0.);
        elastic.assemble_tangent(Tangent::exact, positions, {}, matrix.values(), none);
      }

      /// A^-1 times two columns.
      Columns
      solve(SpdOperator &matrix)
      {
        fill(matrix);
        matrix.factorize(body.fe_space.rest_positions());
        return solve_with_factor(matrix);
      }

      Columns
      solve_with_factor(SpdOperator &matrix) const
      {
        Columns columns(2 * free_dofs.size());
        for (std::size_t i = 0; i < columns.size(); ++i)
          columns[i] = std::sin(1. + static_cast<double>(i));
        matrix.solve(columns);
        return columns;
      }

      Body                   body;
      FreeDofs               free_dofs;
      BodyPotential          elastic;
      dealii::Vector<double> positions;
    };

    double
    relative_difference(const Columns &a, const Columns &b)
    {
      double difference = 0., maximum = 0.;
      for (std::size_t i = 0; i < a.size(); ++i)
      {
        difference = std::max(difference, std::abs(a[i] - b[i]));
        maximum    = std::max(maximum, std::abs(b[i]));
      }
      return difference / maximum;
    }

    void
    expect_agreement(BentBar &bar)
    {
      EXPECT_LT(relative_difference(bar.solve(*bar.iterative()), bar.solve(*bar.cholmod())), 1e-9);
    }

    TEST_F(IterativeOperator, AgreesWithCholmod)
    {
      const Mesh mesh(BentBar::fine_mesh());
      BentBar    bar(left_end(mesh));
      expect_agreement(bar);
    }

    TEST_F(IterativeOperator, MayEndEarlier)
    {
      const Mesh    mesh(BentBar::fine_mesh());
      BentBar       bar(left_end(mesh));
      const Columns load(bar.free_dofs.size(), 1.);
      const auto    solve = [&](SpdOperator &matrix, const double accuracy)
      {
        Columns column = load;
        bar.fill(matrix);
        matrix.factorize(bar.body.fe_space.rest_positions());
        matrix.solve(column, accuracy);
        return column;
      };
      const Columns exact = solve(*bar.cholmod(), 0.1);
      const double  rough = relative_difference(solve(*bar.iterative(), 0.1), exact);
      EXPECT_LT(rough, 0.3);
      EXPECT_GT(rough, 1e-6);
      EXPECT_LT(relative_difference(solve(*bar.iterative(), 1e-20), exact), 1e-9);
    }

    /// All values and the diagonal's, times these.
    void
    scale(SpdOperator            &matrix,
          const SymmetricPattern &pattern,
          const double            all,
          const double            diagonal)
    {
      for (double &value : matrix.values())
        value *= all;
      for (unsigned int j = 0; j < pattern.n(); j += 7)
        matrix.values()[pattern.column_start[j]] *= diagonal;
    }

    TEST_F(IterativeOperator, AgreesWithCholmodOnAMatrixNearAnEarlierOne)
    {
      const Mesh    mesh(BentBar::fine_mesh());
      BentBar       bar(left_end(mesh));
      const Vector &rest      = bar.body.fe_space.rest_positions();
      const auto    iterative = bar.iterative(), cholmod = bar.cholmod();
      bar.solve(*iterative);
      EXPECT_FALSE(iterative->leans_on_earlier());
      for (SpdOperator *matrix : { iterative.get(), cholmod.get() })
      {
        bar.fill(*matrix);
        scale(*matrix, bar.elastic.matrix_pattern, 1.1, 1.2);
        matrix->factorize_near(rest);
      }
      EXPECT_TRUE(iterative->leans_on_earlier());
      EXPECT_LT(
          relative_difference(bar.solve_with_factor(*iterative), bar.solve_with_factor(*cholmod)),
          1e-9);
      EXPECT_TRUE(iterative->leans_on_earlier());
      // and anew, as if there had been no earlier one
      iterative->factorize(rest);
      EXPECT_FALSE(iterative->leans_on_earlier());
      const auto other = bar.iterative();
      bar.fill(*other);
      scale(*other, bar.elastic.matrix_pattern, 1.1, 1.2);
      other->factorize(rest);
      EXPECT_EQ(bar.solve_with_factor(*iterative), bar.solve_with_factor(*other));
    }

    TEST_F(IterativeOperator, MakesTheHierarchyAnewForAMatrixFarFromTheEarlierOne)
    {
      const Mesh    mesh(BentBar::fine_mesh());
      BentBar       bar(left_end(mesh));
      const Vector &rest      = bar.body.fe_space.rest_positions();
      const auto    iterative = bar.iterative(), cholmod = bar.cholmod();
      bar.solve(*iterative);
      for (SpdOperator *matrix : { iterative.get(), cholmod.get() })
      {
        bar.fill(*matrix);
        scale(*matrix, bar.elastic.matrix_pattern, 1., 1e6);
        matrix->factorize_near(rest);
      }
      EXPECT_LT(
          relative_difference(bar.solve_with_factor(*iterative), bar.solve_with_factor(*cholmod)),
          1e-9);
      EXPECT_FALSE(iterative->leans_on_earlier());
    }

    TEST_F(IterativeOperator, AgreesWithCholmodWhereNodesAreHeldInPart)
    {
      // rollers on the end, one of their nodes held, another in two components
      const Mesh                mesh(BentBar::fine_mesh());
      std::vector<unsigned int> held  = left_end(mesh, 1);
      const unsigned int        first = held.front() / 3, last = held.back() / 3;
      held.insert(held.end(), { 3 * first + 1, 3 * first + 2, 3 * last + 1 });
      BentBar bar(held);
      expect_agreement(bar);
    }

    TEST_F(IterativeOperator, AgreesWithCholmodOnTheSmallestBodies)
    {
      const MeshParameters      brick = box_mesh(1., 1, 1);
      const Mesh                mesh(brick);
      std::vector<unsigned int> held = left_end(mesh);
      BentBar                   bar(held, brick);
      expect_agreement(bar);
      for (unsigned int dof = 0; dof + 2 < 3 * mesh.n_nodes(); ++dof) // two components of a node
        held.push_back(dof);
      BentBar two_unknowns(held, brick);
      expect_agreement(two_unknowns);
    }

    TEST_F(IterativeOperator, NodesInAnyPlaceGiveTheSameSolution)
    {
      // they only choose the preconditioner: turned, in a plane, in a point
      const Mesh    mesh(BentBar::fine_mesh());
      BentBar       bar(left_end(mesh));
      const Columns expected = bar.solve(*bar.cholmod());
      const auto    matrix   = bar.iterative();
      auto          places   = bar.positions;
      const auto    expect   = [&](const std::string &where)
      {
        SCOPED_TRACE(where);
        bar.fill(*matrix);
        matrix->factorize(places);
        EXPECT_LT(relative_difference(bar.solve_with_factor(*matrix), expected), 1e-9);
      };
      expect("where they are");
      for (unsigned int node = 0; node < mesh.n_nodes(); ++node)
        std::swap(places[3 * node], places[3 * node + 1]);
      expect("elsewhere");
      for (unsigned int node = 0; node < mesh.n_nodes(); ++node)
        places[3 * node] = 1.;
      expect("in a plane");
      places = 0.;
      expect("in a point");
    }

    TEST_F(IterativeOperator, DependsOnNothingBefore)
    {
      // a resumed run has not seen the matrices before
      const Mesh    mesh(BentBar::fine_mesh());
      BentBar       bar(left_end(mesh));
      const auto    matrix = bar.iterative(1e-4);
      const Columns first  = bar.solve(*matrix);
      EXPECT_EQ(bar.solve_with_factor(*matrix), first);
      bar.positions *= 1.1;
      bar.elastic.update_rotations(bar.positions);
      EXPECT_NE(bar.solve(*matrix), first);
      bar.positions /= 1.1;
      bar.elastic.update_rotations(bar.positions);
      const Columns other = bar.solve(*bar.iterative(1e-4));
      EXPECT_EQ(bar.solve(*matrix), other);
    }

    TEST_F(IterativeOperator, ReachesItsTolerance)
    {
      // r = b - A x with the matrix of the other operator
      const Mesh mesh(BentBar::fine_mesh());
      BentBar    bar(left_end(mesh));
      const auto matrix = bar.iterative(1e-3);
      Columns    x = bar.solve(*matrix), exact = bar.solve(*bar.cholmod());
      const auto norm_of_image = [&](const Columns &vector)
      {
        const SymmetricPattern &pattern = bar.elastic.matrix_pattern;
        Columns                 image(pattern.n(), 0.);
        for (unsigned int j = 0; j < pattern.n(); ++j)
          for (int entry = pattern.column_start[j]; entry < pattern.column_start[j + 1]; ++entry)
          {
            const unsigned int i = pattern.row[entry];
            image[i] += matrix->values()[entry] * vector[j];
            if (i != j)
              image[j] += matrix->values()[entry] * vector[i];
          }
        double square = 0.;
        for (const double entry : image)
          square += entry * entry;
        return std::sqrt(square);
      };
      Columns error = x; // norms are of the first column
      for (std::size_t i = 0; i < x.size(); ++i)
        error[i] -= exact[i];
      EXPECT_LT(norm_of_image(error), 1.0001e-3 * norm_of_image(exact));
      EXPECT_GT(norm_of_image(error), 1e-6 * norm_of_image(exact)); // and goes no further
    }

    void
    expect_indefinite(BentBar &bar, SpdOperator &matrix)
    {
      try
      {
        matrix.factorize(bar.body.fe_space.rest_positions());
        bar.solve_with_factor(matrix);
        FAIL() << "solved";
      }
      catch (const SolverFailure &failure)
      {
        EXPECT_NE(std::string(failure.what()).find("not positive definite"), std::string::npos);
      }
    }

    TEST_F(IterativeOperator, NoticesIndefiniteMatrices)
    {
      const Mesh mesh(BentBar::fine_mesh());
      BentBar    bar(left_end(mesh));
      const auto matrix       = bar.iterative();
      const auto add_diagonal = [&](const double factor)
      {
        bar.fill(*matrix);
        for (const int start : bar.elastic.matrix_pattern.column_start)
          if (start < bar.elastic.matrix_pattern.column_start.back())
            matrix->values()[start] *= 1. + factor;
      };
      for (const double factor : { -1e-2, -0.3, -0.9, -1., -2. })
      {
        SCOPED_TRACE(factor);
        add_diagonal(factor);
        expect_indefinite(bar, *matrix);
      }
      add_diagonal(0.); // and can be used again
      EXPECT_LT(relative_difference(bar.solve(*matrix), bar.solve(*bar.cholmod())), 1e-9);
    }

    TEST_F(IterativeOperator, IsSilent)
    {
      const Mesh mesh(BentBar::fine_mesh());
      BentBar    bar(left_end(mesh));
      testing::internal::CaptureStdout();
      testing::internal::CaptureStderr();
      const auto matrix = bar.iterative();
      bar.solve(*matrix);
      for (double &value : matrix->values())
        value = -value;
      expect_indefinite(bar, *matrix);
      EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
      EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    }

    TEST_F(IterativeOperator, SolvesScenesWithExamples)
    {
      // weights on the simplex and free ones: columns of G beside the right side
      for (const std::string weights : { "simplex", "free" })
      {
        const std::string text
            = "set Scene = static\n" + bar + drag
              + examples("set Pose functions = " + twist(60.)
                         + " | 1.1*x; y; 0.9*z\n set Weights = " + weights + "\n")
              + "subsection Solver\n set Tolerance = 1e-10\nend\n";
        Scene cholesky(text, { "Solver/Linear solver=cholesky" });
        Scene iterative(text, { "Solver/Linear solver=iterative" });
        EXPECT_EQ(iterative.problem.system.bordered().traits().name, "iterative");
        const State a = cholesky.solve(), b = iterative.solve();
        EXPECT_LT(max_difference(a.positions, b.positions), 1e-7);
        for (unsigned int i = 0; i < a.weights.size(); ++i)
          EXPECT_NEAR(a.weights[i], b.weights[i], 1e-7);
      }
    }
  } // namespace
} // namespace Exemplar::Testing
