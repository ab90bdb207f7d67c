// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/number_text.h>
#include <exemplar/potential/body_contact_term.h>
#include <exemplar/potential/nodal_vectors.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    constexpr double greatest_reach
        = 10.; ///< widths: gaps from farther are too far from linear, and there are too many
  }

  BodyContactTerm::BodyContactTerm(const BodyContacts   &contacts,
                                   const ContactSurface &surface,
                                   const Material       &material,
                                   const TimeIntegrator *integrator)
      : TouchingTerm(surface, material, integrator, contacts.points), contacts(contacts)
  {
    reached.least_gap = contacts.width;
    follow_parameters();
  }

  void
  BodyContactTerm::follow_parameters()
  {
    found = {};
    TouchingTerm::follow_parameters();
  }

  template <typename Visit>
  void
  BodyContactTerm::visit_pairs(const Vector &positions,
                               const double  range,
                               const Visit  &visit) const
  {
    if (found.positions.size() != positions.size() || range > found.range
        || !std::equal(positions.begin(), positions.end(), found.positions.begin()))
    {
      found.positions = positions;
      found.range     = range;
      found.touches.clear();
      search().append(positions, range, found.touches);
    }
    for (const BodyTouch &touch : found.touches)
      if (touch.gap.distance < range * touch.gap.width)
        visit(touch);
  }

  std::vector<BodyTouch>
  BodyContactTerm::touches(const Vector &positions, const double range) const
  {
    std::vector<BodyTouch> result;
    visit_pairs(positions, range, [&](const BodyTouch &touch) { result.push_back(touch); });
    return result;
  }

  NodePairs
  BodyContactTerm::couplings_of_gaps(const Vector &positions) const
  {
    NodePairs  result;
    const auto add = [&](const Gap &gap)
    {
      const Gap whole = on_nodes(gap, points);
      for (unsigned int i = 0; i < whole.n_nodes; ++i)
        for (unsigned int j = 0; j < i; ++j)
          result.push_back(std::minmax({ whole.nodes[i], whole.nodes[j] }));
    };
    visit_pairs(positions, 1., [&](const BodyTouch &touch) { add(touch.gap); });
    for (const Rubbing &at : step.rubbing)
      add(at.gap);
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

  void
  BodyContactTerm::append_gaps_along(const Vector     &positions,
                                     const Vector     &displacement,
                                     const double      reach,
                                     std::vector<Gap> &gaps) const
  {
    std::vector<BodyTouch> near;
    search().append_along(positions, displacement, std::min(reach, greatest_reach * contacts.width),
                          near);
    for (const BodyTouch &touch : near)
      if (touch.gap.stiffness > 0.)
        gaps.push_back(on_nodes(touch.gap, points));
    append_gaps_of_friction(positions, gaps);
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
        gaps.push_back(on_nodes(touch.gap, points));
    for (const BodyTouch &touch : near)
      if (touch.gap.stiffness > 0.
          && !std::binary_search(meeting.begin(), meeting.end(), touch, is_before))
        gaps.push_back(on_nodes(touch.gap, points));
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
    found          = {}; // pairs may have other widths than before
    step.size      = new_step_size;
    step.has_begun = true;
    if (contacts.friction != 0.)
      remember_slip_base(at, step);
  }

  TermChange
  BodyContactTerm::renew(const TermPoint &at)
  {
    if (contacts.friction == 0. || !step.has_begun || step.n_renewals > max_renewals)
      return TermChange::none;
    std::vector<Rubbing> fresh; // in the order of keys
    visit_pairs(at.positions, 1.,
                [&](const BodyTouch &touch)
                {
                  auto rubs = rubbing_of(touch, touch.pair.key(), contacts.friction);
                  if (!rubs)
                    return;
                  rubs->gap.slip_by_nodes = slip_by_points(rubs->gap, at.positions);
                  fresh.push_back(*rubs);
                });
    return renew_friction(std::move(fresh), lag_tolerance, step);
  }

  std::vector<dealii::Tensor<2, 3>>
  BodyContactTerm::slip_by_points(const Gap &gap, const Vector &positions) const
  {
    PairPoints            now;
    std::array<double, 4> coefficients;
    for (unsigned int i = 0; i < 4; ++i)
    {
      now[i]          = points.value(positions, gap.nodes[i]);
      coefficients[i] = gap.coefficients[i];
    }
    return slip_of_pair(now, coefficients);
  }

  SpaceVector3
  BodyContactTerm::motion_along(const Rubbing &at, const Vector &positions) const
  {
    SpaceVector3 u;
    for (unsigned int i = 0; i < 4; ++i)
    {
      const SpaceVector3 moved = points.value(positions, at.gap.nodes[i])
                                 - points.value(step.slip_base, at.gap.nodes[i]);
      u += at.gap.slip_by_nodes.empty() ? at.gap.coefficients[i] * moved
                                        : at.gap.slip_by_nodes[i] * moved;
    }
    return u;
  }

  TouchingTerm::Slip
  BodyContactTerm::slip(const Rubbing &at, const Vector &positions) const
  {
    Slip result      = TouchingTerm::slip(at, positions);
    result.by_points = at.gap.slip_by_nodes;
    return result;
  }

  std::optional<double>
  BodyContactTerm::dissipation(const State &end) const
  {
    if (contacts.friction == 0.)
      return {};
    return heat_of_all(end.positions);
  }

  void
  BodyContactTerm::leave_step()
  {
    const unsigned int n_renewals = step.n_renewals; // by which has_settled() answers
    step                          = {};
    step.n_renewals               = n_renewals;
  }

  void
  BodyContactTerm::end_step(const State &end)
  {
    heat += dissipation(end).value_or(0.);
    reached = reached_at(end.positions, contacts.width);
  }

  void
  BodyContactTerm::append_columns(const double /*energy*/,
                                  std::vector<std::pair<std::string, double>> &columns) const
  {
    columns.emplace_back("energy_body_contact", reached.barrier_energy);
    columns.emplace_back("least_body_gap", reached.least_gap);
    columns.emplace_back("body_pairs", reached.n_pairs);
    columns.emplace_back("body_contact_force", reached.normal_force);
    if (contacts.friction > 0.)
      columns.emplace_back("heat_body_friction", heat);
  }

  void
  BodyContactTerm::append_fields(const Vector &positions, std::vector<NodalField> &fields) const
  {
    fields.push_back({ "body_contact_force", forces(positions) });
  }

  void
  BodyContactTerm::save(boost::archive::binary_oarchive &archive) const
  {
    archive << reached.barrier_energy << reached.least_gap << reached.n_pairs
            << reached.normal_force << heat;
  }

  void
  BodyContactTerm::load(boost::archive::binary_iarchive &archive)
  {
    archive >> reached.barrier_energy >> reached.least_gap >> reached.n_pairs
        >> reached.normal_force >> heat;
  }

  std::size_t
  BodyContactTerm::memory_consumption() const
  {
    return memory_of_touching() + kept.memory_consumption()
           + found.touches.capacity() * sizeof(BodyTouch) + found.positions.memory_consumption()
           + contacts.own_widths.size() * 4 * sizeof(double) + points.memory_consumption();
  }
} // namespace Exemplar
