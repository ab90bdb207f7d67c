// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_body_contact_start_h
#define exemplar_body_contact_start_h

#include <exemplar/algebra/vector.h>
#include <exemplar/obstacles/body_contacts.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// Let pairs that are near each other at rest or at these positions, where the scene begins, push from half their distance on, and leave
  /// out what touches or crosses at rest; a note says how many and where. Throws UserError where surfaces cross or touch at the beginning
  /// that do not at rest.
  void
  suit_body_contacts(BodyContacts             &contacts,
                     const ContactSurface     &surface,
                     const Vector             &rest_positions,
                     const Vector             &positions,
                     std::vector<std::string> &notes);

  /// A sentence about a pose, which messages call `name`, where surfaces cross that do not at rest; empty: none do.
  std::string
  crossing_pose_warning(const BodyContacts   &contacts,
                        const ContactSurface &surface,
                        const Vector         &pose,
                        const std::string    &name);
} // namespace Exemplar

#endif
