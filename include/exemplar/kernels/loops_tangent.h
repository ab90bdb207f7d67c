// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loops_tangent_h
#define exemplar_loops_tangent_h

#include <exemplar/kernels/loops_law.h>
#include <exemplar/kernels/loops_stiffness.h>

#include <array>

// The loops for tangents, Eqs. (8), (18) and (19), and the coupling columns G of Eqs. (9) and (40):
// the decrease of the forces for a unit of each example's weight. Then the update of history
// variables.

namespace Exemplar::Loops
{
  /// The cells of a group as a tangent of the law needs them, with the stored rotations: R K R^T
  /// needs neither F nor targets.
  template <typename Number, int n_nodes>
  inline void
  load_driven(const CellTask                     &task,
              const LawFunctions<Number>         &law,
              const bool                          convex,
              const LaneGroup<Number>            &group,
              const Tetrahedron<Number, n_nodes> &tet,
              LawInput<Number>                   &in)
  {
    const Matrix3<Number> R = load_rotation(task.cells, group);
    if (law.is_rotated(convex))
    {
      load_state(task, law, group, R, R, in);
      load_damping(task, group, in);
      return;
    }
    load_state(task, law, group, R, deformation_gradient(task, group, tet), in);
    load_drives(task, group, in);
  }

  template <typename Number, int n_nodes>
  inline void
  add_tangent(const CellTask    &task,
              const TangentTask &tangent,
              const std::size_t  begin,
              const std::size_t  end)
  {
    const LawFunctions<Number> &law = law_functions<Number>(task.cells.law);
    if (law.is_isotropic && law.is_rotated(tangent.convex))
      return add_isotropic_stiffness<Number, n_nodes>(task, law.n_constants, tangent, begin, end);
    alignas(64) BlockColumns<Number, n_nodes> columns = {};
    LawInput<Number>                          in;
    LawTangent<Number>                        of_point;
    for_each_group_of_law<Number>(task.cells, begin, end,
                                  [&](const LaneGroup<Number> &group)
                                  {
                                    const auto tet = load_tetrahedron<n_nodes>(task.cells, group);
                                    load_driven(task, law, tangent.convex, group, tet, in);
                                    law.tangent(in, tangent.convex, of_point);
                                    cell_blocks(of_point, in.R, tet, columns);
                                    add_blocks<Number, n_nodes>(task, tangent, begin, group,
                                                                columns);
                                  });
  }

  /// Store the nodal forces V R dP g_a of example i for each cell.
  template <typename Number, int n_nodes>
  inline void
  store_coupling(const CellArrays                   &cells,
                 const LaneGroup<Number>            &group,
                 const Tetrahedron<Number, n_nodes> &tet,
                 const Matrix3<Number>              &R,
                 const Matrix3<Number>              &dP,
                 const std::size_t                   i,
                 double                             *forces)
  {
    Vector3<Number> force[n_nodes];
    frozen_forces(tet, R, dP, force);
    for (int a = 0; a < n_nodes; ++a)
      for (int c = 0; c < 3; ++c)
      {
        double *to = forces + (3 * (n_nodes * i + a) + c) * batch_size + group.lane;
        Lanes<Number>::store(cells.has_other_laws ? select(of_law(cells, group), force[a][c],
                                                           Lanes<Number>::load(to))
                                                  : force[a][c],
                             to);
      }
  }

  template <typename Number, int n_nodes>
  inline void
  coupling(const CellTask &task, const bool convex, const std::size_t batch, double *forces)
  {
    constexpr std::size_t                at_once = 8; // examples for which a law's state is made
    const LawFunctions<Number>          &law     = law_functions<Number>(task.cells.law);
    LawInput<Number>                     in;
    std::array<Matrix3<Number>, at_once> E, dP;
    for_each_group_of_law<Number>(
        task.cells, batch, batch + 1,
        [&](const LaneGroup<Number> &group)
        {
          const auto tet = load_tetrahedron<n_nodes>(task.cells, group);
          load_driven(task, law, convex, group, tet, in);
          for (std::size_t first = 0; first < task.examples.n; first += at_once)
          {
            const std::size_t n = std::min<std::size_t>(at_once, task.examples.n - first);
            for (std::size_t i = 0; i < n; ++i)
              E[i] = load_strain(task.examples.strains, group, task.examples.n, first + i);
            law.columns(in, convex, n, E.data(), dP.data());
            for (std::size_t i = 0; i < n; ++i)
              store_coupling(task.cells, group, tet, in.R, dP[i], first + i, forces);
          }
        });
  }

  template <typename Number, int n_nodes>
  inline void
  advance_history(const CellTask &task, const std::size_t begin, const std::size_t end)
  {
    const LawFunctions<Number> &law = law_functions<Number>(task.cells.law);
    const std::size_t           n   = law.traits->n_history;
    if (n == 0)
      return;
    LawInput<Number>                in;
    std::array<Number, max_history> history;
    for_each_group_of_law<Number>(
        task.cells, begin, end,
        [&](const LaneGroup<Number> &group)
        {
          load_state(
              task, law, group, load_rotation(task.cells, group),
              deformation_gradient(task, group, load_tetrahedron<n_nodes>(task.cells, group)), in);
          law.advance(in, history.data());
          for (std::size_t k = 0; k < n; ++k)
            store(task.cells, group, history[k], task.cells.history, n, k);
        });
  }
} // namespace Exemplar::Loops

#endif
