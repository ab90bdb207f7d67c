// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed_body.h"

#include <limits>
#include <numeric>

namespace Exemplar::Testing
{
  namespace
  {
    /// The iterative operator of several processes.
    class DistributedOperator : public Distributed
    {
    protected:
      void
      SetUp() override
      {
        if (!has_iterative_operator())
          GTEST_SKIP() << "built without Trilinos";
      }

      std::unique_ptr<SpdOperator>
      distributed(const double tolerance = 1e-13)
      {
        return part->reinit(make_iterative_operator(part->free_dofs, tolerance));
      }

      void
      expect_agreement()
      {
        const Columns solution = solve(*distributed());
        EXPECT_LT(difference(solution, own_rows(solve_alone(make_cholesky_operator()))), 1e-10);
        EXPECT_LT(difference(solution, own_rows(solve_alone(
                                           make_iterative_operator(whole->free_dofs, 1e-13)))),
                  1e-10);
      }

      /// All processes throw, or none.
      void
      expect_indefinite(SpdOperator &matrix)
      {
        std::string error;
        try
        {
          solve(matrix);
        }
        catch (const SolverFailure &failure)
        {
          error = failure.what();
        }
        EXPECT_NE(error.find("not positive definite"), std::string::npos) << error;
      }
    };

    TEST_F(DistributedOperator, AgreesWithOneProcess)
    {
      make(bar(), left_end);
      expect_agreement();
    }

    TEST_F(DistributedOperator, AgreesWhereOthersCoupleOwnNodes)
    {
      make(bar(), left_end, scattered);
      expect_agreement();
    }

    TEST_F(DistributedOperator, AgreesWhereNodesAreHeldInPart)
    {
      const auto rollers = [](const dealii::Point<3> &x, const unsigned int component)
      { return x[0] == 0. && (component == 0 || x[component] < -0.4); };
      make(bar(), rollers, scattered);
      expect_agreement();
      make(bar(), rollers);
      expect_agreement();
    }

    TEST_F(DistributedOperator, AgreesWhereAProcessHasNoUnknowns)
    {
      const auto first_slice
          = [](const dealii::Point<3> &x, unsigned int /*component*/) { return x[0] <= 2.5; };
      make(bar(), first_slice);
      expect_agreement();
      const auto all_but_the_end
          = [](const dealii::Point<3> &x, unsigned int /*component*/) { return x[0] < 4.; };
      make(bar(), all_but_the_end);
      expect_agreement();
    }

    /// Two columns of numbers for unknowns, as two vectors.
    std::pair<Columns, Columns>
    halves(const Columns &columns)
    {
      const auto middle = columns.begin() + columns.size() / 2;
      return { { columns.begin(), middle }, { middle, columns.end() } };
    }

    /// On levels with the Galerkin products, and with a product on the finest that is not assembled.
    TEST_F(DistributedOperator, KeepsOuterProductsApart)
    {
      const auto rollers = [](const dealii::Point<3> &x, const unsigned int component)
      { return x[0] == 0. && (component == 0 || x[component] < -0.4); };
      const auto first_slice
          = [](const dealii::Point<3> &x, unsigned int /*component*/) { return x[0] <= 2.5; };
      for (const auto partition : { slices, scattered })
        for (const IsHeld &is_held : { IsHeld(left_end), IsHeld(rollers), IsHeld(first_slice) })
        {
          make(bar(), is_held, partition);
          const auto matrix         = distributed();
          *matrix->outer_products() = own_products;
          const Columns solution = solve(*matrix), expected = own_rows(solve_assembled());
          EXPECT_LT(difference(solution, expected), 1e-10);
          Columns kept = halves(own_rows(right_side())).first;
          matrix->keep()->apply(kept);
          EXPECT_LT(difference(kept, halves(expected).first), 0.5);
        }
    }

    TEST_F(DistributedOperator, IsIndefiniteByOuterProducts)
    {
      make(bar(), left_end);
      const auto matrix         = distributed();
      *matrix->outer_products() = own_products;
      const Columns expected    = solve(*matrix);
      matrix->outer_products()->scale(-1.);
      expect_indefinite(*matrix);
      matrix->outer_products()->scale(-1.);
      EXPECT_EQ(solve(*matrix), expected);
    }

    TEST_F(DistributedOperator, HasNothingToDoWithoutUnknowns)
    {
      make(bar(), [](const dealii::Point<3> &, unsigned int) { return true; });
      EXPECT_TRUE(solve(*distributed()).empty());
    }

    TEST_F(DistributedOperator, RepeatsBitForBit)
    {
      make(bar(), left_end, scattered);
      const auto    matrix = distributed(1e-4);
      const Columns first  = solve(*matrix);
      for (double &value : matrix->values())
        value *= 1.1;
      EXPECT_GT(difference(solve(*matrix), first), 0.01);
      part->fill(*matrix);
      EXPECT_EQ(solve(*matrix), first);
      EXPECT_EQ(solve(*distributed(1e-4)), first);
    }

    double
    product(const Exchange &exchange, const Columns &a, const Columns &b)
    {
      return exchange.sum(std::inner_product(a.begin(), a.end(), b.begin(), 0.));
    }

    TEST_F(DistributedOperator, KeepsASymmetricPositiveInverse)
    {
      for (const auto partition : { slices, scattered })
      {
        make(bar(), left_end, partition);
        const auto    matrix   = distributed();
        const Columns solution = solve(*matrix);
        const auto    inverse  = matrix->keep();
        for (double &value : matrix->values()) // it outlives what comes after
          value *= 2.;
        matrix->factorize(part->positions);
        const auto [a, b] = halves(own_rows(right_side()));
        Columns kept_a = a, kept_b = b;
        inverse->apply(kept_a);
        inverse->apply(kept_b);
        const double a_a = product(*exchange, a, kept_a), a_b = product(*exchange, a, kept_b);
        EXPECT_GT(a_a, 0.);
        EXPECT_NEAR(product(*exchange, b, kept_a), a_b, 1e-5 * a_a);

        // linear: of a vector, of its multiple, and of a sum
        Columns sum;
        for (std::size_t i = 0; i < a.size(); ++i)
          sum.push_back(1e-9 * (a[i] - 2. * b[i]));
        inverse->apply(sum);
        for (std::size_t i = 0; i < a.size(); ++i)
          sum[i] = 1e9 * sum[i] + 2. * kept_b[i];
        EXPECT_LT(difference(sum, kept_a), 1e-3); // single precision

        // and about the inverse of the matrix then
        EXPECT_LT(difference(kept_a, halves(solution).first), partition == slices ? 0.1 : 0.5);
        Columns zeros(a.size(), 0.);
        inverse->apply(zeros);
        EXPECT_EQ(zeros, Columns(a.size(), 0.));
      }
    }

    TEST_F(DistributedOperator, KeepsAnInverseWhereAProcessHasNoUnknowns)
    {
      make(bar(),
           [](const dealii::Point<3> &x, unsigned int /*component*/) { return x[0] <= 2.5; });
      const auto    matrix   = distributed();
      const Columns solution = halves(solve(*matrix)).first;
      const auto    inverse  = matrix->keep();
      Columns       kept     = halves(own_rows(right_side())).first;
      inverse->apply(kept);
      EXPECT_LT(difference(kept, solution), 0.1);
      EXPECT_GT(inverse->cost_in_iterations(0), 1.);
      EXPECT_GT(inverse->cost_in_iterations(2), inverse->cost_in_iterations(0));
      EXPECT_GT(inverse->memory_consumption(), 0.);
    }

    TEST_F(DistributedOperator, FailsEverywhereWhereTheMatrixIsIndefinite)
    {
      make(bar(), left_end);
      const auto    matrix   = distributed();
      const auto    diagonal = part->pattern.column_start;
      const Columns expected = solve(*matrix);
      const bool    is_last  = this_process() + 1 == n_processes();
      for (const double factor : { -0.3, -0.9, -2., std::numeric_limits<double>::quiet_NaN() })
      {
        SCOPED_TRACE(factor);
        part->fill(*matrix);
        if (is_last)
          for (std::size_t i = 0; i + 1 < diagonal.size(); ++i)
            matrix->values()[diagonal[i]] *= 1. + factor;
        expect_indefinite(*matrix);
      }
      part->fill(*matrix); // beside the diagonal
      if (is_last)
        matrix->values()[1] = std::numeric_limits<double>::quiet_NaN();
      expect_indefinite(*matrix);
      part->fill(*matrix);
      EXPECT_EQ(solve(*matrix), expected);
    }
  } // namespace
} // namespace Exemplar::Testing
