// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cell_field_h
#define exemplar_cell_field_h

#include <exemplar/algebra/vector.h>
#include <exemplar/body/cell_batches.h>
#include <exemplar/body/fe_space.h>
#include <exemplar/body/material.h>
#include <exemplar/kernels/cell_kernels.h>
#include <exemplar/potential/nodal_sums.h>
#include <exemplar/potential/strain_damping.h>

#include <deal.II/base/aligned_vector.h>

#include <algorithm>
#include <vector>

namespace Exemplar
{
  /// What strongly stretched patches tell the loops, in batches, see StretchArrays.
  struct StretchField
  {
    bool                          acts = false; ///< in some patch; else nothing here is asked for
    dealii::AlignedVector<double> transitions, by_F, stiffnesses, elasticity, energies;
    dealii::AlignedVector<double> pressures; ///< of the elasticity alone in these patches [Pa]

    /// All 0.
    void
    reinit(unsigned int n_points);

    StretchArrays
    arrays();

    /// In bytes.
    std::size_t
    memory_consumption() const;
  };

  /// What loops and terms tell each other of J, in batches; see VolumeArrays. Empty unless a term asks
  /// for it.
  struct VolumeField
  {
    dealii::AlignedVector<double> changes, cofactors, pressures;

    /// From now on loops fill it.
    void
    resize(unsigned int n_points);

    VolumeArrays
    arrays();

    /// What terms make act along cof F in a point [Pa].
    double
    pressure(const unsigned int point) const
    {
      return pressures.empty() ? 0. : pressures[point];
    }

    /// In bytes.
    std::size_t
    memory_consumption() const;
  };

  /// What loops over the cells and terms tell each other of the dilatation, in batches; see
  /// DilatationArrays. Empty unless a term asks for it.
  struct DilatationField
  {
    dealii::AlignedVector<double> traces, squares, pressures, scales;
    std::vector<unsigned char>    flags; ///< CellFlags of each batch
    StretchField                  stretch;
    VolumeField                   volume;

    /// From now on loops fill it.
    void
    resize(unsigned int n_points);

    DilatationArrays
    arrays();

    /// Whether a term asks for them.
    bool
    is_filled() const
    {
      return !traces.empty();
    }

    /// Before a loop that finds dilatations.
    void
    clear_flags()
    {
      std::fill(flags.begin(), flags.end(), 0);
    }

    /// What terms make act in a point [Pa].
    double
    pressure(const unsigned int point) const
    {
      return pressures.empty() ? 0. : pressures[point];
    }

    /// Whether some batch has that flag.
    bool
    has(const CellFlags flag) const
    {
      return std::any_of(flags.begin(), flags.end(),
                         [flag](const unsigned char of_batch) { return (of_batch & flag) != 0; });
    }

    /// In bytes.
    std::size_t
    memory_consumption() const;
  };

  /// The quadrature points of the cells as the loops of kernels/ see them, with the rotation at
  /// each, their damping and dilatation, and the positions of the last loop. Rotations stay as they are ("frozen") until a loop
  /// updates them.
  class CellField
  {
  public:
    /// `material` is that of the cells' own energy. The space must outlive the field. `n_threads` of
    /// the loops: no result depends on it.
    CellField(LawsOfCells             laws,
              const ExampleConstants &examples,
              const FESpace          &fe_space,
              const Material         &material,
              unsigned int            n_threads);

    /// The input of a loop over these cells at these positions, by degree of freedom [m]. It refers
    /// to arrays of this object.
    CellTask
    task(const Vector &positions, RotationUse rotations);

    /// The input of a loop at other positions, four numbers a node [m], that keeps off the stored
    /// rotations.
    CellTask
    task_elsewhere(const double *positions);

    /// tr(e) and |F|^2 of the points at these positions into the dilatation field.
    void
    update_dilatations(const Vector &positions, RotationUse rotations);

    /// The energies of the guards where patches are strongly stretched, by the rotations as they are.
    void
    update_stretch_energies(const Vector &positions);

    /// As StrainDamping::set().
    void
    set_damping(double s, const std::vector<WeightedPositions> &history)
    {
      damping.set(s, history, batches, fe_space);
    }

    /// R at every point from the polar decomposition at these positions. Models without rotations
    /// keep I.
    void
    update_rotations(const Vector &positions);

    /// Find the rotations that the last loop has found and forgotten, if it has.
    void
    refresh_rotations();

    /// About the rotation of each node, the mean of its cells': nine numbers a node, by rows.
    void
    node_rotations(std::vector<float> &rotations);

    /// Requires refresh_rotations().
    Matrix3<double>
    rotation(const unsigned int point) const
    {
      return batches.rotation(point);
    }

    /// Node a at a point in the order of the loops.
    unsigned int
    node(const unsigned int point, const unsigned int a) const
    {
      return batches.node(point, a);
    }

    unsigned int
    n_nodes() const
    {
      return node_positions.size() / 4;
    }

    /// Threads of the loops over cells and patches.
    int
    n_threads() const
    {
      return nodal_sums.n_threads();
    }

    StrainDamping &
    get_damping()
    {
      return damping;
    }

    const StrainDamping &
    get_damping() const
    {
      return damping;
    }

    DilatationField &
    get_dilatation()
    {
      return dilatation;
    }

    const DilatationField &
    get_dilatation() const
    {
      return dilatation;
    }

    /// Geometry, laws and constants of the points, for loops over patches.
    CellArrays
    arrays()
    {
      return batches.arrays();
    }

    /// What the loops of an evaluation add up.
    NodalSums &
    get_nodal_sums()
    {
      return nodal_sums;
    }

    /// What they remember after a step that ends at these positions, from what they remembered. The
    /// step is over then.
    std::vector<double>
    advance_history(const Vector &positions);

    /// What the cells of this process have dissipated since the first step [J].
    double
    dissipated_energy() const;

    const CellKernels &
    loops() const
    {
      return kernels;
    }

    /// What a point with deformation gradient F and the last rotation gives its law, with its damping
    /// and the pressures of its patch, but without a target.
    LawInput<double>
    law_input(unsigned int point, const Matrix3<double> &F) const;

    /// Laws, constants and history of the points.
    CellBatches &
    get_batches()
    {
      return batches;
    }

    const CellBatches &
    get_batches() const
    {
      return batches;
    }

    /// Call function(task) for each law, with the task for its cells alone.
    template <typename Function>
    void
    for_each_law(CellTask task, const Function &function)
    {
      batches.for_each_law(task.cells,
                           [&](const CellArrays &cells)
                           {
                             task.cells = cells;
                             function(task);
                           });
    }

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    /// Run a loop of the kernels that leaves no sums.
    void
    for_each_law_in_stripes(const CellTask &task,
                            void (*CellKernels::*loop)(const CellTask &, std::size_t, std::size_t));

    const FESpace                &fe_space;
    const CellKernels            &kernels;
    CellBatches                   batches;
    StrainDamping                 damping;
    DilatationField               dilatation;
    NodalSums                     nodal_sums;
    dealii::AlignedVector<double> node_positions; ///< of the last loop, four numbers a node
    dealii::AlignedVector<float>  rotation_sums;
    bool                          rotations_are_forgotten = false; ///< those of node_positions
  };
} // namespace Exemplar

#endif
