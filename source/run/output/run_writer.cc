// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/agreement.h>
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/digest.h>
#include <exemplar/base/errors.h>
#include <exemplar/run/output/resume_checks.h>
#include <exemplar/run/output/run_writer.h>
#include <exemplar/run/output/summary.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace Exemplar
{
  namespace fs = std::filesystem;

  namespace
  {
    /// Empty the cells of a failed step but for its report: the problem is still in the state
    /// before the step, and its forces are those of the last attempt, so neither belongs there.
    void
    keep_only_report(StatisticsRow &row)
    {
      for (StatisticsCell &cell : row)
        if (!cell.is_of_report)
          cell.value = std::monostate();
    }

    /// Throws SolverFailure if a number is not finite.
    void
    require_numbers(const StatisticsRow &row)
    {
      for (const StatisticsCell &cell : row)
        if (const double *const number = std::get_if<double>(&cell.value);
            number != nullptr && !std::isfinite(*number))
          throw SolverFailure("Step " + row.front().text() + " failed: its " + cell.column
                              + " is not a finite number. Take smaller steps, and look at what "
                                "handles, loads and Initial do.");
    }
  } // namespace

  RunWriter::RunWriter(Problem                        &problem,
                       const SceneFile                &scene,
                       const std::vector<FrameFormat> &formats)
      : problem(problem), exchange(problem.body.exchange()), scene(scene), diagnostics(problem),
        directory(problem.parameters.output.directory, formats),
        input_digests(exchange.is_root() ? digests_of(scene)
                                         : std::map<std::string, std::string>()),
        last_checkpoint(std::chrono::steady_clock::now()), frames(problem, directory, formats),
        estimator(problem)
  {
  }

  void
  RunWriter::at_root(const std::function<void()> &action) const
  {
    do_at_root(exchange,
               [&]
               {
                 directory.require_taken();
                 action();
               });
  }

  void
  RunWriter::begin()
  {
    const auto inputs = [&]
    {
      auto files = scene.named_files();
      files.push_back(scene.get_path());
      return files;
    };
    {
      StepClock::Scope scope(problem.clock, Phase::output);
      at_root(
          [&]
          {
            directory.take_for_new_run(inputs());
            totals.first_scene = digest_of(scene, input_digests);
            write_parameters(totals.edits);
            write_original();
            write_rest_mesh();
            statistics.emplace(directory.statistics());
            frames.write_shapes();
          });
      watch_directory();
      if (frames.is_due(0))
        write_frame();
      write_row(diagnostics.row(problem.state, SolveReport()), {}, true);
      save(); // so that a crash before the first interval can be resumed, too
      keep_state();
    }
    end_reading();
    lap();
  }

  void
  RunWriter::watch_directory()
  {
    if (!exchange.is_root())
      directory.watch();
  }

  void
  RunWriter::write_row(StatisticsRow                      row,
                       const std::optional<PhaseSeconds> &seconds,
                       const bool                         is_of_state)
  {
    at_root(
        [&]
        {
          Diagnostics::append_seconds(row, seconds);
          statistics->write(row);
          if (is_of_state)
            accepted_bytes = statistics->n_bytes();
        });
  }

  void
  RunWriter::end_reading()
  {
    problem.clock.switch_to(Phase::evaluate);
  }

  void
  RunWriter::write_parameters(const std::vector<SceneEdit> &edits) const
  {
    AtomicFile atomic_file(directory.parameters_prm());
    atomic_file.stream() << RunDirectory::mark << '\n';
    for (const SceneEdit &edit : edits)
      atomic_file.stream() << "# after step " << edit.step << "; the scene before is "
                           << edit.before << '\n';
    print_keys(atomic_file.stream(), scene.get_keys(), false);
    atomic_file.commit();
  }

  void
  RunWriter::write_original() const
  {
    AtomicFile file(directory.original_prm());
    file.stream() << scene.get_text();
    file.commit();
  }

  void
  RunWriter::write_rest_mesh() const
  {
    if (problem.parameters.mesh.is_surface())
      problem.body.mesh.write_pose(problem.body.mesh.contents_of_whole().nodes,
                                   directory.rest_mesh());
  }

  PhaseSeconds
  RunWriter::lap()
  {
    const PhaseSeconds now = problem.clock.read();
    PhaseSeconds       seconds;
    for (unsigned int phase = 0; phase < n_phases; ++phase)
    {
      seconds[phase] = now[phase] - last_lap[phase];
      totals.seconds[phase] += seconds[phase];
    }
    last_lap = now;
    return seconds;
  }

  void
  RunWriter::add_step(const SolveReport &report)
  {
    const bool       accepted = is_success(report.status);
    StepClock::Scope scope(problem.clock, Phase::output);

    totals.iterations += report.iterations;
    totals.factorizations = earlier_factorizations + problem.system.n_factorizations();
    totals.worst_residual = std::max(totals.worst_residual, report.residual);

    space_error.reset();
    if (accepted)
      diagnostics.add_step();
    State shown = problem.state;
    if (!accepted) // the problem stands before the step that failed
    {
      ++shown.step;
      shown.time = problem.time_axis.time(shown.step);
    }
    StatisticsRow row = diagnostics.row(shown, report);
    if (!accepted)
      keep_only_report(row);
    else
      require_numbers(row);
    if (accepted && frames.is_due(problem.state.step))
      write_frame();
    write_row(std::move(row), lap(), accepted);
    if (accepted)
      keep_state();

    const std::chrono::duration<double> since = std::chrono::steady_clock::now() - last_checkpoint;
    const bool is_time = since.count() > 60. * problem.parameters.output.checkpoint_minutes;
    if (accepted && exchange.any(exchange.is_root() && is_time))
      save();
  }

  void
  RunWriter::write_frame()
  {
    find_space_error();
    frames.write(space_error);
  }

  bool
  RunWriter::is_last_step() const
  {
    return problem.state.step == problem.time_axis.n_steps();
  }

  void
  RunWriter::find_space_error()
  {
    const SpaceErrorUse use          = problem.parameters.output.space_error;
    const unsigned int  step         = problem.state.step;
    const bool          is_asked_for = use != SpaceErrorUse::never
                              && (step == problem.time_axis.n_steps()
                                  || (use == SpaceErrorUse::in_frames && frames.is_due(step)));
    if (is_asked_for && !space_error)
      space_error = estimator.estimate();
  }

  void
  RunWriter::finish(const std::string &status, const std::vector<std::string> &warnings)
  {
    {
      StepClock::Scope scope(problem.clock, Phase::output);
      frames.drain();
      write_final_pose();
      save(); // whatever happens to animations and estimates
      if (is_last_step())
        find_space_error();
      else
        space_error.reset();
      at_root([&] { frames.write_animations(); });
    }
    lap();
    at_root([] {}); // the directory is still there
    const auto mesh_digest = input_digests.find(problem.parameters.mesh.file);
    write_summary(problem, totals, space_error,
                  mesh_digest != input_digests.end() ? mesh_digest->second : "generated", status,
                  warnings, directory.summary());
  }

  void
  RunWriter::write_final_pose() const
  {
    const bool   is_linear = problem.parameters.output.final_pose == FinalTetrahedra::linear;
    const Vector positions = whole(exchange, problem.state.positions);
    const Mesh  &mesh      = problem.body.mesh;
    at_root(
        [&]
        {
          std::vector<dealii::Point<3>> nodes(is_linear ? mesh.whole().n_nodes
                                                        : positions.size() / 3);
          for (unsigned int dof = 0; dof < 3 * nodes.size(); ++dof)
            nodes[dof / 3][dof % 3] = positions[dof];
          mesh.write_pose(nodes, directory.final_pose());
        });
  }

  void
  RunWriter::save()
  {
    frames.drain(); // because a resumed run does not write them again
    last_checkpoint             = std::chrono::steady_clock::now();
    const Checkpoint checkpoint = present();
    at_root([&] { save_checkpoint(checkpoint, directory.checkpoint()); });
  }

  void
  RunWriter::keep_state() const
  {
    if (!problem.parameters.output.keep_states || !frames.is_due(problem.state.step))
      return;
    const Checkpoint checkpoint = present();
    at_root([&] { save_checkpoint(checkpoint, directory.state(problem.state.step)); });
  }

  Checkpoint
  RunWriter::present() const
  {
    std::string digest;
    at_root([&] { digest = sha256_of_begin(directory.statistics(), accepted_bytes); });
    return { values_of(scene),
             input_digests,
             whole(problem.body.mesh, problem.state),
             problem.solver_memory(),
             diagnostics.get_work(),
             totals,
             accepted_bytes,
             digest };
  }
} // namespace Exemplar
