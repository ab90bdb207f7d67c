// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/environment.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/launcher.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/progress.h>
#include <exemplar/program/commands.h>
#include <exemplar/program/interrupt.h>
#include <exemplar/program/joint_run.h>
#include <exemplar/program/run_log.h>
#include <exemplar/program/taken_examples.h>
#include <exemplar/run/inputs/shared_body.h>
#include <exemplar/run/output/run_directory.h>
#include <exemplar/run/output/run_writer.h>
#include <exemplar/run/problem/idle_review.h>
#include <exemplar/run/problem/motion_review.h>
#include <exemplar/run/problem/obstacle_start.h>
#include <exemplar/run/problem/problem.h>
#include <exemplar/run/problem/scene_review.h>
#include <exemplar/run/problem/state_review.h>
#include <exemplar/run/problem/unit_review.h>

#include <fmt/core.h>

#include <iostream>
#include <memory>
#include <unistd.h>

namespace Exemplar
{
  namespace
  {
    /// Announces slow preparations of a run.
    Announce
    announcer(const bool quiet)
    {
      if (quiet)
        return {};
      return [&out = JointRun::group().of_root(std::cout)](const std::string &what)
      { out << "          " << message_text(what) << " ..." << std::endl; };
    }

    std::unique_ptr<Problem>
    make_problem_and_warn(CompleteScene      parameters,
                          const RunOptions  &options,
                          RunLog            &log,
                          const unsigned int n_threads = 1)
    {
      parameters.solver.n_threads    = n_threads;
      parameters.mesh.allow_commands = options.allow_commands;
      const Announce announce        = announcer(options.quiet);
      auto           problem
          = JointRun::group().n_processes == 1
                ? make_problem(parameters, announce)
                : make_problem(
                    parameters,
                    ReadBody([&](const CompleteScene &scene)
                             { return read_shared_body(scene, MPI_COMM_WORLD, announce); }));
      log.warn(problem->warnings());
      log.warn(unit_warnings(*problem));
      log.warn(scene_warnings(*problem));
      log.warn(motion_warnings(*problem, options.resume || options.resume_from));
      log.warn(idle_load_warnings(*problem));
      return problem;
    }

    /// Begin or continue in the output directory, and keep the log there.
    void
    take_directory(const RunOptions &options,
                   const Problem    &problem,
                   RunWriter        &writer,
                   RunLog           &log)
    {
      try
      {
        if (options.resume_from)
          log.warn(writer.resume_from(*options.resume_from));
        else if (options.resume)
          writer.resume();
        else
          writer.begin();
        if (options.resume_from || options.resume)
          log.say(resumption_text(problem));
        log.keep_in(RunFiles{ problem.parameters.output.directory }.log());
      }
      catch (const std::filesystem::filesystem_error &error)
      {
        throw UserError("The output directory cannot be used: " + trouble_with_path(error)
                        + ". Give another one by --output or Output/Directory.");
      }
    }

    /// Whether lines can be overwritten. Processes of mpirun seem to have a terminal, but their
    /// output is mixed and often goes to a file.
    bool
    is_terminal()
    {
      return isatty(STDOUT_FILENO) != 0 && find_launch().program.empty();
    }

    /// Write all results after a failed step, and throw SolverFailure with the cause.
    [[noreturn]] void
    end_with_failure(const Problem     &problem,
                     const SolveReport &report,
                     RunWriter         &writer,
                     RunLog            &log)
    {
      const std::string message = problem.failure_message(report);
      log.note(message_text(message) + '\n');
      writer.finish(status_name(report.status), log.get_warnings());
      JointRun::group().wait_for_all(); // while the root writes
      throw SolverFailure(message);
    }

    void
    run_steps(Problem       &problem,
              RunWriter     &writer,
              RunLog        &log,
              Progress      &progress,
              StateReview   &review,
              TakenExamples &taken)
    {
      while (problem.state.step < problem.time_axis.n_steps())
      {
        if (problem.body.exchange().any(is_interrupted()))
          throw Interrupted("Interrupted.");
        progress.go_on("");
        const SolveReport report = problem.advance();
        writer.add_step(report);
        if (!is_success(report.status))
          end_with_failure(problem, report, writer, log);
        StepClock::Scope scope(problem.clock, Phase::output);
        review.add_step(report);
        taken.add_step();
        progress.update(problem.state.step, progress_text(report));
      }
    }

    void
    run_to_end(Problem       &problem,
               RunWriter     &writer,
               RunLog        &log,
               Progress      &progress,
               StateReview   &review,
               TakenExamples &taken)
    {
      try
      {
        run_steps(problem, writer, log, progress, review, taken);
      }
      catch (const Interrupted &)
      {
        const std::string message = fmt::format("Interrupted after step {}.", problem.state.step);
        log.note(message + '\n');
        writer.finish("interrupted", log.get_warnings());
        JointRun::group().wait_for_all(); // while the root writes
        throw Interrupted(message + " Go on with --resume.");
      }
      progress.finish();
      log.warn(review.warnings());
      log.warn(missed_example_warnings(problem));
      log.warn(idle_obstacle_warnings(problem));
      if (const std::string starts = starts_text(problem); !starts.empty())
        log.say(starts);
      writer.finish(status_name(problem.parameters.solver.method == Method::one_pass
                                    ? SolveStatus::one_pass
                                    : SolveStatus::converged),
                    log.get_warnings());
    }
  } // namespace

  void
  run_scene(const RunOptions &options)
  {
    const SceneFile scene(options.scene_file, options.overrides);
    JointRun::require_same(scene.get_text(), "reads another scene than",
                           "Let all machines see the same files.");
    RunLog     log(options.quiet);
    const auto problem
        = make_problem_and_warn(scene.get_parameters(), options, log, options.n_threads);
    RunWriter writer(*problem, scene);
    is_interrupted(); // signals wait until results are written from now on
    take_directory(options, *problem, writer, log);
    for (const std::string &warning : { blas_warning(), instruction_set_warning() })
      if (!warning.empty())
        log.warn(warning);
    {
      StepClock::Scope scope(problem->clock, Phase::output);
      log.say(header_text(*problem));
    }

    std::ostream &out = JointRun::group().of_root(std::cout);
    Progress progress(out, is_terminal(), options.quiet || options.verbose, problem->state.step,
                      problem->time_axis.n_steps());
    problem->solver->observe = [&](const SolveReport &report)
    {
      progress.go_on(progress_text(report));
      if (options.verbose)
        out << iteration_text(*problem, report) << std::flush;
      return !problem->body.exchange().any(is_interrupted());
    };
    StateReview   review(*problem);
    TakenExamples taken(*problem);
    try
    {
      run_to_end(*problem, writer, log, progress, review, taken);
    }
    catch (const UserError &error) // after writing files it is no refusal
    {
      throw std::runtime_error(error.what());
    }
    log.say(closing_text(*problem, writer) + taken.text());
  }

  void
  validate_scene(const RunOptions &options)
  {
    const SceneFile scene(options.scene_file, options.overrides);
    RunLog          log(options.quiet);
    const auto      problem = make_problem_and_warn(scene.get_parameters(), options, log);
    const RunWriter writer(*problem, scene); // may throw if frames cannot show the surface
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
