// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/run/inputs/shared_body.h>
#include <exemplar/run/scene/scene_file.h>
#include <exemplar/verification/verification.h>
#include <exemplar/verification/verification_scene.h>

#include <memory>

// Several processes that share a body, against a closed form and against one process with another
// linear solver.

namespace Exemplar::Verification
{
  namespace
  {
    const std::string bar = box({ { 4., 1., 1. } }, { { 16, 4, 4 } });

    std::unique_ptr<Problem>
    shared_problem(const std::string &text)
    {
      const SceneParameters parameters
          = SceneFile("", text, std::vector<std::string>()).get_parameters();
      return std::make_unique<Problem>(parameters, read_shared_body(parameters, MPI_COMM_WORLD));
    }

    /// Differences of positions, relative to the greatest displacement, and of weights.
    std::vector<Measurement>
    compare_with_one_process(const std::string &text)
    {
      const auto               problem   = shared_problem(text);
      const State              together  = solve_all_steps(*problem);
      const Vector             positions = whole(problem->body.exchange(), together.positions);
      std::vector<Measurement> found;
      at_root(problem->body.exchange(),
              [&]
              {
                Scene        scene(text);
                const Vector rest    = scene.problem.body.fe_space.rest_positions();
                const State  alone   = scene.solve();
                const double way     = max_difference(alone.positions, rest);
                double       weights = 0.;
                for (unsigned int i = 0; i < alone.weights.size(); ++i)
                  weights = max_or_nan(weights, std::abs(together.weights[i] - alone.weights[i]));
                found = { { "positions, of the way", 0.,
                            max_difference(positions, alone.positions) / way, Comparison::absolute,
                            1e-8 },
                          { "weights", 0., weights, Comparison::absolute, 1e-8 } };
              });
      return found;
    }

    const std::string lifted_bar
        = bar + section("Examples", set("Pose functions", bend(90., 4.)))
          + named_sections("Handles",
                           { { "left", set("Select", "boundary 1") },
                             { "right", set("Select", "boundary 2") + set("Motion", "0; 0; t")
                                            + set("Components", "z") } });

    std::vector<Measurement>
    shared_static()
    {
      return compare_with_one_process(set("Scene", "static") + lifted_bar
                                      + section("Time", set("Increments", "2"))
                                      + section("Solver", set("Tolerance", 1e-11)));
    }

    std::vector<Measurement>
    shared_dynamics()
    {
      return compare_with_one_process(set("Scene", "dynamic") + lifted_bar
                                      + section("Time", set("Step", 0.02) + set("End", 0.1))
                                      + section("Solver", set("Method", "quasi newton")
                                                              + set("Step tolerance", 1e-11)
                                                              + set("Tolerance", 1e-11)));
    }

    /// A bar stretched by its held ends, with sides free along x alone: u = x / 10.
    std::vector<Measurement>
    shared_stretch()
    {
      const std::string along_x  = set("Components", "x") + set("Motion", "0.1*x; 0; 0");
      const std::string across_x = set("Components", "y, z");
      const auto        problem  = shared_problem(
                  set("Scene", "static") + bar + section("Model", set("Dilatation", "cells"))
                  + section("Material", set("Young's modulus", 1e6) + set("Poisson's ratio", 0.25))
                  + named_sections("Handles", { { "left", set("Select", "boundary 1") + along_x },
                                                { "right", set("Select", "boundary 2") + along_x },
                                                { "all", set("Select", "box -1 -1 -1 5 2 2") + across_x } })
                  + section("Time", set("Increments", "1")) + section("Solver", set("Tolerance", 1e-12)));
      const State     state    = solve_all_steps(*problem);
      const Exchange &exchange = problem->body.exchange();
      const Vector   &rest     = problem->body.fe_space.rest_positions();
      double          error    = 0.;
      for (unsigned int dof = 0; dof < rest.size(); ++dof)
        error = max_or_nan(error,
                           std::abs(state.positions[dof] - rest[dof] * (dof % 3 == 0 ? 1.1 : 1.)));
      error = exchange.max(error);
      // V (lambda / 2 + mu) / 100 with lambda = mu = E / 2.5
      return { { "u_x - x / 10", 0., error, Comparison::absolute, 1e-9 },
               { "energy", 4. * 1.5 * 0.4e6 / 100., problem->evaluation.elastic.energy,
                 Comparison::relative, 1e-10 } };
    }
    /// Coordinates of the cells' centroids, the same in any process.
    std::vector<double>
    centroids(const Mesh &mesh)
    {
      std::vector<double> values;
      for (const auto &cell : mesh.get_cells())
        for (unsigned int c = 0; c < 3; ++c)
        {
          values.push_back(0.);
          for (const unsigned int node : cell)
            values.back() += 0.25 * mesh.get_nodes()[node][c];
        }
      return values;
    }

    /// Fields of nodes and cells, gathered and distributed again.
    std::vector<Measurement>
    shared_state()
    {
      const auto problem                = shared_problem(set("Scene", "static") + lifted_bar);
      State      own                    = problem->state;
      own.history                       = centroids(problem->body.mesh);
      const State              together = whole(problem->body.mesh, own);
      const double             lost     = own == part(problem->body.mesh, together) ? 0. : 1.;
      std::vector<Measurement> found;
      at_root(problem->body.exchange(),
              [&]
              {
                const Scene  alone(set("Scene", "static") + lifted_bar);
                const double nodes
                    = max_difference(together.positions, alone.problem.state.positions);
                double                    cells    = 0.;
                const std::vector<double> expected = centroids(alone.problem.body.mesh);
                for (std::size_t i = 0; i < expected.size(); ++i)
                  cells = max_or_nan(cells, std::abs(together.history.at(i) - expected[i]));
                found = { { "positions", 0., nodes, Comparison::absolute, 0. },
                          { "numbers of cells", 0., cells, Comparison::absolute, 0. },
                          { "of the part lost", 0., lost, Comparison::absolute, 0. } };
              });
      return found;
    }
  } // namespace

  std::vector<Case>
  process_cases()
  {
    return {
      { "shared-stretch", "a stretched bar of all processes: closed form", shared_stretch, true },
      { "shared-static", "a bar with an example, by all processes and by one", shared_static,
        true },
      { "shared-state", "its state as a whole and in parts", shared_state, true },
      { "shared-dynamics", "the same in motion, by quasi-Newton steps", shared_dynamics, true }
    };
  }
} // namespace Exemplar::Verification
