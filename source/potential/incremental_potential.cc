// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/errors.h>
#include <exemplar/potential/incremental_potential.h>

#include <algorithm>

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

    std::vector<std::pair<unsigned int, unsigned int>>
    couplings_of(const std::vector<std::unique_ptr<PotentialTerm>> &terms,
                 const ElasticParts                                &parts)
    {
      std::vector<std::pair<unsigned int, unsigned int>> couplings;
      if (parts.patches != nullptr)
        couplings = PatchScatter::couplings(*parts.patches, parts.fe_space);
      for (const auto &term : terms)
      {
        const auto more = term->couplings();
        couplings.insert(couplings.end(), more.begin(), more.end());
      }
      return couplings;
    }

    /// a + c (b - a)
    void
    mix(std::vector<double> &a, const std::vector<double> &b, const double c)
    {
      for (std::size_t i = 0; i < b.size(); ++i)
        a[i] += c * (b[i] - a[i]);
    }
  } // namespace

  IncrementalPotential::IncrementalPotential(const ElasticParts                         &parts,
                                             std::vector<std::unique_ptr<PotentialTerm>> new_terms,
                                             TimeIntegrator                             *integrator)
      : terms(std::move(new_terms)),
        pattern(make_pattern(parts.fe_space, couplings_of(terms, parts), parts.free_dofs)),
        cells(parts, pattern), weights(parts.weights), integrator(integrator),
        free_dofs(parts.free_dofs)
  {
    for (const auto &term : terms)
      term->attach(pattern, free_dofs);
  }

  void
  IncrementalPotential::begin_step(const State &start, const double step_size)
  {
    if (integrator != nullptr)
    {
      integrator->begin_step(start, step_size);
      in_dynamic_step = true;
      if (integrator->stiffness_damping_factor() > 0.)
        cells.set_damping(integrator->stiffness_damping_factor(), integrator->history(start));
    }
    for (const auto &term : terms)
      term->begin_step(start);
  }

  void
  IncrementalPotential::leave_step()
  {
    in_dynamic_step = false;
    cells.set_damping(0., {});
    for (const auto &term : terms)
      term->leave_step();
  }

  void
  IncrementalPotential::set_time(const double time, State &state)
  {
    state.time = time;
    for (const auto &term : terms)
      term->set_time(time);
    if (weights != nullptr && !weights->are_unknown())
      state.weights = weights->at(time);
  }

  bool
  IncrementalPotential::is_driven(const State &from, const double time) const
  {
    if (weights != nullptr && !weights->are_unknown() && weights->at(time) != from.weights)
      return true;
    return std::any_of(terms.begin(), terms.end(),
                       [&](const auto &term) { return term->differs(from.time, time); });
  }

  void
  IncrementalPotential::evaluate(const State      &at,
                                 const RotationUse rotations,
                                 Evaluation       &evaluation)
  {
    cells.evaluate(at.positions, at.weights, evaluation.elastic, rotations);
    add_terms(at.positions, evaluation);
  }

  void
  IncrementalPotential::minimize_over_weights(State            &at,
                                              const RotationUse rotations,
                                              Evaluation       &evaluation)
  {
    if (unknown_weights() == nullptr)
    {
      evaluate(at, rotations, evaluation);
      return;
    }
    // the loop over the cells needs the weights, so their linear term takes a loop of its own,
    // which leaves the rotations that both need
    const std::vector<double> c = cells.weight_linear_term(at.positions, RotationUse::update);
    at.weights                  = weights->best(c, at.weights);
    cells.evaluate(at.positions, at.weights, evaluation.elastic, RotationUse::keep, &c);
    add_terms(at.positions, evaluation);
  }

  void
  IncrementalPotential::evaluate_cells(const State &at, Evaluation &evaluation)
  {
    cells.evaluate(at.positions, at.weights, evaluation.elastic);
  }

  void
  IncrementalPotential::add_response(const Tangent tangent,
                                     const Vector &displacement,
                                     const State  &from,
                                     Evaluation   &evaluation)
  {
    cells.add_response(tangent, displacement, from.positions, from.weights, evaluation.elastic);
  }

  void
  IncrementalPotential::add_terms(const Vector &positions, Evaluation &evaluation) const
  {
    evaluation.gradient    = evaluation.elastic.gradient;
    evaluation.force_scale = evaluation.elastic.force_scale;
    evaluation.potential   = evaluation.elastic.energy + evaluation.elastic.energy_damping;
    evaluation.term_energies.clear();
    for (const auto &term : terms)
    {
      const double energy = term->add(positions, evaluation.gradient, evaluation.force_scale);
      evaluation.term_energies.push_back(energy);
      evaluation.potential += energy;
    }
    if (held_back.part == 0.)
      return;
    Vector displacement = positions;
    displacement -= held_back.positions;
    evaluation.gradient.add(-held_back.part, held_back.gradient);
    evaluation.potential
        -= held_back.part * free_dofs.exchange().product(held_back.gradient, displacement);
  }

  void
  IncrementalPotential::hold_back(const Vector &gradient, const Vector &positions)
  {
    held_back = { 1., Vector(gradient.size()), positions };
    for (const unsigned int dof : free_dofs.local_list())
      held_back.gradient[dof] = gradient[dof];
  }

  void
  IncrementalPotential::assemble_tangent(const Tangent              tangent,
                                         const Vector              &positions,
                                         const std::vector<double> &at_weights,
                                         std::vector<double>       &matrix_values,
                                         std::vector<double>       &columns)
  {
    std::fill(matrix_values.begin(), matrix_values.end(), 0.);
    for (const auto &term : terms)
      term->add_tangent(positions, matrix_values);
    cells.assemble_tangent(tangent, positions, at_weights, matrix_values, columns);
  }

  void
  IncrementalPotential::assemble(const Vector              &positions,
                                 const std::vector<double> &at_weights,
                                 const double               convexity,
                                 std::vector<double>       &matrix_values,
                                 std::vector<double>       &columns)
  {
    assemble_tangent(convexity < 1. ? Tangent::exact : Tangent::convex, positions, at_weights,
                     matrix_values, columns);
    if (convexity > 0. && convexity < 1.)
    {
      std::vector<double> convex_values(matrix_values.size()), convex_columns;
      assemble_tangent(Tangent::convex, positions, at_weights, convex_values, convex_columns);
      mix(matrix_values, convex_values, convexity);
      mix(columns, convex_columns, convexity);
    }
  }

  double
  IncrementalPotential::max_free_gradient(const Evaluation &evaluation) const
  {
    MaxMagnitude greatest;
    for (const unsigned int dof : free_dofs.list())
      greatest.add(evaluation.gradient[dof]);
    return free_dofs.exchange().max(greatest.value());
  }

  Residual
  IncrementalPotential::residual(const State &at, const Evaluation &evaluation) const
  {
    double rounding = cells.rounding_force();
    for (const auto &term : terms)
      rounding += term->rounding_force();
    Residual residual;
    residual.positions = relative(max_free_gradient(evaluation),
                                  free_dofs.exchange().max(max_entry(evaluation.force_scale.begin(),
                                                                     evaluation.force_scale.end())),
                                  rounding);
    if (!evaluation.elastic.weight_gradient.empty())
    {
      WeightResidual of_weights = weights->residual(at.weights, evaluation.elastic.weight_gradient);
      residual.weights          = relative(of_weights.deviation, evaluation.elastic.weight_scale,
                                           cells.rounding_weight_gradient());
      residual.multipliers      = std::move(of_weights.multipliers);
    }
    return residual;
  }
} // namespace Exemplar
