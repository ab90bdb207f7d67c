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
    /// Empty a failed step's cells except those of its report: the problem's state is that before
    /// the step, but its forces are of the last attempt.
    void
    keep_only_report(StatisticsRow &row)
    {
      for (StatisticsCell &cell : row)
        if (!cell.is_of_report)
          cell.value = std::monostate();
    }

    /// Digests of the input files at the root; empty elsewhere.
    std::map<std::string, std::string>
    digests_at_root(const SceneFile &scene, const Exchange &exchange)
    {
      std::map<std::string, std::string> digests;
      do_at_root(exchange, [&] { digests = digests_of(scene); });
      return digests;
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
      : problem(problem), exchange(problem.body.exchange()), scene(scene),
        diagnostics(problem, Diagnostics::Columns::of_beginning),
        directory(problem.parameters.output.directory, formats),
        input_digests(digests_at_root(scene, exchange)), account(problem.clock),
        last_checkpoint(std::chrono::steady_clock::now()), frames(problem, directory, formats),
        space_error(problem)
  {
    require_functional(problem);
  }

  void
  RunWriter::at_root(const std::function<void()> &action) const
  {
    do_at_root(exchange, [&] { directory.do_inside(action); });
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
            RunTotals totals;
            totals.first_scene = digest_of(scene, input_digests);
            account.take_over(totals);
            write_parameters({});
            write_original();
            write_rest_mesh();
            statistics.emplace(directory.get_files().statistics());
            frames.write_shapes();
          });
      directory.watch();
      if (frames.is_due(0))
        write_frame();
      write_row(diagnostics.row(problem.state, SolveReport()), {}, true);
      save(); // for crashes before the first interval has passed
      keep_state();
    }
    account.begin_steps();
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
  RunWriter::write_parameters(const std::vector<SceneEdit> &edits) const
  {
    AtomicFile atomic_file(directory.get_files().parameters_prm());
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
    AtomicFile file(directory.get_files().original_prm());
    file.stream() << scene.get_text();
    file.commit();
  }

  void
  RunWriter::write_rest_mesh() const
  {
    if (problem.parameters.mesh.is_surface())
      problem.body.mesh.write_pose(problem.body.mesh.contents_of_whole().nodes,
                                   directory.get_files().rest_mesh());
  }

  void
  RunWriter::add_step(const SolveReport &report)
  {
    const bool       accepted = is_success(report.status);
    StepClock::Scope scope(problem.clock, Phase::output);

    account.add_step(report, problem.system.n_factorizations());
    space_error.forget();
    if (accepted)
      diagnostics.add_step();
    StatisticsRow row;
    if (accepted)
    {
      row = diagnostics.row(problem.state, report);
      require_numbers(row);
    }
    else // the problem stands before the step that failed
    {
      State shown = problem.state;
      ++shown.step;
      shown.time = problem.time_axis.time(shown.step);
      row        = diagnostics.row(shown, report);
      keep_only_report(row);
    }
    if (accepted && frames.is_due(problem.state.step))
      write_frame();
    write_row(std::move(row), account.lap(), accepted);
    if (accepted)
      keep_state();

    const std::chrono::duration<double> since = std::chrono::steady_clock::now() - last_checkpoint;
    bool                                is_time = false; // by the root's clock
    Exemplar::at_root(
        exchange,
        [&] { is_time = since.count() > 60. * problem.parameters.output.checkpoint_minutes; });
    if (accepted && exchange.any(is_time))
      save();
  }

  void
  RunWriter::write_frame()
  {
    space_error.find(frames.is_due(problem.state.step));
    frames.write(space_error.get());
  }

  void
  RunWriter::finish(const std::string &status, const std::vector<std::string> &warnings)
  {
    LastEstimates last;
    {
      StepClock::Scope scope(problem.clock, Phase::output);
      frames.drain();
      write_final_pose();
      save(); // before animations and estimates, which may fail
      space_error.find_at_end();
      last = { space_error.get(), functional_at_end(problem) };
      at_root([&] { frames.write_animations(); });
    }
    account.lap();
    at_root([] {}); // throws if the directory is gone
    write_summary(problem, get_totals(), last, mesh_digest(), status, warnings,
                  directory.get_files().summary());
  }

  std::string
  RunWriter::mesh_digest() const
  {
    const MeshParameters &mesh = problem.parameters.mesh;
    std::string           all;
    for (const std::string &file : mesh.files)
      if (const auto found = input_digests.find(file); found != input_digests.end())
        all += found->second + "\n";
    if (!all.empty())
      return sha256_of_text(all);
    const auto found = input_digests.find(mesh.file);
    return found != input_digests.end() ? found->second : "generated";
  }

  void
  RunWriter::write_final_pose() const
  {
    const bool   is_linear = problem.parameters.output.final_pose == FinalTetrahedra::linear;
    const Mesh  &mesh      = problem.body.mesh;
    const bool   has_tips  = problem.body.fe_space.numbering().has_slopes();
    const Vector positions
        = has_tips ? problem.body.fe_space.with_tips(
              problem.state.positions, problem.constraints.held_tips, problem.state.history)
                   : whole(exchange, problem.state.positions);
    at_root(
        [&]
        {
          std::vector<dealii::Point<3>> nodes(is_linear && !has_tips ? mesh.whole().n_nodes
                                                                     : positions.size() / 3);
          for (unsigned int dof = 0; dof < 3 * nodes.size(); ++dof)
            nodes[dof / 3][dof % 3] = positions[dof];
          mesh.write_pose(nodes, directory.get_files().final_pose());
        });
  }

  void
  RunWriter::save()
  {
    frames.drain(); // a resumed run does not write them again
    last_checkpoint             = std::chrono::steady_clock::now();
    const Checkpoint checkpoint = present();
    at_root([&] { save_checkpoint(checkpoint, directory.get_files().checkpoint()); });
  }

  void
  RunWriter::keep_state() const
  {
    if (!problem.parameters.output.keep_states || !frames.is_due(problem.state.step))
      return;
    const Checkpoint checkpoint = present();
    at_root([&] { save_checkpoint(checkpoint, directory.get_files().state(problem.state.step)); });
  }

  Checkpoint
  RunWriter::present() const
  {
    std::string digest;
    at_root([&] { digest = sha256_of_begin(directory.get_files().statistics(), accepted_bytes); });
    return { values_of(scene),
             input_digests,
             whole(problem.body.mesh, problem.state),
             problem.solver_memory(),
             diagnostics.get_work(),
             get_totals(),
             accepted_bytes,
             digest };
  }
} // namespace Exemplar
