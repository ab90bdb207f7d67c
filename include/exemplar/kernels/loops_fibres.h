// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loops_fibres_h
#define exemplar_loops_fibres_h

#include <exemplar/kernels/loops_io.h>

#include <algorithm>
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

  template <typename Number>
  inline double
  pull_fibres(const double     *amounts,
              const std::size_t n,
              const double      least_stretch,
              double           *vectors)
  {
    constexpr std::size_t width = LaneGroup<Number>::width;
    const Number          least(least_stretch);
    Number                energy(0.);
    alignas(64) double    lanes[width];
    for (std::size_t begin = 0; begin < n; begin += width)
    {
      const std::size_t  n_here = std::min(width, n - begin);
      alignas(64) double amounts_here[width], factors[width], forces[width];
      for (std::size_t l = 0; l < width; ++l)
      {
        const std::size_t i = begin + std::min(l, n_here - 1);
        const double     *v = vectors + 4 * i;
        lanes[l]            = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        amounts_here[l]     = l < n_here ? amounts[i] : 0.;
      }
      const Number amount  = Lanes<Number>::load(amounts_here);
      const Number square  = Lanes<Number>::load(lanes);
      const Number stretch = sqrt(square);
      const Number usual   = max(stretch, least);
      const Number factor  = amount / usual;
      // below the least stretch the energy is a parabola
      energy
          += amount * (usual - Number(1.))
             - select(stretch < least,
                      amount * (least * least - square) * Number(0.5 / least_stretch), Number(0.));
      Lanes<Number>::store(factor, factors);
      Lanes<Number>::store(factor * stretch, forces);
      for (std::size_t l = 0; l < n_here; ++l)
      {
        double *v = vectors + 4 * (begin + l);
        for (int c = 0; c < 3; ++c)
          v[c] *= factors[l];
        v[3] = forces[l];
      }
    }
    Lanes<Number>::store(energy, lanes);
    double sum = 0.;
    for (const double value : lanes)
      sum += value;
    return sum;
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
