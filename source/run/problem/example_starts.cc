// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/problem/example_starts.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// Whether an energy is less by more than rounding, tolerances and the ridge of the weights
    /// explain.
    bool
    is_clearly_less(const double energy, const double other, const Body &body)
    {
      return energy
             < other - 1e-6 * std::abs(other) - 1e-10 * unit_energy(body.fe_space, body.material);
    }

    /// Weights with 1 for this example in all regions, else 0.
    std::vector<double>
    weight_of(const unsigned int example, const ExampleWeights &weights)
    {
      std::vector<double> all(weights.size(), 0.);
      for (unsigned int i = example; i < all.size(); i += weights.n_per_region())
        all[i] = 1.;
      return all;
    }
    /// The pose of an example, its weight 1, with the held nodes where they are in `end`.
    State
    at_example(const Problem &problem, const unsigned int i, const State &end)
    {
      const ExamplePoses &poses = problem.examples.poses;
      State               at    = end;
      at.positions              = poses.pose(i);
      at.weights                = weight_of(i, problem.examples.weights);
      align_at(problem.constraints.handles.held_dofs(), end.positions, at.positions,
               problem.body.exchange());
      problem.constraints.handles.move(end.time, at.positions);
      return at;
    }
  } // namespace

  std::optional<ExampleStart>
  missed_example(Problem &problem)
  {
    IncrementalPotential       &potential = problem.potential;
    const Examples             &examples  = problem.examples;
    std::optional<ExampleStart> best;
    if (problem.body.mesh.is_shell() || problem.parameters.scene != SceneKind::statics
        || examples.weights.n_unknown() == 0 || problem.elastic->remembers()
        || potential.get_weights().get_memory().in_use() || !examples.starts.empty())
      return best;
    for (unsigned int i = 0; i < examples.poses.size(); ++i)
    {
      State      at = at_example(problem, i, problem.state);
      Evaluation of_example;
      potential.minimize_over_weights(at, RotationUse::update, of_example);
      if (const double energy = of_example.potential;
          is_clearly_less(energy, best ? best->energy : problem.evaluation.potential, problem.body))
        best = { examples.poses.name(i), SolveStatus::initial, energy, false };
    }
    problem.start(problem.state); // restores its rotations
    return best;
  }

  void
  start_from_examples(Problem            &problem,
                      State              &end,
                      const StepInterval &interval,
                      SolveReport        &report)
  {
    IncrementalPotential      &potential = problem.potential;
    const ExamplePoses        &poses     = problem.examples.poses;
    std::vector<ExampleStart> &starts    = problem.examples.starts;
    starts           = { { "the steps", report.status, problem.evaluation.potential, false } };
    std::size_t kept = 0;
    for (unsigned int i = 0; i < poses.size(); ++i)
    {
      State      at = at_example(problem, i, end);
      Evaluation found;
      problem.solver->forget(); // factorised at other positions
      potential.leave_step(at);
      potential.set_time(at.time, at);
      potential.minimize_over_weights(at, RotationUse::update, found);
      SolveReport of_example = problem.solver->solve(at, found, interval.end, interval.size);
      report.iterations += of_example.iterations;
      starts.push_back({ poses.name(i), of_example.status, found.potential, false });
      if (!is_success(of_example.status)
          || !is_clearly_less(found.potential, starts[kept].energy, problem.body))
        continue;
      kept                  = starts.size() - 1;
      of_example.iterations = report.iterations;
      report                = of_example;
      end                   = at;
    }
    starts[kept].is_kept = true;
    problem.solver->forget();
    problem.start(end);
  }
} // namespace Exemplar
