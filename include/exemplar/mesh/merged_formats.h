// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_merged_formats_h
#define exemplar_merged_formats_h

#include <string>

namespace Exemplar
{
  /// The extension by which gmsh reads these bytes as data: .stl, .step, .iges, .brep, .msh,
  /// .mesh, .ply, .vtk, .unv, .wrl or .pos. Empty if they are not known to be in any such format.
  std::string
  merged_format(const std::string &bytes);
} // namespace Exemplar

#endif
