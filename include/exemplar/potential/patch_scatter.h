// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_patch_scatter_h
#define exemplar_patch_scatter_h

#include <exemplar/algebra/free_dofs.h>
#include <exemplar/algebra/spd_operator.h>
#include <exemplar/body/patches.h>
#include <exemplar/potential/cell_field.h>

#include <utility>
#include <vector>

namespace Exemplar
{
  /// The nodes of each patch, and where the products of their degrees of freedom are in the matrix of the body.
  class PatchScatter
  {
  public:
    /// All must outlive it.
    PatchScatter(const Patches &patches, const FESpace &fe_space, const FreeDofs &free_dofs);

    /// All pairs of nodes that share a patch, for make_pattern().
    static std::vector<std::pair<unsigned int, unsigned int>>
    couplings(const Patches &patches, const FESpace &fe_space);

    /// dtheta_p/dx of Eq. (25) with the rotations of `cells`: numbers for the degrees of freedom that dofs() lists [1/m].
    void
    gradient(unsigned int patch, const CellField &cells, std::vector<double> &b) const;

    /// Of the nodes of a patch, ascending.
    const std::vector<unsigned int> &
    dofs(const unsigned int patch) const
    {
      return dofs_of_patch[patch];
    }

    /// Whether some of them are held.
    bool
    is_beside_held(const unsigned int patch) const
    {
      return beside_held[patch];
    }

    /// Add factor b b^T to the values on a pattern that has the couplings().
    void
    add_product(unsigned int               patch,
                double                     factor,
                const std::vector<double> &b,
                const SymmetricPattern    &pattern,
                std::vector<double>       &values) const;

    /// Add factor b to a column by free degree of freedom.
    void
    add_column(unsigned int               patch,
               double                     factor,
               const std::vector<double> &b,
               double                    *column) const;

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    const Patches                         &patches;
    const FESpace                         &fe_space;
    const FreeDofs                        &free_dofs;
    std::vector<std::vector<unsigned int>> dofs_of_patch;
    std::vector<bool>                      beside_held;
  };
} // namespace Exemplar

#endif
