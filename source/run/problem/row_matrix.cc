// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/problem/problem.h>
#include <exemplar/run/problem/row_matrix.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace Exemplar
{
  void
  SymmetricRows::follow(const SymmetricPattern &lower)
  {
    const auto n              = static_cast<int>(lower.n());
    const auto for_each_entry = [&](const auto &function)
    {
      // entries left of the diagonal come first, in the order of the columns of `lower`
      for (int column = 0; column < n; ++column)
        for (int entry = lower.column_start[column]; entry < lower.column_start[column + 1];
             ++entry)
          if (lower.row[entry] != column)
            function(lower.row[entry], column, entry);
      for (int column = 0; column < n; ++column)
        for (int entry = lower.column_start[column]; entry < lower.column_start[column + 1];
             ++entry)
          function(column, lower.row[entry], entry);
    };
    version = lower.version;
    pattern.row_start.assign(n + 1, 0);
    for_each_entry([&](const int row, int, int) { ++pattern.row_start[row + 1]; });
    std::partial_sum(pattern.row_start.begin(), pattern.row_start.end(), pattern.row_start.begin());
    pattern.column.resize(pattern.row_start[n]);
    source.resize(pattern.row_start[n]);
    std::vector<int> next(pattern.row_start.begin(), pattern.row_start.end() - 1);
    for_each_entry(
        [&](const int row, const int column, const int entry)
        {
          pattern.column[next[row]] = column;
          source[next[row]++]       = entry;
        });
  }

  RowMatrix
  SymmetricRows::with(const SymmetricPattern &lower, const std::vector<double> &values)
  {
    if (pattern.row_start.empty() || version != lower.version)
      follow(lower);
    RowMatrix matrix = pattern;
    matrix.value.resize(source.size());
    for (std::size_t i = 0; i < source.size(); ++i)
      matrix.value[i] = values[source[i]];
    return matrix;
  }

  RowMatrix
  mass_matrix(const Problem &problem)
  {
    const FESpace        &fe_space = problem.body.fe_space;
    std::unique_ptr<Mass> made;
    if (problem.actions.mass == nullptr)
      made = std::make_unique<Mass>(fe_space, problem.body.material,
                                    problem.parameters.material.mass_matrix);
    const auto &nodal = (made != nullptr ? *made : *problem.actions.mass).nodal();
    RowMatrix   matrix;
    matrix.row_start.push_back(0);
    for (unsigned int dof = 0; dof < fe_space.n_dofs(); ++dof)
    {
      std::vector<std::pair<int, double>> row;
      for (auto entry = nodal.begin(dof / 3); entry != nodal.end(dof / 3); ++entry)
        row.emplace_back(3 * entry->column() + dof % 3, entry->value());
      std::sort(row.begin(), row.end()); // deal.II puts the diagonal first
      for (const auto &[column, value] : row)
      {
        matrix.column.push_back(column);
        matrix.value.push_back(value);
      }
      matrix.row_start.push_back(static_cast<int>(matrix.column.size()));
    }
    return matrix;
  }
} // namespace Exemplar
