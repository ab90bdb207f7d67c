// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_length_filter_h
#define exemplar_length_filter_h

#include <exemplar/algebra/spd_operator.h>
#include <exemplar/body/fe_space.h>

#include <memory>
#include <vector>

namespace Exemplar
{
  /// Spreads fields of cells over about a length [m], measured inside the body: the nodes' values s of
  /// s - l^2 Laplace s = field, with natural boundary conditions and l = length / (2 sqrt 3), the filter of
  /// Lazarov and Sigmund 2011, on linear elements with lumped mass; only for a single process.
  class LengthFilter
  {
  public:
    /// `linear` must outlive the filter.
    LengthFilter(const FESpace &linear, double length);

    /// The fields at the nodes, one field after the other, from their loads as add() makes them.
    void
    solve(std::vector<double> &loads) const;

    /// Add the load of a field's value in a cell to the `loads` of a field, a number a node.
    void
    add(const unsigned int cell, const double value, double *const loads) const
    {
      for (const unsigned int node : linear.nodes(cell))
        loads[node] += 0.25 * linear.volume(cell) * value;
    }

    /// The mean of the nodes' values in a cell.
    double
    mean(const unsigned int cell, const double *const values) const
    {
      double sum = 0.;
      for (const unsigned int node : linear.nodes(cell))
        sum += 0.25 * values[node];
      return sum;
    }

  private:
    const FESpace               &linear;
    std::unique_ptr<SpdOperator> matrix;
  };
} // namespace Exemplar

#endif
