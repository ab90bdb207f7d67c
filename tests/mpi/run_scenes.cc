// SPDX-License-Identifier: GPL-3.0-or-later
// Runs several scenes by the processes of one mpirun, as the program runs one: each start of
// several processes takes longer than a small scene.
// Usage: mpirun -n N run_scenes SCENE DIRECTORY [SCENE DIRECTORY]...
// Ends with status 1 at the first scene that fails.

#include <exemplar/run/inputs/shared_body.h>
#include <exemplar/run/output/run_writer.h>
#include <exemplar/run/problem/problem.h>
#include <exemplar/run/scene/scene_file.h>
#include <exemplar/solvers/step_solver.h>

#include <deal.II/base/mpi.h>

#include <iostream>
#include <stdexcept>

namespace
{
  using namespace Exemplar;

  void
  run(const std::string &file, const std::string &directory)
  {
    const SceneFile scene(file, { "Output/Directory=" + directory });
    const auto      problem = make_problem(
             scene.get_parameters(), ReadBody([](const CompleteScene &parameters)
                                         { return read_shared_body(parameters, MPI_COMM_WORLD); }));
    for (const std::string &warning : problem->warnings())
      if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
        std::cerr << "Warning: " << warning << std::endl;
    RunWriter writer(*problem, scene);
    writer.begin();
    while (problem->state.step < problem->time_axis.n_steps())
    {
      const SolveReport report = problem->advance();
      writer.add_step(report);
      if (!is_success(report.status))
        throw std::runtime_error(problem->failure_message(report));
    }
    writer.finish("converged");
  }
} // namespace

int
main(int argc, char *argv[])
{
  MPI_Init(&argc, &argv);
  for (int i = 1; i + 1 < argc; i += 2)
    try
    {
      run(argv[i], argv[i + 1]);
    }
    catch (const std::exception &error)
    {
      std::cerr << argv[i] << ": " << error.what() << std::endl;
      MPI_Abort(MPI_COMM_WORLD, 1); // the others may wait
    }
  MPI_Finalize();
  return 0;
}
