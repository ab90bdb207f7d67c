// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_patch_scatter_h
#define exemplar_patch_scatter_h

#include <exemplar/algebra/free_dofs.h>
#include <exemplar/algebra/outer_products.h>
#include <exemplar/algebra/spd_operator.h>
#include <exemplar/body/patches.h>
#include <exemplar/potential/cell_field.h>

#include <utility>
#include <vector>

namespace Exemplar
{
  /// Four numbers, the last of them 0, for each node of each patch, patch by patch.
  using PatchVectors = std::vector<double>;

  /// What of the tangent of patches couples all their nodes: sums of products of vectors b, squares and
  /// sums, see PatchColumns.
  struct PatchProducts
  {
    std::vector<double> factors; ///< of b b^T, a patch
    PatchVectors        vectors; ///< b
    PatchVectors        squares; ///< empty if no patch is strongly stretched
    PatchVectors        sums;
    std::vector<double> of_squares;
    std::vector<double> of_products;
  };

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
                 const CellField        &cells,
                 bool                    has_couplings);

    /// All pairs of nodes that share a patch, for make_pattern().
    static std::vector<std::pair<unsigned int, unsigned int>>
    couplings(const Patches &patches, const FESpace &fe_space);

    /// dtheta_p/dx of Eq. (25) by the rotations of `cells` [1/m].
    void
    find_gradients(CellField &cells, PatchVectors &b) const;

    /// Sum V/V_p M grad N_a over the points of each patch, as dtheta_p/dx has R for the matrices M, nine numbers a
    /// point in batches.
    void
    find_gradients(CellField &cells, double *matrices, PatchVectors &b) const;

    /// Nodes of all patches, each counted once a patch.
    std::size_t
    n_nodes() const
    {
      return all_nodes.size();
    }

    /// The mean over a patch of numbers by point.
    double
    mean(unsigned int patch, const double *numbers) const;

    /// Scalar product of a patch's vector with a field by degree of freedom.
    double
    product(unsigned int patch, const PatchVectors &vectors, const Vector &field) const;

    /// Add a factor times the vector of a patch to a field.
    void
    add(unsigned int patch, double factor, const PatchVectors &vectors, Vector &field) const;

    /// Add a factor times three numbers for each node of a point's cell, in FESpace's order, to those of a
    /// patch.
    void
    add_at_cell(unsigned int               patch,
                unsigned int               point,
                double                     factor,
                const std::vector<double> &of_cell,
                PatchVectors              &vectors) const;

    /// Whether some of their degrees of freedom are held.
    bool
    is_beside_held(const unsigned int patch) const
    {
      return beside_held[patch];
    }

    /// Add to the values on a pattern with the couplings; the vectors are changed.
    void
    add_products(const CellField     &cells,
                 PatchProducts       &products,
                 std::vector<double> &values) const;

    /// Add to a sum of outer products over nodes.
    void
    add_products(const PatchProducts &products, OuterProducts &to) const;

    /// Add factor b to a column by free degree of freedom.
    void
    add_column(unsigned int patch, double factor, const PatchVectors &b, double *column) const;

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    /// The arrays behind PatchArrays.
    struct Points
    {
      std::vector<std::size_t>  starts;
      std::vector<unsigned int> points;
      std::vector<double>       fractions;
      std::vector<int>          places;
    };

    /// The arrays behind PatchColumns, for nodes with a free component.
    struct Columns
    {
      std::vector<std::size_t> starts;
      std::vector<PatchAtNode> patches;
      std::vector<int>         columns, offsets;
    };

    /// The place of a patch's node among the nodes of all patches.
    std::size_t
    place(unsigned int patch, unsigned int node) const;

    void
    find_points(const Patches &patches, const CellField &cells);

    void
    find_held();

    void
    find_columns(const SymmetricPattern &pattern);

    /// Where the rows of the nodes from `place` on are in the first column of the node there.
    void
    append_offsets(const SymmetricPattern &pattern, std::size_t place, std::size_t end);

    /// The first free degree of freedom of a node by number among the free ones, or FreeDofs::held.
    int
    first_free(unsigned int node) const;

    /// The three numbers of each node of a patch.
    std::vector<double>
    of_nodes(unsigned int patch, const PatchVectors &vectors) const;

    /// At nodes of which some components are held the free ones first.
    void
    pack(PatchVectors &vectors) const;

    const FESpace            &fe_space;
    const FreeDofs           &free_dofs;
    std::vector<std::size_t>  node_starts;
    std::vector<unsigned int> all_nodes;
    Points                    of_points;
    Columns                   of_columns;
    std::vector<std::size_t>  mixed; ///< places of nodes of which some components are held
    std::vector<bool>         beside_held;
  };
} // namespace Exemplar

#endif
