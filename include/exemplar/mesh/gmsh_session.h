// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_gmsh_session_h
#define exemplar_gmsh_session_h

#include <string>

namespace Exemplar
{
  /// gmsh keeps one model for the whole process; here it lives for one mesh, without the settings
  /// that a user keeps at home.
  class GmshSession
  {
  public:
    GmshSession();
    ~GmshSession();

    GmshSession(const GmshSession &) = delete;
    GmshSession &
    operator=(const GmshSession &)
        = delete;
  };

  /// What tells the library of gmsh that is linked from every other.
  std::string
  gmsh_identity();
} // namespace Exemplar

#endif
