// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mesh_parameters_h
#define exemplar_mesh_parameters_h

#include <array>
#include <string>
#include <vector>

namespace Exemplar
{
  class KeyTable;

  /// Generators of a mesh instead of a file.
  enum class MeshGenerator
  {
    none,
    box
  };

  /// What a mesh is made of.
  enum class MeshKind
  {
    solid, ///< tetrahedra
    shell  ///< triangles, which have a thickness
  };

  /// A file of Mesh/Files, and where it stands: subsection Mesh/NAME.
  struct PlacedFile
  {
    std::string           name; ///< that of the file without directory and extension
    double                scale = 1.;
    std::array<double, 3> displacement{ { 0., 0., 0. } }; ///< after scaling, in the mesh's unit

    void
    declare(KeyTable &keys);
  };

  /// Subsection Mesh. Exactly one of `file`, `files` and `generator` must be given, unless a program passes
  /// its own mesh.
  ///
  /// The box is [0,Lx] x [-Ly/2,Ly/2] x [-Lz/2,Lz/2], cut into nx x ny x nz bricks
  /// of 6 tetrahedra each (Kuhn's subdivision, all along the diagonal from the
  /// lowest to the highest corner). Its nodes are numbered from 1, x fastest; its
  /// boundary ids are 1..6 for x-, x+, y-, y+, z-, z+, its material id is 1.
  struct MeshParameters
  {
    MeshKind                    kind = MeshKind::solid;
    std::string                 file;
    std::vector<std::string>    files;             ///< several meshes in one scene
    std::vector<PlacedFile>     placed;            ///< of `files`, in their order
    std::string                 surface;           ///< a file; empty: see surface_file()
    std::vector<std::string>    carried;           ///< files of surfaces that are carried along
    unsigned int                n_cells   = 10000; ///< number wanted, if `file` is a surface
    bool                        repair    = false; ///< whether to repair a surface first
    MeshGenerator               generator = MeshGenerator::none;
    std::array<double, 3>       box_size{ { 1., 1., 1. } };
    std::array<unsigned int, 3> box_cells{ { 4, 4, 4 } };
    double                      scale = 1.;
    /// Whether a .geo may run programs and write files. No key, so that no scene can allow it to
    /// itself.
    bool allow_commands = false;

    void
    declare(KeyTable &keys);

    /// Names of `files`: those of the files without directory and extension, with " 2", " 3" behind one that is there
    /// again. Throws UserError for a file that is a surface and for names that are the same or no names of subsections.
    std::vector<std::string>
    names_of_files() const;

    /// Name of the mesh in messages: the file or files, "box" or, with neither, "mesh".
    std::string
    name() const;

    /// Throws UserError unless `carried` are files of surfaces with distinct names.
    void
    check_carried() const;

    /// Whether `file` is a surface that is to be filled with cells.
    bool
    is_surface() const;

    /// The original surface of the body: `surface`, or else `file` if that is one; empty if none is
    /// given.
    std::string
    surface_file() const;
  };

  /// Whether a file is a surface, by its extension: .obj, .ply or .stl, also in capitals.
  bool
  is_surface_file(const std::string &file);

  /// Name of the frames of a carried surface: its file without directory and extension.
  std::string
  name_of_carried(const std::string &file);

  /// Limits of MeshParameters::n_cells.
  constexpr unsigned int min_n_cells = 10, max_n_cells = 10000000;
} // namespace Exemplar

#endif
