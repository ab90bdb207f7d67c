// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/spd_operator.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>

namespace Exemplar::Testing
{
  namespace
  {
    using Entries = std::map<std::pair<int, int>, double>; ///< column, row

    /// The Laplacian of a grid of n x n points, plus I, and springs between some of them.
    Entries
    grid(const int n, const std::vector<std::pair<int, int>> &springs)
    {
      Entries    entries;
      const auto connect = [&](const int a, const int b)
      {
        entries[{ a, a }] += 1.;
        entries[{ b, b }] += 1.;
        entries[{ std::min(a, b), std::max(a, b) }] -= 1.;
      };
      for (int i = 0; i < n * n; ++i)
      {
        entries[{ i, i }] += 1.;
        if (i % n + 1 < n)
          connect(i, i + 1);
        if (i + n < n * n)
          connect(i, i + n);
      }
      for (const auto &[a, b] : springs)
        connect(a, b);
      return entries;
    }

    SymmetricPattern
    pattern_of(const Entries &entries, const int n)
    {
      SymmetricPattern pattern;
      pattern.column_start.assign(n + 1, 0);
      for (const auto &[place, value] : entries)
      {
        pattern.row.push_back(place.second);
        ++pattern.column_start[place.first + 1];
      }
      for (int j = 0; j < n; ++j)
        pattern.column_start[j + 1] += pattern.column_start[j];
      return pattern;
    }

    std::vector<double>
    solution(SpdOperator &matrix, const Entries &entries)
    {
      std::size_t k = 0;
      for (const auto &[place, value] : entries)
        matrix.values()[k++] = value;
      matrix.factorize({});
      std::vector<double> x(900, 1.);
      matrix.solve(x);
      return x;
    }

    /// |A x - b|
    double
    residual(const Entries &entries, const std::vector<double> &x)
    {
      std::vector<double> rest(x.size(), -1.);
      for (const auto &[place, value] : entries)
      {
        rest[place.second] += value * x[place.first];
        if (place.first != place.second)
          rest[place.first] += value * x[place.second];
      }
      double sum = 0.;
      for (const double r : rest)
        sum += r * r;
      return std::sqrt(sum);
    }

    std::vector<std::pair<int, int>>
    random_springs(const unsigned int n)
    {
      std::mt19937                       generator(7);
      std::uniform_int_distribution<int> node(0, 899);
      std::vector<std::pair<int, int>>   springs;
      while (springs.size() < n)
        if (const int a = node(generator), b = node(generator); a != b)
          springs.emplace_back(a, b);
      return springs;
    }

    /// Few springs stand in the order of the grid, many are worth an order of their own.
    TEST(KeptOrder, SolutionsDoNotDependOnThePatternsBefore)
    {
      const Entries plain      = grid(30, {});
      const auto    of_plain   = std::make_shared<const SymmetricPattern>(pattern_of(plain, 900));
      const auto    with_plain = [&](const Entries &entries)
      {
        SymmetricPattern pattern = pattern_of(entries, 900);
        pattern.plain            = of_plain;
        return pattern;
      };
      const auto used = make_cholesky_operator();
      for (const unsigned int n_springs : { 3u, 0u, 200u, 1u, 0u })
      {
        const Entries entries = grid(30, random_springs(n_springs));
        used->reinit(with_plain(entries));
        const std::vector<double> x     = solution(*used, entries);
        const auto                fresh = make_cholesky_operator();
        fresh->reinit(with_plain(entries));
        EXPECT_EQ(x, solution(*fresh, entries)) << n_springs;
        EXPECT_LT(residual(entries, x), 1e-11) << n_springs;
        if (n_springs == 0)
        {
          fresh->reinit(*of_plain); // as before there was any spring
          EXPECT_EQ(x, solution(*fresh, entries));
        }
      }
    }

    TEST(KeptOrder, ManyCouplingsGetAnOrderOfTheirOwn)
    {
      const Entries    entries = grid(30, random_springs(200));
      SymmetricPattern pattern = pattern_of(entries, 900);
      const auto by_itself = make_cholesky_operator(), beside_plain = make_cholesky_operator();
      by_itself->reinit(pattern);
      pattern.plain = std::make_shared<const SymmetricPattern>(pattern_of(grid(30, {}), 900));
      beside_plain->reinit(pattern);
      EXPECT_EQ(by_itself->traits().n_operations, beside_plain->traits().n_operations);
    }

    /// The unknowns of a sheet of 60 x 60 squares that are cut into two triangles: three at a node, one at the middle of an edge.
    SymmetricPattern
    pattern_of_sheet()
    {
      constexpr int                      n    = 61;
      const auto                         node = [](const int i, const int j) { return j * n + i; };
      std::map<std::pair<int, int>, int> slopes;
      Entries                            entries;
      const auto                         add_triangle = [&](const std::array<int, 3> &nodes)
      {
        std::vector<int> unknowns;
        for (int i = 0; i < 3; ++i)
        {
          const auto edge = std::minmax(nodes[i], nodes[(i + 1) % 3]);
          const int  next = 3 * n * n + static_cast<int>(slopes.size());
          unknowns.push_back(slopes.insert({ edge, next }).first->second);
          for (int c = 0; c < 3; ++c)
            unknowns.push_back(3 * nodes[i] + c);
        }
        for (const int a : unknowns)
          for (const int b : unknowns)
            entries[{ std::min(a, b), std::max(a, b) }] += a == b ? 1. : 0.;
      };
      for (int j = 0; j + 1 < n; ++j)
        for (int i = 0; i + 1 < n; ++i)
        {
          add_triangle({ { node(i, j), node(i + 1, j), node(i + 1, j + 1) } });
          add_triangle({ { node(i, j), node(i + 1, j + 1), node(i, j + 1) } });
        }
      return pattern_of(entries, 3 * n * n + static_cast<int>(slopes.size()));
    }

    TEST(KeptOrder, SurfacesAreOrderedByTheirSeparators)
    {
      SymmetricPattern pattern = pattern_of_sheet();
      const auto by_degrees = make_cholesky_operator(), by_separators = make_cholesky_operator(),
                 again = make_cholesky_operator();
      by_degrees->reinit(pattern);
      pattern.is_of_surface = true;
      by_separators->reinit(pattern);
      again->reinit(pattern);
      EXPECT_LT(1.3 * by_separators->traits().n_operations, by_degrees->traits().n_operations);
      EXPECT_EQ(by_separators->traits().n_operations, again->traits().n_operations);
    }
  } // namespace
} // namespace Exemplar::Testing
