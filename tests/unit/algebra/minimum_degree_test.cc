// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/minimum_degree.h>

#include <gtest/gtest.h>

namespace Exemplar::Testing
{
  namespace
  {
    TEST(MinimumDegree, CountsTheOperationsOfAFactor)
    {
      // an arrow, from whose tip elimination would fill the matrix, and which fills nothing from its other end
      constexpr int    n = 20;
      SymmetricPattern arrow, full;
      for (int j = 0; j < n; ++j)
      {
        arrow.column_start.push_back(static_cast<int>(arrow.row.size()));
        full.column_start.push_back(static_cast<int>(full.row.size()));
        for (int i = j; i < n; ++i)
        {
          full.row.push_back(i);
          if (i == j || j == 0)
            arrow.row.push_back(i);
        }
      }
      arrow.column_start.push_back(static_cast<int>(arrow.row.size()));
      full.column_start.push_back(static_cast<int>(full.row.size()));
      EXPECT_EQ(operations_by_minimum_degree(arrow), 4. * (n - 1) + 1.);
      EXPECT_EQ(operations_by_minimum_degree(full), n * (n + 1.) * (2. * n + 1.) / 6.);
    }
  } // namespace
} // namespace Exemplar::Testing
