// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loops_fibres_h
#define exemplar_loops_fibres_h

#include <exemplar/kernels/loops_io.h>

#include <limits>

// Where fibres are and what they pull at: vectors of a cell's nodes, four numbers a node.

namespace Exemplar::Loops
{
  template <typename Number, int n_nodes>
  inline void
  fibre_vectors(const FibreArrays &fibres,
                const std::size_t  begin,
                const std::size_t  end,
                const double      *positions,
                double            *vectors)
  {
    for (std::size_t point = begin; point < end; ++point)
    {
      const unsigned int *nodes  = fibres.nodes + n_nodes * (point / points_of_cell(n_nodes));
      const double       *shares = fibres.shares + n_nodes * point;
      Four                sum{};
      for (int a = 0; a < n_nodes; ++a)
      {
        Four x;
        load_four(positions + 4 * std::size_t(nodes[a]), x);
        sum += shares[a] * x;
      }
      for (int i = 0; i < 4; ++i)
        vectors[4 * (point - begin) + i] = sum[i];
    }
  }

  template <typename Number, int n_nodes>
  inline void
  add_fibre_forces(const FibreArrays &fibres,
                   const std::size_t  begin,
                   const std::size_t  end,
                   const double      *forces,
                   double            *nodal_sums)
  {
    using Bits = long long __attribute__((vector_size(32)));
    constexpr Bits without_last_sign{ -1, -1, -1, std::numeric_limits<long long>::max() };
    for (std::size_t point = begin; point < end; ++point)
    {
      const unsigned int *nodes  = fibres.nodes + n_nodes * (point / points_of_cell(n_nodes));
      const double       *shares = fibres.shares + n_nodes * point;
      Four                force;
      load_four(forces + 4 * (point - begin), force);
      for (int a = 0; a < n_nodes; ++a)
      {
        const Four of_node = shares[a] * force;
        add_four((Four) ((Bits) of_node & without_last_sign),
                 nodal_sums + 4 * std::size_t(nodes[a]));
      }
    }
  }
} // namespace Exemplar::Loops

#endif
