// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed_body.h"

#include <exemplar/algebra/multigrid_operator.h>

#include <limits>

namespace Exemplar::Testing
{
  namespace
  {
    using Indices = std::vector<int>;

    class Rows : public Distributed
    {
    protected:
      std::unique_ptr<DistributedRows>
      make_rows()
      {
        auto rows = std::make_unique<DistributedRows>(part->free_dofs);
        rows->reinit(part->pattern);
        rows->fill(part->values());
        return rows;
      }

      /// The matrix of one process times a vector.
      Columns
      product_alone(const Columns &vector) const
      {
        const SymmetricPattern &pattern = whole->pattern;
        const Columns           values  = whole->values();
        Columns                 image(vector.size(), 0.);
        for (unsigned int j = 0; j < pattern.n(); ++j)
          for (int entry = pattern.column_start[j]; entry < pattern.column_start[j + 1]; ++entry)
          {
            const unsigned int i = pattern.row[entry];
            image[i] += values[entry] * vector[j];
            if (i != j)
              image[j] += values[entry] * vector[i];
          }
        return image;
      }

      /// Products are those of one process, and the rows of held components give what they are given.
      void
      expect_the_same_product()
      {
        const auto        rows   = make_rows();
        const RowNumbers &of     = rows->get_numbers();
        Columns           vector = right_side();
        vector.resize(vector.size() / 2);
        const Columns own = own_rows(vector);
        Vector        x(of.n_rows()), image(of.n_rows());
        for (double &entry : x) // a process may have no rows
          entry = 7.;
        for (std::size_t i = 0; i < own.size(); ++i)
          x[of.row_of()[i]] = own[i];
        rows->multiply(x, image);
        Columns product;
        for (const int row : of.row_of())
        {
          product.push_back(image[row]);
          image[row] = 7.;
        }
        EXPECT_LT(difference(product, own_rows(product_alone(vector))), 1e-14);
        for (const double entry : image)
          EXPECT_EQ(entry, 7.);
      }
    };

    bool
    rollers(const dealii::Point<3> &x, const unsigned int component)
    {
      return x[0] == 0. && (component == 0 || x[component] < -0.4);
    }

    TEST_F(Rows, MultiplyAsOneProcessDoes)
    {
      for (const auto partition : { slices, scattered })
        for (const auto is_held : { left_end, rollers })
        {
          make(bar(), is_held, partition);
          expect_the_same_product();
        }
    }

    TEST_F(Rows, MayBeNone)
    {
      make(bar(), [](const dealii::Point<3> &x, unsigned int) { return x[0] <= 2.5; });
      expect_the_same_product();
      make(bar(), [](const dealii::Point<3> &, unsigned int) { return true; });
      EXPECT_EQ(make_rows()->get_matrix().row_start, std::vector<int>{ 0 });
    }

    TEST_F(Rows, AreNumberedOneProcessAfterTheOther)
    {
      make(bar(), left_end, scattered);
      const auto        rows = make_rows();
      const RowNumbers &of   = rows->get_numbers();
      EXPECT_EQ(of.first_nodes().size(), n_processes() + 1);
      EXPECT_EQ(3 * of.first_nodes().back(), whole->free_dofs.size());
      const std::vector<int> columns = rows->global_columns();
      for (unsigned int row = 0; row < of.n_rows(); ++row)
        EXPECT_EQ(columns[row], of.first_row() + static_cast<int>(row));
      EXPECT_TRUE(std::is_sorted(columns.begin() + of.n_rows(), columns.end()));
      for (std::size_t k = 0; k < columns.size(); ++k)
        EXPECT_EQ(of.owner(columns[k]) == this_process(), k < of.n_rows());
      const CsrMatrix &matrix = rows->get_matrix();
      EXPECT_EQ(matrix.column.size(), matrix.value.size());
      EXPECT_EQ(matrix.row_start.back(), static_cast<int>(matrix.column.size()));
      for (unsigned int row = 0; row < of.n_rows(); ++row)
        for (int entry = matrix.row_start[row] + 1; entry < matrix.row_start[row + 1]; ++entry)
          EXPECT_LT(matrix.column[entry - 1], matrix.column[entry]);
    }

    TEST_F(Rows, AreRefusedByAllWhereTheDiagonalIsNotPositive)
    {
      make(bar(), left_end, scattered);
      const auto rows = make_rows();
      for (const double entry : { 0., -1., std::numeric_limits<double>::quiet_NaN() })
      {
        std::vector<double> values = part->values();
        if (this_process() + 1 == n_processes())
          for (unsigned int j = 0; j < part->pattern.n(); ++j)
            values[part->pattern.column_start[j]] *= n_processes() * entry - 1.;
        EXPECT_THROW(rows->fill(values), SolverFailure);
      }
    }

    /// No library's multigrid: a level, of which the coarsest inverse is a dense one.
    std::vector<MultigridLevel>
    make_one_level(DistributedRows &rows, const std::vector<double> & /*modes*/)
    {
      const CsrMatrix       &matrix   = rows.get_matrix();
      const RowNumbers      &numbers  = rows.get_numbers();
      const std::vector<int> all      = rows.global_columns();
      const auto             read_row = [&](const int row, Indices &columns, Columns &values)
      {
        const int begin = matrix.row_start[row], end = matrix.row_start[row + 1];
        std::copy(&matrix.column[begin], &matrix.column[end], columns.begin());
        std::copy(&matrix.value[begin], &matrix.value[end], values.begin());
        return end - begin;
      };
      std::vector<MultigridLevel> levels;
      levels.push_back(
          { make_block_matrix(numbers.n_rows() / 3, numbers.first_nodes(),
                              { all.begin(), all.end() }, read_row, numbers.exchange()),
            BlockMatrix(Halo()) });
      return levels;
    }

    TEST_F(Rows, MayHaveOuterProductsBesideThem)
    {
      for (const auto partition : { slices, scattered })
        for (const auto is_held : { left_end, rollers })
        {
          make(box_mesh(4., 6, 2), is_held, partition);
          const auto    matrix      = part->reinit(std::make_unique<MultigridOperator>(
              part->free_dofs, 1e-13, std::vector<unsigned int>(), make_one_level));
          const Columns without     = solve(*matrix);
          *matrix->outer_products() = own_products;
          const Columns with = solve(*matrix), expected = own_rows(solve_assembled());
          EXPECT_LT(difference(with, expected), 1e-10);
          EXPECT_GT(difference(without, expected), 0.01); // else it proves nothing
        }
    }

    TEST_F(Rows, AreSolvedWithAnyLibrary)
    {
      for (const auto is_held : { left_end, rollers })
      {
        make(box_mesh(4., 6, 2), is_held, scattered);
        const auto matrix = part->reinit(std::make_unique<MultigridOperator>(
            part->free_dofs, 1e-13, std::vector<unsigned int>(), make_one_level));
        EXPECT_LT(difference(solve(*matrix), own_rows(solve_alone(make_cholesky_operator()))),
                  1e-10);
      }
    }
  } // namespace
} // namespace Exemplar::Testing
