// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/kernels/initial_stress.h>
#include <exemplar/potential/initial_stress_term.h>

#include <deal.II/base/memory_consumption.h>

#include <algorithm>
#include <array>

namespace Exemplar
{
  namespace
  {
    /// dP of the nine dF that have a single entry 1, in row j and column l at 3 j + l.
    std::array<Matrix3<double>, 9>
    responses(const InitialStress &state, const Matrix3<double> &R)
    {
      std::array<Matrix3<double>, 9> all;
      for (int j = 0; j < 3; ++j)
        for (int l = 0; l < 3; ++l)
        {
          Matrix3<double> M{}; // R^T dF
          for (int i = 0; i < 3; ++i)
            M[i][l] = R[j][i];
          all[3 * j + l] = R * state.response(M);
        }
      return all;
    }
  } // namespace

  void
  InitialStressTerm::attach(const SymmetricPattern &pattern, const FreeDofs &free_dofs)
  {
    scatter.emplace(fe_space, pattern, free_dofs);
  }

  bool
  InitialStressTerm::turns(const unsigned int point) const
  {
    return traits_of(cells.get_batches().law(point)).has_rotations;
  }

  void
  InitialStressTerm::add(const TermPoint &at, ElasticSums &sums)
  {
    cells.refresh_rotations();
    std::vector<double> forces;
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
    {
      const double           volume = fe_space.volume(point);
      const Matrix3<double> &tau    = stresses[point];
      const Matrix3<double>  F      = fe_space.deformation_gradient(point, at.positions);
      if (turns(point))
      {
        const Matrix3<double> R = cells.rotation(point);
        const InitialStress   state(tau, R, F);
        sums->energy += volume * state.energy();
        fe_space.nodal_forces(point, R * state.force(), forces);
      }
      else
      {
        sums->energy += volume * (contract(tau, F) - trace(tau));
        fe_space.nodal_forces(point, tau, forces);
      }
      const auto   nodes = fe_space.nodes(fe_space.cell_of(point));
      const auto   g     = fe_space.gradients(point);
      const double size  = norm(tau);
      for (unsigned int a = 0; a < nodes.size(); ++a)
      {
        for (unsigned int c = 0; c < 3; ++c)
          sums->gradient[3 * nodes[a] + c] += forces[3 * a + c];
        sums->force_scale[nodes[a]] += volume * size * std::sqrt(dot(g[a], g[a]));
      }
    }
  }

  void
  InitialStressTerm::add_blocks(const unsigned int   point,
                                const Vector        &positions,
                                std::vector<double> &blocks) const
  {
    const Matrix3<double> R = cells.rotation(point);
    const InitialStress state(stresses[point], R, fe_space.deformation_gradient(point, positions));
    const auto          by_F  = responses(state, R);
    const auto          nodes = fe_space.nodes(fe_space.cell_of(point));
    std::vector<Vector3<double>> g; // in the order of the loops
    for (unsigned int a = 0; a < nodes.size(); ++a)
    {
      const auto node = std::find(nodes.begin(), nodes.end(), cells.node(point, a));
      g.push_back(fe_space.gradients(point)[node - nodes.begin()]);
    }
    double *entry = blocks.data();
    for (unsigned int a = 0; a < g.size(); ++a)
      for (unsigned int b = 0; b <= a; ++b)
        for (int j = 0; j < 3; ++j)
        {
          Vector3<double> force{};
          for (int l = 0; l < 3; ++l)
          {
            const Vector3<double> of_column = by_F[3 * j + l] * g[a];
            for (int i = 0; i < 3; ++i)
              force[i] += of_column[i] * g[b][l];
          }
          for (int i = 0; i < 3; ++i)
            *entry++ += fe_space.volume(point) * force[i];
        }
  }

  void
  InitialStressTerm::add_tangent(const TermPoint     &at,
                                 const Tangent        kind,
                                 std::vector<double> &values,
                                 std::vector<double> & /*columns*/)
  {
    if (kind == Tangent::convex)
      return;
    cells.refresh_rotations();
    const auto          n_points = static_cast<unsigned int>(points_per_cell(fe_space.element()));
    const std::size_t   n_blocks = n_block_columns(nodes_per_cell(fe_space.element()));
    std::vector<double> blocks;
    for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
    {
      if (!turns(n_points * cell))
        continue;
      blocks.assign(3 * n_blocks, 0.);
      for (unsigned int point = n_points * cell; point < n_points * (cell + 1); ++point)
        add_blocks(point, at.positions, blocks);
      scatter->add_blocks(cell, blocks.data(), values);
    }
  }

  std::size_t
  InitialStressTerm::memory_consumption() const
  {
    return stresses.size() * sizeof(stresses[0]) + (scatter ? scatter->memory_consumption() : 0);
  }
} // namespace Exemplar
