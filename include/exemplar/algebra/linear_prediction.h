// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_linear_prediction_h
#define exemplar_linear_prediction_h

#include <exemplar/algebra/exchange.h>

#include <array>
#include <cstddef>
#include <deque>
#include <vector>

namespace Exemplar
{
  /// Predicts the next vector of a sequence: by the linear combination of the last ones that,
  /// one earlier, comes closest to the last. Exact for what is a sum of few oscillations,
  /// damped or not, and for polynomials of low degree.
  class LinearPrediction
  {
  public:
    /// Most vectors of a combination.
    static constexpr unsigned int max_order = 5;

    /// `exchange` must outlive this; `order`, from 1 to max_order, is how many vectors are combined.
    LinearPrediction(const Exchange &exchange, unsigned int order)
        : exchange(&exchange), order(order)
    {
    }

    void
    add(std::vector<double> vector);

    /// The last one, where the combination is more than four times as long. Requires that there is a last one.
    std::vector<double>
    next() const;

    /// In bytes.
    std::size_t
    memory_consumption() const
    {
      std::size_t bytes = 0;
      for (const std::vector<double> &vector : history)
        bytes += sizeof(double) * vector.capacity();
      return bytes;
    }

    /// The vectors that it remembers, as for a checkpoint; the last first.
    const std::deque<std::vector<double>> &
    vectors() const
    {
      return history;
    }

    /// Remember these instead.
    void
    restore(std::deque<std::vector<double>> vectors);

  private:
    /// Products of vector i with those that are older.
    void
    multiply_out(std::size_t i);

    using Products = std::array<std::array<double, max_order + 1>, max_order + 1>;

    const Exchange                 *exchange;
    unsigned int                    order;
    std::deque<std::vector<double>> history;    ///< the last first, order + 1 at most
    Products                        products{}; ///< [i][j], i <= j
  };
} // namespace Exemplar

#endif
