// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/problem/problem.h>

#include <algorithm>
#include <cmath>

// A body with examples has an equilibrium near each of them, and steps find that which the way leads to. Here
// others are looked for, from the examples themselves.

namespace Exemplar
{
  namespace
  {
    /// By more than rounding, tolerances and the ridge of the weights make of an energy.
    bool
    is_clearly_less(const double energy, const double other, const Body &body)
    {
      return energy
             < other - 1e-6 * std::abs(other) - 1e-10 * unit_energy(body.fe_space, body.material);
    }

    /// The only example whose weight is 1, in all regions.
    std::vector<double>
    weight_of(const unsigned int example, const ExampleWeights &weights)
    {
      std::vector<double> all(weights.size(), 0.);
      for (unsigned int i = example; i < all.size(); i += weights.n_per_region())
        all[i] = 1.;
      return all;
    }
  } // namespace

  State
  Problem::at_example(const unsigned int i, const State &end) const
  {
    State at     = end;
    at.positions = examples.poses.pose(i);
    at.weights   = weight_of(i, examples.weights);
    align_at(constraints.handles.held_dofs(), end.positions, at.positions, body.exchange());
    constraints.handles.move(end.time, at.positions);
    return at;
  }

  std::optional<ExampleStart>
  Problem::missed_example()
  {
    std::optional<ExampleStart> best;
    const CellBatches          &batches = potential.get_cells().get_field().get_batches();
    if (parameters.scene != SceneKind::statics || examples.weights.n_unknown() == 0
        || batches.remembers() || potential.dissipates() || !starts.empty())
      return best;
    for (unsigned int i = 0; i < examples.poses.size(); ++i)
    {
      State      at = at_example(i, state);
      Evaluation of_example;
      potential.minimize_over_weights(at, RotationUse::update, of_example);
      if (const double energy = of_example.potential;
          is_clearly_less(energy, best ? best->energy : evaluation.potential, body))
        best = { examples.poses.name(i), SolveStatus::initial, energy, false };
    }
    start(state); // the rotations are its own again
    return best;
  }

  void
  Problem::start_from_examples(State &end, const StepInterval &interval, SolveReport &report)
  {
    starts           = { { "the steps", report.status, evaluation.potential, false } };
    std::size_t kept = 0;
    for (unsigned int i = 0; i < examples.poses.size(); ++i)
    {
      State      at = at_example(i, end);
      Evaluation found;
      solver->forget(); // its factor is of other positions
      potential.leave_step(at);
      potential.set_time(at.time, at);
      potential.minimize_over_weights(at, RotationUse::update, found);
      SolveReport of_example = solver->solve(at, found, interval.end, interval.size);
      report.iterations += of_example.iterations;
      starts.push_back({ examples.poses.name(i), of_example.status, found.potential, false });
      if (!is_success(of_example.status)
          || !is_clearly_less(found.potential, starts[kept].energy, body))
        continue;
      kept                  = starts.size() - 1;
      of_example.iterations = report.iterations;
      report                = of_example;
      end                   = at;
    }
    starts[kept].is_kept = true;
    solver->forget();
    start(end);
  }
} // namespace Exemplar
