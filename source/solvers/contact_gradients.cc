// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/solvers/contact_gradients.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    class GradientSearch
    {
    public:
      GradientSearch(const GapEnergies         &gaps,
                     const ContactOperators    &operators,
                     const std::vector<double> &r)
          : gaps(gaps), operators(operators), exchange(operators.exchange),
            r(r), at{ std::vector<double>(r.size()), std::vector<double>(r.size()),
                      std::vector<double>(gaps.n_rows()) }
      {
      }

      ContactStep
      run()
      {
        for (unsigned int step = 0; step < max_newton_steps; ++step)
          if (is_last_step())
            break;
        return std::move(at);
      }

    private:
      static constexpr unsigned int max_newton_steps   = 50;
      static constexpr unsigned int max_gradient_steps = 40; ///< for one of these
      static constexpr unsigned int max_halvings       = 20;
      static constexpr double       gradient_tolerance = 0.03;
      static constexpr double       tolerance = 1e-2; ///< of the change of the gaps' forces
      static constexpr double       max_slope = 0.1;  ///< that a line search leaves of the first

      double
      product(const std::vector<double> &a, const std::vector<double> &b) const
      {
        return exchange.sum(dot(a, b));
      }

      /// H^-1 u - r + U B'
      std::vector<double>
      gradient(const std::vector<double> &slopes) const
      {
        std::vector<double> result = operators.forces(slopes);
        add(result, 1., at.forces);
        add(result, -1., r);
        return result;
      }

      /// (H^-1 + U S S U^T)^-1 times -gradient. Each direction p goes with H^-1 p, which its preconditioned residuals know.
      ContactStep
      newton_step(const std::vector<double> &gradient) const
      {
        const GapEnergies::Blocks S = gaps.root_of_curvatures(at.changes);
        const auto                zeros
            = [](const std::vector<double> &like) { return std::vector<double>(like.size()); };
        ContactStep         sum{ zeros(r), zeros(r), zeros(at.changes) };
        std::vector<double> residual = gradient;
        for (double &entry : residual)
          entry = -entry;
        ContactStep  p{ operators.respond(residual), residual, {} };
        double       squared = product(residual, p.step);
        const double first   = squared;
        for (unsigned int i = 0; i < max_gradient_steps && squared > 0.; ++i)
        {
          p.changes = operators.changes(p.step);
          std::vector<double> once, twice;
          S.multiply(p.changes, once);
          S.multiply(once, twice);
          std::vector<double> image = operators.forces(twice);
          add(image, 1., p.forces);
          const double length = squared / product(p.step, image);
          add(sum.step, length, p.step);
          add(sum.forces, length, p.forces);
          add(sum.changes, length, p.changes);
          add(residual, -length, image);
          std::vector<double> response = operators.respond(residual);
          const double        next     = product(residual, response);
          if (!(next > gradient_tolerance * gradient_tolerance * first))
            break;
          const double ratio = next / squared;
          squared            = next;
          for (std::size_t k = 0; k < response.size(); ++k)
          {
            p.step[k]   = response[k] + ratio * p.step[k];
            p.forces[k] = residual[k] + ratio * p.forces[k];
          }
        }
        return sum;
      }

      bool
      is_last_step()
      {
        const std::vector<double> slopes = gaps.slopes(at.changes), here = gradient(slopes);
        const ContactStep         step  = newton_step(here);
        const double              first = product(here, step.step);
        // (H^-1 u - r) . step, which is linear along it, without the rows
        const double of_body = first - exchange.sum(dot(slopes, step.changes)),
                     more    = product(step.forces, step.step);
        double length
            = std::min(1., min_of_all(exchange, gaps.longest_part(at.changes, step.changes)));
        std::vector<double> there, slopes_there;
        for (unsigned int halving = 0;; ++halving)
        {
          there = at.changes;
          add(there, length, step.changes);
          slopes_there = gaps.slopes(there);
          const double slope
              = of_body + length * more + exchange.sum(dot(slopes_there, step.changes));
          if (slope <= max_slope * std::abs(first) || halving == max_halvings)
            break;
          length *= 0.5;
        }
        add(at.step, length, step.step);
        add(at.forces, length, step.forces);
        at.changes    = there;
        double change = 0.;
        for (std::size_t i = 0; i < slopes.size(); ++i)
          change = std::max(change, std::abs(slopes_there[i] - slopes[i]));
        return length == 1.
               && exchange.max(change) <= tolerance * exchange.max(max_entry(slopes_there));
      }

      const GapEnergies         &gaps;
      const ContactOperators    &operators;
      const Exchange            &exchange;
      const std::vector<double> &r;
      ContactStep                at;
    };
  } // namespace

  ContactStep
  minimize_with_contact(const GapEnergies         &gaps,
                        const ContactOperators    &operators,
                        const std::vector<double> &r)
  {
    return GradientSearch(gaps, operators, r).run();
  }
} // namespace Exemplar
