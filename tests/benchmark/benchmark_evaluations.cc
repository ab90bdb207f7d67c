// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/scene/scene_file.h>

#include "benchmark_unit.h"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

// benchmark_evaluations SCENE STEPS [KEY=VALUE]...: what an evaluation of the potential costs where the scene is after so
// many steps, in nanoseconds a cell of this thread's processor time: the least of many, as others work beside.

namespace Exemplar
{
  namespace
  {
    constexpr unsigned int n_repeats = 400;

    void
    measure(const std::string              &file,
            const unsigned int              n_steps,
            const std::vector<std::string> &overrides)
    {
      const SceneFile scene(file, overrides);
      Problem         problem(scene.get_parameters(), read_inputs(scene.get_parameters()));
      for (unsigned int step = 0; step < n_steps; ++step)
        problem.advance();
      State               state = problem.state;
      std::vector<double> all, of_nodes;
      std::vector<float>  rotations;
      problem.potential.begin_step(state, problem.time_axis.step_size(1));
      for (unsigned int i = 0; i < n_repeats; ++i)
      {
        all.push_back(duration_of(
                          [&]
                          {
                            problem.potential.minimize_over_weights(
                                state, RotationUse::find_and_forget, problem.evaluation);
                          })
                          .cpu);
        of_nodes.push_back(
            duration_of([&] { problem.potential.get_body().node_rotations(rotations); }).cpu);
      }
      const double n_cells = problem.body.mesh.n_cells();
      const auto   tell    = [&](const std::string &what, std::vector<double> &seconds)
      {
        std::sort(seconds.begin(), seconds.end());
        std::cout << what << " " << 1e9 * seconds[0] / n_cells << " ns/cell at least, median "
                  << 1e9 * seconds[n_repeats / 2] / n_cells << "\n";
      };
      std::cout << n_cells << " cells, " << problem.body.mesh.n_nodes() << " nodes\n";
      tell("evaluation    ", all);
      tell("node rotations", of_nodes);
    }
  } // namespace
} // namespace Exemplar

int
main(int argc, char *argv[])
{
  return Exemplar::run_benchmark(
      "benchmark_evaluations", argv,
      [&]
      {
        if (argc < 3)
          throw Exemplar::UserError(
              "usage: benchmark_evaluations SCENE STEPS ['Section/Key=value']...");
        Exemplar::measure(argv[1], std::atoi(argv[2]), { argv + 3, argv + argc });
        return 0;
      });
}
