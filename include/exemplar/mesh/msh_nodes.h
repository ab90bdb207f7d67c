// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_msh_nodes_h
#define exemplar_msh_nodes_h

#include <exemplar/mesh/msh_file.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// Remove the nodes for which `keep` is false, which no element may have.
  void
  remove_nodes(MshFile &msh, const std::vector<bool> &keep);

  /// Remove nodes that only points without a physical group have, as the centres of arcs in a geometry of gmsh, and
  /// these points. MshFile::note says so, calling the file `name`.
  void
  drop_construction_points(MshFile &msh, const std::string &name);
} // namespace Exemplar

#endif
