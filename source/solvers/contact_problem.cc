// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/errors.h>
#include <exemplar/solvers/contact_problem.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    std::vector<double>
    product(const dealii::FullMatrix<double> &W, const std::vector<double> &vector)
    {
      std::vector<double> result(vector.size());
      for (std::size_t i = 0; i < vector.size(); ++i)
        result[i] = dot(vector, &W(i, 0));
      return result;
    }

    /// Overwrite b by the solution of A x = b for a positive definite matrix, of which the lower triangle counts and which is
    /// overwritten, too. There are hundreds of rows: BLAS is worth its while. Throws SolverFailure where rounding makes A
    /// indefinite.
    void
    solve_by_blocks(dealii::LAPACKFullMatrix<double> &A, std::vector<double> &b)
    {
      dealii::Vector<double> solution(b.begin(), b.end());
      A.set_property(dealii::LAPACKSupport::symmetric);
      try
      {
        A.compute_cholesky_factorization();
      }
      catch (const dealii::ExceptionBase &) // whose text is for programmers
      {
        throw SolverFailure("Forces of contacts are too large to compute with. Look at velocities, "
                            "loads and the units of lengths, or take smaller steps.");
      }
      A.solve(solution);
      std::copy(solution.begin(), solution.end(), b.begin());
    }

    /// An iterate, and the derivative of the function along a step from another one to it.
    class DenseSearch
    {
    public:
      DenseSearch(const GapEnergies                &gaps,
                  const dealii::FullMatrix<double> &W,
                  const std::vector<double>        &free,
                  const double                      work,
                  const std::vector<double>        &first)
          : gaps(gaps), W(W), free(free), work(work)
      {
        at.forces.resize(free.size());
        at.changes.resize(free.size());
        if (!first.empty())
          begin_near(first);
        slopes = gaps.slopes(at.changes);
      }

      ContactForces
      run(const double enough)
      {
        for (bool is_last = false;; ++at.iterations)
        {
          if (is_last || at.iterations == max_iterations
              || (at.part == 1. && unbalanced() <= enough))
            return at;
          const ContactForces step    = newton_step();
          const double        longest = gaps.longest_part(at.changes, step.changes);
          // so near the slope along the step is lost in rounding
          const double near = tolerance * max_entry(at.forces);
          is_last           = longest >= 1. && at.part == 1. && max_entry(step.forces) <= near
                    && unbalanced() <= near;
          go(is_last ? 1. : length_along(step, longest), step);
        }
      }

    private:
      static constexpr unsigned int max_iterations = 100;
      static constexpr unsigned int max_halvings   = 20;
      static constexpr double       tolerance
          = 1e-3; ///< of forces before the last step; their error is its square
      static constexpr double max_slope = 0.1; ///< that a line search leaves of the first

      /// Go from u = 0 towards where the first rows have these forces and the others none.
      void
      begin_near(const std::vector<double> &first)
      {
        ContactForces there{ 1., first, {}, 0 };
        there.forces.resize(free.size());
        there.changes = product(W, there.forces);
        add(there.changes, 1., free);
        at = sum(std::move(at), std::min(1., gaps.longest_part(at.changes, there.changes)), there);
      }

      /// To where the function with B as a quadratic one has its minimum. With S S = B'' and e the change of the
      /// rows, (I + S W S) S e = S (free - y - W B'), which is definite whatever W is, and the forces are -B' - S S e.
      ContactForces
      newton_step() const
      {
        const GapEnergies::Blocks        S      = gaps.root_of_curvatures(at.changes);
        dealii::LAPACKFullMatrix<double> matrix = S.on_both_sides_of(W);
        for (std::size_t i = 0; i < matrix.m(); ++i)
          matrix(i, i) += 1.;
        std::vector<double> unscaled = product(W, slopes), scaled, forces;
        for (std::size_t i = 0; i < unscaled.size(); ++i)
          unscaled[i] = free[i] - at.changes[i] - unscaled[i];
        S.multiply(unscaled, scaled);
        solve_by_blocks(matrix, scaled);
        S.multiply(scaled, forces);
        ContactForces step;
        for (std::size_t i = 0; i < forces.size(); ++i)
          forces[i] = -slopes[i] - forces[i];
        step.changes = product(W, forces);
        for (std::size_t i = 0; i < forces.size(); ++i)
        {
          step.changes[i] += free[i] - at.changes[i];
          forces[i] -= at.forces[i];
        }
        step.forces = std::move(forces);
        step.part   = 1. - at.part;
        return step;
      }

      /// The greatest force that is not that of its gap.
      double
      unbalanced() const
      {
        std::vector<double> rest = at.forces;
        add(rest, 1., slopes);
        return max_entry(rest);
      }

      double
      slope_along(const ContactForces       &from,
                  const std::vector<double> &slopes_there,
                  const ContactForces       &step) const
      {
        double slope = (from.part - 1.) * (work * step.part + dot(step.forces, free));
        for (std::size_t i = 0; i < slopes_there.size(); ++i)
          slope += (from.forces[i] + slopes_there[i]) * step.changes[i];
        return slope;
      }

      static ContactForces
      sum(ContactForces from, const double part, const ContactForces &step)
      {
        from.part += part * step.part;
        add(from.forces, part, step.forces);
        add(from.changes, part, step.changes);
        return from;
      }

      double
      length_along(const ContactForces &step, const double longest) const
      {
        const double first  = slope_along(at, slopes, step);
        double       length = std::min(1., longest);
        for (unsigned int halving = 0; halving < max_halvings; ++halving)
        {
          const ContactForces there = sum(at, length, step);
          if (slope_along(there, gaps.slopes(there.changes), step) <= max_slope * std::abs(first))
            break;
          length *= 0.5;
        }
        return length;
      }

      void
      go(const double length, const ContactForces &step)
      {
        at = sum(std::move(at), length, step);
        if (length == 1.)
          at.part = 1.;
        slopes = gaps.slopes(at.changes);
      }

      const GapEnergies                &gaps;
      const dealii::FullMatrix<double> &W;
      const std::vector<double>        &free;
      const double                      work;
      ContactForces                     at;
      std::vector<double>               slopes;
    };
  } // namespace

  ContactForces
  minimize_with_contact(const GapEnergies                &gaps,
                        const dealii::FullMatrix<double> &W,
                        const std::vector<double>        &free,
                        const double                      work,
                        const double                      enough,
                        const std::vector<double>        &first)
  {
    return DenseSearch(gaps, W, free, work, first).run(enough);
  }
} // namespace Exemplar
