// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_mesh_builder_h
#define exemplar_mesh_builder_h

#include <exemplar/mesh/msh_file.h>

#include <functional>
#include <unordered_map>

namespace Exemplar
{
  /// Collects nodes and elements of a mesh. `fail` throws UserError with the place in the file.
  class MeshBuilder
  {
  public:
    using Fail = std::function<void(const std::string &)>;

    explicit MeshBuilder(Fail fail) : fail(std::move(fail)) {}

    /// Append a node with a number of its own.
    void
    add_node(long long number, const dealii::Point<3> &place);

    /// Let MshFile's numbers of nodes be those of the file plus 1, as gmsh's begin with 1.
    void
    count_from_0()
    {
      first = 0;
    }

    /// Append a node with the next number.
    void
    add_node(const dealii::Point<3> &place)
    {
      add_node(static_cast<long long>(msh.nodes.size()) + first, place);
    }

    /// Append an element of gmsh's type between nodes of these numbers, in gmsh's order. `number` 0
    /// means the next one, counted from 1.
    void
    add_element(unsigned int                  type,
                const std::vector<long long> &node_numbers,
                int                           tag,
                long long                     number = 0);

    /// Add a sentence to the note for the user.
    void
    note(const std::string &sentence);

    /// A tag of an element: fails for one that is negative or too large for gmsh's.
    int
    tag(long long value, const std::string &what) const;

    MshFile msh;

  private:
    Fail                                         fail;
    long long                                    first = 1; ///< the file's first number
    std::unordered_map<std::size_t, std::size_t> index_of;
    std::unordered_map<std::size_t, std::size_t> element_of;
  };

  /// Exchange the last two nodes of a 10-node tetrahedron: gmsh has the edges 2-3 and 1-3 there, VTK,
  /// Abaqus, Medit and TetGen the edges 1-3 and 2-3.
  template <typename Node>
  void
  exchange_last_edges(std::vector<Node> &nodes)
  {
    if (nodes.size() == 10)
      std::swap(nodes[8], nodes[9]);
  }
} // namespace Exemplar

#endif
