// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_linear_prediction_h
#define exemplar_linear_prediction_h

#include <exemplar/algebra/exchange.h>

#include <deal.II/lac/full_matrix.h>

#include <array>
#include <cstddef>
#include <deque>
#include <vector>

namespace Exemplar
{
  /// Linear prediction of the next vector of a sequence: the coefficients are those that fit the
  /// last vector best by the ones before it, in least squares. Exact for sums of few oscillations,
  /// damped or not, and for polynomials of low degree.
  class LinearPrediction
  {
  public:
    /// Greatest number of combined vectors.
    static constexpr unsigned int max_order = 5;

    /// `exchange` must outlive this; `order`, from 1 to max_order, is how many vectors are
    /// combined.
    LinearPrediction(const Exchange &exchange, unsigned int order)
        : exchange(&exchange), order(order)
    {
    }

    /// Append a vector, which is swapped for the memory of one that has left.
    void
    add(std::vector<double> &vector);

    /// Undo the last add(). To be called once for it.
    void
    take_back();

    /// Overwrite `next` by the predicted vector, or by the last one if the prediction is more than
    /// four times as long. Requires a last one.
    void
    predict(std::vector<double> &next);

    /// Memory in bytes.
    std::size_t
    memory_consumption() const
    {
      std::size_t bytes = sizeof(double) * left.capacity();
      for (const std::vector<double> &vector : history)
        bytes += sizeof(double) * vector.capacity();
      return bytes;
    }

    /// The stored vectors, for checkpoints; the last first.
    const std::deque<std::vector<double>> &
    vectors() const
    {
      return history;
    }

    /// Replace the stored vectors.
    void
    restore(std::deque<std::vector<double>> vectors);

  private:
    /// Compute the scalar products of vector i with itself and older ones.
    void
    multiply_out(std::size_t i);

    /// Find the coefficients by which the vectors before the last combine to it best; false if
    /// there are none, or these vectors are zero.
    bool
    find_coefficients();

    using Products = std::array<std::array<double, max_order + 1>, max_order + 1>;

    const Exchange                 *exchange;
    unsigned int                    order;
    std::deque<std::vector<double>> history; ///< the last first, order + 1 at most
    std::vector<double>             left;    ///< the vector that the last add() has removed
    bool                            has_left = false; ///< whether there was one
    Products                        products{};       ///< [i][j], i <= j
    dealii::FullMatrix<double>      gram;             ///< memory of find_coefficients()
    std::vector<double>             coefficients;     ///< which it finds
  };
} // namespace Exemplar

#endif
