// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/potential/barrier.h>
#include <exemplar/potential/contact_clearance.h>
#include <exemplar/potential/nodal_vectors.h>
#include <exemplar/potential/obstacle_term.h>

#include <boost/serialization/vector.hpp>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  ObstacleTerm::ObstacleTerm(const Obstacles      &obstacles,
                             const ContactSurface &surface,
                             const Material       &material,
                             const TimeIntegrator *integrator)
      : TouchingTerm(surface, material, integrator), obstacles(obstacles)
  {
    reached.least_gap = obstacles.width;
    follow_parameters();
  }

  void
  ObstacleTerm::follow_obstacles()
  {
    have_friction = obstacles.have_friction();
    sums_of.resize(obstacles.all.size());
    has_appeared.resize(obstacles.all.size(), 0);
    kept.assign(obstacles.all.size(), {});
    step = {};
    standing.clear();
    for (const Obstacle &obstacle : obstacles.all)
      standing.emplace_back(obstacle);
    move_to(time);
  }

  void
  ObstacleTerm::attach(const SymmetricPattern &new_pattern, const FreeDofs &new_free_dofs)
  {
    TouchingTerm::attach(new_pattern, new_free_dofs);
    if (!node_areas.empty())
      return;
    node_areas.assign(free_dofs->n_dofs() / 3, 0.);
    for (const ContactSurface::Node &node : surface.nodes)
      node_areas[node.node] = node.area;
    free_dofs->exchange().assemble(node_areas.data(), 1);
  }

  void
  ObstacleTerm::follow_parameters()
  {
    if (standing.size() != obstacles.all.size())
      follow_obstacles();
    for (unsigned int i = 0; i < step.there.size(); ++i)
      if (obstacles.all[i].has_left())
        step.there[i] = 0;
    TouchingTerm::follow_parameters();
    found.positions.reinit(0);
  }

  void
  ObstacleTerm::set_time(const double new_time)
  {
    step.restart();
    move_to(new_time);
  }

  void
  ObstacleTerm::move_to(const double new_time)
  {
    time = new_time;
    for (StandingObstacle &obstacle : standing)
      obstacle.move_to(time);
    found.positions.reinit(0);
  }

  ContactSearch
  ObstacleTerm::search(const unsigned int obstacle) const
  {
    return { surface, obstacles, standing[obstacle], obstacle, &kept[obstacle] };
  }

  std::vector<Contact>
  ObstacleTerm::contacts(const Vector &positions, const double range) const
  {
    std::vector<Contact> result;
    for (unsigned int i = 0; i < standing.size(); ++i)
      if (is_there(i))
        search(i).append(positions, range, result);
    return result;
  }

  const std::vector<Contact> &
  ObstacleTerm::touches(const Vector &positions) const
  {
    if (found.positions.size() != positions.size()
        || !std::equal(positions.begin(), positions.end(), found.positions.begin()))
    {
      found.contacts  = contacts(positions);
      found.positions = positions;
    }
    return found.contacts;
  }

  void
  ObstacleTerm::append_gaps_of_way(const double      now,
                                   const double      to_time,
                                   const Vector     &from,
                                   const Vector     &to,
                                   const double      range,
                                   std::vector<Gap> &gaps)
  {
    std::vector<std::pair<unsigned int, PairKey>> met;
    std::vector<Contact>                          meeting;
    for (unsigned int i = 0; i < standing.size(); ++i)
      if (is_there(i))
        search(i).append_meeting(to_time, from, to, meeting);
    for (const Contact &contact : meeting)
    {
      met.emplace_back(contact.obstacle, contact.pair.key());
      if (contact.gap.stiffness > 0.)
        gaps.push_back(contact.gap);
    }
    std::sort(met.begin(), met.end());
    move_to(to_time);
    for (const Contact &contact : contacts(to, range))
      if (contact.gap.stiffness > 0.
          && !std::binary_search(met.begin(), met.end(),
                                 std::pair(contact.obstacle, contact.pair.key())))
        gaps.push_back(contact.gap);
    move_to(now);
  }

  double
  ObstacleTerm::max_step_to(const double  to_time,
                            const Vector &positions,
                            const Vector &displacement) const
  {
    double part = std::numeric_limits<double>::infinity();
    for (unsigned int i = 0; i < standing.size(); ++i)
      if (is_there(i))
        part = std::min(part, search(i).max_step_to(to_time, positions, displacement));
    return part;
  }

  std::string
  ObstacleTerm::limit_to(const double  to_time,
                         const Vector &positions,
                         const Vector &displacement) const
  {
    for (unsigned int i = 0; i < standing.size(); ++i)
      if (is_there(i) && search(i).max_step_to(to_time, positions, displacement) < 1.)
        return "the obstacle '" + obstacles.all[i].name() + "'";
    return PotentialTerm::limit_to(to_time, positions, displacement);
  }

  double
  ObstacleTerm::max_step(const Vector &positions, const Vector &displacement) const
  {
    double part = std::numeric_limits<double>::infinity();
    for (unsigned int i = 0; i < standing.size(); ++i)
      if (is_there(i))
        part = std::min(part, search(i).max_step(positions, displacement));
    return part;
  }

  // Steps

  void
  ObstacleTerm::begin_step(const State &at, const double new_step_size)
  {
    move_to(at.time);
    step.size      = new_step_size;
    step.start     = at.positions;
    step.has_begun = true;
    follow_times(at);
    found.positions.reinit(0);
    step.rubbing.clear();
    step.restart();
    step.n_looks        = 0;
    step.greatest_force = 0.;
    if (have_friction)
      remember_slip_base(at);
  }

  bool
  ObstacleTerm::has_tangent_of_step() const
  {
    return have_friction
           || !std::all_of(obstacles.all.begin(), obstacles.all.end(),
                           [](const Obstacle &obstacle) { return obstacle.is_always_there(); });
  }

  void
  ObstacleTerm::follow_times(const State &at)
  {
    step.there.clear();
    for (unsigned int i = 0; i < standing.size(); ++i)
    {
      const Obstacle &obstacle = obstacles.all[i];
      step.there.push_back(obstacle.is_there(at.time) ? 1 : 0);
      if (!obstacle.appears() || step.there[i] == 0 || has_appeared[i] != 0)
        continue;
      StandingObstacle now(obstacle);
      now.move_to(at.time);
      const Clearance room = clearance(surface, obstacles, now, i, at.positions, obstacles.width,
                                       free_dofs->exchange());
      if (room.is_crossed || room.pushes)
        throw SolverFailure("Obstacles/" + obstacle.name()
                            + " appears at t = " + shortest_text(at.time)
                            + " s where the body is, near " + place_text(room.place)
                            + " m, or nearer to it than the distance from which "
                              "it pushes. Change its From, or where it is then.");
      has_appeared[i] = 1;
    }
  }

  void
  ObstacleTerm::end_step(const State &end)
  {
    for (Sums &sums : sums_of)
      sums.force = sums.torque = SpaceVector3();
    reached = reached_at(end.positions, obstacles.width);
    for (const Rubbing &at : step.rubbing)
      sums_of[at.obstacle].heat += heat_of(at, end.positions);
    visit_gradients(
        end.positions,
        [&](const unsigned int obstacle, const Gap &gap, const ContactGradient &gradient)
        {
          Sums &sums = sums_of[obstacle];
          for (unsigned int i = 0; i < gap.n_nodes; ++i)
          {
            const SpaceVector3 x     = at_node(end.positions, gap.nodes[i]);
            const SpaceVector3 force = -gradient[i];
            sums.has_touched         = true;
            sums.force += force;
            sums.torque += dealii::cross_product_3d(x - standing[obstacle].pose.place, force);
            sums.work += force * (x - at_node(step.start, gap.nodes[i]));
          }
        });
  }

  void
  ObstacleTerm::leave_step()
  {
    step.has_begun = false;
    step.rubbing.clear();
    step.there.clear();
    found.positions.reinit(0);
  }

  // What is shown and remembered

  std::vector<ObstacleReport>
  ObstacleTerm::report() const
  {
    std::vector<ObstacleReport> result;
    for (unsigned int i = 0; i < sums_of.size(); ++i)
    {
      const Sums           &own = sums_of[i];
      std::array<double, 8> all{ { own.force[0], own.force[1], own.force[2], own.torque[0],
                                   own.torque[1], own.torque[2], own.work, own.heat } };
      free_dofs->exchange().sum(all.data(), all.size());
      result.push_back({ obstacles.all[i].name(), dealii::Point<3>(all[0], all[1], all[2]),
                         dealii::Point<3>(all[3], all[4], all[5]), all[6], all[7] });
    }
    return result;
  }

  std::vector<std::string>
  ObstacleTerm::untouched() const
  {
    std::vector<std::string> names;
    for (unsigned int i = 0; i < sums_of.size(); ++i)
      if (!free_dofs->exchange().any(sums_of[i].has_touched))
        names.push_back(obstacles.all[i].name());
    return names;
  }

  void
  ObstacleTerm::append_columns(const double /*energy*/,
                               std::vector<std::pair<std::string, double>> &columns) const
  {
    const Exchange &exchange = free_dofs->exchange();
    columns.emplace_back("energy_contact", exchange.sum(reached.barrier_energy));
    columns.emplace_back("least_gap", min_of_all(exchange, reached.least_gap));
    columns.emplace_back("contact_pairs", exchange.sum(reached.n_pairs));
    double heat = 0.;
    for (const ObstacleReport &obstacle : report())
    {
      const std::string name = "contact_" + obstacle.name;
      for (unsigned int c = 0; c < 3; ++c)
        columns.emplace_back(name + "_" + "xyz"[c], obstacle.force[c]);
      for (unsigned int c = 0; c < 3; ++c)
        columns.emplace_back(name + "_torque_" + "xyz"[c], obstacle.torque[c]);
      columns.emplace_back(name + "_work", obstacle.work);
      if (have_friction)
        columns.emplace_back(name + "_heat", obstacle.heat);
      heat += obstacle.heat;
    }
    if (have_friction)
      columns.emplace_back("heat_friction", heat);
  }

  void
  ObstacleTerm::append_fields(const Vector &positions, std::vector<NodalField> &fields) const
  {
    NodalField pressure{ "contact_pressure", Vector(positions.size() / 3), 1 };
    for (const Contact &contact : contacts(positions))
      if (contact.gap.distance > 0.)
        for (unsigned int i = 0; i < contact.gap.n_nodes; ++i)
          pressure.values[contact.gap.nodes[i]]
              -= Barrier{ contact.gap.stiffness, contact.gap.width }.slope(contact.gap.distance)
                 * contact.gap.coefficients[i] / node_areas[contact.gap.nodes[i]];
    fields.push_back({ "contact_force", forces(positions) });
    fields.push_back(std::move(pressure));
  }

  void
  ObstacleTerm::save(boost::archive::binary_oarchive &archive) const
  {
    archive << has_appeared << sums_of << reached.barrier_energy << reached.least_gap
            << reached.n_pairs;
  }

  void
  ObstacleTerm::load(boost::archive::binary_iarchive &archive)
  {
    archive >> has_appeared >> sums_of >> reached.barrier_energy >> reached.least_gap
        >> reached.n_pairs;
    sums_of.resize(standing.size()); // some obstacles may have been added since
    has_appeared.resize(standing.size(), 0);
  }

  std::size_t
  ObstacleTerm::memory_consumption() const
  {
    std::size_t bytes = memory_of_touching() + node_areas.size() * sizeof(double)
                        + step.start.memory_consumption() + found.positions.memory_consumption()
                        + found.contacts.capacity() * sizeof(Contact);
    for (const Obstacle &obstacle : obstacles.all)
      bytes += obstacle.memory_consumption();
    for (const KeptPairs &pairs : kept)
      bytes += pairs.pairs.capacity() * sizeof(ContactPair)
               + pairs.places.capacity() * sizeof(SpaceVector3);
    for (const auto &widths : obstacles.start_widths)
      bytes += widths.size() * (sizeof(StartWidth) + 3 * sizeof(double));
    return bytes;
  }
} // namespace Exemplar
