// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_body_contact_start_h
#define exemplar_body_contact_start_h

#include <exemplar/algebra/free_dofs.h>
#include <exemplar/algebra/vector.h>
#include <exemplar/obstacles/body_contacts.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// Let contact suit a body that begins at these positions, which may change: suit_pieces(), and pairs of one piece that are near each other at rest or
  /// where the scene begins push from half of their distance on. What touches or crosses in one piece at rest is left out. Notes tell
  /// how many and where. Throws UserError where a piece crosses or touches itself at the beginning, but not at rest, and
  /// as suit_pieces().
  void
  suit_body_contacts(BodyContacts             &contacts,
                     const ContactSurface     &surface,
                     const FESpace            &fe_space,
                     const FreeDofs           &free_dofs,
                     Vector                   &positions,
                     std::vector<std::string> &notes);

  /// A sentence about a pose, which messages call `name`, where surfaces cross that do not at rest; empty: none do.
  std::string
  crossing_pose_warning(const BodyContacts   &contacts,
                        const ContactSurface &surface,
                        const Vector         &pose,
                        const std::string    &name);
} // namespace Exemplar

#endif
