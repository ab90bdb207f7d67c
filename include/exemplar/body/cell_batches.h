// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cell_batches_h
#define exemplar_cell_batches_h

#include <exemplar/body/fe_space.h>
#include <exemplar/body/laws_of_cells.h>
#include <exemplar/body/material.h>
#include <exemplar/kernels/cell_kernels.h>

#include <deal.II/base/aligned_vector.h>

#include <algorithm>
#include <vector>

namespace Exemplar
{
  /// The data of the quadrature points in SIMD batches, in the layout of CellArrays, with each
  /// point's rotation and the history variables of its law.
  class CellBatches
  {
  public:
    /// `fe_space` must outlive this.
    CellBatches(const FESpace          &fe_space,
                const Material         &material,
                LawsOfCells             laws,
                const ExampleConstants &examples);

    /// Replace the laws' constants; their history stays.
    void
    set_constants(const Material &material, const ExampleConstants &examples);

    /// The arrays for loops that are the same for all laws.
    CellArrays
    arrays();

    /// Call function(cells) for each law, with the arrays for loops over its cells alone. Loops
    /// that update rotations write them here.
    template <typename Function>
    void
    for_each_law(CellArrays cells, const Function &function)
    {
      cells.has_other_laws = of_laws.size() > 1;
      for (OfLaw &of_law : of_laws)
      {
        cells.law       = of_law.law;
        cells.volumes   = cells.has_other_laws ? of_law.volumes.data() : volumes.data();
        cells.constants = of_law.constants.data();
        cells.history   = of_law.history.data();
        function(cells);
      }
    }

    CellLaw
    law(const unsigned int point) const
    {
      return laws[fe_space.cell_of(point)];
    }

    /// The constants of a point: those of its law, or CellMaterial, which all of them begin with.
    template <typename Constants>
    Constants
    constants(const unsigned int point) const
    {
      const OfLaw &of_law = of_law_at(point);
      return Constants::from_numbers([&, n = n_constants(of_law.law)](const std::size_t k)
                                     { return of_law.constants[batch_index(point, n, k)]; });
    }

    /// What a point with rotation R and deformation gradient F gives its law; nothing acts on it.
    LawInput<double>
    law_input(const unsigned int point, const Matrix3<double> &R, const Matrix3<double> &F) const
    {
      const OfLaw     &of_law = of_law_at(point);
      LawInput<double> in;
      in.R         = R;
      in.F         = F;
      in.constants = &of_law.constants[batch_index(point, n_constants(of_law.law), 0)];
      if (const std::size_t n = traits_of(of_law.law).n_history; n > 0)
        in.history = &of_law.history[batch_index(point, n, 0)];
      in.examples  = examples;
      in.step_size = step_size;
      return in;
    }

    /// Whether any law has history variables.
    bool
    remembers() const
    {
      return n_history() > 0;
    }

    /// History variables, in the layout of State::history; empty if no law has any.
    std::vector<double>
    history() const;

    /// Set the history variables; empty: to zero, as before any deformation.
    void
    set_history(const std::vector<double> &history);

    /// Set the size of the current step [s], infinite in statics; 0: no step, in which history
    /// variables stay.
    void
    set_step_size(const double new_step_size)
    {
      step_size = new_step_size;
    }

    /// History variable k of a point; 0 if its law has no such variable.
    double
    history_number(const unsigned int point, const std::size_t k) const
    {
      const OfLaw      &of_law = of_law_at(point);
      const std::size_t n      = traits_of(of_law.law).n_history;
      return k < n ? of_law.history[batch_index(point, n, k)] : 0.;
    }

    /// Whether some law has the history variable whose index is this member of ModelTraits.
    bool
    has_trait(std::size_t ModelTraits::*number) const
    {
      return std::any_of(of_laws.begin(), of_laws.end(),
                         [number](const OfLaw &of_law)
                         { return traits_of(of_law.law).*number != ModelTraits::not_remembered; });
    }

    /// Whether the energies of all cells depend on J = det F, which patches may replace by a mean.
    bool
    has_volumetric_energy() const
    {
      return std::all_of(of_laws.begin(), of_laws.end(),
                         [](const OfLaw &of_law)
                         { return traits_of(of_law.law).has_volumetric_energy; });
    }

    Matrix3<double>
    rotation(const unsigned int point) const
    {
      Matrix3<double> R;
      for (unsigned int k = 0; k < 9; ++k)
        R[k / 3][k % 3] = rotations[batch_index(point, 9, k)];
      return R;
    }

    /// Node a at a point. All arrays have the nodes of a cell in ascending order of their numbers.
    unsigned int
    node(const unsigned int point, const unsigned int a) const
    {
      return nodes[batch_index(point, n_nodes, a)];
    }

    /// Memory in bytes.
    std::size_t
    memory_consumption() const;

  private:
    /// Data of the cells of one law, in batches of all cells.
    struct OfLaw
    {
      CellLaw                       law;
      dealii::AlignedVector<double> volumes; ///< 0 in cells of other laws; empty if there are none
      dealii::AlignedVector<double> constants, history;
    };

    const OfLaw &
    of_law_at(const unsigned int point) const
    {
      const CellLaw law = this->law(point);
      return *std::find_if(of_laws.begin(), of_laws.end(),
                           [&](const OfLaw &of_law) { return of_law.law == law; });
    }

    /// Numbers a point in State::history: the greatest number of history variables of a law.
    std::size_t
    n_history() const;

    OfLaw
    make(CellLaw law, const Material &material) const;

    void
    fill_constants(const Material &material, OfLaw &of_law) const;

    /// The cell of a slot; slots behind the last point repeat it.
    unsigned int
    cell_of_slot(const std::size_t slot) const
    {
      return fe_space.cell_of(static_cast<unsigned int>(std::min(slot, n_points - 1)));
    }

    const FESpace                &fe_space;
    const LawsOfCells             laws;
    ExampleConstants              examples;
    double                        step_size = 0.;
    const std::size_t             n_points;
    const std::size_t             n_nodes; ///< number of nodes of each cell
    std::vector<int>              nodes;
    dealii::AlignedVector<double> gradients;
    dealii::AlignedVector<double> volumes;
    dealii::AlignedVector<double> rotations;
    std::vector<OfLaw>            of_laws;
  };
} // namespace Exemplar

#endif
