// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_model_parameters_h
#define exemplar_model_parameters_h

#include <exemplar/kernels/cell_model.h>

namespace Exemplar
{
  class KeyTable;

  /// Whether forces follow the rotations, Eq. (17), or hold them fixed, Eq. (6).
  enum class GradientKind
  {
    consistent,
    frozen
  };

  /// Of what the volume part of the energy knows the dilatation.
  enum class DilatationKind
  {
    automatic, ///< patches for the strains that have them, cells for others and in interpolations
    cells,
    patches ///< its mean, Eqs. (25) and (37)
  };

  /// What energy the body has of its own, beside its examples.
  enum class Background
  {
    corotational, ///< that of the strain
    neo_hookean   ///< Eq. (34)
  };

  /// Subsection Model.
  struct ModelParameters
  {
    CellLaw        strain     = CellLaw::corotational; ///< the law of that strain
    GradientKind   gradient   = GradientKind::consistent;
    DilatationKind dilatation = DilatationKind::automatic;
    Element        element    = Element::P1;
    Background     background = Background::corotational;

    void
    declare(KeyTable &keys);

    /// Choose the dilatation that `automatic` stands for. To do so twice changes nothing.
    void
    complete();

    /// To be called after complete(), as check().
    bool
    has_patches() const
    {
      return dilatation == DilatationKind::patches;
    }

    /// Throws UserError for a strain without what the scene asks of it.
    void
    check() const;

    /// The law of the cells. Only the corotational strain has rotations that a force may hold fixed,
    /// and only with consistent forces another background.
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

  private:
    void
    check_neo_hookean() const;
  };
} // namespace Exemplar

#endif
