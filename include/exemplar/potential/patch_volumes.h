// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_patch_volumes_h
#define exemplar_patch_volumes_h

#include <exemplar/body/patches.h>
#include <exemplar/potential/evaluation.h>
#include <exemplar/potential/patch_energy.h>
#include <exemplar/potential/patch_scatter.h>

#include <vector>

namespace Exemplar
{
  /// The volume part of a neo-Hookean background by patches, Eq. (37): sum lambda_p/2 V_p (J_p - 1)^2
  /// with the mean J_p of det F over a patch. J has no kink, and a pressure that is the same in all cells of a
  /// patch moves no node inside it, so that this needs none of the guards of PatchGuard.
  class PatchVolumes
  {
  public:
    /// `patches` must outlive it. From now on loops over the cells tell what it asks for.
    PatchVolumes(const Patches &patches, CellField &cells);

    /// J_p - 1 anew, from what the cells have told.
    void
    find(const CellField &cells, const PatchScatter &scatter);

    /// lambda_p (J_p - 1) [Pa].
    double
    pressure(const unsigned int patch) const
    {
      return pressure_of_mean(patches.lambda(patch), 1., changes[patch], 0.);
    }

    /// lambda_p (J_p - 1)^2 / 2 [J/m^3].
    double
    density(const unsigned int patch) const
    {
      return energy_of_mean(patches.lambda(patch), changes[patch], 0.);
    }

    /// Let the pressures act in the cells, which have the share of the background in their energy.
    void
    write_pressures(CellField &cells) const;

    /// `share` lambda_p V_p b b^T with b = dJ_p/dx [N/m]. A convex tangent lacks that of lambda_p < 0, which
    /// the cells do not outweigh where they are long.
    PatchProducts
    find_products(double share, Tangent kind, CellField &cells, const PatchScatter &scatter) const;

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    const Patches      &patches;
    std::vector<double> changes; ///< J_p - 1
  };
} // namespace Exemplar

#endif
