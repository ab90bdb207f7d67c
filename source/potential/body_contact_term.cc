// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/potential/barrier.h>
#include <exemplar/potential/body_contact_term.h>
#include <exemplar/potential/nodal_vectors.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  BodyContactTerm::BodyContactTerm(const BodyContacts   &contacts,
                                   const ContactSurface &surface,
                                   const Material       &material,
                                   const TimeIntegrator *integrator)
      : contacts(contacts), surface(surface), material(material), integrator(integrator),
        least_gap(contacts.width)
  {
    follow_parameters();
  }

  void
  BodyContactTerm::attach(const SymmetricPattern &new_pattern, const FreeDofs &new_free_dofs)
  {
    pattern   = &new_pattern;
    free_dofs = &new_free_dofs;
  }

  void
  BodyContactTerm::follow_parameters()
  {
    surface.set_material(material);
  }

  std::vector<BodyTouch>
  BodyContactTerm::touches(const Vector &positions, const double range) const
  {
    std::vector<BodyTouch> result;
    search().append(positions, range, result);
    return result;
  }

  NodePairs
  BodyContactTerm::couplings_of_gaps(const Vector &positions) const
  {
    NodePairs  result;
    const auto add = [&](const Gap &gap)
    {
      for (unsigned int i = 0; i < 4; ++i)
        for (unsigned int j = 0; j < i; ++j)
          result.push_back(std::minmax({ gap.nodes[i], gap.nodes[j] }));
    };
    for (const BodyTouch &touch : touches(positions))
      add(touch.gap);
    for (const Rubbing &at : step.rubbing)
      add(at.gap);
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

  void
  BodyContactTerm::append_gaps(const Vector     &positions,
                               const double      range,
                               std::vector<Gap> &gaps) const
  {
    for (const BodyTouch &touch : touches(positions, range))
      if (touch.gap.stiffness > 0.)
        gaps.push_back(touch.gap);
    for (const Rubbing &at : step.rubbing)
    {
      const SlipEnergy energy = slip_energy(at);
      Gap              gap    = at.gap;
      gap.stiffness           = 0.; // where it rubs is not where it is nearest by now
      gap.distance            = gap.width;
      gap.friction            = energy.greatest;
      gap.slip_width          = energy.e;
      gap.friction_normal     = at.gap.normal;
      gap.slip                = slip(at, positions);
      gaps.push_back(gap);
    }
  }

  void
  BodyContactTerm::append_gaps_of_way(const double /*now*/,
                                      const double /*to_time*/,
                                      const Vector     &from,
                                      const Vector     &to,
                                      const double      range,
                                      std::vector<Gap> &gaps)
  {
    std::vector<BodyTouch> meeting, near = touches(to, range);
    search().append_meeting(from, to, meeting);
    const auto is_before
        = [](const BodyTouch &a, const BodyTouch &b) { return a.pair.key() < b.pair.key(); };
    for (const BodyTouch &touch : meeting)
      if (touch.gap.stiffness > 0.)
        gaps.push_back(touch.gap);
    for (const BodyTouch &touch : near)
      if (touch.gap.stiffness > 0.
          && !std::binary_search(meeting.begin(), meeting.end(), touch, is_before))
        gaps.push_back(touch.gap);
  }

  double
  BodyContactTerm::max_step(const Vector &positions, const Vector &displacement) const
  {
    return search().max_step(positions, displacement).part;
  }

  std::string
  BodyContactTerm::limit_to(const double /*time*/,
                            const Vector &positions,
                            const Vector &displacement) const
  {
    const SpaceVector3 place = search().max_step(positions, displacement).place;
    return "the surface near (" + short_text(place[0]) + ", " + short_text(place[1]) + ", "
           + short_text(place[2]) + ") m";
  }

  // Steps, and what rubs in them

  void
  BodyContactTerm::begin_step(const State &at, const double new_step_size)
  {
    step           = {};
    step.size      = new_step_size;
    step.has_begun = true;
    if (contacts.friction == 0.)
      return;
    step.rate = integrator != nullptr ? integrator->rate_factor() : 1. / step.size;
    step.slip_base.reinit(at.positions.size());
    if (integrator == nullptr)
      step.slip_base = at.positions;
    else
      for (const WeightedPositions &then : integrator->history(at))
        step.slip_base.add(then.weight, *then.positions);
  }

  TermChange
  BodyContactTerm::renew(const TermPoint &at)
  {
    if (contacts.friction == 0. || !step.has_begun || step.n_renewals > max_renewals)
      return TermChange::none;
    std::vector<Rubbing> fresh;
    for (const BodyTouch &touch : touches(at.positions)) // in the order of keys
      if (const Gap &gap = touch.gap; gap.distance > 0. && gap.stiffness > 0.)
        fresh.push_back({ 0,
                          touch.pair.key(),
                          gap,
                          -Barrier{ gap.stiffness, gap.width }.slope(gap.distance),
                          contacts.friction,
                          {},
                          {},
                          {} });
    const auto [greatest, change] = force_and_change_of(fresh, step.rubbing);
    if (change <= lag_tolerance * greatest)
      return TermChange::none;
    ++step.n_renewals;
    step.rubbing = std::move(fresh);
    return TermChange::values;
  }

  SpaceVector3
  BodyContactTerm::slip(const Rubbing &at, const Vector &positions) const
  {
    SpaceVector3 u;
    for (unsigned int i = 0; i < 4; ++i)
      u += at.gap.coefficients[i]
           * (at_node(positions, at.gap.nodes[i]) - at_node(step.slip_base, at.gap.nodes[i]));
    return u - (u * at.gap.normal) * at.gap.normal;
  }

  std::optional<double>
  BodyContactTerm::dissipation(const State &end) const
  {
    if (contacts.friction == 0.)
      return {};
    double result = 0.;
    for (const Rubbing &at : step.rubbing) // by a velocity that lasts for the step
      result += step.rate * step.size * slip_energy(at).heat(slip(at, end.positions).norm());
    return result;
  }

  void
  BodyContactTerm::leave_step()
  {
    step = {};
  }

  void
  BodyContactTerm::end_step(const State &end)
  {
    barrier_energy = n_pairs = normal_force = 0.;
    heat += dissipation(end).value_or(0.);
    least_gap = contacts.width;
    for (const BodyTouch &touch : touches(end.positions))
    {
      const Gap &gap = touch.gap;
      least_gap      = std::min(least_gap, gap.distance);
      barrier_energy += energy_of(touch);
      n_pairs += 1.;
      normal_force -= Barrier{ gap.stiffness, gap.width }.slope(gap.distance);
    }
  }

  template <typename Visit>
  void
  BodyContactTerm::visit_gradients(const Vector &positions, const Visit &visit) const
  {
    for (const BodyTouch &touch : touches(positions))
      if (touch.gap.distance > 0.) // an infinite energy has no force
        visit(touch.gap, gradient_of(touch));
    for (const Rubbing &at : step.rubbing)
    {
      const SpaceVector3 u     = slip(at, positions);
      const SpaceVector3 force = slip_energy(at).force_by_slip(u.norm()) * u;
      ContactGradient    gradient;
      for (unsigned int i = 0; i < 4; ++i)
        gradient[i] = at.gap.coefficients[i] * force;
      visit(at.gap, gradient);
    }
  }

  template <typename Visit>
  void
  BodyContactTerm::visit_blocks(const Vector &positions,
                                const Tangent kind,
                                const Visit  &visit) const
  {
    for (const BodyTouch &touch : touches(positions))
      if (touch.gap.distance > 0.)
        visit(touch.gap, hessian_of(touch, kind));
    for (const Rubbing &at : step.rubbing)
    {
      const auto     curvature = slip_energy(at).curvature(slip(at, positions), at.gap.normal);
      ContactHessian blocks;
      for (unsigned int i = 0; i < 4; ++i)
        for (unsigned int j = 0; j < 4; ++j)
          blocks[i][j] = at.gap.coefficients[i] * at.gap.coefficients[j] * curvature;
      visit(at.gap, blocks);
    }
  }

  void
  BodyContactTerm::add(const TermPoint &at, ElasticSums &sums)
  {
    for (const BodyTouch &touch : touches(at.positions))
      sums->energy += energy_of(touch);
    for (const Rubbing &rub : step.rubbing)
      sums->energy += slip_energy(rub).value(slip(rub, at.positions).norm());
    visit_gradients(at.positions,
                    [&](const Gap &gap, const ContactGradient &gradient)
                    {
                      for (unsigned int i = 0; i < 4; ++i)
                      {
                        add_to(sums->gradient, gap.nodes[i], gradient[i]);
                        sums->force_scale[gap.nodes[i]] += gradient[i].norm();
                      }
                    });
  }

  void
  BodyContactTerm::add_tangent(const TermPoint     &at,
                               const Tangent        kind,
                               std::vector<double> &values,
                               std::vector<double> & /*columns*/)
  {
    visit_blocks(at.positions, kind,
                 [&](const Gap &gap, const ContactHessian &blocks)
                 { add_blocks(gap, blocks, *pattern, *free_dofs, values); });
  }

  void
  BodyContactTerm::add_response(const TermPoint &at,
                                const Tangent    kind,
                                const Vector    &displacement,
                                ElasticSums     &sums)
  {
    visit_blocks(at.positions, kind,
                 [&](const Gap &gap, const ContactHessian &blocks)
                 { add_products(gap, blocks, displacement, sums->gradient); });
  }

  double
  BodyContactTerm::rounding_force(const Vector &positions) const
  {
    std::vector<Gap> gaps;
    for (const BodyTouch &touch : touches(positions))
      gaps.push_back(touch.gap);
    return rounding_force_of(gaps, positions);
  }

  void
  BodyContactTerm::append_columns(const double /*energy*/,
                                  std::vector<std::pair<std::string, double>> &columns) const
  {
    columns.emplace_back("energy_body_contact", barrier_energy);
    columns.emplace_back("least_body_gap", least_gap);
    columns.emplace_back("body_pairs", n_pairs);
    columns.emplace_back("body_contact_force", normal_force);
    if (contacts.friction > 0.)
      columns.emplace_back("heat_body_friction", heat);
  }

  void
  BodyContactTerm::append_fields(const Vector &positions, std::vector<NodalField> &fields) const
  {
    NodalField force{ "body_contact_force", Vector(positions.size()) };
    visit_gradients(positions,
                    [&](const Gap &gap, const ContactGradient &gradient)
                    {
                      for (unsigned int i = 0; i < 4; ++i)
                        add_to(force.values, gap.nodes[i], -gradient[i]);
                    });
    fields.push_back(std::move(force));
  }

  void
  BodyContactTerm::save(boost::archive::binary_oarchive &archive) const
  {
    archive << barrier_energy << least_gap << n_pairs << normal_force << heat;
  }

  void
  BodyContactTerm::load(boost::archive::binary_iarchive &archive)
  {
    archive >> barrier_energy >> least_gap >> n_pairs >> normal_force >> heat;
  }

  std::size_t
  BodyContactTerm::memory_consumption() const
  {
    return surface.memory_consumption() + kept.memory_consumption()
           + step.slip_base.memory_consumption() + step.rubbing.size() * sizeof(Rubbing)
           + contacts.own_widths.size() * 4 * sizeof(double);
  }
} // namespace Exemplar
