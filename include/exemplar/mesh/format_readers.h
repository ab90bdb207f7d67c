// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_format_readers_h
#define exemplar_format_readers_h

#include <exemplar/mesh/msh_file.h>

// Readers of formats, of bytes in memory; `name` stands for the file in messages. See
// read_mesh_file() for what they give and throw.

namespace Exemplar
{
  MshFile
  read_medit(std::string bytes, const std::string &name);

  MshFile
  read_legacy_vtk(std::string bytes, const std::string &name);

  MshFile
  read_vtu(std::string bytes, const std::string &name);

  MshFile
  read_abaqus(std::string bytes, const std::string &name);

  MshFile
  read_nastran(std::string bytes, const std::string &name);

  MshFile
  read_usd(std::string bytes, const std::string &name);

  /// `nodes` and `cells` are the bytes of .node and .ele, `faces` those of .face, or empty.
  MshFile
  read_tetgen(std::string                  nodes,
              std::string                  cells,
              std::string                  faces,
              const std::filesystem::path &node_file);
} // namespace Exemplar

#endif
