// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loops_coupling_h
#define exemplar_loops_coupling_h

#include <exemplar/kernels/loops_tangent.h>

// The loop for the coupling columns G of Eqs. (9) and (40): the decrease of the forces for a unit
// of each example's weight.

namespace Exemplar::Loops
{
  /// Store the nodal forces factor V R dP g_a of example i for each cell.
  template <typename Number, int n_nodes>
  inline void
  store_coupling(const CellArrays                   &cells,
                 const LaneGroup<Number>            &group,
                 const Tetrahedron<Number, n_nodes> &tet,
                 const Matrix3<Number>              &R,
                 const Number                       &factor,
                 const Matrix3<Number>              &dP,
                 const unsigned int                  i,
                 double                             *forces)
  {
    Vector3<Number> force[n_nodes];
    frozen_forces(tet, R, dP, force);
    for (int a = 0; a < n_nodes; ++a)
      for (int c = 0; c < 3; ++c)
      {
        double      *to  = forces + (3 * (n_nodes * i + a) + c) * batch_size + group.lane;
        const Number own = factor * force[a][c];
        Lanes<Number>::store(
            cells.has_other_laws ? select(of_law(cells, group), own, Lanes<Number>::load(to)) : own,
            to);
      }
  }

  /// Coupling that belongs to R K R^T: the forces eta V R (C:E_i) g_a with fixed rotations,
  /// Eq. (9).
  template <typename Constants, int n_nodes, typename Number>
  inline void
  couple_rotated(const CellTask &task, const LaneGroup<Number> &group, double *forces)
  {
    const auto            tet       = load_tetrahedron<n_nodes>(task.cells, group);
    const Matrix3<Number> R         = load_rotation(task.cells, group);
    const auto            constants = load_constants<Constants>(task.cells, group);
    for (unsigned int i = 0; i < task.examples.n; ++i)
      store_coupling(
          task.cells, group, tet, R, Number(1.),
          stress(constants, load_strain(task.examples.strains, group, task.examples.n, i)), i,
          forces);
  }

  /// Coupling that belongs to the tangent of the law, Eq. (40).
  template <typename Cell, int n_nodes, typename Number>
  inline void
  couple_exactly(const CellTask          &task,
                 const TangentTask       &tangent,
                 const LaneGroup<Number> &group,
                 double                  *forces)
  {
    const auto            tet    = load_tetrahedron<n_nodes>(task.cells, group);
    const Matrix3<Number> R      = load_rotation(task.cells, group);
    Number                factor = Number(1.);
    // the damped target changes by 1/(1+s) times the examples' target, see damped_target()
    if (task.damping.factors != nullptr)
      factor /= Number(1.) + load(task.damping.factors, group, 1, 0);
    const Cell cell = driven_cell<Cell>(task, tangent, group, tet, R);
    for (unsigned int i = 0; i < task.examples.n; ++i)
      store_coupling(
          task.cells, group, tet, R, factor,
          cell.example_response(load_strain(task.examples.strains, group, task.examples.n, i)), i,
          forces);
  }

  template <typename Laws, typename Number, int n_nodes>
  inline void
  coupling(const CellTask    &task,
           const TangentTask &tangent,
           const bool         rotated,
           const std::size_t  batch,
           double            *forces)
  {
    with_cell_model<Number>(
        Laws(), task.cells.law,
        [&](auto model)
        {
          using Cell = typename decltype(model)::type;
          for_each_group_of_law<Number>(
              task.cells, batch, batch + 1,
              [&](const LaneGroup<Number> &group)
              {
                if constexpr (!Cell::traits.exact_is_rotated)
                  if (!rotated)
                    return couple_exactly<Cell, n_nodes>(task, tangent, group, forces);
                couple_rotated<typename Cell::Constants, n_nodes>(task, group, forces);
              });
        });
  }
} // namespace Exemplar::Loops

#endif
