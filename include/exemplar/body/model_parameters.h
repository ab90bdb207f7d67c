// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_model_parameters_h
#define exemplar_model_parameters_h

#include <exemplar/body/shell_mesh.h>
#include <exemplar/kernels/cell_model.h>

namespace Exemplar
{
  class KeyTable;

  /// Whether forces include the derivatives of the rotations, Eq. (17), or hold the rotations
  /// fixed, Eq. (6).
  enum class GradientKind
  {
    consistent,
    frozen
  };

  /// Where the dilatation in the volume part of the energy is evaluated.
  enum class DilatationKind
  {
    automatic, ///< patches for the strains that have them, cells for others and in interpolations
    cells,
    patches ///< mean over a patch, Eqs. (25) and (37)
  };

  /// The energy of the body without examples.
  enum class Background
  {
    corotational, ///< the energy of the strain
    neo_hookean   ///< Eq. (34)
  };

  /// Subsection Model.
  struct ModelParameters
  {
    CellLaw        strain     = CellLaw::corotational; ///< the law, by its strain
    GradientKind   gradient   = GradientKind::consistent;
    DilatationKind dilatation = DilatationKind::automatic;
    Element        element    = Element::P1;
    Background     background = Background::corotational;
    ShellKind      shell      = ShellKind::plate;

    void
    declare(KeyTable &keys);

    /// Replace `automatic` by the dilatation that it stands for. Idempotent.
    void
    complete();

    /// Whether there are patches. This and check() require complete().
    bool
    has_patches() const
    {
      return dilatation == DilatationKind::patches;
    }

    /// Throws UserError for a strain that does not support the rest of the scene.
    void
    check() const;

    /// The law of the cells. Only the corotational strain has rotations that may be held fixed or,
    /// with consistent forces, another background.
    CellLaw
    law() const
    {
      if (strain != CellLaw::corotational)
        return strain;
      if (gradient == GradientKind::frozen)
        return CellLaw::frozen;
      return is_neo_hookean() ? CellLaw::neo_hookean : CellLaw::corotational;
    }

    bool
    is_neo_hookean() const
    {
      return background == Background::neo_hookean;
    }

    /// Whether forces are the paper's, which hold the rotations fixed.
    bool
    is_frozen() const
    {
      return law() == CellLaw::frozen;
    }
  };
} // namespace Exemplar

#endif
