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
    constexpr unsigned int max_rounds        = 4;    ///< in which gaps join
    constexpr unsigned int max_weight_rounds = 3;    ///< in one of these
    constexpr double       joins_below       = 0.2;  ///< widths
    constexpr double       same_weights      = 1e-3; ///< of their greatest change
    constexpr std::size_t  max_rows          = 300;  ///< of a dense problem
    /// Of the gradient: so much of it may be left where the model's minimum should be, whose error is greater than that.
    constexpr double forcing = 1e-2;
  } // namespace

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

  bool
  ContactModel::is_dense(const GapEnergies &gaps)
  {
    return potential.get_free_dofs().exchange().n_processes() == 1 && gaps.n_rows() <= max_rows
           && columns.has_entries();
  }

  ContactModel::Touching
  ContactModel::touch(const GapEnergies     &gaps,
                      const WeightsThere    &weights,
                      const LbfgsCorrection &correction,
                      Direction             &free,
                      std::vector<double>   &by_row)
  {
    const Exchange        &exchange = potential.get_free_dofs().exchange();
    const ContactOperators operators
        = { [&](const std::vector<double> &forces) { return respond(forces); },
            [&](const std::vector<double> &of_rows) { return forces_of(gaps, of_rows); },
            [&](const std::vector<double> &step) { return gaps.changes(displacement(step)); },
            exchange };
    const bool dense = is_dense(gaps);
    many_gaps        = exchange.n_processes() == 1 && columns.has_entries() && !dense;
    dealii::FullMatrix<double> W;
    if (dense)
      W = columns.between_rows(gaps, correction);
    for (unsigned int round = 1;; ++round)
    {
      Touching touching;
      double   part = 1.;
      if (dense)
      {
        ContactForces found = minimize_with_contact(gaps, W, operators.changes(free.step),
                                                    dot(free.forces, free.step),
                                                    forcing * free.greatest_gradient, by_row);
        by_row              = std::move(found.forces);
        part                = found.part;
      }
      else
      {
        ContactStep found = minimize_with_contact(gaps, operators, free.forces);
        by_row            = gaps.slopes(found.changes);
        for (double &force : by_row)
          force = -force;
        touching.step = std::move(found.step);
      }
      touching.forces = operators.forces(by_row);
      if (round < max_weight_rounds && find_weights(weights, touching.forces, correction, free))
        continue;
      if (dense)
      {
        touching.step = respond(touching.forces);
        add(touching.step, part, free.step);
      }
      return touching;
    }
  }

  bool
  ContactModel::find_weights(const WeightsThere        &weights,
                             const std::vector<double> &forces_of_contact,
                             const LbfgsCorrection     &correction,
                             Direction                 &free) const
  {
    if (free.weight_changes.empty())
      return false;
    std::vector<double> difference = free.weight_changes, forces = free.forces;
    for (double &change : difference)
      change = -change;
    metric.add_example_forces(difference, forces);
    add(forces, 1., forces_of_contact);
    const std::vector<double> changes
        = metric.find_weight_changes(forces, weights.gradient, weights.limits);
    add(difference, 1., changes);
    if (max_entry(difference) <= same_weights * max_entry(changes))
      return false;
    std::vector<double> more(free.forces.size());
    metric.add_example_forces(difference, more);
    add(free.forces, 1., more);
    metric.add_example_responses(difference, free.step);
    add_correction(correction, more, free.step);
    free.weight_changes = changes;
    return true;
  }

  void
  ContactModel::add_correction(const LbfgsCorrection     &correction,
                               const std::vector<double> &forces,
                               std::vector<double>       &step) const
  {
    const std::size_t   k = correction.columns.size();
    std::vector<double> along(k);
    for (std::size_t i = 0; i < k; ++i)
      along[i] = dot(forces, *correction.columns[i]);
    potential.get_free_dofs().exchange().sum(along);
    for (std::size_t i = 0; i < k; ++i)
    {
      double factor = 0.;
      for (std::size_t j = 0; j < k; ++j)
        factor += correction.matrix(i, j) * along[j];
      add(step, factor, *correction.columns[i]);
    }
  }

  void
  ContactModel::find_free_step(const std::vector<double> &of_body, Direction &direction)
  {
    const auto apply     = [this](std::vector<double> &vector) { metric.apply(vector); };
    direction.correction = lbfgs.correction(apply);
    if (response.of_body.empty())
    {
      response.of_body = of_body;
      apply(response.of_body);
    }
    else if (response.is_behind)
    {
      // the change of forces is that of the pair without the examples'
      add(response.of_body, -1., lbfgs.newest_response());
      metric.add_example_responses(response.weight_changes, response.of_body);
    }
    response.is_behind = false;
    direction.step     = response.of_body;
    metric.add_example_responses(direction.weight_changes, direction.step);
    add_correction(*direction.correction, direction.forces, direction.step);
  }

  void
  ContactModel::follow(const bool has_pair, const std::vector<double> &weight_changes)
  {
    if (!has_pair || response.is_behind)
      forget_response();
    else if (!response.of_body.empty())
    {
      response.weight_changes = weight_changes;
      response.is_behind      = true;
    }
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
    GapEnergies     near(potential.gaps_along(positions, moved, reach));
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
    if (!direction.correction)
      direction.correction
          = lbfgs.correction([this](std::vector<double> &vector) { metric.apply(vector); });
    Touching            touching;
    std::vector<double> by_row;
    for (unsigned int round = 1;; ++round)
    {
      touching = touch(GapEnergies(taken), weights, *direction.correction, direction, by_row);
      moved    = displacement(touching.step);
      if (round == max_rounds || !take_what_comes_near())
        break;
    }
    direction.step              = std::move(touching.step);
    std::vector<double> changes = near.changes(moved);
    return std::make_unique<AlongDirection>(AlongDirection{ std::move(near), std::move(changes) });
  }
} // namespace Exemplar
