// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_piece_overlap_h
#define exemplar_piece_overlap_h

#include <exemplar/algebra/vector.h>
#include <exemplar/obstacles/body_contacts.h>

#include <optional>

namespace Exemplar
{
  /// A piece within another one.
  struct EnclosedPiece
  {
    PiecePair            pieces;
    dealii::Tensor<1, 3> place; ///< of a node of it [m]
  };

  /// The first one, of pieces that may meet; empty: there is none.
  std::optional<EnclosedPiece>
  enclosed_piece(const BodyContacts   &contacts,
                 const ContactSurface &surface,
                 const Vector         &positions);

  /// A displacement of one of two pieces.
  struct WayApart
  {
    dealii::Tensor<1, 3> way;    ///< [m]
    dealii::Tensor<1, 3> centre; ///< of the box around the piece [m]
  };

  /// The least displacement of the smaller one of two overlapping pieces after which they do not overlap, among those along the axes and
  /// along the normal where they cross.
  WayApart
  way_apart(const PiecePair      &of,
            const BodyContacts   &contacts,
            const ContactSurface &surface,
            const Vector         &positions);
} // namespace Exemplar

#endif
