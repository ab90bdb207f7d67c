// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_contact_columns_h
#define exemplar_contact_columns_h

#include <exemplar/algebra/lbfgs.h>
#include <exemplar/solvers/gap_energies.h>
#include <exemplar/solvers/rotated_metric.h>

#include <array>
#include <memory>
#include <unordered_map>
#include <vector>

namespace Exemplar
{
  /// U^T P^-1 U of a rotated metric for rows U of gaps: entries of the kept inverse between nodes, which are
  /// found when a node first takes part and kept for the life of the metric.
  class ContactColumns
  {
  public:
    ContactColumns(const FreeDofs &free_dofs, const RotatedMetric &metric);

    /// Whether the metric gives entries.
    bool
    has_entries();

    /// U^T (P^-1 + B M B^T) U, with the correction by L-BFGS.
    dealii::FullMatrix<double>
    between_rows(const GapEnergies &gaps, const LbfgsCorrection &correction);

    void
    clear();

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    using Block = std::array<double, 9>;

    /// Forget what is another metric's.
    void
    follow_metric();

    /// The number of a node's entries, which are found if it has none.
    std::size_t
    number_of(unsigned int node);

    /// What a row is at one of its nodes, in the frame of the metric.
    struct Part
    {
      std::size_t          node; ///< number_of() it
      unsigned int         first_dof;
      dealii::Tensor<1, 3> direction;
    };

    std::vector<std::vector<Part>>
    parts_of(const GapEnergies &gaps);

    /// Add the entries between a direction at a node and other nodes, three numbers each, times a row's.
    void
    add_entries(const Part &row, const std::vector<std::size_t> &nodes, double *entries) const;

    /// The lower triangle of U^T P^-1 U.
    void
    find_entries(const std::vector<std::vector<Part>> &rows, dealii::FullMatrix<double> &W) const;

    /// Add U^T B M B^T U to it.
    void
    add_correction(const std::vector<std::vector<Part>> &rows,
                   const LbfgsCorrection                &correction,
                   dealii::FullMatrix<double>           &W) const;

    const FreeDofs                               &free_dofs;
    const RotatedMetric                          &metric;
    unsigned int                                  version = 0; ///< of the metric
    std::unique_ptr<InverseEntries>               entries;
    std::unordered_map<unsigned int, std::size_t> numbers; ///< by node
    std::vector<std::array<int, 3>> columns; ///< of the entries, by number of a node; -1: held
    std::vector<std::vector<Block>> blocks;  ///< of nodes a >= b
  };
} // namespace Exemplar

#endif
