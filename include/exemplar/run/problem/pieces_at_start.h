// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_pieces_at_start_h
#define exemplar_pieces_at_start_h

#include <exemplar/algebra/free_dofs.h>
#include <exemplar/run/problem/standing_surface.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// Let each pair of pieces begin at a distance. Pieces that touch or overlap slightly at these positions, where the scene begins, are moved
  /// apart as wholes. Those that cannot go, as between two that are held, touch by points below their surfaces. Pieces that begin
  /// nearer than their width get that distance as the width. Notes tell what was done. Throws UserError for
  /// pieces that overlap by more than their width.
  void
  suit_pieces(BodyContacts             &contacts,
              const ContactSurface     &surface,
              const FESpace            &fe_space,
              const FreeDofs           &free_dofs,
              Vector                   &positions,
              std::vector<std::string> &notes);
} // namespace Exemplar

#endif
