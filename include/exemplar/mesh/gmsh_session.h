// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_gmsh_session_h
#define exemplar_gmsh_session_h

#include <string>

namespace Exemplar
{
  /// A session of gmsh, which has one model for the whole process, for one mesh and without the
  /// user's settings.
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

  /// An identity of the linked library of gmsh, which differs between versions and builds.
  std::string
  gmsh_identity();
} // namespace Exemplar

#endif
