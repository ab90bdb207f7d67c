// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_session_checks_h
#define exemplar_session_checks_h

#include <exemplar/run/session/session.h>

#include <string>

namespace Exemplar
{
  class Problem;

  /// Throws UserError, with the line of `file`, if the problem would refuse an event of a session,
  /// so that a long run does not fail there. The problem is left as before.
  void
  check_session(Problem &problem, const Session &session, const std::string &file);
} // namespace Exemplar

#endif
