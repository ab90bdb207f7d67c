// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loops_energy_h
#define exemplar_loops_energy_h

#include <exemplar/kernels/loops_dilatation.h>
#include <exemplar/kernels/loops_examples.h>

// The loops for energies, forces and their scales, and for the linear term of the weights.

namespace Exemplar::Loops
{
  /// Number of cells in some state, at any of their points.
  template <typename Number, int n_nodes>
  class CellCount
  {
  public:
    template <typename Mask>
    void
    add(const LaneGroup<Number> &group, const Mask &mask)
    {
      const auto one = [&] { return select(mask, Number(1.), Number(0.)); };
      if constexpr (points_of_cell(n_nodes) == 1)
        lanes += one();
      else if (any(mask)) // hardly ever
      {
        alignas(64) double lane[LaneGroup<Number>::width];
        Lanes<Number>::store(one(), lane);
        for (std::size_t l = 0; l < LaneGroup<Number>::width; ++l)
          if (const std::size_t next = group.cell(l) / points_of_cell(n_nodes) + 1;
              lane[l] > 0. && next != end)
          {
            end = next;
            n += 1.;
          }
      }
    }

    double
    total() const
    {
      alignas(64) double lane[LaneGroup<Number>::width];
      Lanes<Number>::store(lanes, lane);
      double sum = n;
      for (const double value : lane)
        sum += value;
      return sum;
    }

  private:
    Number      lanes = Number(0.);
    double      n     = 0.;
    std::size_t end   = 0; ///< index after the last cell that was counted
  };

  /// CellSums, separate for each lane.
  template <typename Number, int n_nodes>
  struct LaneSums
  {
    Number energy = Number(0.), elastic = Number(0.), damping = Number(0.);
    Number inelastic     = Number(0.);
    Number stress_square = Number(0.);
    Number min_det       = Number(std::numeric_limits<double>::max());

    CellCount<Number, n_nodes> inverted, guarded;

    void
    add_to(CellSums &sums) const
    {
      sums.energy += total(energy);
      sums.energy_elastic += total(elastic);
      sums.energy_damping += total(damping);
      sums.energy_inelastic += total(inelastic);
      sums.stress_square += total(stress_square);
      sums.inverted_cells += static_cast<unsigned int>(inverted.total());
      sums.guarded_cells += static_cast<unsigned int>(guarded.total());
      alignas(64) double lane[LaneGroup<Number>::width];
      Lanes<Number>::store(min_det, lane);
      for (const double det : lane)
        sums.min_det_F = det >= sums.min_det_F ? sums.min_det_F : det; // NaN is the least
    }

    static double
    total(const Number &number)
    {
      alignas(64) double lane[LaneGroup<Number>::width];
      Lanes<Number>::store(number, lane);
      double sum = 0.;
      for (const double value : lane)
        sum += value;
      return sum;
    }
  };

  /// Add the cells' nodal forces and their scales to `nodal_sums`.
  template <typename Number, int n_nodes>
  [[gnu::always_inline]] inline void
  add_forces(const CellTask                     &task,
             const LaneGroup<Number>            &group,
             const Tetrahedron<Number, n_nodes> &tet,
             const Matrix3<Number>              &VP, ///< V P
             const Number                       &scale,
             double                             *nodal_sums)
  {
    alignas(64) double lanes[n_nodes][4][LaneGroup<Number>::width];
    Vector3<Number>    last{}; // the force at node 0 is minus the sum of the others
    for (int a = n_nodes - 1; a >= 0; --a)
    {
      const Vector3<Number> force = a > 0 ? VP * tet.shape_gradient[a] : last;
      for (int i = 0; i < 3; ++i)
      {
        last[i] = a == n_nodes - 1 ? -force[i] : last[i] - force[i];
        Lanes<Number>::store(force[i], lanes[a][i]);
      }
      const Vector3<Number> &g = tet.shape_gradient[a];
      Lanes<Number>::store(scale * sqrt(dot(g, g)), lanes[a][3]);
    }
    for (int a = 0; a < n_nodes; ++a)
    {
      const int *nodes = nodal_places(task) + group.at(n_nodes, a);
      if constexpr (LaneGroup<Number>::width >= 4)
        for (std::size_t lane = 0; lane < LaneGroup<Number>::width; lane += 4)
        {
          Four rows[4];
          for (int k = 0; k < 4; ++k)
            load_four(lanes[a][k] + lane, rows[k]);
          transpose(rows);
          if constexpr (fours_share_nodes<n_nodes>)
            add_four((rows[0] + rows[1]) + (rows[2] + rows[3]), nodal_sums + 4 * nodes[lane]);
          else
            for (std::size_t l = 0; l < 4; ++l)
              add_four(rows[l], nodal_sums + 4 * nodes[lane + l]);
        }
      else
        for (std::size_t lane = 0; lane < LaneGroup<Number>::width; ++lane)
          for (int k = 0; k < 4; ++k)
            nodal_sums[4 * nodes[lane] + k] += lanes[a][k][lane];
    }
  }

  /// Add the guard of the stretch, where it acts. It starts anew from the positions in a function
  /// apart from evaluate_group(), whose numbers would otherwise be kept out of registers for what
  /// hardly any cell needs.
  template <typename Cell, int n_nodes, typename Number>
  [[gnu::noinline, gnu::cold]] void
  add_stretch_guard(const CellTask            &task,
                    const LaneGroup<Number>   &group,
                    double                    *nodal_sums,
                    LaneSums<Number, n_nodes> &sums)
  {
    const auto            tet  = load_tetrahedron<n_nodes>(task.cells, group);
    const Matrix3<Number> F    = deformation_gradient(task, group, tet);
    const Matrix3<Number> R    = rotation<Cell>(task, group, F);
    const Cell            cell = make_cell<Cell>(task.cells, group, R, F);
    if (!cell.is_stretched())
      return;
    const StretchGuard<Number> guard  = cell.stretch();
    const Number               energy = tet.volume * guard.energy();
    sums.elastic += energy;
    sums.energy += energy;
    Matrix3<Number> RP = R * guard.force();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        RP[i][j] *= tet.volume;
    add_forces(task, group, tet, RP, Number(0.), nodal_sums);
  }

  /// Add the forces of patches beside their pressures, where there are any, in a function apart
  /// like the guard.
  template <typename Cell, int n_nodes, typename Number>
  [[gnu::noinline, gnu::cold]] void
  add_stress_of_special(const CellTask &task, const LaneGroup<Number> &group, double *nodal_sums)
  {
    const auto            tet = load_tetrahedron<n_nodes>(task.cells, group);
    const Matrix3<Number> F   = deformation_gradient(task, group, tet);
    const Matrix3<Number> R   = load_rotation(task.cells, group);
    Matrix3<Number>       RP
        = R
          * patch_cell<Cell>(task, group, R, F)
                .force(transpose_times(R, F), load(task.dilatation.pressures, group, 1, 0));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        RP[i][j] *= tet.volume;
    add_forces(task, group, tet, RP, Number(0.), nodal_sums);
  }

  template <typename Cell, int n_nodes, typename Number>
  inline void
  add_patch_stress(const CellTask &task, const LaneGroup<Number> &group, double *nodal_sums)
  {
    if constexpr (Cell::traits.has_guard_of_patches())
      if (is_special(task.dilatation, group))
        add_stress_of_special<Cell, n_nodes>(task, group, nodal_sums);
  }

  template <typename Cell, int n_nodes, typename Number>
  inline void
  evaluate_group(const CellTask            &task,
                 const LaneGroup<Number>   &group,
                 double                    *nodal_sums,
                 double                    *weight_sums,
                 LaneSums<Number, n_nodes> &sums)
  {
    const bool            has_examples = task.examples.n_weights > 0;
    const auto            tet          = load_tetrahedron<n_nodes>(task.cells, group);
    const Matrix3<Number> F            = deformation_gradient(task, group, tet);
    const Matrix3<Number> R            = rotation<Cell>(task, group, F);
    const auto            is_real      = tet.volume > Number(0.);

    const Number det
        = task.cells.has_other_laws
              ? select(is_real, determinant(F), Number(std::numeric_limits<double>::max()))
              : determinant(F);
    Cell         cell    = make_cell<Cell>(task.cells, group, R, F);
    const Number density = cell.elastic_density();
    const Number elastic = tet.volume * density;
    Number       scale   = cell.elastic_scale();
    add_volume_pressure(task, group, cell);
    sums.min_det = select(det >= sums.min_det, sums.min_det, det);
    sums.inverted.add(group, is_real & (det <= Number(0.)));
    sums.elastic += elastic;
    if constexpr (Cell::traits.n_history > 0)
      sums.inelastic += tet.volume * cell.inelastic_density();

    const PatchStress<Number> patch = patch_stress<Cell>(task, group);
    Matrix3<Number>           P; // R^T P
    Matrix3<Number>           D;
    if (has_examples)
    {
      D = target(task, group); // eta E(w)
      scale += cell.scale_of(D);
      sums.stress_square += tet.volume * scale * scale;
      sums.stress_square += tet.volume * patch.scale * patch.scale;
      sums.energy += tet.volume * cell.energy(D);
      sums.guarded.add(group, is_real & cell.is_guarded());
      if (task.with_weight_sums)
        add_weight_sums(task, group, -tet.volume, cell.weight_stress(D), weight_sums);
    }
    else
    {
      // history variables have inelastic energy, and act like a target
      if constexpr (Cell::traits.n_history > 0)
      {
        sums.energy += tet.volume * cell.energy();
        sums.guarded.add(group, is_real & cell.is_guarded());
      }
      else
        sums.energy += elastic;
      if constexpr (Cell::traits.n_history == 0 && !Cell::Constants::is_isotropic)
        sums.guarded.add(group, is_real & cell.is_guarded());
      if (task.damping.factors == nullptr)
        P = cell.elastic_force();
    }

    if (task.damping.factors != nullptr)
    {
      const Number          s    = load(task.damping.factors, group, 1, 0);
      const Matrix3<Number> past = load_strain(task.damping.strains, group, 1, 0);
      sums.damping += s * tet.volume * cell.damping_density(past);
      scale += s * (cell.elastic_scale() + cell.scale_of(past));
      D = cell.damp(has_examples ? D : Matrix3<Number>{}, s, past);
    }
    if (has_examples || task.damping.factors != nullptr)
    {
      cell.set_target(D);
      P = cell.force();
    }
    if (patch.acts)
      for (int i = 0; i < 3; ++i)
        P[i][i] += patch.pressure;
    Matrix3<Number> RP = R * P;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        RP[i][j] *= tet.volume;
    add_forces(task, group, tet, RP, tet.volume * (cell.force_factor() * scale + patch.scale),
               nodal_sums);
    if (patch.acts) // the guard of the stretch is the patch's, then
      add_patch_stress<Cell, n_nodes>(task, group, nodal_sums);
    else if (cell.may_be_stretched(density))
      add_stretch_guard<Cell, n_nodes>(task, group, nodal_sums, sums);
  }

  template <typename Laws, typename Number, int n_nodes>
  inline void
  evaluate(const CellTask   &task,
           const std::size_t begin,
           const std::size_t end,
           double           *nodal_sums,
           double           *weight_sums,
           CellSums         &result)
  {
    LaneSums<Number, n_nodes> sums;
    with_cell_model<Number>(
        Laws(), task.cells.law,
        [&](auto model)
        {
          using Cell = typename decltype(model)::type;
          for_each_group_of_law<Number>(
              task.cells, begin, end,
              [&](const LaneGroup<Number> &group)
              { evaluate_group<Cell, n_nodes>(task, group, nodal_sums, weight_sums, sums); });
        });
    sums.add_to(result);
  }

  template <typename Laws, typename Number, int n_nodes>
  inline void
  weight_linear_term(const CellTask   &task,
                     const std::size_t begin,
                     const std::size_t end,
                     double           *weight_sums)
  {
    with_cell_model<Number>(
        Laws(), task.cells.law,
        [&](auto model)
        {
          using Cell = typename decltype(model)::type;
          for_each_group_of_law<Number>(
              task.cells, begin, end,
              [&](const LaneGroup<Number> &group)
              {
                const auto            tet = load_tetrahedron<n_nodes>(task.cells, group);
                const Matrix3<Number> F   = deformation_gradient(task, group, tet);
                const Cell            cell
                    = make_cell<Cell>(task.cells, group, rotation<Cell>(task, group, F), F);
                if constexpr (Cell::traits.trace_gradient_is_R)
                  if (task.dilatation.traces != nullptr)
                    store_dilatation<Cell>(task, group, cell.strain(), F);
                add_weight_sums(task, group, tet.volume, cell.weight_stress(Matrix3<Number>{}),
                                weight_sums);
              });
        });
  }
} // namespace Exemplar::Loops

#endif
