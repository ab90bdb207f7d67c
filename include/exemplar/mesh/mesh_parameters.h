// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mesh_parameters_h
#define exemplar_mesh_parameters_h

#include <array>
#include <string>
#include <vector>

namespace Exemplar
{
  class KeyTable;

  /// What makes the mesh where no file does.
  enum class MeshGenerator
  {
    none,
    box
  };

  /// Subsection Mesh. Exactly one of `file` and `generator` must be given, unless a program
  /// hands in a mesh of its own.
  ///
  /// The box is [0,Lx] x [-Ly/2,Ly/2] x [-Lz/2,Lz/2], cut into nx x ny x nz bricks
  /// of 6 tetrahedra each (Kuhn's subdivision, all along the diagonal from the
  /// lowest to the highest corner). Its nodes are numbered from 1, x fastest; its
  /// boundary ids are 1..6 for x-, x+, y-, y+, z-, z+, its material id is 1.
  struct MeshParameters
  {
    std::string                 file;
    std::string                 surface;           ///< a file; empty: see surface_file()
    std::vector<std::string>    carried;           ///< files of surfaces that go along
    unsigned int                n_cells   = 10000; ///< wanted, if `file` is a surface
    bool                        repair    = false; ///< whether a surface is mended first
    MeshGenerator               generator = MeshGenerator::none;
    std::array<double, 3>       box_size{ { 1., 1., 1. } };
    std::array<unsigned int, 3> box_cells{ { 4, 4, 4 } };
    double                      scale = 1.;
    /// Whether a .geo may run programs and write files. No key: a scene may not allow it to
    /// itself.
    bool allow_commands = false;

    void
    declare(KeyTable &keys);

    /// What stands for the mesh in messages: the file, "box" or, with neither, "mesh".
    std::string
    name() const;

    /// Throws UserError unless `carried` are files of surfaces with names of their own.
    void
    check_carried() const;

    /// Whether `file` is a surface, which is to be filled with cells.
    bool
    is_surface() const;

    /// The surface that bounds the body as its maker has it: `surface`, or else `file` if that is
    /// one; empty if none is named.
    std::string
    surface_file() const;
  };

  /// Whether a file is a surface, by its extension: .obj, .ply or .stl, in capitals, too.
  bool
  is_surface_file(const std::string &file);

  /// What the frames of a surface that is carried are called after: its file without directory and
  /// extension.
  std::string
  name_of_carried(const std::string &file);

  /// How many cells may be asked for.
  constexpr unsigned int min_n_cells = 10, max_n_cells = 10000000;
} // namespace Exemplar

#endif
