// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/patch_scatter.h>

#include <deal.II/base/memory_consumption.h>

#include <algorithm>
#include <array>

namespace Exemplar
{
  namespace
  {
    std::vector<unsigned int>
    nodes_of(const Patches &patches, const FESpace &fe_space, const unsigned int patch)
    {
      std::vector<unsigned int> nodes;
      for (const unsigned int point : patches.points(patch))
        for (const unsigned int node : fe_space.nodes(fe_space.cell_of(point)))
          nodes.push_back(node);
      std::sort(nodes.begin(), nodes.end());
      nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
      return nodes;
    }
  } // namespace

  PatchScatter::PatchScatter(const Patches          &patches,
                             const FESpace          &fe_space,
                             const SymmetricPattern &pattern,
                             const FreeDofs         &free_dofs,
                             const CellField        &cells,
                             const bool              has_couplings)
      : fe_space(fe_space), free_dofs(free_dofs), node_starts(1, 0)
  {
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
    {
      const std::vector<unsigned int> nodes = nodes_of(patches, fe_space, patch);
      all_nodes.insert(all_nodes.end(), nodes.begin(), nodes.end());
      node_starts.push_back(all_nodes.size());
    }
    find_points(patches, cells);
    find_held();
    if (has_couplings)
      find_columns(pattern);
  }

  std::vector<std::pair<unsigned int, unsigned int>>
  PatchScatter::couplings(const Patches &patches, const FESpace &fe_space)
  {
    std::vector<std::pair<unsigned int, unsigned int>> pairs;
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
    {
      const std::vector<unsigned int> nodes = nodes_of(patches, fe_space, patch);
      for (std::size_t a = 0; a < nodes.size(); ++a)
        for (std::size_t b = 0; b < a; ++b)
          pairs.emplace_back(nodes[b], nodes[a]);
    }
    return pairs;
  }

  std::size_t
  PatchScatter::place(const unsigned int patch, const unsigned int node) const
  {
    const auto nodes = all_nodes.begin();
    return std::lower_bound(nodes + node_starts[patch], nodes + node_starts[patch + 1], node)
           - nodes;
  }

  void
  PatchScatter::find_points(const Patches &patches, const CellField &cells)
  {
    of_points.starts.push_back(0);
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
    {
      for (const unsigned int point : patches.points(patch))
      {
        of_points.points.push_back(point);
        of_points.fractions.push_back(fe_space.volume(point) / patches.volume(patch));
        for (unsigned int a = 0; a < fe_space.gradients(point).size(); ++a)
          of_points.places.push_back(static_cast<int>(place(patch, cells.node(point, a))));
      }
      of_points.starts.push_back(of_points.points.size());
    }
  }

  int
  PatchScatter::first_free(const unsigned int node) const
  {
    for (unsigned int c = 0; c < 3; ++c)
      if (const int index = free_dofs.free_index(3 * node + c); index != FreeDofs::held)
        return index;
    return FreeDofs::held;
  }

  void
  PatchScatter::find_held()
  {
    for (unsigned int patch = 0; patch + 1 < node_starts.size(); ++patch)
    {
      beside_held.push_back(false);
      for (auto place = node_starts[patch]; place < node_starts[patch + 1]; ++place)
      {
        unsigned int n_held = 0;
        for (unsigned int c = 0; c < 3; ++c)
          n_held += free_dofs.free_index(3 * all_nodes[place] + c) == FreeDofs::held ? 1 : 0;
        if (n_held == 1 || n_held == 2)
          mixed.push_back(place);
        if (n_held > 0)
          beside_held.back() = true;
      }
    }
  }

  void
  PatchScatter::find_columns(const SymmetricPattern &pattern)
  {
    std::vector<std::vector<PatchAtNode>> at_nodes(fe_space.n_nodes());
    for (unsigned int patch = 0; patch + 1 < node_starts.size(); ++patch)
      for (auto place = node_starts[patch]; place < node_starts[patch + 1]; ++place)
        if (first_free(all_nodes[place]) != FreeDofs::held)
          at_nodes[all_nodes[place]].push_back({ patch, static_cast<unsigned int>(place), 0 });
    of_columns.starts.push_back(0);
    for (unsigned int node = 0; node < at_nodes.size(); ++node)
    {
      if (at_nodes[node].empty())
        continue;
      std::array<int, 3> columns = { { -1, -1, -1 } };
      unsigned int       n       = 0;
      for (unsigned int c = 0; c < 3; ++c)
        if (const int index = free_dofs.free_index(3 * node + c); index != FreeDofs::held)
          columns[n++] = pattern.column_start[index];
      of_columns.columns.insert(of_columns.columns.end(), columns.begin(), columns.end());
      for (PatchAtNode &at : at_nodes[node])
      {
        at.offsets = of_columns.offsets.size();
        append_offsets(pattern, at.place, node_starts[at.patch + 1]);
        of_columns.patches.push_back(at);
      }
      of_columns.starts.push_back(of_columns.patches.size());
    }
  }

  void
  PatchScatter::append_offsets(const SymmetricPattern &pattern,
                               const std::size_t       place,
                               const std::size_t       end)
  {
    const int column = first_free(all_nodes[place]);
    for (std::size_t other = place; other < end; ++other)
    {
      const int row = first_free(all_nodes[other]);
      of_columns.offsets.push_back(row == FreeDofs::held ? -1
                                                         : pattern.position(row, column)
                                                               - pattern.column_start[column]);
    }
  }

  void
  PatchScatter::find_gradients(CellField &cells, PatchVectors &b) const
  {
    find_gradients(cells, cells.arrays().rotations, b);
  }

  void
  PatchScatter::find_gradients(CellField &cells, double *matrices, PatchVectors &b) const
  {
    b.resize(4 * n_nodes());
    const PatchArrays arrays
        = { node_starts.data(),         of_points.starts.data(), of_points.points.data(),
            of_points.fractions.data(), of_points.places.data(), b.data() };
    CellArrays points = cells.arrays();
    points.rotations  = matrices;
    const int n       = cells.n_threads();
    for_each_part(n, node_starts.size() - 1, n,
                  [&](std::size_t /*part*/, const std::size_t begin, const std::size_t end)
                  { cells.loops().patch_gradients(points, arrays, begin, end); });
  }

  double
  PatchScatter::mean(const unsigned int patch, const double *numbers) const
  {
    double sum = 0.;
    for (std::size_t k = of_points.starts[patch]; k < of_points.starts[patch + 1]; ++k)
      sum += of_points.fractions[k] * numbers[of_points.points[k]];
    return sum;
  }

  double
  PatchScatter::product(const unsigned int  patch,
                        const PatchVectors &vectors,
                        const Vector       &field) const
  {
    double sum = 0.;
    for (std::size_t place = node_starts[patch]; place < node_starts[patch + 1]; ++place)
      for (unsigned int c = 0; c < 3; ++c)
        sum += vectors[4 * place + c] * field[3 * all_nodes[place] + c];
    return sum;
  }

  void
  PatchScatter::add(const unsigned int  patch,
                    const double        factor,
                    const PatchVectors &vectors,
                    Vector             &field) const
  {
    for (std::size_t place = node_starts[patch]; place < node_starts[patch + 1]; ++place)
      for (unsigned int c = 0; c < 3; ++c)
        field[3 * all_nodes[place] + c] += factor * vectors[4 * place + c];
  }

  void
  PatchScatter::add_at_cell(const unsigned int         patch,
                            const unsigned int         point,
                            const double               factor,
                            const std::vector<double> &of_cell,
                            PatchVectors              &vectors) const
  {
    const double *from = of_cell.data();
    for (const unsigned int node : fe_space.nodes(fe_space.cell_of(point)))
    {
      double *to = &vectors[4 * place(patch, node)];
      for (unsigned int c = 0; c < 3; ++c)
        to[c] += factor * *from++;
    }
  }

  void
  PatchScatter::pack(PatchVectors &vectors) const
  {
    if (vectors.empty())
      return;
    for (const std::size_t place : mixed)
    {
      unsigned int n = 0;
      double      *v = &vectors[4 * place];
      for (unsigned int c = 0; c < 3; ++c)
        if (free_dofs.free_index(3 * all_nodes[place] + c) != FreeDofs::held)
          v[n++] = v[c];
      std::fill(v + n, v + 3, 0.);
    }
  }

  void
  PatchScatter::add_products(const CellField     &cells,
                             PatchProducts       &products,
                             std::vector<double> &values) const
  {
    for (PatchVectors *vectors : { &products.vectors, &products.squares, &products.sums })
      pack(*vectors);
    const PatchColumns to = {
      node_starts.data(),         of_columns.starts.data(),
      of_columns.patches.data(),  of_columns.columns.data(),
      of_columns.offsets.data(),  products.factors.data(),
      products.vectors.data(),    products.squares.empty() ? nullptr : products.squares.data(),
      products.sums.data(),       products.of_squares.data(),
      products.of_products.data()
    };
    const auto add = [&](const std::size_t begin, const std::size_t end)
    { cells.loops().add_patch_products(to, begin, end, values.data()); };
    // up to three values behind those of a part may be of the next one: its last nodes wait
    const std::size_t n_columns = of_columns.starts.size() - 1;
    const int         n         = cells.n_threads();
    const auto        last_of   = [](const std::size_t begin, const std::size_t end)
    { return end - std::min<std::size_t>(3, end - begin); };
    for_each_part(n, n_columns, n,
                  [&](std::size_t /*part*/, const std::size_t begin, const std::size_t end)
                  { add(begin, last_of(begin, end)); });
    for_each_part(n, n_columns, 1,
                  [&](std::size_t /*part*/, const std::size_t begin, const std::size_t end)
                  { add(last_of(begin, end), end); });
  }

  std::vector<double>
  PatchScatter::of_nodes(const unsigned int patch, const PatchVectors &vectors) const
  {
    std::vector<double> numbers;
    for (std::size_t place = node_starts[patch]; place < node_starts[patch + 1]; ++place)
      numbers.insert(numbers.end(), &vectors[4 * place], &vectors[4 * place] + 3);
    return numbers;
  }

  void
  PatchScatter::add_products(const PatchProducts &products, OuterProducts &to) const
  {
    for (unsigned int patch = 0; patch + 1 < node_starts.size(); ++patch)
    {
      const std::vector<unsigned int> nodes(all_nodes.begin() + node_starts[patch],
                                            all_nodes.begin() + node_starts[patch + 1]);
      to.add(products.factors[patch], nodes, of_nodes(patch, products.vectors));
      if (products.squares.empty())
        continue;
      const std::vector<double> square = of_nodes(patch, products.squares);
      if (products.of_squares[patch] != 0.)
        to.add(products.of_squares[patch], nodes, square);
      if (products.of_products[patch] == 0.)
        continue;
      // u v^T + v u^T = ((u + v) (u + v)^T - (u - v) (u - v)^T) / 2
      std::vector<double> sum = of_nodes(patch, products.sums), difference = square;
      for (std::size_t i = 0; i < sum.size(); ++i)
      {
        difference[i] -= sum[i];
        sum[i] += square[i];
      }
      to.add(0.5 * products.of_products[patch], nodes, sum);
      to.add(-0.5 * products.of_products[patch], nodes, difference);
    }
  }

  void
  PatchScatter::add_column(const unsigned int  patch,
                           const double        factor,
                           const PatchVectors &b,
                           double             *column) const
  {
    for (std::size_t place = node_starts[patch]; place < node_starts[patch + 1]; ++place)
      for (unsigned int c = 0; c < 3; ++c)
        if (const int index = free_dofs.free_index(3 * all_nodes[place] + c);
            index != FreeDofs::held)
          column[index] += factor * b[4 * place + c];
  }

  std::size_t
  PatchScatter::memory_consumption() const
  {
    using dealii::MemoryConsumption::memory_consumption;
    return memory_consumption(node_starts) + memory_consumption(all_nodes)
           + memory_consumption(of_points.starts) + memory_consumption(of_points.points)
           + memory_consumption(of_points.fractions) + memory_consumption(of_points.places)
           + memory_consumption(of_columns.starts)
           + of_columns.patches.capacity() * sizeof(PatchAtNode)
           + memory_consumption(of_columns.columns) + memory_consumption(of_columns.offsets)
           + memory_consumption(mixed);
  }
} // namespace Exemplar
