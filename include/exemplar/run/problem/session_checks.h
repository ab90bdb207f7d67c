// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_session_checks_h
#define exemplar_session_checks_h

#include <exemplar/run/session/session.h>

#include <string>

namespace Exemplar
{
  class Problem;

  /// Throws UserError, with the line of `file`, for an event of a session that the problem would refuse when it comes
  /// to it, so that a run of hours does not end there. The problem is as before.
  void
  check_session(Problem &problem, const Session &session, const std::string &file);
} // namespace Exemplar

#endif
