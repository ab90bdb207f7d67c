// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_gap_energies_h
#define exemplar_gap_energies_h

#include <exemplar/algebra/vector.h>
#include <exemplar/potential/gap.h>

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/lapack_full_matrix.h>

#include <vector>

namespace Exemplar
{
  /// Barriers and friction of gaps as functions of how far their points move, by rows: each is the part along a direction
  /// of the displacement of a gap's point. A gap with a barrier has a row along its
  /// normal, and one with friction two across its lagged one.
  class GapEnergies
  {
  public:
    explicit GapEnergies(std::vector<Gap> gaps);

    /// A row: y = direction . sum C_i u_i, Gap::derivative().
    struct Row
    {
      unsigned int         gap; ///< its index
      dealii::Tensor<1, 3> direction;
    };

    std::size_t
    n_rows() const
    {
      return rows.size();
    }

    const Gap &
    gap_of(const std::size_t row) const
    {
      return gaps[rows[row].gap];
    }

    const std::vector<Gap> &
    get_gaps() const
    {
      return gaps;
    }

    const Row &
    row(const std::size_t i) const
    {
      return rows[i];
    }

    /// The distance [m] of each gap after a displacement by degree of freedom; infinite without a barrier.
    std::vector<double>
    distances(const Vector &displacement) const;

    /// The rows of a displacement [m] by degree of freedom.
    std::vector<double>
    changes(const Vector &displacement) const;

    /// Add a number a row, as forces on the points along the rows' directions, to a field by degree of freedom.
    void
    add_forces(const std::vector<double> &by_row, Vector &field) const;

    /// The energy [J], infinite where a gap is closed, at these changes of the rows.
    double
    value(const std::vector<double> &changes) const;

    /// Its derivatives [N].
    std::vector<double>
    slopes(const std::vector<double> &changes) const;

    /// A symmetric matrix with blocks for the rows of a gap.
    class Blocks
    {
    public:
      void
      multiply(const std::vector<double> &vector, std::vector<double> &product) const;

      /// The lower triangle of this matrix times a symmetric one times this matrix.
      dealii::LAPACKFullMatrix<double>
      on_both_sides_of(const dealii::FullMatrix<double> &matrix) const;

    private:
      friend class GapEnergies;
      std::vector<double> diagonal,
          beside_next; ///< entries with the row itself, and with the next one
    };

    /// The symmetric root of the second derivatives, which are positive semidefinite.
    Blocks
    root_of_curvatures(const std::vector<double> &changes) const;

    /// The part of a further change that leaves each gap a tenth; infinite if there is none that shrinks.
    double
    longest_part(const std::vector<double> &changes, const std::vector<double> &further) const;

  private:
    /// How far a gap slips along its two directions across the normal, and the length of that [m].
    struct Slip
    {
      double x, y, length;
    };

    /// Where a row is the first of two across a normal.
    Slip
    slip(std::size_t row, const std::vector<double> &changes) const;

    std::vector<Gap>  gaps;
    std::vector<Row>  rows;
    std::vector<char> kinds; ///< of rows
  };
} // namespace Exemplar

#endif
