// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_pieces_apart_h
#define exemplar_pieces_apart_h

#include <exemplar/algebra/vector.h>
#include <exemplar/obstacles/body_contacts.h>

#include <map>
#include <set>
#include <vector>

namespace Exemplar
{
  /// Two pieces that are near each other: how far apart they must be, and up to which distance places of the one face the other [m].
  struct TouchingPieces
  {
    double distance, near;
  };

  /// Displacements of the pieces as wholes after which they are apart by their distances where they face each other; empty:
  /// there are none, as where a piece is between two that stay. Pieces that are tied together go together.
  std::vector<dealii::Tensor<1, 3>>
  ways_of_pieces_apart(const std::map<PiecePair, TouchingPieces> &touching,
                       const BodyContacts                        &contacts,
                       const ContactSurface                      &surface,
                       const Vector                              &positions,
                       const std::set<unsigned int>              &staying);
} // namespace Exemplar

#endif
