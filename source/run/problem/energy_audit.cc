// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/run/problem/energy_audit.h>
#include <exemplar/run/problem/problem.h>

#include <boost/serialization/vector.hpp>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace Exemplar
{
  bool
  EnergyAudit::is_possible(const Problem &problem)
  {
    const SceneParameters &scene = problem.parameters;
    return scene.scene != SceneKind::interpolation && scene.solver.method != Method::one_pass
           && !scene.model.is_frozen()
           && (scene.scene != SceneKind::dynamic
               || scene.time.scheme == TimeScheme::implicit_euler);
  }

  EnergyAudit::EnergyAudit(const Problem &problem)
      : problem(problem), balance(problem.parameters.scene == SceneKind::dynamic),
        least_energy(1e-16 * unit_energy(problem.body.fe_space, problem.body.material))
  {
    const InitialParameters &initial = problem.parameters.initial;
    // a pose is no equilibrium, and its energy is not that of any work
    if (problem.actions.mass != nullptr || (initial.pose.empty() && initial.pose_function.empty()))
      begin();
  }

  void
  EnergyAudit::restart(const std::string &what)
  {
    if (!balance.has_begun())
      return;
    balance.forget();
    if (n_restarts == 0)
    {
      first_restart = problem.state.step;
      first_cause   = what;
    }
    ++n_restarts;
  }

  void
  EnergyAudit::begin()
  {
    balance.forget();
    if (const auto here = energies(problem.state, problem.state))
      count_from(*here, false);
  }

  void
  EnergyAudit::count_from(const EnergyStep &at, const bool is_balanced)
  {
    balance.begin(at);
    last.gradient     = problem.evaluation.gradient;
    last.are_balanced = is_balanced;
    last.weights      = weight_forces;
  }

  std::string
  EnergyAudit::add_step(const State &start, const State &end)
  {
    const std::optional<EnergyStep> step = energies(start, end);
    if (!step)
      restart("a term whose energy is not known");
    else if (!balance.has_begun())
      count_from(*step, true);
    else if (const auto excess = balance.add(*step))
      return failure(*excess);
    last.gradient     = problem.evaluation.gradient;
    last.are_balanced = true;
    last.weights      = weight_forces;
    return "";
  }

  // What a step consists of

  std::optional<EnergyStep>
  EnergyAudit::energies(const State &start, const State &end)
  {
    const Evaluation     &now      = problem.evaluation;
    const Exchange       &exchange = problem.body.exchange();
    const auto           &terms    = problem.potential.get_terms();
    const double          of_body  = now.elastic.energy - now.elastic.energy_inelastic;
    EnergyStep            step;
    std::array<double, 4> own{}; // what is lost, work, its doubt, plastic work
    step.step   = end.step;
    step.stored = of_body;
    step.size = std::max({ std::abs(of_body), std::abs(now.elastic.energy_elastic), least_energy });
    for (std::size_t i = 0; i < terms.size(); ++i)
    {
      const std::optional<EnergyFlow> flow = terms[i]->energy_flow(start, end);
      if (!flow)
        return {};
      own[0] += flow->lost;
      own[1] += flow->work;
      own[2] += flow->doubt;
      if (!flow->is_stored)
        continue;
      step.stored += now.term_energies[i];
      step.size += std::abs(now.term_energies[i]);
    }
    if (problem.has_trait(&ModelTraits::dissipated))
      own[3] = problem.cells().get_field().dissipated_energy();
    exchange.sum(own.data(), own.size());
    step.stored += own[3] - own[0];
    step.size += own[3];
    step.plastic = own[3];
    step.work    = own[1];
    step.doubt   = own[2];
    if (problem.actions.mass != nullptr)
    {
      // flow that is viscous has half of its work as a potential, which a step need not pay
      step.doubt += 0.5 * std::abs(step.plastic - balance.get_last().plastic);
      step.kinetic = kinetic_energy(end);
      step.size += step.kinetic;
    }
    add_work_of_weights(start, end, step);
    if (balance.has_begun())
      add_work_of_nodes(start, end, step);
    constexpr double of_sums = 1e-13, of_positions = 4e-16;
    // forces that cancel, as initial stresses and loads do, work along the rounding of positions
    const double forces = exchange.sum(now.force_scale.l1_norm()),
                 size   = exchange.max(max_entry(end.positions.begin(), end.positions.end()));
    step.rounding       = now.rounding_energy + problem.elastic->rounding_energy(now.elastic)
                    + of_sums * (step.size + std::abs(step.work)) + of_positions * forces * size;
    return step;
  }

  void
  EnergyAudit::add_work_of_nodes(const State &start, const State &end, EnergyStep &step) const
  {
    enum
    {
      held_by_start,
      held_by_end,
      spread,
      left_by_start,
      left_by_end
    };
    std::array<double, 5> sums{};
    const Exchange       &exchange  = problem.body.exchange();
    const FreeDofs       &free_dofs = problem.constraints.free_dofs;
    const Vector         &now = problem.evaluation.gradient, &before = last.gradient;
    for (unsigned int node = 0; node < now.size() / 3; ++node)
    {
      if (!exchange.owns(node))
        continue;
      double way_square = 0., change_square = 0.;
      for (unsigned int dof = 3 * node; dof < 3 * node + 3; ++dof)
      {
        const double way     = end.positions[dof] - start.positions[dof];
        const bool   is_held = free_dofs.free_index(dof) == FreeDofs::held;
        sums[is_held ? held_by_start : left_by_start] += before[dof] * way;
        sums[is_held ? held_by_end : left_by_end] += now[dof] * way;
        if (!is_held)
          continue;
        way_square += way * way;
        change_square += (now[dof] - before[dof]) * (now[dof] - before[dof]);
      }
      // forces that turn do work that neither of the rules has
      sums[spread] += std::sqrt(way_square * change_square);
    }
    exchange.sum(sums.data(), sums.size());
    step.work += 0.5 * (sums[held_by_start] + sums[held_by_end]);
    step.doubt += 0.5 * sums[spread];
    const bool has_both = problem.actions.mass == nullptr && last.are_balanced;
    step.unsolved = has_both ? 0.5 * (std::abs(sums[left_by_start]) + std::abs(sums[left_by_end]))
                             : std::abs(sums[left_by_end]);
  }

  void
  EnergyAudit::add_work_of_weights(const State &start, const State &end, EnergyStep &step)
  {
    const Examples &examples = problem.examples;
    if (!examples.weights.are_prescribed())
      return;
    // the energy is A(x) - c(x).w + w.G w/2, of which only the last part knows nothing of the body
    const dealii::FullMatrix<double> &gram = examples.poses.gram();
    for (unsigned int i = 0; i < gram.m(); ++i)
      for (unsigned int j = 0; j < gram.m(); ++j)
        step.stored -= 0.5 * end.weights[i] * gram(i, j) * end.weights[j];
    weight_forces = problem.elastic->weight_linear_term(end.positions, RotationUse::keep);
    if (last.weights.size() != weight_forces.size())
      return;
    for (std::size_t i = 0; i < weight_forces.size(); ++i)
    {
      const double change = end.weights[i] - start.weights[i];
      step.work -= 0.5 * (weight_forces[i] + last.weights[i]) * change;
      step.doubt += 0.5 * std::abs((weight_forces[i] - last.weights[i]) * change);
    }
  }

  double
  EnergyAudit::kinetic_energy(const State &at)
  {
    const std::size_t n = at.velocities.size() / 3;
    velocities.resize(4 * n);
    momenta.resize(4 * n);
    for (std::size_t node = 0; node < n; ++node)
      for (unsigned int c = 0; c < 3; ++c)
        velocities[4 * node + c] = at.velocities[3 * node + c];
    problem.actions.mass->multiply(velocities, momenta);
    double energy = 0.;
    for (std::size_t node = 0; node < n; ++node)
      for (unsigned int c = 0; c < 3; ++c)
        energy += 0.5 * velocities[4 * node + c] * momenta[4 * node + c];
    return problem.body.exchange().sum(energy);
  }

  // What is said

  std::string
  EnergyAudit::failure(const EnergyExcess &excess) const
  {
    const std::string grown = short_text(excess.grown), work = short_text(excess.work),
                      doubt = short_text(excess.doubt);
    if (problem.actions.mass != nullptr)
      return fmt::format(
          "the stored energy is {} J at its end, but stored energy, kinetic energy and work gave "
          "it only {} J, known to within {} J. Take smaller steps (Time/Step).",
          grown, work, doubt);
    return fmt::format(
        "the stored energy has grown by {} J since step {}, but the work on the body is only {} J, "
        "known to within {} J. The body has come to a state that this work cannot lead to. Take "
        "more increments (Time/Increments).",
        grown, excess.since, work, doubt);
  }

  std::vector<std::string>
  EnergyAudit::warnings() const
  {
    const std::optional<EnergyGain> gain = balance.gain();
    if (!gain)
      return {};
    return { fmt::format("Stored and kinetic energy have risen by {} J without work between steps "
                         "{} and {}, by {} % "
                         "of the greatest energy so far. Take smaller steps (Time/Step).",
                         short_text(gain->energy), gain->since, gain->until,
                         short_text(100. * gain->energy / gain->greatest)) };
  }

  void
  EnergyAudit::count_parts(const unsigned int step)
  {
    if (n_in_parts == 0)
      first_in_parts = step;
    ++n_in_parts;
  }

  std::string
  EnergyAudit::notes() const
  {
    const auto times = [](const unsigned int n)
    { return n == 1 ? std::string("once") : fmt::format("{} times", n); };
    std::string lines;
    if (n_in_parts > 0)
      lines
          += fmt::format("Note      the work in an increment was not known well enough, {}: it was "
                         "made in parts, first increment {}\n",
                         times(n_in_parts), first_in_parts);
    if (n_restarts > 0)
      lines += fmt::format("Note      the energy audit started again {}, first after step {}: {}\n",
                           times(n_restarts), first_restart, first_cause);
    return lines;
  }

  // What is remembered

  void
  EnergyAudit::save(boost::archive::binary_oarchive &archive) const
  {
    const Vector                gradient = whole(problem.body.exchange(), last.gradient);
    archive &balance &gradient &last.weights                              &last
        .are_balanced &n_restarts &first_restart &first_cause &n_in_parts &first_in_parts;
  }

  void
  EnergyAudit::load(boost::archive::binary_iarchive &archive)
  {
    archive &balance &last.gradient &last.weights                         &last
        .are_balanced &n_restarts &first_restart &first_cause &n_in_parts &first_in_parts;
    last.gradient = part(problem.body.exchange(), last.gradient);
  }

  std::size_t
  EnergyAudit::memory_consumption() const
  {
    return last.gradient.memory_consumption() + velocities.memory_consumption()
           + momenta.memory_consumption();
  }
} // namespace Exemplar
