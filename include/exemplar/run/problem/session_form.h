// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_session_form_h
#define exemplar_session_form_h

#include <exemplar/body/material.h>
#include <exemplar/run/session/session.h>

#include <optional>
#include <string>

namespace Exemplar
{
  /// Title of an event in messages: its line in `file`, if any, its step, its kind and name.
  std::string
  title_of(const SessionEvent &event, const std::string &file = "");

  /// Throws UserError, with `title`, for an event that is invalid for any body of `n_nodes` nodes:
  /// of unknown kind, with wrong counts of nodes and numbers, missing nodes, springs that push.
  void
  check_form(const SessionEvent &event, unsigned int n_nodes, const std::string &title);

  /// The constant of all cells that an event changes; nothing for other kinds of events.
  std::optional<ChangedConstants>
  constants_of(const SessionEvent &event);
} // namespace Exemplar

#endif
