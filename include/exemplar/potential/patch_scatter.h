// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_patch_scatter_h
#define exemplar_patch_scatter_h

#include <exemplar/algebra/free_dofs.h>
#include <exemplar/algebra/spd_operator.h>
#include <exemplar/body/patches.h>
#include <exemplar/potential/cell_field.h>

#include <deal.II/lac/full_matrix.h>

#include <utility>
#include <vector>

namespace Exemplar
{
  /// The nodes of each patch, and where the products of their degrees of freedom are in the matrix
  /// of the body.
  class PatchScatter
  {
  public:
    /// Whether `pattern` has the couplings(), or only those of cells. All must outlive it.
    PatchScatter(const Patches          &patches,
                 const FESpace          &fe_space,
                 const SymmetricPattern &pattern,
                 const FreeDofs         &free_dofs,
                 bool                    has_couplings);

    /// All pairs of nodes that share a patch, for make_pattern().
    static std::vector<std::pair<unsigned int, unsigned int>>
    couplings(const Patches &patches, const FESpace &fe_space);

    /// dtheta_p/dx of Eq. (25) with the rotations of `cells`: three numbers for each of nodes()
    /// [1/m].
    void
    gradient(unsigned int patch, const CellField &cells, std::vector<double> &b) const;

    /// Of a patch, ascending.
    const std::vector<unsigned int> &
    nodes(const unsigned int patch) const
    {
      return layouts[patch].nodes;
    }

    /// The places among nodes() of the nodes of each point's cell, point by point.
    const unsigned int *
    places(const unsigned int patch) const
    {
      return layouts[patch].places.data();
    }

    /// Whether some of their degrees of freedom are held.
    bool
    is_beside_held(const unsigned int patch) const
    {
      return layouts[patch].free_dofs.size() < 3 * layouts[patch].nodes.size();
    }

    /// Add factor u u^T to the values on a pattern with the couplings, as add_matrix() requires, too.
    void
    add_square(unsigned int               patch,
               double                     factor,
               const std::vector<double> &u,
               std::vector<double>       &values) const;

    /// Add a symmetric matrix over nodes(), three rows each, to the values on the pattern.
    void
    add_matrix(unsigned int                      patch,
               const dealii::FullMatrix<double> &matrix,
               std::vector<double>              &values) const;

    /// The same on a pattern that need not have the couplings of nodes between which the matrix is
    /// zero.
    void
    add_cells(unsigned int                      patch,
              const dealii::FullMatrix<double> &matrix,
              std::vector<double>              &values) const;

    /// Add factor b to a column by free degree of freedom.
    void
    add_column(unsigned int               patch,
               double                     factor,
               const std::vector<double> &b,
               double                    *column) const;

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    /// Where the numbers of a patch go in the matrix.
    struct Layout
    {
      std::vector<unsigned int> nodes;
      std::vector<unsigned int> places;    ///< of the nodes of each cell among these
      std::vector<unsigned int> free_dofs; ///< the free ones of 3 place + component
      std::vector<unsigned int> node_ends; ///< after the free ones of each node
      /// The entry where the rows of a node begin in the column of a free one, for each column and
      /// each node from the column's on; of its own node, with the diagonal.
      std::vector<int> entries;
    };

    /// In the matrix of the body of one of its free_dofs.
    int
    free_index(const Layout &layout, unsigned int i) const;

    void
    find_entries(Layout &layout) const;

    std::vector<double>
    free_part(const Layout &layout, const std::vector<double> &u) const;

    /// Call add(i, j, value) for each value of a patch that is stored, with the indices i >= j of
    /// its free degrees of freedom.
    template <typename Function>
    void
    for_each_value(const Layout &layout, std::vector<double> &values, const Function &add) const;

    const Patches          &patches;
    const FESpace          &fe_space;
    const FreeDofs         &free_dofs;
    const SymmetricPattern &pattern;
    std::vector<Layout>     layouts;
  };
} // namespace Exemplar

#endif
