// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/solvers/contact_gradients.h>
#include <exemplar/solvers/contact_model.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    constexpr unsigned int max_rounds        = 4; ///< in which gaps join and weights follow
    constexpr unsigned int max_weight_rounds = 3;
    constexpr double       joins_below       = 0.2;  ///< widths
    constexpr double       same_weights      = 1e-3; ///< of their greatest change
    constexpr std::size_t  max_rows          = 300;  ///< of a dense problem
  }                                                  // namespace

  ContactModel::ContactModel(const IncrementalPotential &potential,
                             RotatedMetric              &metric,
                             Lbfgs                      &lbfgs)
      : potential(potential), metric(metric), lbfgs(lbfgs),
        columns(potential.get_free_dofs(), metric)
  {
  }

  std::vector<double>
  ContactModel::gradient(const Vector &positions) const
  {
    const FreeDofs     &free_dofs = potential.get_free_dofs();
    std::vector<double> result;
    if (!is_possible())
      return result;
    const GapEnergies gaps(potential.gaps(positions, 1.));
    if (!free_dofs.exchange().any(gaps.n_rows() > 0))
      return result;
    Vector field(positions.size());
    gaps.add_forces(gaps.slopes(std::vector<double>(gaps.n_rows())), field);
    free_dofs.exchange().assemble(field.begin(), 3);
    free_dofs.gather(field, result);
    return result;
  }

  Vector
  ContactModel::displacement(const std::vector<double> &step) const
  {
    const FreeDofs     &free_dofs = potential.get_free_dofs();
    std::vector<double> direct    = step;
    Vector              field(free_dofs.n_dofs());
    metric.rotate_forth(direct);
    free_dofs.add(1., direct, field);
    return field;
  }

  std::vector<double>
  ContactModel::forces_of(const GapEnergies &gaps, const std::vector<double> &by_row) const
  {
    const FreeDofs     &free_dofs = potential.get_free_dofs();
    std::vector<double> forces;
    Vector              field(free_dofs.n_dofs());
    gaps.add_forces(by_row, field);
    free_dofs.exchange().assemble(field.begin(), 3);
    free_dofs.gather(field, forces);
    metric.rotate_back(forces);
    return forces;
  }

  std::vector<double>
  ContactModel::respond(std::vector<double> forces)
  {
    lbfgs.before(forces);
    metric.apply(forces);
    lbfgs.after(forces);
    return forces;
  }

  ContactModel::Touching
  ContactModel::minimize_densely(const GapEnergies &gaps, const Direction &free)
  {
    const LbfgsCorrection correction
        = lbfgs.correction([this](std::vector<double> &vector) { metric.apply(vector); });
    const dealii::FullMatrix<double> W     = columns.between_rows(gaps, correction);
    const ContactForces              found = minimize_with_contact(
                     gaps, W, gaps.changes(displacement(free.step)), dot(free.forces, free.step));
    Touching touching;
    touching.forces = forces_of(gaps, found.forces);
    touching.step   = respond(touching.forces);
    add(touching.step, found.part, free.step);
    return touching;
  }

  ContactModel::Touching
  ContactModel::minimize_by_gradients(const GapEnergies &gaps, const Direction &free)
  {
    const ContactOperators operators
        = { [&](const std::vector<double> &forces) { return respond(forces); },
            [&](const std::vector<double> &by_row) { return forces_of(gaps, by_row); },
            [&](const std::vector<double> &step) { return gaps.changes(displacement(step)); },
            potential.get_free_dofs().exchange() };
    const ContactStep   found  = minimize_with_contact(gaps, operators, free.forces);
    std::vector<double> by_row = gaps.slopes(found.changes);
    for (double &force : by_row)
      force = -force;
    return { found.step, forces_of(gaps, by_row) };
  }

  ContactModel::Touching
  ContactModel::minimize(const GapEnergies &gaps, const Direction &free)
  {
    const Exchange &exchange = potential.get_free_dofs().exchange();
    if (!exchange.any(gaps.n_rows() > 0))
      return { free.step, std::vector<double>(free.step.size()) };
    if (exchange.n_processes() == 1 && gaps.n_rows() <= max_rows && columns.has_entries())
      return minimize_densely(gaps, free);
    return minimize_by_gradients(gaps, free);
  }

  bool
  ContactModel::find_weights(const WeightsThere        &weights,
                             const std::vector<double> &forces_of_contact,
                             Direction                 &free)
  {
    std::vector<double> body = free.forces, opposite = free.weight_changes;
    for (double &change : opposite)
      change = -change;
    metric.add_example_forces(opposite, body);
    std::vector<double> all = body;
    add(all, 1., forces_of_contact);
    std::vector<double> changes = metric.find_weight_changes(all, weights.gradient, weights.limits);
    double              difference = 0.;
    for (std::size_t i = 0; i < changes.size(); ++i)
      difference = std::max(difference, std::abs(changes[i] - free.weight_changes[i]));
    if (difference <= same_weights * max_entry(changes))
      return false;
    free.forces = std::move(body);
    metric.add_example_forces(changes, free.forces);
    free.weight_changes = std::move(changes);
    free.step           = respond(free.forces);
    return true;
  }

  double
  ContactModel::AlongDirection::beyond_slope(const double part) const
  {
    const std::vector<double> none(changes.size());
    std::vector<double>       there = changes;
    for (double &change : there)
      change *= part;
    return gaps.value(there) - gaps.value(none) - dot(gaps.slopes(none), there);
  }

  std::unique_ptr<ContactModel::AlongDirection>
  ContactModel::add_contact(const Vector       &positions,
                            const WeightsThere &weights,
                            Direction          &direction)
  {
    if (!is_possible())
      return nullptr;
    const Exchange &exchange = potential.get_free_dofs().exchange();
    Vector          moved    = displacement(direction.step);
    const double    reach    = std::sqrt(3.) * exchange.max(max_entry(moved.begin(), moved.end()));
    GapEnergies     near(potential.gaps(positions, 1. + reach / potential.gap_width()));
    const std::vector<Gap> &gaps = near.get_gaps();
    std::vector<Gap>        taken;
    std::vector<char>       is_taken(gaps.size(), 0);
    const auto              take_where = [&](const auto &condition)
    {
      bool is_more = false;
      for (std::size_t g = 0; g < gaps.size(); ++g)
        if (is_taken[g] == 0 && condition(g))
        {
          is_taken[g] = 1;
          taken.push_back(gaps[g]);
          is_more = true;
        }
      return exchange.any(is_more);
    };
    const auto take_what_comes_near = [&]
    {
      const std::vector<double> distances = near.distances(moved);
      return take_where([&](const std::size_t g)
                        { return distances[g] < joins_below * gaps[g].width; });
    };
    const bool touches
        = take_where([&](const std::size_t g)
                     { return gaps[g].distance < gaps[g].width || gaps[g].friction > 0.; });
    if (!touches && !take_what_comes_near())
      return nullptr;
    Direction &free = direction;
    Touching   touching;
    for (unsigned int round = 1;; ++round)
    {
      touching     = minimize(GapEnergies(taken), free);
      moved        = displacement(touching.step);
      bool goes_on = round < max_rounds && take_what_comes_near();
      if (round < max_weight_rounds && find_weights(weights, touching.forces, free))
        goes_on = true;
      if (!goes_on)
        break;
    }
    direction.step              = std::move(touching.step);
    std::vector<double> changes = near.changes(moved);
    return std::make_unique<AlongDirection>(AlongDirection{ std::move(near), std::move(changes) });
  }
} // namespace Exemplar
