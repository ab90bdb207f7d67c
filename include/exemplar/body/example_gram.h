// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_example_gram_h
#define exemplar_example_gram_h

#include <exemplar/body/fe_space.h>
#include <exemplar/body/laws_of_cells.h>
#include <exemplar/body/material.h>
#include <exemplar/body/patches.h>

#include <deal.II/lac/full_matrix.h>

namespace Exemplar
{
  class ExamplePoses;

  /// The Gram matrix of the examples' strains in energy, Eq. (9), and the dilatations of patches by
  /// their weights, Eq. (25).
  class ExampleGram
  {
  public:
    /// `cell_material` is that of the cells' energy without the part of `patches`, which are empty
    /// where there are none.
    void
    compute(const ExamplePoses &poses,
            const FESpace      &fe_space,
            const LawsOfCells  &laws,
            const Material     &cell_material,
            const Patches      &patches);

    /// eta^2 sum V E_i : C : E_j for all pairs of weights [J]; with patches, the volume part by
    /// Eq. (25).
    const dealii::FullMatrix<double> &
    matrix() const
    {
      return gram;
    }

    /// Add `factor` times the further part of H in the blended energy, sum V eta (1 - eta) E_i : C
    /// : E_j [J], with eta of each cell, or its mean over each patch. Where examples have C_e, the
    /// form C_y of Eq. (38) instead.
    void
    add_blended(double factor, dealii::FullMatrix<double> &sum) const;

    /// eta dtheta_p/dw of a patch by a weight, Eq. (25): the mean of eta tr E over the volume of
    /// the patch.
    double
    patch_dilatation(const unsigned int patch, const unsigned int weight) const
    {
      return patch_dilatations(patch, weight);
    }

    /// Memory in bytes.
    std::size_t
    memory_consumption() const;

  private:
    void
    compute_patch_dilatations(const ExamplePoses &poses,
                              const FESpace      &fe_space,
                              const Patches      &patches);

    void
    add_cells(const ExamplePoses &poses,
              const FESpace      &fe_space,
              const LawsOfCells  &laws,
              const Material     &cell_material);

    void
    add_patches(const FESpace &fe_space, const Material &cell_material, const Patches &patches);

    /// Compute the form C_y of Eq. (38), the part of H beyond the Gram matrix where examples have
    /// C_e.
    void
    compute_excess(const ExamplePoses &poses,
                   const FESpace      &fe_space,
                   const Material     &cell_material,
                   const Patches      &patches);

    double                     importance = 0.;
    dealii::FullMatrix<double> patch_dilatations; ///< patch, weight; empty without patches
    dealii::FullMatrix<double> gram;
    dealii::FullMatrix<double>
        blended; ///< see add_blended(), where importance varies or examples have C_e; else empty
  };
} // namespace Exemplar

#endif
