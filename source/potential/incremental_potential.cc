// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/errors.h>
#include <exemplar/potential/incremental_potential.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Exemplar
{
  namespace
  {
    /// a / b; where a is nothing but rounding, as in a body on which nothing acts, it
    /// counts as 0. Throws SolverFailure for what is not finite.
    double
    relative(const double a, const double b, const double rounding)
    {
      const double ratio = a <= rounding ? 0. : a / b;
      if (!std::isfinite(a) || !std::isfinite(b) || !std::isfinite(rounding)
          || !std::isfinite(ratio))
        throw SolverFailure("The residual is not a finite number. Forces have grown without bound: "
                            "take smaller steps, or look at what the handles do.");
      return ratio;
    }
  } // namespace

  void
  HeldBackForces::hold(const FreeDofs &free_dofs, const Vector &gradient, const Vector &positions)
  {
    part   = 1.;
    origin = positions;
    forces.reinit(gradient.size());
    for (const unsigned int dof : free_dofs.local_list())
      forces[dof] = gradient[dof];
  }

  void
  HeldBackForces::add(const Exchange &exchange,
                      const Vector   &positions,
                      Evaluation     &evaluation) const
  {
    if (part == 0.)
      return;
    Vector displacement = positions;
    displacement -= origin;
    evaluation.gradient.add(-part, forces);
    evaluation.potential -= part * exchange.product(forces, displacement);
  }

  IncrementalPotential::IncrementalPotential(ElasticBody    &body,
                                             ExampleWeights &weights,
                                             const FreeDofs &free_dofs,
                                             PotentialTerms  new_terms,
                                             TimeIntegrator *integrator,
                                             const bool      in_parts)
      : terms(std::move(new_terms)), body(body), tangent(body, free_dofs, terms, in_parts),
        weights(weights), integrator(integrator), free_dofs(free_dofs)
  {
  }

  void
  IncrementalPotential::add_term(std::unique_ptr<PotentialTerm> term)
  {
    tangent.attach(*term);
    terms.push_back(std::move(term));
  }

  void
  IncrementalPotential::follow_parameters()
  {
    body.follow_parameters();
    for (const auto &term : terms)
      term->follow_parameters();
  }

  void
  IncrementalPotential::begin_step(const State &start, const double step_size)
  {
    // the pattern depends on no earlier step, so that a resumed run has the same
    tangent.follow_gaps(start.positions, PotentialTangent::Terms::without_gaps);
    body.set_history(start.history);
    body.set_step_size(integrator != nullptr ? step_size : std::numeric_limits<double>::infinity());
    if (integrator != nullptr)
    {
      integrator->begin_step(start, step_size);
      in_dynamic_step      = true;
      const double damping = integrator->stiffness_damping_factor();
      body.begin_step(damping,
                      damping > 0. ? integrator->history(start) : std::vector<WeightedPositions>());
    }
    if (weights.get_memory().in_use())
      weights.set_step(integrator != nullptr ? integrator->weight_step(start)
                                             : WeightStep{ start.weights, {} });
    for (const auto &term : terms)
      term->begin_step(start, step_size);
    renew_terms(start, true);
  }

  TermChange
  IncrementalPotential::renew_terms(const State &at, const bool with_gaps)
  {
    TermChange change = TermChange::none;
    for (const auto &term : terms)
      if (with_gaps || term->gap_width() == 0.)
        change = std::max(change, term->renew({ at.positions, at.weights }));
    change = static_cast<TermChange>(
        std::lround(free_dofs.exchange().max(static_cast<double>(change))));
    if (change == TermChange::couplings)
      tangent.renew_pattern();
    return change;
  }

  TermChange
  IncrementalPotential::renew(const State &at, Evaluation &evaluation, const bool is_solved)
  {
    const TermChange change = renew_terms(at, is_solved);
    if (change != TermChange::none)
      add_terms(at.positions, evaluation);
    return change;
  }

  void
  IncrementalPotential::remember(State &end)
  {
    end.history = body.advance_history(end.positions);
  }

  void
  IncrementalPotential::end_step(State &end)
  {
    end.dissipated += weights.get_memory().dissipation(end.weights).total();
    for (const auto &term : terms)
    {
      end.dissipated += free_dofs.exchange().sum(term->dissipation(end).value_or(0.));
      term->end_step(end);
    }
  }

  bool
  IncrementalPotential::has_dissipating_terms(const State &at) const
  {
    return std::any_of(terms.begin(), terms.end(),
                       [&](const auto &term) { return term->dissipation(at).has_value(); });
  }

  std::vector<unsigned int>
  IncrementalPotential::weakly_constrained_pieces() const
  {
    for (const auto &term : terms)
      if (auto pieces = term->weakly_constrained_pieces(); !pieces.empty())
        return pieces;
    return {};
  }

  bool
  IncrementalPotential::has_tangent_of_step() const
  {
    return std::any_of(terms.begin(), terms.end(),
                       [](const auto &term) { return term->has_tangent_of_step(); });
  }

  void
  IncrementalPotential::leave_step(const State &at)
  {
    in_dynamic_step = false;
    body.set_history(at.history);
    body.set_step_size(0.);
    body.leave_step();
    if (weights.get_memory().in_use())
      weights.set_step({ at.weights, {} });
    for (const auto &term : terms)
      term->leave_step();
  }

  void
  IncrementalPotential::set_time(const double time, State &state)
  {
    state.time = time;
    set_time_of_terms(time);
    state.weights = weights.at(time, state.weights);
  }

  void
  IncrementalPotential::set_time_of_terms(const double time)
  {
    for (const auto &term : terms)
      term->set_time(time);
  }

  bool
  IncrementalPotential::is_driven(const State &from, const double time) const
  {
    bool differs = weights.at(time, from.weights) != from.weights;
    for (const auto &term : terms)
      differs |= term->differs(from.time, time);
    return free_dofs.exchange().any(differs);
  }

  void
  IncrementalPotential::evaluate(const State      &at,
                                 const RotationUse rotations,
                                 Evaluation       &evaluation)
  {
    body.evaluate(at.positions, at.weights, evaluation.elastic, rotations);
    add_terms(at.positions, evaluation);
  }

  void
  IncrementalPotential::minimize_over_weights(State            &at,
                                              const RotationUse rotations,
                                              Evaluation       &evaluation)
  {
    if (weights.n_unknown() == 0)
    {
      evaluate(at, rotations, evaluation);
      return;
    }
    // the loop over the cells needs the weights, so their linear term takes a loop of its own,
    // which leaves the rotations that both need
    const std::vector<double> c = body.weight_linear_term(at.positions, RotationUse::update);
    at.weights                  = weights.best(c, at.weights);
    body.evaluate(at.positions, at.weights, evaluation.elastic, RotationUse::keep, &c);
    add_terms(at.positions, evaluation);
  }

  void
  IncrementalPotential::add_terms(const Vector &positions, Evaluation &evaluation) const
  {
    const Exchange &exchange = free_dofs.exchange();
    ElasticSums     own;
    own->gradient.swap(evaluation.gradient); // for their memory
    own->force_scale.swap(evaluation.force_scale);
    own->gradient.reinit(positions.size());
    own->force_scale.reinit(positions.size() / 3);
    evaluation.term_energies.clear();
    for (const auto &term : terms)
    {
      const double before = own->energy;
      term->add({ positions, {} }, own);
      evaluation.term_energies.push_back(own->energy - before);
    }
    evaluation.term_energies.push_back(own->rounding_energy); // to be summed at once
    exchange.sum(evaluation.term_energies);
    evaluation.rounding_energy = evaluation.term_energies.back();
    evaluation.term_energies.pop_back();
    evaluation.gradient.swap(own->gradient);
    evaluation.force_scale.swap(own->force_scale);
    exchange.assemble(evaluation.gradient.begin(), 3);
    exchange.assemble(evaluation.force_scale.begin(), 1);
    evaluation.gradient += evaluation.elastic.gradient;
    evaluation.force_scale += evaluation.elastic.force_scale;
    evaluation.potential = evaluation.elastic.energy + evaluation.elastic.energy_damping
                           + evaluation.elastic.energy_memory;
    for (const double energy : evaluation.term_energies)
      evaluation.potential += energy;
    held_back.add(exchange, positions, evaluation);
  }

  Residual
  IncrementalPotential::residual(const State &at, const Evaluation &evaluation) const
  {
    double rounding = body.rounding_force(
        free_dofs.exchange().max(max_entry(at.positions.begin(), at.positions.end())));
    for (const auto &term : terms)
      rounding += term->rounding_force(at.positions);
    rounding = free_dofs.exchange().max(rounding);
    Residual residual;
    residual.positions        = relative(free_dofs.max_magnitude(evaluation.gradient),
                                         free_dofs.exchange().max(max_entry(evaluation.force_scale.begin(),
                                                                            evaluation.force_scale.end())),
                                         rounding);
    WeightResidual of_weights = weights.residual(at.weights, evaluation.elastic.weight_gradient);
    residual.weights          = relative(of_weights.deviation, evaluation.elastic.weight_scale,
                                         body.rounding_weight_gradient());
    residual.multipliers      = std::move(of_weights.multipliers);
    return residual;
  }

  double
  IncrementalPotential::max_step_to(const double  time,
                                    const Vector &positions,
                                    const Vector &displacement) const
  {
    double part = std::numeric_limits<double>::infinity();
    for (const auto &term : terms)
      part = std::min(part, term->max_step_to(time, positions, displacement));
    return min_of_all(free_dofs.exchange(), part);
  }

  std::string
  IncrementalPotential::limit_to(const double  time,
                                 const Vector &positions,
                                 const Vector &displacement) const
  {
    for (const auto &term : terms)
    {
      const bool limits = term->max_step_to(time, positions, displacement) < 1.;
      if (const std::string who = free_dofs.exchange().first_text(
              limits ? term->limit_to(time, positions, displacement) : "");
          !who.empty())
        return who;
    }
    return "";
  }

  double
  IncrementalPotential::gap_width() const
  {
    double width = 0.;
    for (const auto &term : terms)
      width = std::max(width, term->gap_width());
    return width;
  }

  std::vector<Gap>
  IncrementalPotential::gaps(const Vector &positions, const double range) const
  {
    std::vector<Gap> all;
    for (const auto &term : terms)
      term->append_gaps(positions, range, all);
    return all;
  }

  std::vector<Gap>
  IncrementalPotential::gaps_along(const Vector &positions,
                                   const Vector &displacement,
                                   const double  reach) const
  {
    std::vector<Gap> all;
    for (const auto &term : terms)
      if (term->gap_width() > 0.)
        term->append_gaps_along(positions, displacement, reach, all);
    return all;
  }

  std::vector<Gap>
  IncrementalPotential::gaps_of_way(const double  now,
                                    const double  time,
                                    const Vector &from,
                                    const Vector &to,
                                    const double  range) const
  {
    std::vector<Gap> all;
    for (const auto &term : terms)
      term->append_gaps_of_way(now, time, from, to, range, all);
    return all;
  }

  void
  IncrementalPotential::move_to(const double time)
  {
    for (const auto &term : terms)
      term->move_to(time);
  }

  bool
  IncrementalPotential::moves_between(const double time, const double other_time) const
  {
    bool moves = false;
    for (const auto &term : terms)
      moves |= term->moves_between(time, other_time);
    return free_dofs.exchange().any(moves);
  }

  double
  IncrementalPotential::max_step(const Vector &positions, const Vector &displacement) const
  {
    double part = std::numeric_limits<double>::infinity();
    for (const auto &term : terms)
      part = std::min(part, term->max_step(positions, displacement));
    return min_of_all(free_dofs.exchange(), part);
  }

  std::string
  IncrementalPotential::name_of_limit(const Vector &positions, const Vector &displacement) const
  {
    for (const auto &term : terms)
      if (min_of_all(free_dofs.exchange(), term->max_step(positions, displacement)) < 1.)
        return term->name();
    return "";
  }
} // namespace Exemplar
