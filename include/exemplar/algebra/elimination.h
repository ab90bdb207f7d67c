// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_elimination_h
#define exemplar_elimination_h

#include <exemplar/algebra/factor_structure.h>
#include <exemplar/algebra/front_kernels.h>

#include <atomic>
#include <memory>
#include <vector>

namespace Exemplar
{
  /// One multifrontal factorisation, from the entries of A to the panels of L.
  template <typename Number>
  class Elimination
  {
  public:
    /// Factorises `scale` times the matrix with these entries. `panels` have room for structure.n_values() numbers plus one
    /// register.
    Elimination(const FactorStructure     &structure,
                const std::vector<double> &entries,
                double                     scale,
                Number                    *panels);

    /// Returns whether the matrix is positive definite.
    bool
    run(int n_threads);

  private:
    using Columns = SlabColumns<Number>;

    /// The update matrix of a front for its parent: a square by columns, of which the lower triangle is set.
    using Square = std::unique_ptr<Number[]>;

    void
    eliminate(int s, int n_threads);

    void
    gather_entries(int s);

    /// Extend-add a child's update matrix to the supernode's columns in a block of its panel.
    void
    add_to_block(int child, int s, const PanelBlock &block, int n_threads);

    /// Extend-add what is left of it to the supernode's square.
    void
    add_to_square(int child, int s, int n_threads);

    /// Where rows of a supernode, so many and consecutive, stand in a column, and the distance of columns.
    struct Place
    {
      Number        *values;
      std::ptrdiff_t column_stride;
      int            n_rows;
    };

    /// Add columns begin to end - 1 of a child's update matrix. place_of(row of the parent) is a Place in the column of the
    /// parent's `first_column`.
    template <typename PlaceOf>
    void
    add_columns(int child, int begin, int end, int first_column, const PlaceOf &place_of) const;

    /// Factorise a block, after its update by the blocks before it, which begin with its first row.
    bool
    factorize_block(const PanelBlock           &block,
                    const std::vector<Columns> &before,
                    Number                     *panel,
                    int                         n_threads);

    void
    make_square(int s, const std::vector<Columns> &columns, int n_threads);

    /// FrontKernels::subtract_products() with so many blocks at once as the caches hold.
    void
    subtract_products(const std::vector<Columns> &blocks,
                      int                         n_rows,
                      int                         begin,
                      int                         end,
                      int                         n_columns,
                      const SlabTarget<Number>   &C,
                      bool                        overwrite) const;

    const FactorStructure      &structure;
    const std::vector<double>  &entries;
    const double                scale;
    Number                     *panels;
    const FrontKernels<Number> &kernels;
    std::vector<Square>         squares;
    std::atomic<bool>           is_definite{ true };
  };
} // namespace Exemplar

#endif
