// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_rigid_correction_h
#define exemplar_rigid_correction_h

#include <exemplar/algebra/exchange.h>
#include <exemplar/algebra/vector.h>

#include <deal.II/lac/full_matrix.h>

#include <functional>
#include <vector>

namespace Exemplar
{
  /// The inverse of a matrix A on the rigid motions Z of pieces, Z (Z^T A Z)^-1 Z^T. Weak springs alone may constrain these
  /// motions. Their stiffness is then below the single precision of multigrid, and conjugate gradients do not converge
  /// without such a correction in double precision.
  class RigidCorrection
  {
  public:
    using Multiply = std::function<void(const Vector &, Vector &)>;

    /// No correction.
    RigidCorrection() = default;

    /// `places` (x, y, z) and `pieces` are those of the nodes with rows of this process, three rows each; `rows` are those
    /// that are free. `multiply` multiplies vectors of all rows of this process by A. All processes must call this.
    RigidCorrection(const std::vector<double>       &places,
                    const std::vector<unsigned int> &pieces,
                    const std::vector<int>          &rows,
                    const Multiply                  &multiply,
                    const Exchange                  &exchange);

    /// Add its product with `residual`. All processes must call this.
    void
    add(const Vector &residual, Vector &image) const;

    bool
    empty() const
    {
      return factor.m() == 0;
    }

  private:
    std::size_t
    n_rows() const
    {
      return places.size();
    }

    /// Call action(column, entry) for the six motions of a row's piece.
    template <typename Action>
    void
    for_each_motion(std::size_t row, const Action &action) const;

    /// Z^T vector, of all processes.
    std::vector<double>
    components(const Vector &vector) const;

    const Exchange            *exchange = nullptr;
    std::vector<double>        places;
    std::vector<unsigned int>  pieces;  ///< of nodes
    std::vector<char>          is_free; ///< by row
    dealii::FullMatrix<double> factor;  ///< Cholesky's, of Z^T A Z
  };
} // namespace Exemplar

#endif
