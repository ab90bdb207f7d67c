// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loops_energy_h
#define exemplar_loops_energy_h

#include <exemplar/kernels/loops_law.h>

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

  /// Add the forces of R^T P to those of the nodes.
  template <typename Number, int n_nodes>
  inline void
  add_turned_forces(const CellTask                     &task,
                    const LaneGroup<Number>            &group,
                    const Tetrahedron<Number, n_nodes> &tet,
                    const Matrix3<Number>              &R,
                    const Matrix3<Number>              &P,
                    const Number                       &scale,
                    double                             *nodal_sums)
  {
    add_forces(task, group, tet, times(tet.volume, R * P), scale, nodal_sums);
  }

  // What hardly any cell needs loads its cells anew: arguments by reference would keep the numbers
  // of all others out of registers.

  /// Add the guard of the stretch, where it acts.
  template <int n_nodes, typename Number>
  [[gnu::noinline, gnu::cold]] void
  add_stretch_guard(const CellTask             &task,
                    const LawFunctions<Number> &law,
                    const LaneGroup<Number>    &group,
                    const LawInput<Number>     &in,
                    double                     *nodal_sums,
                    LaneSums<Number, n_nodes>  &sums)
  {
    const StretchGuard<Number> guard = law.stretch_guard(in);
    if (!guard.acts())
      return;
    const auto   tet    = load_tetrahedron<n_nodes>(task.cells, group);
    const Number energy = tet.volume * guard.energy();
    sums.elastic += energy;
    sums.energy += energy;
    add_turned_forces(task, group, tet, in.R, guard.force(), Number(0.), nodal_sums);
  }

  /// Add the forces of patches beside their pressures, where there are any.
  template <int n_nodes, typename Number>
  [[gnu::noinline, gnu::cold]] void
  add_stress_of_special(const CellTask          &task,
                        const LaneGroup<Number> &group,
                        const LawInput<Number>  &in,
                        double                  *nodal_sums)
  {
    const Matrix3<Number> P
        = patch_cell(task, group, in.R, in.F).force(transpose_times(in.R, in.F), in.pressure);
    add_turned_forces(task, group, load_tetrahedron<n_nodes>(task.cells, group), in.R, P,
                      Number(0.), nodal_sums);
  }

  template <typename Number, int n_nodes>
  inline void
  evaluate_group(const CellTask             &task,
                 const LawFunctions<Number> &law,
                 const LaneGroup<Number>    &group,
                 LawInput<Number>           &in,
                 LawValue<Number>           &value,
                 double                     *nodal_sums,
                 double                     *weight_sums,
                 LaneSums<Number, n_nodes>  &sums)
  {
    {
      const Matrix3<Number> F
          = deformation_gradient(task, group, load_tetrahedron<n_nodes>(task.cells, group));
      load_state(task, law, group, rotation(task, law, group, F), F, in);
    }
    load_drives(task, group, in);
    law.evaluate(in, task.with_weight_sums, value);

    // loaded once more, as no register survives the call
    const auto   tet     = load_tetrahedron<n_nodes>(task.cells, group);
    const auto   is_real = tet.volume > Number(0.);
    const Number det
        = task.cells.has_other_laws
              ? select(is_real, determinant(in.F), Number(std::numeric_limits<double>::max()))
              : determinant(in.F);
    sums.min_det = select(det >= sums.min_det, sums.min_det, det);
    sums.inverted.add(group, is_real & (det <= Number(0.)));
    sums.elastic += tet.volume * value.elastic;
    sums.inelastic += tet.volume * value.inelastic;
    sums.energy += tet.volume * value.energy;
    sums.damping += tet.volume * value.damping;
    if (in.has_target || law.guards_without_target())
      sums.guarded.add(group, is_real & value.is_guarded);
    Number     scale_of_patch = Number(0.);
    const bool is_in_patch    = in.has_pressure && law.traits->trace_gradient_is_R;
    if (is_in_patch)
      scale_of_patch = load(task.dilatation.scales, group, 1, 0);
    if (in.has_target)
    {
      sums.stress_square += tet.volume * value.stress_scale * value.stress_scale;
      sums.stress_square += tet.volume * scale_of_patch * scale_of_patch;
      if (task.with_weight_sums)
        add_weight_sums(task, group, -tet.volume, value.weight_stress, weight_sums);
    }
    add_turned_forces(task, group, tet, in.R, value.P,
                      tet.volume * (value.force_scale + scale_of_patch), nodal_sums);
    if (is_in_patch) // the guard of the stretch is the patch's, then
    {
      if (law.traits->has_guard_of_patches() && is_special(task.dilatation, group))
        add_stress_of_special<n_nodes>(task, group, in, nodal_sums);
    }
    else if (value.may_be_stretched)
      add_stretch_guard<n_nodes>(task, law, group, in, nodal_sums, sums);
  }

  template <typename Number, int n_nodes>
  [[gnu::flatten]] inline void
  evaluate(const CellTask   &task,
           const std::size_t begin,
           const std::size_t end,
           double           *nodal_sums,
           double           *weight_sums,
           CellSums         &result)
  {
    const LawFunctions<Number> &law = law_functions<Number>(task.cells.law);
    LaneSums<Number, n_nodes>   sums;
    LawInput<Number>            in;
    LawValue<Number>            value;
    for_each_group_of_law<Number>(
        task.cells, begin, end,
        [&](const LaneGroup<Number> &group)
        { evaluate_group(task, law, group, in, value, nodal_sums, weight_sums, sums); });
    sums.add_to(result);
  }

  template <typename Number, int n_nodes>
  [[gnu::flatten]] inline void
  weight_linear_term(const CellTask   &task,
                     const std::size_t begin,
                     const std::size_t end,
                     double           *weight_sums)
  {
    const LawFunctions<Number> &law = law_functions<Number>(task.cells.law);
    LawInput<Number>            in;
    for_each_group_of_law<Number>(
        task.cells, begin, end,
        [&](const LaneGroup<Number> &group)
        {
          const auto            tet = load_tetrahedron<n_nodes>(task.cells, group);
          const Matrix3<Number> F   = deformation_gradient(task, group, tet);
          load_state(task, law, group, rotation(task, law, group, F), F, in);
          if (law.traits->trace_gradient_is_R && task.dilatation.traces != nullptr)
            store_dilatation(task, *law.traits, group, corotated_strain(in.R, F), F);
          add_weight_sums(task, group, tet.volume, law.weight_stress(in), weight_sums);
        });
  }
} // namespace Exemplar::Loops

#endif
