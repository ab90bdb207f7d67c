// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loops_io_h
#define exemplar_loops_io_h

#include <exemplar/kernels/cell_kernels.h>
#include <exemplar/kernels/law_functions.h>
#include <exemplar/kernels/loops_fours.h>
#include <exemplar/kernels/symmetric.h>

#include <utility>

// Input of the loops over the cells: how they read the cells and nodes of a group, and transpose
// four numbers of each cell into registers of one number of four cells.
//
// All of loops_*.h are templates of the number type. Only the files that compile them for an
// instruction set include them, each for its own type: two files that instantiated them for the
// same type would leave the linker to choose one, and it might take code that the CPU cannot run.

namespace Exemplar::Loops
{
  /// A group of cells computed at once: as many neighbours in a batch as a register has lanes.
  template <typename Number>
  struct LaneGroup
  {
    static constexpr std::size_t width = Lanes<Number>::n;

    std::size_t batch;
    std::size_t lane; ///< lane of the first cell in the batch

    /// The cell in lane l of the register; behind the last cell the batch is filled with copies.
    std::size_t
    cell(const std::size_t l) const
    {
      return batch * batch_size + lane + l;
    }

    /// Position of entry e of a quantity with n entries a cell.
    std::size_t
    at(const std::size_t n, const std::size_t e) const
    {
      return (batch * n + e) * batch_size + lane;
    }
  };

  /// Number of quadrature points of a cell with `n_nodes` nodes.
  constexpr std::size_t
  points_of_cell(const int n_nodes)
  {
    for (const ElementTraits &traits : element_traits)
      if (traits.nodes_per_cell == n_nodes)
        return traits.points_per_cell;
    return 0;
  }

  /// Whether four neighbours in a batch are the points of one cell, so that their nodes are the
  /// same.
  template <int n_nodes>
  constexpr bool fours_share_nodes = points_of_cell(n_nodes) == 4;

  /// Call function(group) for all groups of the batches begin to end - 1.
  template <typename Number, typename Function>
  inline void
  for_each_group(const std::size_t begin, const std::size_t end, const Function &function)
  {
    for (std::size_t batch = begin; batch < end; ++batch)
      for (std::size_t lane = 0; lane < batch_size; lane += LaneGroup<Number>::width)
        function(LaneGroup<Number>{ batch, lane });
  }

  template <typename Number>
  inline Number
  load(const double *from, const LaneGroup<Number> &group, const std::size_t n, const std::size_t e)
  {
    return Lanes<Number>::load(from + group.at(n, e));
  }

  /// The compiler's vector types of n numbers.
  template <std::size_t n>
  struct Registers;

  template <>
  struct Registers<2>
  {
    using Floats  = float __attribute__((vector_size(8), aligned(4), may_alias));
    using Doubles = double __attribute__((vector_size(16)));
  };

  template <>
  struct Registers<4>
  {
    using Floats  = float __attribute__((vector_size(16), aligned(4), may_alias));
    using Doubles = double __attribute__((vector_size(32)));
  };

  template <>
  struct Registers<8>
  {
    using Floats  = float __attribute__((vector_size(32), aligned(4), may_alias));
    using Doubles = double __attribute__((vector_size(64)));
  };

  /// Load numbers stored in single precision.
  template <typename Number>
  [[gnu::always_inline]] inline Number
  load(const float *from, const LaneGroup<Number> &group, const std::size_t n, const std::size_t e)
  {
    constexpr std::size_t width = LaneGroup<Number>::width;
    const float          *at    = from + group.at(n, e);
    if constexpr (width == 1)
      return *at;
    else
    {
      using Floats  = typename Registers<width>::Floats;
      using Doubles = typename Registers<width>::Doubles;
      Floats floats;
      load_vector<Floats>(at, floats);
      return Number(__builtin_convertvector(floats, Doubles));
    }
  }

  /// Mask of the cells of a group that have the current law.
  template <typename Number>
  inline auto
  of_law(const CellArrays &cells, const LaneGroup<Number> &group)
  {
    return load(cells.volumes, group, 1, 0) > Number(0.);
  }

  /// Store entry e of n; entries of cells of another law stay as they are.
  template <typename Number>
  inline void
  store(const CellArrays        &cells,
        const LaneGroup<Number> &group,
        const Number            &value,
        double                  *to,
        const std::size_t        n = 1,
        const std::size_t        e = 0)
  {
    double *at = to + group.at(n, e);
    Lanes<Number>::store(
        cells.has_other_laws ? select(of_law(cells, group), value, Lanes<Number>::load(at)) : value,
        at);
  }

  /// Call function(group) for all groups of the batches begin to end - 1 with a cell of the law.
  template <typename Number, typename Function>
  inline void
  for_each_group_of_law(const CellArrays &cells,
                        const std::size_t begin,
                        const std::size_t end,
                        const Function   &function)
  {
    for_each_group<Number>(begin, end,
                           [&](const LaneGroup<Number> &group)
                           {
                             if (!cells.has_other_laws || any(of_law(cells, group)))
                               function(group);
                           });
  }

  template <typename Number>
  inline Matrix3<Number>
  load_rotation(const CellArrays &cells, const LaneGroup<Number> &group)
  {
    Matrix3<Number> R;
    for (int k = 0; k < 9; ++k)
      R[k / 3][k % 3] = load(cells.rotations, group, 9, k);
    return R;
  }

  /// Load strain i of the n that are stored for each cell.
  template <typename Number>
  inline Matrix3<Number>
  load_strain(const double            *strains,
              const LaneGroup<Number> &group,
              const std::size_t        n,
              const std::size_t        i)
  {
    SymmetricEntries<Number> E;
    for (std::size_t k = 0; k < n_symmetric; ++k)
      E[k] = load(strains, group, n_symmetric * n, n_symmetric * i + k);
    return unpack(E);
  }

  template <typename Function, int... a>
  [[gnu::always_inline]] inline auto
  sum_of(const Function &function, std::integer_sequence<int, a...>)
  {
    return (... + function(a));
  }

  /// function(0) + ... + function(n - 1), written out: compilers unroll loops too late to keep the
  /// numbers of an array in registers.
  template <int n, typename Function>
  [[gnu::always_inline]] inline auto
  sum_of(const Function &function)
  {
    return sum_of(function, std::make_integer_sequence<int, n>());
  }

  template <int n_nodes, typename Number>
  inline Tetrahedron<Number, n_nodes>
  load_tetrahedron(const CellArrays &cells, const LaneGroup<Number> &group)
  {
    constexpr std::size_t        n = 3 * (n_nodes - 1);
    Tetrahedron<Number, n_nodes> tet;
    for (int i = 0; i < 3; ++i)
    {
      for (int a = 1; a < n_nodes; ++a)
        tet.shape_gradient[a][i] = load(cells.gradients, group, n, 3 * (a - 1) + i);
      // shape functions sum to one
      tet.shape_gradient[0][i]
          = -sum_of<n_nodes - 1>([&](const int a) { return tet.shape_gradient[a + 1][i]; });
    }
    tet.volume = load(cells.volumes, group, 1, 0);
    return tet;
  }

  /// Join the numbers of all cells of a group in one register, not by way of memory, because a load
  /// that is wider than the stores before it has to wait for them.
  template <typename Number>
  inline Number
  join(const Four (&four)[2])
  {
    if constexpr (LaneGroup<Number>::width == 8)
      return Number(__builtin_shufflevector(four[0], four[1], 0, 1, 2, 3, 4, 5, 6, 7));
    else
      return Number(four[0]);
  }

  /// Index of each node of the cells in the nodal sums.
  [[gnu::always_inline]] static inline const int *
  nodal_places(const CellTask &task)
  {
    return task.places != nullptr ? task.places : task.cells.nodes;
  }

  /// Load the positions of one node of each cell; `positions` holds four numbers a node.
  template <int n_nodes, typename Number>
  inline void
  load_nodes(const double *positions, const int *nodes, Vector3<Number> &x)
  {
    if constexpr (LaneGroup<Number>::width >= 4)
    {
      Four parts[3][2];
      for (std::size_t lane = 0; lane < LaneGroup<Number>::width; lane += 4)
        if constexpr (fours_share_nodes<n_nodes>)
          for (int i = 0; i < 3; ++i)
            parts[i][lane / 4] = positions[4 * nodes[lane] + i] - Four{};
        else
        {
          Four rows[4];
          for (std::size_t l = 0; l < 4; ++l)
            load_four(positions + 4 * nodes[lane + l], rows[l]);
          transpose(rows);
          for (int i = 0; i < 3; ++i)
            parts[i][lane / 4] = rows[i];
        }
      for (int i = 0; i < 3; ++i)
        x[i] = join<Number>(parts[i]);
    }
    else
    {
      alignas(64) double parts[3][LaneGroup<Number>::width];
      for (std::size_t lane = 0; lane < LaneGroup<Number>::width; ++lane)
        for (int i = 0; i < 3; ++i)
          parts[i][lane] = positions[4 * nodes[lane] + i];
      for (int i = 0; i < 3; ++i)
        x[i] = Lanes<Number>::load(parts[i]);
    }
  }

  template <typename Number, int n_nodes>
  [[gnu::always_inline]] inline Matrix3<Number>
  deformation_gradient(const CellTask                     &task,
                       const LaneGroup<Number>            &group,
                       const Tetrahedron<Number, n_nodes> &tet)
  {
    Vector3<Number> x[n_nodes];
    for (int a = 0; a < n_nodes; ++a)
      load_nodes<n_nodes>(task.positions, task.cells.nodes + group.at(n_nodes, a), x[a]);
    Vector3<Number> edge[n_nodes]; // from node 0
    for (int a = 1; a < n_nodes; ++a)
      for (int i = 0; i < 3; ++i)
        edge[a][i] = x[a][i] - x[0][i];
    Matrix3<Number> F; // Eq. (1)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        F[i][j] = sum_of<n_nodes - 1>([&](const int a)
                                      { return edge[a + 1][i] * tet.shape_gradient[a + 1][j]; });
    // a law may be undefined at the deformation of cells with another law
    if (task.cells.has_other_laws)
      F = select_matrix(tet.volume > Number(0.), F, identity_matrix<Number>());
    return F;
  }
} // namespace Exemplar::Loops

#endif
