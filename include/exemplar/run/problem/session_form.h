// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_session_form_h
#define exemplar_session_form_h

#include <exemplar/body/material.h>
#include <exemplar/run/session/session.h>

#include <optional>
#include <string>

namespace Exemplar
{
  /// What messages call an event: with its line, if it has one, of this file, its step, what is done and the name.
  std::string
  title_of(const SessionEvent &event, const std::string &file = "");

  /// Throws UserError, calling it `title`, for an event that no body of so many nodes would take, whatever is held:
  /// an unknown deed, other nodes and numbers than it needs, nodes that are not there, springs that push.
  void
  check_form(const SessionEvent &event, unsigned int n_nodes, const std::string &title);

  /// The constant that an event gives all cells; nothing if it is another one.
  std::optional<ChangedConstants>
  constants_of(const SessionEvent &event);
} // namespace Exemplar

#endif
