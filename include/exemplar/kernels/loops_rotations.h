// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loops_rotations_h
#define exemplar_loops_rotations_h

#include <exemplar/kernels/loops_io.h>

// The loops for rotations of cells and mean rotations of nodes.

namespace Exemplar::Loops
{
  /// R of the cells of a group, computed or loaded as the task says; I for laws without rotations.
  template <typename Number>
  inline Matrix3<Number>
  rotation(const CellTask             &task,
           const LawFunctions<Number> &law,
           const LaneGroup<Number>    &group,
           const Matrix3<Number>      &F)
  {
    if (!law.traits->has_rotations || task.rotation_use == RotationUse::keep)
      return load_rotation(task.cells, group);
    const Matrix3<Number> R = closest_rotation(F);
    if (task.rotation_use == RotationUse::update)
      for (int k = 0; k < 9; ++k)
        store(task.cells, group, R[k / 3][k % 3], task.cells.rotations, 9, k);
    return R;
  }

  template <typename Number, int n_nodes>
  inline void
  update_rotations(const CellTask &task, const std::size_t begin, const std::size_t end)
  {
    const LawFunctions<Number> &law = law_functions<Number>(task.cells.law);
    if (!law.traits->has_rotations)
      return;
    CellTask updating     = task;
    updating.rotation_use = RotationUse::update;
    for_each_group_of_law<Number>(
        task.cells, begin, end,
        [&](const LaneGroup<Number> &group)
        {
          rotation(updating, law, group,
                   deformation_gradient(task, group, load_tetrahedron<n_nodes>(task.cells, group)));
        });
  }

  using FourFloats         = float __attribute__((vector_size(16)));
  using FourFloatsInMemory = float __attribute__((vector_size(16), aligned(4), may_alias));

  /// R of four cells, each in three vectors, the last of which holds one number.
  template <typename Number>
  inline void
  load_rotations(const CellArrays &cells, const LaneGroup<Number> &group, FourFloats (&R)[4][3])
  {
    for (int part = 0; part < 3; ++part)
    {
      Four rows[4] = {};
      for (int k = 4 * part; k < std::min(9, 4 * part + 4); ++k)
        load_four(cells.rotations + group.at(9, k), rows[k % 4]);
      transpose(rows);
      for (int l = 0; l < 4; ++l)
        R[l][part] = __builtin_convertvector(rows[l], FourFloats);
    }
  }

  [[gnu::always_inline]] static inline void
  add_to(float *sums, const FourFloats (&R)[3])
  {
    for (int part = 0; part < 3; ++part)
      add_vector<FourFloatsInMemory>(R[part], sums + 4 * part);
  }

  template <typename Number, int n_nodes>
  inline void
  add_rotations(const CellTask   &task,
                const std::size_t begin,
                const std::size_t end,
                float            *nodal_sums)
  {
    for_each_group<Number>(
        begin, end,
        [&](const LaneGroup<Number> &group)
        {
          const int *nodes = nodal_places(task) + group.at(n_nodes, 0);
          if constexpr (LaneGroup<Number>::width >= 4)
            for (std::size_t lane = 0; lane < LaneGroup<Number>::width; lane += 4)
            {
              FourFloats R[4][3];
              load_rotations<Number>(task.cells, { group.batch, group.lane + lane }, R);
              if constexpr (fours_share_nodes<n_nodes>)
                for (int part = 0; part < 3; ++part)
                  R[0][part] = (R[0][part] + R[1][part]) + (R[2][part] + R[3][part]);
              for (std::size_t l = 0; l < (fours_share_nodes<n_nodes> ? 1 : 4); ++l)
                for (int a = 0; a < n_nodes; ++a)
                  add_to(nodal_sums + 12 * nodes[a * batch_size + lane + l], R[l]);
            }
          else
            for (std::size_t lane = 0; lane < LaneGroup<Number>::width; ++lane)
              for (int a = 0; a < n_nodes; ++a)
                for (int k = 0; k < 9; ++k)
                  nodal_sums[12 * nodes[a * batch_size + lane] + k]
                      += static_cast<float>(task.cells.rotations[group.at(9, k) + lane]);
        });
  }

  /// Closest rotations by whole groups: in the last one, lanes behind the last node repeat it.
  template <typename Number>
  inline void
  closest_rotations(const std::size_t n, const float *sums, float *rotations)
  {
    for (std::size_t first = 0; first < n; first += LaneGroup<Number>::width)
    {
      alignas(64) double lanes[9][LaneGroup<Number>::width];
      for (int k = 0; k < 9; ++k)
        for (std::size_t lane = 0; lane < LaneGroup<Number>::width; ++lane)
          lanes[k][lane] = sums[12 * std::min(first + lane, n - 1) + k];
      Matrix3<Number> F;
      for (int k = 0; k < 9; ++k)
        F[k / 3][k % 3] = Lanes<Number>::load(lanes[k]);
      const Matrix3<Number> R = closest_rotation(F);
      for (int k = 0; k < 9; ++k)
        Lanes<Number>::store(R[k / 3][k % 3], lanes[k]);
      for (std::size_t lane = 0; lane < LaneGroup<Number>::width && first + lane < n; ++lane)
        for (int k = 0; k < 9; ++k)
          rotations[9 * (first + lane) + k] = static_cast<float>(lanes[k][lane]);
    }
  }
} // namespace Exemplar::Loops

#endif
