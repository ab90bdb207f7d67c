// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tests_distributed_body_h
#define exemplar_tests_distributed_body_h

#include "../unit/body.h"

#include <exemplar/algebra/mpi_exchange.h>
#include <exemplar/algebra/spd_operator.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

// A body that processes share, and the matrix of its elasticity: all processes run all tests.
namespace Exemplar::Testing
{
  using Columns = std::vector<double>;

  inline unsigned int
  n_processes()
  {
    return dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  }

  inline unsigned int
  this_process()
  {
    return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  }

  /// The process of each tetrahedron.
  using Partition = std::vector<unsigned int>;

  inline std::vector<const MshElement *>
  tetrahedra(const MshFile &msh)
  {
    std::vector<const MshElement *> cells;
    for (const MshElement &element : msh.elements)
      if (element.type == MshElementType::tetrahedron)
        cells.push_back(&element);
    return cells;
  }

  /// Slices of a bar of length 4.
  inline Partition
  slices(const MshFile &msh)
  {
    Partition partition;
    for (const MshElement *cell : tetrahedra(msh))
    {
      double x = 0.;
      for (const std::size_t node : cell->nodes)
        x += 0.25 * msh.nodes[node][0];
      partition.push_back(static_cast<unsigned int>(x * n_processes() / 4.));
    }
    return partition;
  }

  /// Neighbours are at different processes: most nodes are shared, and many of them are coupled
  /// by cells of others alone.
  inline Partition
  scattered(const MshFile &msh)
  {
    Partition partition;
    for (std::size_t cell = 0; cell < tetrahedra(msh).size(); ++cell)
      partition.push_back((cell * cell + cell / 3) % n_processes());
    return partition;
  }

  /// The lowest process with a cell at a node owns it.
  inline std::vector<unsigned int>
  find_owners(const MshFile &msh, const Partition &partition)
  {
    std::vector<unsigned int> owners(msh.nodes.size(), n_processes());
    const auto                cells = tetrahedra(msh);
    for (std::size_t cell = 0; cell < cells.size(); ++cell)
      for (const std::size_t node : cells[cell]->nodes)
        owners[node] = std::min(owners[node], partition[cell]);
    return owners;
  }

  /// The nodes of the cells of this process.
  inline SharedNodes
  share_nodes(const MshFile &msh, const Partition &partition)
  {
    const std::vector<unsigned int> owners = find_owners(msh, partition);
    SharedNodes                     shared{ {}, {}, { 0 } };
    std::vector<unsigned int>       numbers(msh.nodes.size());
    for (unsigned int process = 0; process < n_processes(); ++process)
    {
      unsigned int next = shared.first_numbers.back();
      for (std::size_t node = 0; node < owners.size(); ++node)
        if (owners[node] == process)
          numbers[node] = next++;
      shared.first_numbers.push_back(next);
    }
    const auto        cells = tetrahedra(msh);
    std::vector<bool> is_here(msh.nodes.size(), false);
    for (std::size_t cell = 0; cell < cells.size(); ++cell)
      if (partition[cell] == this_process())
        for (const std::size_t node : cells[cell]->nodes)
          is_here[node] = true;
    for (unsigned int node = 0; node < is_here.size(); ++node)
      if (is_here[node])
      {
        shared.in_files.push_back(node);
        shared.numbers.push_back(numbers[node]);
      }
    return shared;
  }

  /// The cells of this process and their nodes.
  inline MshFile
  own_part(const MshFile &msh, const Partition &partition, const SharedNodes &shared)
  {
    MshFile                  part;
    std::vector<std::size_t> here(msh.nodes.size());
    for (const unsigned int node : shared.in_files)
    {
      here[node] = part.nodes.size();
      part.nodes.push_back(msh.nodes[node]);
      part.node_numbers.push_back(msh.node_numbers[node]);
    }
    const auto cells = tetrahedra(msh);
    for (std::size_t cell = 0; cell < cells.size(); ++cell)
      if (partition[cell] == this_process())
      {
        part.elements.push_back(*cells[cell]);
        for (auto &node : part.elements.back().nodes)
          node = here[node];
      }
    return part;
  }

  /// Linear elasticity of tetrahedra, as a matrix that each process sums over its cells: the
  /// cells of `msh`, which are a body or a part of it.
  class Elasticity
  {
  public:
    Elasticity(const MshFile                   &msh,
               const std::vector<unsigned int> &held,
               const Exchange                  &exchange = Exchange::serial())
        : free_dofs(3 * msh.nodes.size(), held, exchange), positions(3 * msh.nodes.size()),
          cells(tetrahedra(msh))
    {
      for (unsigned int dof = 0; dof < positions.size(); ++dof)
        positions[dof] = msh.nodes[dof / 3][dof % 3];
      make_pattern();
    }

    std::unique_ptr<SpdOperator>
    reinit(std::unique_ptr<SpdOperator> matrix) const
    {
      matrix->reinit(pattern);
      fill(*matrix);
      return matrix;
    }

    void
    fill(SpdOperator &matrix) const
    {
      const std::vector<double> all = values();
      std::copy(all.begin(), all.end(), matrix.values().begin());
    }

    std::vector<double>
    values() const
    {
      std::vector<double> values(pattern.n_values(), 0.);
      for (const MshElement *cell : cells)
        for_each_pair(*cell,
                      [&](const unsigned int a, const unsigned int b, const int i, const int j)
                      { values[pattern.position(i, j)] += stiffness(*cell, a, b); });
      return values;
    }

    FreeDofs         free_dofs;
    Vector           positions;
    SymmetricPattern pattern;

  private:
    /// Call action(a, b, row, column) for the lower triangle of a cell's matrix.
    template <typename Action>
    void
    for_each_pair(const MshElement &cell, const Action &action) const
    {
      for (unsigned int a = 0; a < 12; ++a)
        for (unsigned int b = 0; b < 12; ++b)
        {
          const int i = free_dofs.free_index(3 * cell.nodes[a / 3] + a % 3),
                    j = free_dofs.free_index(3 * cell.nodes[b / 3] + b % 3);
          if (i != FreeDofs::held && j != FreeDofs::held && i >= j)
            action(a, b, i, j);
        }
    }

    void
    make_pattern()
    {
      std::vector<std::set<int>> rows(free_dofs.local_list().size());
      for (const MshElement *cell : cells)
        for_each_pair(*cell, [&](unsigned int, unsigned int, const int i, const int j)
                      { rows[j].insert(i); });
      pattern.column_start.push_back(0);
      for (const std::set<int> &column : rows)
      {
        pattern.row.insert(pattern.row.end(), column.begin(), column.end());
        pattern.column_start.push_back(pattern.row.size());
      }
    }

    /// Lame's constants are 1 and 1.
    double
    stiffness(const MshElement &cell, const unsigned int a, const unsigned int b) const
    {
      dealii::Tensor<2, 3> edges;
      for (unsigned int k = 0; k < 3; ++k)
        for (unsigned int c = 0; c < 3; ++c)
          edges[k][c] = positions[3 * cell.nodes[k + 1] + c] - positions[3 * cell.nodes[0] + c];
      const dealii::Tensor<2, 3> inverse  = dealii::invert(edges);
      const auto                 gradient = [&](const unsigned int node)
      {
        dealii::Tensor<1, 3> g;
        for (unsigned int c = 0; c < 3; ++c)
          g[c] = node == 0 ? -inverse[c][0] - inverse[c][1] - inverse[c][2] : inverse[c][node - 1];
        return g;
      };
      const dealii::Tensor<1, 3> g = gradient(a / 3), h = gradient(b / 3);
      return std::abs(dealii::determinant(edges)) / 6.
             * (g[a % 3] * h[b % 3] + g[b % 3] * h[a % 3] + (a % 3 == b % 3 ? g * h : 0.));
    }

    std::vector<const MshElement *> cells; ///< of a mesh that outlives this
  };

  /// Outer products over patches of cells far from each other, as one process makes them of its cells;
  /// by the nodes of the whole body.
  inline OuterProducts
  make_products(const MshFile &msh, const Partition &partition, const unsigned int process)
  {
    constexpr std::size_t n_patches = 30;
    OuterProducts         products;
    const auto            cells = tetrahedra(msh);
    for (std::size_t patch = 0; patch < n_patches; ++patch)
    {
      std::set<unsigned int> nodes;
      for (std::size_t cell = patch; cell < cells.size(); cell += n_patches)
        if (partition[cell] == process)
          nodes.insert(cells[cell]->nodes.begin(), cells[cell]->nodes.end());
      std::vector<double> values;
      for (const unsigned int node : nodes)
        for (unsigned int c = 0; c < 3; ++c)
          values.push_back(std::sin(1. + patch + 3. * node + c));
      products.add(0.1 * (1. + patch % 3), { nodes.begin(), nodes.end() }, values);
    }
    return products;
  }

  /// A body in this process alone, and its part of it among all processes.
  class Distributed : public testing::Test
  {
  protected:
    using IsHeld = std::function<bool(const dealii::Point<3> &, unsigned int component)>;

    void
    make(const MeshParameters &mesh,
         const IsHeld         &is_held,
         Partition             make_partition(const MshFile &) = slices)
    {
      msh                         = Mesh(mesh).get_contents();
      const Partition   partition = make_partition(msh);
      const SharedNodes shared    = share_nodes(msh, partition);
      own                         = own_part(msh, partition, shared);
      exchange                    = std::make_unique<MpiExchange>(MPI_COMM_WORLD, shared);
      const auto held             = [&](const MshFile &part)
      {
        std::vector<unsigned int> dofs;
        for (unsigned int dof = 0; dof < 3 * part.nodes.size(); ++dof)
          if (is_held(part.nodes[dof / 3], dof % 3))
            dofs.push_back(dof);
        return dofs;
      };
      whole = std::make_unique<Elasticity>(msh, held(msh));
      part  = std::make_unique<Elasticity>(own, held(own), *exchange);

      own_products = make_products(msh, partition, this_process());
      for (unsigned int &node : own_products.blocks)
        node = std::lower_bound(shared.in_files.begin(), shared.in_files.end(), node)
               - shared.in_files.begin();
      all_products.clear();
      for (unsigned int process = 0; process < n_processes(); ++process)
        all_products.add(make_products(msh, partition, process));
    }

    /// The solution of one process with all products assembled, on a full pattern.
    Columns
    solve_assembled()
    {
      const FreeDofs  &free = whole->free_dofs;
      const int        n    = static_cast<int>(free.size());
      SymmetricPattern full;
      full.column_start = { 0 };
      for (int j = 0; j < n; ++j)
      {
        for (int i = j; i < n; ++i)
          full.row.push_back(i);
        full.column_start.push_back(full.row.size());
      }
      const auto matrix = make_cholesky_operator();
      matrix->reinit(full);
      std::fill(matrix->values().begin(), matrix->values().end(), 0.);
      const Columns values = whole->values();
      for (int j = 0; j < n; ++j)
        for (int k = whole->pattern.column_start[j]; k < whole->pattern.column_start[j + 1]; ++k)
          matrix->values()[full.position(whole->pattern.row[k], j)] = values[k];
      for (std::size_t product = 0; product < all_products.size(); ++product)
      {
        Columns u(n, 0.);
        for (std::size_t k = all_products.begin(product); k < all_products.ends[product]; ++k)
          for (unsigned int c = 0; c < 3; ++c)
            if (const int i = free.free_index(3 * all_products.blocks[k] + c); i != FreeDofs::held)
              u[i] = all_products.values[3 * k + c];
        for (int j = 0; j < n; ++j)
          for (int i = j; i < n; ++i)
            matrix->values()[full.position(i, j)] += all_products.factors[product] * u[i] * u[j];
      }
      matrix->factorize(whole->positions);
      Columns columns = right_side();
      matrix->solve(columns);
      return columns;
    }

    /// Two columns for the body.
    Columns
    right_side() const
    {
      Columns columns(2 * whole->free_dofs.size());
      for (std::size_t i = 0; i < columns.size(); ++i)
        columns[i] = std::sin(1. + static_cast<double>(i));
      return columns;
    }

    Columns
    solve_alone(std::unique_ptr<SpdOperator> matrix)
    {
      matrix = whole->reinit(std::move(matrix));
      matrix->factorize(whole->positions);
      Columns columns = right_side();
      matrix->solve(columns);
      return columns;
    }

    /// The unknowns of this process in columns of the body.
    Columns
    own_rows(const Columns &columns) const
    {
      const std::size_t n = whole->free_dofs.size();
      Columns           own;
      for (std::size_t first = 0; first < columns.size(); first += n)
      {
        const Columns rows
            = part->free_dofs.part({ columns.begin() + first, columns.begin() + first + n });
        own.insert(own.end(), rows.begin(), rows.end());
      }
      return own;
    }

    Columns
    solve(SpdOperator &matrix)
    {
      matrix.factorize(part->positions);
      Columns columns = own_rows(right_side());
      matrix.solve(columns);
      return columns;
    }

    double
    difference(const Columns &a, const Columns &b) const
    {
      double maximum = 0., difference = a.size() == b.size() ? 0. : 1.;
      for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
      {
        difference = std::max(difference, std::abs(a[i] - b[i]));
        maximum    = std::max(maximum, std::abs(b[i]));
      }
      return exchange->max(difference) / exchange->max(maximum);
    }

    static MeshParameters
    bar()
    {
      return box_mesh(4., 12, 3);
    }

    OuterProducts                own_products, all_products;
    MshFile                      msh, own;
    std::unique_ptr<MpiExchange> exchange;
    std::unique_ptr<Elasticity>  whole, part;
  };

  inline bool
  left_end(const dealii::Point<3> &x, unsigned int /*component*/)
  {
    return x[0] == 0.;
  }
} // namespace Exemplar::Testing

#endif
