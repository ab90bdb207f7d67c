// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/dense.h>
#include <exemplar/algebra/rigid_correction.h>
#include <exemplar/algebra/rigid_modes.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    constexpr double least_pivot
        = 1e-12; ///< motions that others contain, as where handles hold nodes
  }              // namespace

  template <typename Action>
  void
  RigidCorrection::for_each_motion(const std::size_t row, const Action &action) const
  {
    if (is_free[row] == 0)
      return;
    const std::size_t c = row % 3, first = n_rigid_modes * pieces[row / 3];
    const double     *x = places.data() + (row - c);
    action(first + c, 1.);
    action(first + 3 + (c + 1) % 3, x[(c + 2) % 3]);
    action(first + 3 + (c + 2) % 3, -x[(c + 1) % 3]);
  }

  RigidCorrection::RigidCorrection(const std::vector<double>       &places,
                                   const std::vector<unsigned int> &pieces,
                                   const std::vector<int>          &rows,
                                   const Multiply                  &multiply,
                                   const Exchange                  &exchange)
      : exchange(&exchange), places(places), pieces(pieces), is_free(places.size(), 0)
  {
    for (const int row : rows)
      is_free[row] = 1;
    const unsigned int last = pieces.empty() ? 0 : *std::max_element(pieces.begin(), pieces.end());
    const auto n_columns    = n_rigid_modes * (static_cast<std::size_t>(exchange.max(last)) + 1);
    factor.reinit(n_columns, n_columns);
    Vector motion(std::max<std::size_t>(n_rows(), 1)), image(motion);
    for (std::size_t j = 0; j < n_columns; ++j)
    {
      motion = 0.;
      for (std::size_t row = 0; row < n_rows(); ++row)
        for_each_motion(row,
                        [&](const std::size_t column, const double entry)
                        {
                          if (column == j)
                            motion[row] = entry;
                        });
      multiply(motion, image);
      const std::vector<double> column = components(image);
      for (std::size_t i = 0; i < n_columns; ++i)
        factor(i, j) = column[i];
    }
    factorize_by_cholesky(factor, [](unsigned int, const double pivot, const double entry)
                          { return pivot > least_pivot * entry ? pivot : 0.; });
  }

  std::vector<double>
  RigidCorrection::components(const Vector &vector) const
  {
    std::vector<double> result(factor.m(), 0.);
    for (std::size_t row = 0; row < n_rows(); ++row)
      for_each_motion(row, [&](const std::size_t column, const double entry)
                      { result[column] += entry * vector[row]; });
    exchange->sum(result);
    return result;
  }

  void
  RigidCorrection::add(const Vector &residual, Vector &image) const
  {
    std::vector<double> amounts = components(residual);
    solve_with_factor(factor, amounts);
    for (std::size_t row = 0; row < n_rows(); ++row)
      for_each_motion(row, [&](const std::size_t column, const double entry)
                      { image[row] += entry * amounts[column]; });
  }
} // namespace Exemplar
