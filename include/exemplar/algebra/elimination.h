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
    /// Factorises `scale` times the matrix with these entries. `panels` have room for
    /// structure.n_values() numbers plus one register.
    Elimination(const FactorStructure     &structure,
                const std::vector<double> &entries,
                double                     scale,
                Number                    *panels);

    /// Returns whether the matrix is positive definite.
    bool
    run(int n_threads);

  private:
    /// The update matrix of a front for its parent: a square, of which the lower triangle is set.
    using Square = std::unique_ptr<Number[]>;

    void
    eliminate(int s, int n_threads);

    void
    gather_entries(int s);

    /// Extend-add columns `begin` to `end` - 1 of a child's update matrix to the panel or the
    /// square.
    void
    add_child(int child, bool to_panel, int s, int n_threads);

    bool
    factorize_panel(int s, int n_threads);

    bool
    factorize_great_panel(int s, int n_threads);

    void
    make_square(int s, int n_threads);

    int
    n_below(const int s) const
    {
      return structure.n_rows(s) - structure.n_columns(s);
    }

    Number *
    panel(const int s)
    {
      return panels + structure.first_value[s];
    }

    const FactorStructure        &structure;
    const std::vector<double>    &entries;
    const double                  scale;
    Number                       *panels;
    const FrontKernels<Number>   &kernels;
    std::vector<std::vector<int>> children;
    std::vector<Square>           squares;
    std::atomic<bool>             is_definite{ true };
  };
} // namespace Exemplar

#endif
