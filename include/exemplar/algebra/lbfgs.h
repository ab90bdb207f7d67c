// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_lbfgs_h
#define exemplar_lbfgs_h

#include <exemplar/algebra/exchange.h>

#include <deal.II/lac/full_matrix.h>

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace Exemplar
{
  /// What the pairs of Lbfgs add to an inverse: columns B and a small symmetric matrix M, B M B^T.
  struct LbfgsCorrection
  {
    std::vector<const std::vector<double> *>
                               columns; ///< of the Lbfgs, as long as it does not change
    dealii::FullMatrix<double> matrix;
  };

  /// The memory of a quasi-Newton method: pairs of steps s and gradient changes y along them, which
  /// correct an approximate inverse of the Hessian (Nocedal and Wright, Algorithm 7.4).
  class Lbfgs
  {
  public:
    static constexpr std::size_t max_pairs = 5;

    /// `exchange` must outlive this.
    explicit Lbfgs(const Exchange &exchange) : exchange(&exchange) {}

    void
    clear();

    /// Append a pair if its curvature s.y is positive, and tell whether it is. Both are swapped for the memory of a pair
    /// that has left, so their values are lost.
    bool
    add_pair(std::vector<double> &s, std::vector<double> &y);

    /// Keep the pairs of this moment for go_back(), in place of earlier ones. No pair is copied.
    void
    keep();

    /// Restore the pairs of the last keep(), whatever has been added or cleared since then.
    void
    go_back();

    /// Memory in bytes.
    std::size_t
    memory_consumption() const;

    /// Replace each stored vector v by function(v), say for a checkpoint, which holds vectors of
    /// the whole body.
    template <typename Function>
    void
    map(const Function &function)
    {
      for (Pair &pair : pairs)
      {
        pair.s = function(pair.s);
        pair.y = function(pair.y);
      }
    }

    /// Serialise the complete state, for checkpoints.
    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      archive &pairs;
      n_kept = 0;
    }

    /// First loop of the two-loop recursion, applied before the approximate inverse.
    void
    before(std::vector<double> &vector);

    /// Second loop of the recursion, applied after the approximate inverse.
    void
    after(std::vector<double> &vector) const;

    /// The correction as a whole (Byrd, Nocedal and Schnabel, Math. Program. 63, 1994, Theorem 2.2): H = H0 + B M B^T with
    /// B = [S, H0 Y], where `apply` overwrites a vector by H0 times it, the same one until clear().
    LbfgsCorrection
    correction(const std::function<void(std::vector<double> &)> &apply);

    /// H0 times the change y of the newest pair, since correction().
    const std::vector<double> &
    newest_response() const
    {
      return pairs.back().inverse_y;
    }

  private:
    /// A step s and the change y of the gradient along it.
    struct Pair
    {
      std::vector<double> s, y;
      double              rho   = 0.; ///< 1 / s.y
      double              alpha = 0.; ///< rho s.vector, of before()
      std::vector<double> inverse_y;  ///< H0 y, if correction() has wanted it; else empty
      /// With s_i.y and y_i.H0 y of the pair i places before this one, from 0 on, if correction() has wanted them.
      std::vector<std::array<double, 2>> products;

      template <typename Archive>
      void
      serialize(Archive &archive, unsigned int /*version*/)
      {
        archive &s &y &rho;
      }
    };

    /// Take the oldest pair away, which waits in `gone` or `spare`.
    void
    drop_oldest();

    const Exchange   *exchange;
    std::vector<Pair> pairs;      ///< the oldest first
    std::size_t       n_kept = 0; ///< so many of the oldest ones have been there since keep()
    std::vector<Pair> gone;       ///< pairs that have left since keep(), in their order
    std::vector<Pair> spare;      ///< memory of pairs that are no longer needed
  };
} // namespace Exemplar

#endif
