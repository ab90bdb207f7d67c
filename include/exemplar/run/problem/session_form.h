// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_session_form_h
#define exemplar_session_form_h

#include <exemplar/body/example_parameters.h>
#include <exemplar/body/fe_space.h>
#include <exemplar/body/material.h>
#include <exemplar/obstacles/obstacle_parameters.h>
#include <exemplar/run/session/session.h>

#include <optional>
#include <string>

namespace Exemplar
{
  /// Title of an event in messages: its line in `file`, if any, its step, its kind and name.
  std::string
  title_of(const SessionEvent &event, const std::string &file = "");

  /// Throws UserError, with `title`, for an event that is invalid for any body of these nodes:
  /// of unknown kind or name, with wrong counts of nodes and numbers, missing nodes, springs that push.
  void
  check_form(const SessionEvent &event, const FESpace &fe_space, const std::string &title);

  /// The obstacle that an event adds: a ball or a block along the axes; nothing for other kinds of events.
  std::optional<ObstacleParameters>
  obstacle_of(const SessionEvent &event);

  /// The energy of the examples that an event of this kind sets. check_form() must have passed.
  ExampleEnergy
  energy_of(const SessionEvent &event);

  /// The constant of all cells that an event changes; nothing for other kinds of events.
  std::optional<ChangedConstants>
  constants_of(const SessionEvent &event);
} // namespace Exemplar

#endif
