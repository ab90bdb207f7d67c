// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mesh_file_h
#define exemplar_mesh_file_h

#include <exemplar/mesh/msh_file.h>

namespace Exemplar
{
  /// Extensions of the files that read_mesh_file() takes, in words: ".msh, .mesh, ...". This is the
  /// list that all messages and documentation quote.
  extern const std::string mesh_extensions;

  /// Whether the name ends in one of `mesh_extensions`, in letters of any case.
  bool
  is_mesh_file(const std::filesystem::path &file);

  /// Read a mesh by the reader of its extension: Medit (.mesh), legacy VTK (.vtk), VTK XML (.vtu),
  /// TetGen (.node and .ele, either named), Abaqus and CalculiX (.inp), USD's TetMesh (.usda), Nastran (.bdf, .nas),
  /// and for all others read_msh(). Regions and boundaries become physical tags, names of sets
  /// physical names; MshFile::note says what was taken for what, and what was left out. Nodes and
  /// elements have the numbers of the file, or are counted from 1. Throws UserError with file, line,
  /// what is wrong and what helps.
  MshFile
  read_mesh_file(const std::filesystem::path &file);

  /// Write a mesh in the format of its extension: .msh, .mesh, .vtu or .inp, with 17 digits. Returns
  /// what the format cannot hold, in sentences, or nothing. Throws UserError for other extensions,
  /// and for numbers that the format has no place for.
  std::string
  write_mesh_file(const MshFile &msh, const std::filesystem::path &file);
} // namespace Exemplar

#endif
