// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_factor_columns_h
#define exemplar_factor_columns_h

#include <exemplar/algebra/inverse_entries.h>
#include <exemplar/algebra/multifrontal_factor.h>

#include <memory>
#include <vector>

namespace Exemplar
{
  /// Entries of A^-1 = L^-T L^-1 as products of columns of L^-1. Such a column is zero but at the supernodes between its
  /// unknown's and the root of the elimination tree, to which the forward substitution keeps; two of them meet where their
  /// ways to the root do.
  class FactorColumns : public InverseEntries
  {
  public:
    explicit FactorColumns(std::shared_ptr<const MultifrontalFactor<float>> factor);

    std::size_t
    add(unsigned int unknown) override;

    double
    entry(std::size_t row, std::size_t column) const override;

    std::size_t
    memory_consumption() const override;

  private:
    /// A column of L^-1 from the root down.
    struct Column
    {
      std::vector<int>   supernodes;
      std::vector<float> values; ///< at the columns of these
    };

    const std::shared_ptr<const MultifrontalFactor<float>> factor;
    std::vector<int>                                       row_of;       ///< of L, by unknown
    std::vector<int>                                       supernode_of; ///< by row of L
    std::vector<int>    subtree_of; ///< by supernode; -1: in the top
    std::vector<float>  vector, block;
    std::vector<Column> columns;
  };
} // namespace Exemplar

#endif
