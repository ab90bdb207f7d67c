// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/python/term_check.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace Exemplar::Python
{
  namespace py = pybind11;

  namespace
  {
    constexpr double tolerance = 1e-4; ///< relative difference of equal slopes
    constexpr double gross     = 0.1;  ///< likewise, for the check by two calls

    Vector
    times(const std::vector<MatrixEntry> &hessian, const Vector &x)
    {
      Vector Hx(x.size());
      for (const MatrixEntry &entry : hessian)
      {
        Hx[entry.row] += entry.value * x[entry.column];
        if (entry.row != entry.column)
          Hx[entry.column] += entry.value * x[entry.row];
      }
      return Hx;
    }

    Vector
    of_size_one(Vector direction)
    {
      direction /= direction.linfty_norm();
      return direction;
    }

    /// Step length of the differences [m]: 1e-5 of the body's size.
    double
    distance(const Vector &positions)
    {
      double extent = 0.;
      for (unsigned int dof = 3; dof < positions.size(); ++dof)
        extent = std::max(extent, std::abs(positions[dof] - positions[dof % 3]));
      return 1e-5 * (extent > 0. ? extent : 1.);
    }

    /// Answers on both sides of a place along a direction, and directional derivatives from them.
    class Line
    {
    public:
      Line(const NamedTerm &term, const FunctionAnswer &at, const Vector &direction)
          : at(at), direction(of_size_one(direction)), h(distance(at.positions)),
            before(beside(term, -h)), after(beside(term, h))
      {
      }

      /// The slope of the energy, by central differences [N].
      double
      slope() const
      {
        return (after.energy - before.energy) / (2. * h);
      }

      /// The slope of the energy, by the gradient [N].
      double
      slope_by_gradient() const
      {
        return at.gradient * direction;
      }

      /// The greatest change of the slope by the gradient over the step, within which the
      /// difference may be off, as at a kink [N].
      double
      change_of_slope() const
      {
        return std::max(std::abs(after.gradient * direction - slope_by_gradient()),
                        std::abs(before.gradient * direction - slope_by_gradient()));
      }

      /// Rounding error of slope() [N].
      double
      rounding() const
      {
        return 1e-15 * (std::abs(after.energy) + std::abs(before.energy)) / h;
      }

      /// Whether the slopes by energy and gradient agree, to this relative tolerance.
      bool
      has_slope_of_gradient(const double allowed) const
      {
        const double size = std::max(std::abs(slope()), std::abs(slope_by_gradient()));
        return std::abs(slope() - slope_by_gradient())
               <= allowed * size + change_of_slope() + rounding();
      }

      /// Relative difference of the slopes by energy and gradient; the latter is the mean over the
      /// step, by Simpson's rule.
      double
      error_of_gradient() const
      {
        const double mean
            = (before.gradient * direction + 4. * slope_by_gradient() + after.gradient * direction)
              / 6.;
        const double size = std::max(std::abs(slope()), std::abs(mean)) + 1e6 * rounding();
        return size > 0. ? std::abs(slope() - mean) / size : 0.;
      }

      /// Relative difference of Hessian times direction and difference quotient of the gradients.
      double
      error_of_hessian() const
      {
        const Vector found = difference(), Hd = times(at.hessian, direction);
        Vector       error = found;
        error -= Hd;
        const double size = std::max(found.linfty_norm(), Hd.linfty_norm()) + 1e6 * noise();
        return size > 0. ? error.linfty_norm() / size : 0.;
      }

      /// Whether the Hessian is at least as stiff as the gradient: it may leave out parts that are
      /// not convex.
      bool
      is_stiff_enough() const
      {
        const double needed = difference() * direction;
        const double there  = std::max({ curvature(at), curvature(before), curvature(after) });
        const double size   = std::max(std::abs(needed), std::abs(there));
        return there >= needed - tolerance * size - noise() * direction.l1_norm();
      }

    private:
      FunctionAnswer
      beside(const NamedTerm &term, const double distance) const
      {
        Vector x = at.positions;
        x.add(distance, direction);
        return answer_of(term.function, term.name, x, at.time);
      }

      /// The central difference quotient of the gradients [N/m].
      Vector
      difference() const
      {
        Vector result = after.gradient;
        result -= before.gradient;
        result /= 2. * h;
        return result;
      }

      double
      curvature(const FunctionAnswer &answer) const
      {
        return times(answer.hessian, direction) * direction;
      }

      /// Rounding error of difference() [N/m].
      double
      noise() const
      {
        return 1e-15 * (after.gradient.linfty_norm() + before.gradient.linfty_norm()) / h;
      }

      const FunctionAnswer &at;
      const Vector          direction; ///< scaled so that its greatest component is 1
      const double          h;         ///< step to both sides [m]
      const FunctionAnswer  before, after;
    };

    std::string
    place_of_answer(const FunctionAnswer &at)
    {
      return " at t = " + shortest_text(at.time);
    }

    std::string
    gradient_message(const std::string &name, const FunctionAnswer &at, const Line &line)
    {
      const double by_energy = line.slope(), by_gradient = line.slope_by_gradient();
      const bool   is_opposite = std::abs(by_energy + by_gradient) <= gross * std::abs(by_gradient);
      return fmt::format(
          "{}: its gradient is not that of its energy{}: along a direction the energy "
          "rises by {} N, and the gradient says {} N.{} Return dE/dx, (n, 3); "
          "problem.check_term() compares them.",
          name, place_of_answer(at), short_text(by_energy), short_text(by_gradient),
          is_opposite ? " The sign is wrong: the gradient is minus the force." : "");
    }

    /// The least curvature of the Hessian that a power method finds: a Rayleigh quotient [N/m].
    double
    least_curvature(const std::vector<MatrixEntry> &hessian, const unsigned int n)
    {
      Vector row_sums(n);
      for (const MatrixEntry &entry : hessian)
      {
        row_sums[entry.row] += std::abs(entry.value);
        if (entry.row != entry.column)
          row_sums[entry.column] += std::abs(entry.value);
      }
      const double bound = row_sums.linfty_norm();
      if (!(bound > 0.))
        return 0.;
      std::mt19937                     random(1);
      std::normal_distribution<double> normal;
      Vector                           x(n);
      for (double &number : x)
        number = normal(random);
      double least = bound;
      for (int i = 0; i < 100; ++i)
      {
        x /= x.l2_norm();
        const Vector Hx = times(hessian, x);
        least           = std::min(least, Hx * x);
        x.sadd(bound, -1., Hx);
        if (!(x.l2_norm() > 1e-100 * bound))
          break; // H is a multiple of the identity
      }
      return least;
    }

    bool
    is_negative(const double curvature, const std::vector<MatrixEntry> &hessian)
    {
      double size = 0.;
      for (const MatrixEntry &entry : hessian)
        size = std::max(size, std::abs(entry.value));
      return curvature < -1e-10 * size;
    }

    /// Some generic directions, and that of the gradient.
    std::vector<Vector>
    directions_of(const FunctionAnswer &at)
    {
      std::mt19937                     random(2);
      std::normal_distribution<double> normal;
      std::vector<Vector>              directions(3, Vector(at.positions.size()));
      for (Vector &direction : directions)
        for (double &number : direction)
          number = normal(random);
      if (at.gradient.linfty_norm() > 0.)
        directions.push_back(at.gradient);
      return directions;
    }

    void
    check_along(const Line           &line,
                const std::string    &name,
                const FunctionAnswer &at,
                TermCheck            &found)
    {
      if (!line.has_slope_of_gradient(tolerance))
        throw UserError(gradient_message(name, at, line));
      if (!line.is_stiff_enough())
        throw UserError(fmt::format(
            "{}: its Hessian is not that of its gradient{}: along a direction they differ by {} "
            "parts of their size, and the Hessian is the softer one. Return d2E/dx2, (3n, 3n), of "
            "which only what makes it indefinite may be left out.",
            name, place_of_answer(at), short_text(line.error_of_hessian())));
      found.gradient = std::max(found.gradient, line.error_of_gradient());
      found.hessian  = std::max(found.hessian, line.error_of_hessian());
    }
  } // namespace

  TermCheck
  check(const NamedTerm &term, const FunctionAnswer &at)
  {
    TermCheck found;
    for (const Vector &direction : directions_of(at))
      check_along(Line(term, at, direction), term.name, at, found);
    if (const std::string complaint = complaint_of_curvature(term.name, at); !complaint.empty())
      throw UserError(complaint);
    found.curvature = least_curvature(at.hessian, at.positions.size());
    return found;
  }

  std::string
  complaint_of_gradient(const NamedTerm &term, const FunctionAnswer &at)
  {
    if (!(at.gradient.linfty_norm() > 0.))
      return "";
    const Line line(term, at, at.gradient);
    return line.has_slope_of_gradient(gross) ? "" : gradient_message(term.name, at, line);
  }

  std::string
  complaint_of_curvature(const std::string &name, const FunctionAnswer &at)
  {
    const double curvature = least_curvature(at.hessian, at.positions.size());
    if (!is_negative(curvature, at.hessian))
      return "";
    return fmt::format("{}: its Hessian has a negative curvature{}, {} N/m, but it stands in the "
                       "convex tangent, too. Leave out of it what is not convex: steps then take "
                       "more iterations.",
                       name, place_of_answer(at), short_text(curvature));
  }
} // namespace Exemplar::Python
