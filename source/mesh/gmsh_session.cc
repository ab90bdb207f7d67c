// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/build_identity.h>
#include <exemplar/mesh/gmsh_session.h>

#include <dlfcn.h>
#include <gmsh.h>

namespace Exemplar
{
  GmshSession::GmshSession()
  {
    gmsh::initialize(0, nullptr, false); // without the user's settings
  }

  GmshSession::~GmshSession()
  {
    gmsh::finalize();
  }

  std::string
  gmsh_identity()
  {
    return build_identity(dlsym(RTLD_DEFAULT, "gmshInitialize"));
  }
} // namespace Exemplar
