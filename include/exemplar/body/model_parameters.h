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
    patches ///< its mean, Eq. (25)
  };

  /// Subsection Model.
  struct ModelParameters
  {
    CellLaw        strain     = CellLaw::corotational; ///< the law of that strain
    GradientKind   gradient   = GradientKind::consistent;
    DilatationKind dilatation = DilatationKind::automatic;
    Element        element    = Element::P1;

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

    /// The law of the cells. Only the corotational strain has rotations that a force may hold fixed.
    CellLaw
    law() const
    {
      return strain == CellLaw::corotational && gradient == GradientKind::frozen ? CellLaw::frozen
                                                                                 : strain;
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
