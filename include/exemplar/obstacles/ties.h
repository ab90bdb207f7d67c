// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_ties_h
#define exemplar_ties_h

#include <exemplar/obstacles/contact_surface.h>
#include <exemplar/obstacles/tie_parameters.h>

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// A node and the point of a cell of another piece that it is tied to: the sum of shares times places of the cell's
  /// nodes, which at rest is where the node is, within the cell or beyond its surface. It goes along with all that the cell
  /// does, so that a tie has neither force nor moment of its own where all turn together.
  struct Tie
  {
    unsigned int              node;
    std::vector<unsigned int> others; ///< nodes of the cell
    std::vector<double>       shares; ///< theirs; their sum is 1
    unsigned int              own_cell, cell;
    unsigned int              piece;     ///< of the cell
    double                    area = 0.; ///< of the surface at the node, at rest [m^2]
  };

  /// Nodes of the body's surface that go along with places of other pieces, in one process.
  class Ties
  {
  public:
    /// The ties of a subsection.
    struct Group
    {
      std::string      name;
      double           stiffness; ///< [N/m^3]; 0: rigid
      std::vector<Tie> ties;
    };

    Ties() = default;

    /// A selected node of the surface that lies in a cell of To's pieces is tied to that place, any other one to the nearest
    /// place of To's surface that it faces: in front of both surfaces, which look at each other, and within Reach.
    /// `named` are the nodes of selections, see Selection. Throws UserError for ties that reach nothing, or farther than a
    /// cell's motion can be continued, with the place.
    Ties(const std::vector<TieParameters> &parameters,
         const Mesh                       &mesh,
         const FESpace                    &fe_space,
         const NamedNodes                 &named);

    bool
    empty() const
    {
      return groups.empty();
    }

    /// Each node with the pieces that it is tied to.
    std::set<std::pair<unsigned int, unsigned int>>
    pieces_of_nodes() const;

    /// The least piece that each piece is joined to, itself if none, by ties of three nodes or more that are not in a line.
    const std::vector<unsigned int> &
    joined_pieces() const
    {
      return joined;
    }

    const std::vector<Group> &
    get_groups() const
    {
      return groups;
    }

    /// What was not tied, for the user.
    const std::vector<std::string> &
    get_notes() const
    {
      return notes;
    }

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    void
    join_pieces(const FESpace &fe_space, const std::vector<unsigned int> &piece_of_node);

    std::vector<Group>        groups;
    std::vector<unsigned int> joined;
    std::vector<std::string>  notes;
  };
} // namespace Exemplar

#endif
