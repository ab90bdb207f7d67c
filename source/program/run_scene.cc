// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/mpi_session.h>
#include <exemplar/base/environment.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/progress.h>
#include <exemplar/program/interrupt.h>
#include <exemplar/program/run_scene.h>
#include <exemplar/run/problem.h>
#include <exemplar/run/run_writer.h>
#include <exemplar/run/shared_inputs.h>
#include <exemplar/run/state_review.h>

#include <iomanip>
#include <iostream>
#include <memory>
#include <numeric>
#include <sstream>
#include <unistd.h>

namespace Exemplar
{
  namespace
  {
    void
    warn(const std::string &warning)
    {
      std::cerr << "Warning: " << message_text(warning) << std::endl;
    }

    /// What all processes say, or the root for all.
    void
    warn_at_root(const std::vector<std::string> &warnings)
    {
      for (const std::string &warning : warnings)
        if (MpiSession::is_root())
          warn(warning);
    }

    /// Tells what takes a while before a run begins.
    Announce
    announcer(const bool quiet)
    {
      if (quiet)
        return {};
      return [](const std::string &what)
      { std::cout << "          " << message_text(what) << " ..." << std::endl; };
    }

    std::unique_ptr<Problem>
    make_problem_and_warn(SceneParameters    parameters,
                          const RunOptions  &options,
                          const unsigned int n_threads = 1)
    {
      parameters.solver.n_threads    = n_threads;
      parameters.mesh.allow_commands = options.allow_commands;
      const Announce announce        = announcer(options.quiet || !MpiSession::is_root());
      auto           problem
          = MpiSession::n_processes() == 1
                ? make_problem(parameters, announce)
                : make_problem(
                    parameters,
                    ReadInputs([&](const SceneParameters &scene)
                               { return read_shared_inputs(scene, MPI_COMM_WORLD, announce); }));
      warn_at_root(problem->warnings());
      return problem;
    }

    /// How mesh and poses became, if they are made of surfaces.
    std::string
    made_text(const MadeOfSurfaces *made)
    {
      std::string text;
      if (made != nullptr)
        for (const std::string &line : lines_of(*made))
          text += "          " + message_text(line) + '\n';
      return text;
    }

    std::string
    processes_text(const unsigned int n)
    {
      return n == 1 ? "" : std::to_string(n) + " processes of ";
    }

    void
    print_header(const Problem &problem)
    {
      const BlasInfo  blas     = blas_info();
      const Exchange &exchange = problem.body.exchange();
      const auto      n_nodes  = exchange.n_nodes(problem.body.fe_space.n_nodes());
      const auto      n_free   = exchange.sum(problem.constraints.free_dofs.size());
      if (!exchange.is_root())
        return;
      std::cout << "Scene     " << printable(problem.parameters.name) << '\n'
                << "Mesh      " << printable(problem.body.mesh.get_name()) << ": "
                << problem.body.mesh.whole().n_cells
                << (problem.parameters.model.element == Element::P1 ? " cells, "
                                                                    : " quadratic cells, ")
                << n_nodes << " nodes, " << static_cast<unsigned int>(n_free) << " of "
                << 3 * n_nodes << " dofs free\n"
                << made_text(problem.body.made.get()) << "Examples  ";
      if (problem.examples.poses != nullptr)
        std::cout << problem.examples.poses->size() << ", importance "
                  << problem.examples.poses->importance() << '\n';
      else
        std::cout << "none\n";
      std::cout << "Solver    " << method_name(problem.parameters.solver.method) << ", "
                << problem.system.bordered().traits().name << ", " << problem.time_axis.n_steps()
                << " steps; " << processes_text(exchange.n_processes())
                << problem.parameters.solver.n_threads
                << (problem.parameters.solver.n_threads == 1 ? " thread" : " threads") << "; BLAS "
                << blas.library << ' ' << blas.core << '\n';
      std::cout << "Output    " << problem.parameters.output.directory << std::endl;
    }

    void
    print_times(const RunTotals &totals)
    {
      const PartSeconds &seconds = totals.seconds;
      const double       total   = std::accumulate(seconds.begin(), seconds.end(), 0.);
      std::cout << "\nWhere the time went\n" << std::fixed;
      for (unsigned int part = 0; part < n_parts; ++part)
        std::cout << "  " << std::left << std::setw(12) << part_names[part] << std::right
                  << std::setw(9) << std::setprecision(3) << seconds[part] << " s " << std::setw(5)
                  << std::setprecision(1) << 100. * seconds[part] / total << " %\n";
      std::cout << "  " << std::left << std::setw(12) << "total" << std::right << std::setw(9)
                << std::setprecision(3) << total << " s\n"
                << totals.iterations << " iterations, " << totals.factorizations
                << " factorisations" << std::endl;
    }

    /// What is known of the errors of the steps and, if it was asked for, of the mesh.
    void
    print_errors(const Problem &problem, const RunWriter &writer)
    {
      if (!writer.get_space_error())
        return;
      const SpaceError       &space  = *writer.get_space_error();
      const SolverParameters &solver = problem.parameters.solver;
      std::ostringstream      text;
      text << "Errors\n  steps       residual up to " << std::setprecision(2)
           << writer.get_totals().worst_residual;
      if (solver.method == Method::quasi_newton)
        text << ", positions to " << solver.step_tolerance << " of a step";
      text << "\n  space       " << std::fixed << std::setprecision(1);
      if (!space.failure.empty())
        text << "no estimate: " << space.failure;
      else
      {
        text << "displacement " << 100. * space.displacement << " %, energy " << 100. * space.energy
             << " %";
        if (space.weights)
          text << ", weights " << std::setprecision(3) << *space.weights;
      }
      std::cout << text.str() << std::endl;
    }

    std::string
    note(const SolveReport &report)
    {
      std::ostringstream text;
      text << report.iterations << (report.iterations == 1 ? " iteration" : " iterations")
           << ", residual " << std::setprecision(2) << report.residual;
      return text.str();
    }

    /// A line for what an iteration has come to.
    void
    print_iteration(const Problem &problem, const SolveReport &report)
    {
      std::ostringstream line;
      line << "step " << problem.state.step + 1 << ", iteration " << report.iterations
           << std::scientific << std::setprecision(2) << ": residual " << report.residual;
      if (!problem.state.multipliers.empty())
        line << ", weights' " << report.kkt_residual;
      if (report.step_length < 1.)
        line << ", step halved to " << report.step_length;
      if (report.convexity > 0.)
        line << ", tangent convex by " << report.convexity;
      std::cout << line.str() << std::endl;
    }

    void
    run_steps(Problem &problem, RunWriter &writer, Progress &progress, StateReview &review)
    {
      while (problem.state.step < problem.time_axis.n_steps())
      {
        if (problem.body.exchange().any(is_interrupted()))
          throw Interrupted("Interrupted.");
        const SolveReport report = problem.advance();
        writer.add_step(report);
        if (!is_success(report.status))
        {
          writer.finish(status_name(report.status));
          progress.finish();
          MpiSession::wait_for_all(); // while the root writes
          throw SolverFailure(problem.failure_message(report));
        }
        StepClock::Scope scope(problem.clock, Part::output);
        review.add_step();
        progress.update(problem.state.step, note(report));
      }
    }

    void
    run_to_end(Problem &problem, RunWriter &writer, Progress &progress, StateReview &review)
    {
      try
      {
        run_steps(problem, writer, progress, review);
      }
      catch (const Interrupted &)
      {
        progress.finish();
        writer.finish("interrupted");
        MpiSession::wait_for_all(); // while the root writes
        throw Interrupted("Interrupted after step " + std::to_string(problem.state.step)
                          + ". Go on with --resume.");
      }
      progress.finish();
      writer.finish(status_name(problem.parameters.solver.method == Method::one_pass
                                    ? SolveStatus::one_pass
                                    : SolveStatus::converged));
    }
  } // namespace

  void
  run_scene(const RunOptions &options)
  {
    const SceneFile scene(options.scene_file, options.overrides);
    MpiSession::require_same(scene.get_text(), "reads another scene than",
                             "Let all machines see the same files.");
    const auto problem = make_problem_and_warn(scene.get_parameters(), options, options.n_threads);
    RunWriter  writer(*problem, scene);
    is_interrupted(); // from now on a signal waits until the run has written what it has
    try
    {
      if (options.resume_from)
        warn_at_root(writer.resume_from(*options.resume_from));
      else if (options.resume)
        writer.resume();
      else
        writer.begin();
    }
    catch (const std::filesystem::filesystem_error &error)
    {
      throw UserError(std::string("The output directory cannot be used: ") + error.what()
                      + ". Give another one by --output or Output/Directory.");
    }
    if (const std::string warning = blas_warning(); !warning.empty())
      warn_at_root({ warning });
    const Exchange &exchange = problem->body.exchange();
    const bool      is_quiet = options.quiet || !exchange.is_root();
    if (!options.quiet)
    {
      StepClock::Scope scope(problem->clock, Part::output);
      print_header(*problem);
    }

    problem->solver->observe = [&](const SolveReport &report)
    {
      if (options.verbose && exchange.is_root())
        print_iteration(*problem, report);
      return !exchange.any(is_interrupted());
    };
    Progress    progress(std::cout, isatty(STDOUT_FILENO) != 0, is_quiet || options.verbose,
                         problem->state.step, problem->time_axis.n_steps());
    StateReview review(*problem);
    try
    {
      run_to_end(*problem, writer, progress, review);
    }
    catch (const UserError &error) // files have been written, so it is not refused any more
    {
      throw std::runtime_error(error.what());
    }
    warn_at_root(review.warnings());
    if (!is_quiet)
    {
      print_times(writer.get_totals());
      print_errors(*problem, writer);
    }
  }

  void
  validate_scene(const RunOptions &options)
  {
    const SceneFile scene(options.scene_file, options.overrides);
    const auto      problem = make_problem_and_warn(scene.get_parameters(), options);
    const RunWriter writer(*problem, scene); // may find that frames cannot show the surface
    std::cout << printable(options.scene_file.string()) << ": valid; "
              << problem->body.mesh.n_cells() << " cells, " << problem->body.mesh.n_nodes()
              << " nodes, " << problem->time_axis.n_steps() << " steps" << std::endl;
  }

  void
  print_parameters()
  {
    std::cout << "# All parameters of exemplar with their defaults.\n"
              << "# Subsections NAME and region N stand for as many as a scene names; N is a "
                 "material id or\n"
              << "# the name of a Physical Volume.\n\n";
    print_keys(std::cout, SceneFile::reference(), true);
  }
} // namespace Exemplar
