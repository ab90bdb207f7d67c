// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/potential/barrier.h>
#include <exemplar/potential/nodal_vectors.h>
#include <exemplar/potential/touching_term.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// Renewals without acceleration. Most steps settle by these, of which the first ones begin where the step is not solved yet.
    constexpr unsigned int n_plain_renewals = 8;

    /// Derivative of a barrier's energy by the gap [N].
    double
    slope_of(const Gap &gap)
    {
      return Barrier{ gap.stiffness, gap.width }.slope(gap.distance);
    }
  } // namespace

  void
  TouchingTerm::attach(const SymmetricPattern &new_pattern, const FreeDofs &new_free_dofs)
  {
    pattern   = &new_pattern;
    free_dofs = &new_free_dofs;
  }

  // Friction

  TouchingTerm::Slip
  TouchingTerm::slip(const Rubbing &at, const Vector &positions) const
  {
    const SpaceVector3 u = motion_along(at, positions);
    return { u - (u * at.gap.normal) * at.gap.normal, at.gap.normal, {} };
  }

  double
  TouchingTerm::heat_of(const Rubbing &at, const Vector &positions) const
  {
    // of a velocity that lasts for the step
    const RubbingStep &step = rubbing_step();
    return step.rate * step.size * slip_energy(at).heat(slip(at, positions).vector.norm());
  }

  double
  TouchingTerm::heat_of_all(const Vector &positions) const
  {
    double heat = 0.;
    for (const Rubbing &at : rubbing_step().rubbing)
      heat += heat_of(at, positions);
    return heat;
  }

  double
  TouchingTerm::energy_of_friction(const Vector &positions) const
  {
    double energy = 0.;
    for (const Rubbing &at : rubbing_step().rubbing)
      energy += slip_energy(at).value(slip(at, positions).vector.norm());
    return energy;
  }

  std::optional<Rubbing>
  TouchingTerm::rubbing_of(const Touch &touch, const PairKey key, const double coefficient)
  {
    const Gap &gap = touch.gap;
    if (coefficient == 0. || !(gap.distance > 0.) || gap.stiffness == 0.)
      return {};
    const double force = -slope_of(gap);
    return Rubbing{ touch.obstacle, key, gap, force, coefficient, {}, {}, {} };
  }

  TermChange
  TouchingTerm::renew_friction(std::vector<Rubbing> now,
                               const double         tolerance,
                               RubbingStep         &step) const
  {
    const Exchange &exchange              = free_dofs->exchange();
    const auto [own_greatest, own_change] = force_and_change_of(now, step.rubbing);
    const double change                   = exchange.max(own_change);
    step.greatest_force                   = exchange.max(own_greatest);
    if (change <= tolerance * step.greatest_force)
      return TermChange::none;
    ++step.n_renewals;
    if (step.n_renewals > n_plain_renewals)
      step.lag.accelerate(step.rubbing, now, exchange);
    step.rubbing = std::move(now);
    return TermChange::values;
  }

  void
  TouchingTerm::remember_slip_base(const State &at, RubbingStep &step) const
  {
    step.rate = integrator != nullptr ? integrator->rate_factor() : 1. / step.size;
    step.slip_base.reinit(at.positions.size());
    if (integrator == nullptr)
      step.slip_base = at.positions;
    else
      for (const WeightedPositions &then : integrator->history(at))
        step.slip_base.add(then.weight, *then.positions);
  }

  Gap
  TouchingTerm::gap_of(const Rubbing &at, const Vector &positions) const
  {
    const SlipEnergy energy = slip_energy(at);
    const Slip       now    = slip(at, positions);
    Gap              gap    = at.gap;
    gap.stiffness           = 0.;
    gap.distance            = gap.width;
    gap.friction            = energy.greatest;
    gap.slip_width          = energy.e;
    gap.friction_normal     = now.normal;
    gap.slip                = now.vector;
    gap.slip_by_nodes       = now.by_points;
    return gap;
  }

  // The potential

  void
  TouchingTerm::append_gaps(const Vector     &positions,
                            const double      range,
                            std::vector<Gap> &gaps) const
  {
    visit_touches(positions, range,
                  [&](const Touch &touch)
                  {
                    if (touch.gap.stiffness > 0.)
                      gaps.push_back(on_nodes(touch.gap, points));
                  });
    append_gaps_of_friction(positions, gaps);
  }

  void
  TouchingTerm::append_gaps_of_friction(const Vector &positions, std::vector<Gap> &gaps) const
  {
    for (const Rubbing &at : rubbing_step().rubbing)
      gaps.push_back(on_nodes(gap_of(at, positions), points));
  }

  ContactGradient
  TouchingTerm::gradient_of_friction(const Rubbing &at, const Slip &slip) const
  {
    const SpaceVector3 force = slip_energy(at).force_by_slip(slip.vector.norm()) * slip.vector;
    ContactGradient    gradient{};
    for (unsigned int i = 0; i < at.gap.n_nodes; ++i)
      gradient[i]
          = slip.by_points.empty() ? at.gap.coefficients[i] * force : force * slip.by_points[i];
    return gradient;
  }

  void
  TouchingTerm::visit_gradients(const Vector &positions, const VisitGradient &visit) const
  {
    visit_touches(positions, 1.,
                  [&](const Touch &touch)
                  {
                    if (touch.gap.distance > 0.)
                      visit(touch.obstacle, touch.gap, gradient_of(touch));
                  });
    for (const Rubbing &at : rubbing_step().rubbing)
      visit(at.obstacle, at.gap, gradient_of_friction(at, slip(at, positions)));
  }

  Vector
  TouchingTerm::forces(const Vector &positions) const
  {
    Vector forces(positions.size());
    visit_gradients(positions,
                    [&](unsigned int, const Gap &gap, const ContactGradient &gradient)
                    {
                      for (unsigned int i = 0; i < gap.n_nodes; ++i)
                        points.add_to(forces, gap.nodes[i], -gradient[i]);
                    });
    return forces;
  }

  void
  TouchingTerm::add(const TermPoint &at, ElasticSums &sums)
  {
    const auto add_gradient = [&](const Gap &gap, const ContactGradient &gradient)
    {
      for (unsigned int i = 0; i < gap.n_nodes; ++i)
      {
        points.add_to(sums->gradient, gap.nodes[i], gradient[i]);
        points.visit(gap.nodes[i], [&](const unsigned int node, const double weight)
                     { sums->force_scale[node] += std::abs(weight) * gradient[i].norm(); });
      }
    };
    // what is light, and hard to press, has little energy beside that of these forces along the rounding of their distances
    const double size = max_entry(at.positions.begin(), at.positions.end());
    visit_touches(at.positions, 1.,
                  [&](const Touch &touch)
                  {
                    sums->energy += energy_of(touch);
                    if (!(touch.gap.distance > 0.)) // an infinite energy has no force
                      return;
                    add_gradient(touch.gap, gradient_of(touch));
                    sums->rounding_energy
                        -= rounding_of_distance(touch.gap, size) * slope_of(touch.gap);
                  });
    for (const Rubbing &rub : rubbing_step().rubbing)
    {
      const Slip u = slip(rub, at.positions);
      sums->energy += slip_energy(rub).value(u.vector.norm());
      add_gradient(rub.gap, gradient_of_friction(rub, u));
    }
  }

  void
  TouchingTerm::visit_blocks(
      const Vector                                                   &positions,
      const Tangent                                                   kind,
      const std::function<void(const Gap &, const ContactHessian &)> &visit) const
  {
    visit_touches(positions, 1.,
                  [&](const Touch &touch)
                  {
                    if (touch.gap.distance > 0.)
                      visit(touch.gap, hessian_of(touch, kind));
                  });
    for (const Rubbing &at : rubbing_step().rubbing)
    {
      const Slip     u         = slip(at, positions);
      const auto     curvature = slip_energy(at).curvature(u.vector, u.normal);
      ContactHessian blocks;
      for (unsigned int i = 0; i < at.gap.n_nodes; ++i)
        for (unsigned int j = 0; j < at.gap.n_nodes; ++j)
          blocks[i][j] = u.by_points.empty()
                             ? at.gap.coefficients[i] * at.gap.coefficients[j] * curvature
                             : dealii::transpose(u.by_points[i]) * curvature * u.by_points[j];
      visit(at.gap, blocks);
    }
  }

  void
  TouchingTerm::add_tangent(const TermPoint     &at,
                            const Tangent        kind,
                            std::vector<double> &values,
                            std::vector<double> & /*columns*/)
  {
    visit_blocks(at.positions, kind,
                 [&](const Gap &gap, const ContactHessian &blocks)
                 { add_blocks(gap, blocks, points, *pattern, *free_dofs, values); });
  }

  void
  TouchingTerm::add_response(const TermPoint &at,
                             const Tangent    kind,
                             const Vector    &displacement,
                             ElasticSums     &sums)
  {
    visit_blocks(at.positions, kind,
                 [&](const Gap &gap, const ContactHessian &blocks)
                 { add_products(gap, blocks, points, displacement, sums->gradient); });
  }

  double
  TouchingTerm::rounding_force(const Vector &positions) const
  {
    std::vector<Gap> gaps;
    visit_touches(positions, 1., [&](const Touch &touch) { gaps.push_back(touch.gap); });
    return rounding_force_of(gaps, positions);
  }

  // What is shown

  TouchingTerm::Reached
  TouchingTerm::reached_at(const Vector &positions, const double width) const
  {
    Reached result;
    result.least_gap = width;
    visit_touches(positions, 1.,
                  [&](const Touch &touch)
                  {
                    const Gap &gap   = touch.gap;
                    result.least_gap = std::min(result.least_gap, gap.distance);
                    result.barrier_energy += energy_of(touch);
                    result.n_pairs += 1.;
                    result.normal_force -= slope_of(gap);
                  });
    return result;
  }

  std::size_t
  TouchingTerm::memory_of_touching() const
  {
    return surface.memory_consumption() + rubbing_step().slip_base.memory_consumption()
           + rubbing_step().rubbing.size() * sizeof(Rubbing);
  }
} // namespace Exemplar
