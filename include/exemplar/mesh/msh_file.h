// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_msh_file_h
#define exemplar_msh_file_h

#include <deal.II/base/point.h>

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// One element of a .msh file, as the file has it.
  struct MshElement
  {
    std::size_t  number; ///< the file's element number
    unsigned int type;   ///< gmsh's element type: 15 point, 1 line, 2 triangle, 4 tetrahedron, ...
    int          physical;     ///< physical tag, 0 = none
    int          elementary;   ///< tag of the geometrical entity
    std::vector<size_t> nodes; ///< indices into MshFile::nodes (0-based), in the file's order
  };

  /// The point of a body that carries a vertex of its surface.
  struct SurfaceTie
  {
    std::array<std::size_t, 4> nodes;  ///< indices into MshFile::nodes
    std::array<double, 4>      shares; ///< barycentric coordinates, sum 1
  };

  /// A file of a mesh that was joined of several.
  struct JoinedFile
  {
    std::string          name;          ///< of the file in the scene
    std::size_t          first_node;    ///< index of its first node
    std::size_t          n_nodes;       ///< they follow each other
    std::size_t          first_element; ///< index of its first element
    double               scale;         ///< of its own [-]
    dealii::Tensor<1, 3> displacement;  ///< after that, in the unit of the joined mesh
  };

  /// The contents of a gmsh .msh file: everything needed to write it back with
  /// the same node and element numbers, order and tags.
  struct MshFile
  {
    std::vector<std::size_t>      node_numbers; ///< the file's node numbers, in file order
    std::vector<dealii::Point<3>> nodes;        ///< coordinates [m], in file order
    std::vector<MshElement>       elements;     ///< elements in file order
    /// (dimension, physical tag) -> name
    std::map<std::pair<int, int>, std::string> physical_names;
    /// (dimension, tag of a geometrical entity) -> physical tags of its elements in addition to MshElement::physical. A
    /// file of version 2.2 repeats the elements for each of them.
    std::map<std::pair<int, int>, std::vector<int>> further_groups = {};
    /// Ties of the vertices of the surface that the mesh was made of, in the surface's order; empty
    /// where they are those that the places at rest give. A section of our own, $SurfaceTies, has
    /// them: their number, and a line of four node numbers and four shares each.
    std::vector<SurfaceTie> surface_ties = {};
    /// The tips of the normals at the edges of a shell in a pose, by ascending ends of the edges, as far from the middles as the
    /// edges are long at rest; empty: none are known. A section of our own, $NormalTips, has them: their number, and a line of
    /// three coordinates each.
    std::vector<dealii::Point<3>> normal_tips = {};
    std::vector<JoinedFile>       files
        = {};              ///< empty unless it was joined of several, see join_meshes()
    std::string note = {}; ///< for the user, on conversions of the file; empty: none
    /// Restrictions of gmsh when it made this of a .geo ("text", "seccomp", "landlock"); no value
    /// if it was not made of one.
    std::optional<std::vector<std::string>> geo_walls = {};
  };

  /// gmsh's numbers for the element types that the program uses.
  namespace MshElementType
  {
    constexpr unsigned int line                  = 1;
    constexpr unsigned int triangle              = 2;
    constexpr unsigned int tetrahedron           = 4;
    constexpr unsigned int quadratic_line        = 8;
    constexpr unsigned int quadratic_triangle    = 9;
    constexpr unsigned int quadratic_tetrahedron = 11;
    constexpr unsigned int point                 = 15;
  } // namespace MshElementType

  /// An element type in gmsh's documentation.
  struct MshElementKind
  {
    const char  *name; ///< such as "10-node tetrahedron"
    unsigned int dimension;
    unsigned int n_nodes;
  };

  /// The kind of types 1 to 31; nullptr for any other, which read_msh() refuses.
  const MshElementKind *
  find_msh_element_kind(unsigned int type);

  /// Physical tags of an element in addition to its first one.
  const std::vector<int> &
  further_groups_of(const MshFile &msh, const MshElement &element);

  /// Whether an element is in the physical group of this tag, whose sign does not count.
  bool
  is_in_group(const MshFile &msh, const MshElement &element, unsigned int tag);

  /// Read a .msh file of version 2.0 to 2.2 or 4.1, ASCII or binary. In a 4.1 file the
  /// physical tags come from the element's entity.
  /// Throws UserError, naming the file and what is missing, if it cannot be
  /// opened, is truncated, of another version, or refers to unknown nodes.
  MshFile
  read_msh(const std::filesystem::path &file);

  /// read_msh() for bytes in memory; `name` stands for the file in messages.
  MshFile
  read_msh_bytes(std::string bytes, const std::string &name);

  /// MSH 2.2 ASCII, as write_msh() writes it.
  std::string
  msh_text(const MshFile &msh);

  /// Write MSH 2.2 ASCII with 17 digits, so that reading it back gives the same doubles. Written to
  /// a temporary name and renamed, so that no incomplete file is left. A `comment` of one line goes
  /// to the end, where readers skip it.
  void
  write_msh(const MshFile &msh, const std::filesystem::path &file, const std::string &comment = "");

  /// First bytes of every file by write_msh().
  extern const std::string msh_beginning;

  /// Last bytes of a file by write_msh() with this comment.
  std::string
  msh_end(const std::string &comment);
} // namespace Exemplar

#endif
