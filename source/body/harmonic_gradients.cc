// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/spd_operator.h>
#include <exemplar/body/grain_axes.h>

#include <algorithm>
#include <array>
#include <set>

namespace Exemplar
{
  namespace
  {
    using Gradient = dealii::Tensor<1, 3>;

    /// Gradients of the linear shape functions of a cell, and its volume.
    struct ShapeGradients
    {
      std::array<Gradient, 4> g;
      double                  volume;
    };

    ShapeGradients
    shape_gradients(const Mesh &mesh, const std::array<unsigned int, 4> &nodes)
    {
      const auto &x = mesh.get_nodes();
      Gradient    edge[3];
      for (int a = 0; a < 3; ++a)
        edge[a] = x[nodes[a + 1]] - x[nodes[0]];
      const double   det = edge[0] * cross_product_3d(edge[1], edge[2]);
      ShapeGradients cell{ {}, det / 6. };
      for (int a = 0; a < 3; ++a)
      {
        cell.g[a + 1] = cross_product_3d(edge[(a + 1) % 3], edge[(a + 2) % 3]) / det;
        cell.g[0] -= cell.g[a + 1];
      }
      return cell;
    }

    constexpr int fixed = -1;

    /// Index of each node among the unknowns: the free nodes connected to a fixed one by cells.
    std::vector<int>
    number_unknowns(const Mesh &mesh, const std::vector<bool> &is_fixed)
    {
      std::vector<std::vector<unsigned int>> around(mesh.n_nodes());
      for (unsigned int cell = 0; cell < mesh.n_cells(); ++cell)
        for (const unsigned int node : mesh.get_cells()[cell])
          around[node].push_back(cell);
      std::vector<bool>         is_reached = is_fixed;
      std::vector<unsigned int> reached;
      for (unsigned int node = 0; node < is_fixed.size(); ++node)
        if (is_fixed[node])
          reached.push_back(node);
      while (!reached.empty())
      {
        const unsigned int node = reached.back();
        reached.pop_back();
        for (const unsigned int cell : around[node])
          for (const unsigned int other : mesh.get_cells()[cell])
            if (!is_reached[other])
            {
              is_reached[other] = true;
              reached.push_back(other);
            }
      }
      std::vector<int> number(mesh.n_nodes(), fixed);
      int              n = 0;
      for (unsigned int node = 0; node < number.size(); ++node)
        if (is_reached[node] && !is_fixed[node])
          number[node] = n++;
      return number;
    }

    SymmetricPattern
    make_pattern_of(const Mesh &mesh, const std::vector<int> &number, const int n)
    {
      std::vector<std::set<int>> columns(n);
      for (int i = 0; i < n; ++i)
        columns[i].insert(i);
      for (const auto &cell : mesh.get_cells())
        for (const unsigned int a : cell)
          for (const unsigned int b : cell)
            if (number[b] != fixed && number[a] > number[b])
              columns[number[b]].insert(number[a]);
      SymmetricPattern pattern;
      pattern.column_start = { 0 };
      for (const std::set<int> &column : columns)
      {
        pattern.row.insert(pattern.row.end(), column.begin(), column.end());
        pattern.column_start.push_back(static_cast<int>(pattern.row.size()));
      }
      return pattern;
    }

    /// Solve Laplace's equation for the values of the unknowns, with the other values fixed.
    void
    solve_laplace(const Mesh &mesh, const std::vector<int> &number, std::vector<double> &values)
    {
      const int n = 1 + *std::max_element(number.begin(), number.end());
      if (n == 0)
        return;
      const SymmetricPattern pattern = make_pattern_of(mesh, number, n);
      const auto             matrix  = make_cholesky_operator();
      matrix->reinit(pattern);
      std::fill(matrix->values().begin(), matrix->values().end(), 0.);
      std::vector<double> right(n, 0.);
      for (const auto &nodes : mesh.get_cells())
      {
        const ShapeGradients cell = shape_gradients(mesh, nodes);
        for (int a = 0; a < 4; ++a)
          for (int b = 0; b < 4; ++b)
          {
            const int    i = number[nodes[a]], j = number[nodes[b]];
            const double entry = cell.volume * (cell.g[a] * cell.g[b]);
            if (i != fixed && j == fixed)
              right[i] -= entry * values[nodes[b]];
            else if (j != fixed && i >= j)
              matrix->values()[pattern.position(i, j)] += entry;
          }
      }
      matrix->factorize(Vector());
      matrix->solve(right);
      for (unsigned int node = 0; node < number.size(); ++node)
        if (number[node] != fixed)
          values[node] = right[number[node]];
    }
  } // namespace

  std::vector<dealii::Tensor<1, 3>>
  harmonic_gradients(const Mesh                      &mesh,
                     const std::vector<unsigned int> &from,
                     const std::vector<unsigned int> &to)
  {
    std::vector<bool>   is_fixed(mesh.n_nodes(), false);
    std::vector<double> values(mesh.n_nodes(), 0.);
    for (const unsigned int node : from)
      is_fixed[node] = true;
    for (const unsigned int node : to)
    {
      is_fixed[node] = true;
      values[node]   = 1.;
    }
    solve_laplace(mesh, number_unknowns(mesh, is_fixed), values);
    std::vector<Gradient> gradients;
    for (const auto &nodes : mesh.get_cells())
    {
      const ShapeGradients cell = shape_gradients(mesh, nodes);
      Gradient             gradient;
      for (int a = 0; a < 4; ++a)
        gradient += (values[nodes[a]] - values[nodes[0]]) * cell.g[a];
      gradients.push_back(gradient);
    }
    return gradients;
  }
} // namespace Exemplar
