// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/digest.h>
#include <exemplar/base/environment.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/run/results.h>
#include <exemplar/run/summary.h>

#include <algorithm>
#include <utility>

namespace Exemplar
{
  namespace fs = std::filesystem;

  namespace
  {
    std::map<std::string, std::string>
    values_of(const SceneFile &scene)
    {
      std::map<std::string, std::string> values;
      for (const DeclaredKey &key : scene.get_keys())
        values[key.path()] = key.value;
      return values;
    }

    std::map<std::string, std::string>
    digests_of(const SceneFile &scene)
    {
      std::map<std::string, std::string> digests;
      for (const fs::path &file : scene.input_files())
        digests[file.string()] = sha256(file);
      return digests;
    }

    bool
    may_change(const std::string &key)
    {
      return key == "Time/End" || key.compare(0, 7, "Output/") == 0;
    }

    /// A resumed run may end later and write differently; all else must be the same.
    void
    check_same_scene(const Checkpoint                         &checkpoint,
                     const SceneFile                          &scene,
                     const std::map<std::string, std::string> &input_digests,
                     const fs::path                           &file)
    {
      const std::string failure = "Cannot resume from " + file.string() + ": ";
      const std::string remedy
          = " Change it back, or run the scene without --resume. Only Time/End "
            "and the section Output may change.";
      const std::string absent   = "(absent)";
      const auto        value_in = [&](const auto &values, const std::string &key)
      {
        const auto entry = values.find(key);
        return entry == values.end() ? absent : entry->second;
      };
      const auto now  = values_of(scene);
      auto       both = now;
      both.insert(checkpoint.parameters.begin(), checkpoint.parameters.end());
      for (const auto &entry : both)
      {
        const std::string &key    = entry.first;
        const std::string  before = value_in(checkpoint.parameters, key);
        const std::string  after  = value_in(now, key);
        if (before != after && !may_change(key))
          throw UserError(failure + key + " was '" + before + "' and is now '" + after + "'."
                          + remedy);
      }
      for (const auto &[input, digest] : input_digests)
        if (value_in(checkpoint.input_digests, input) != digest)
          throw UserError(failure + "the file " + input + " has changed since." + remedy);
    }

    /// The row of a failed step: neither its forces nor the state before would be true.
    void
    keep_only_report(StatisticsRow &row)
    {
      for (auto &[column, value] : row)
        if (column != "step" && column != "time" && column != "status" && column != "iterations"
            && column != "residual")
          value.clear();
    }

    /// What a frame shows, independent of the problem that goes on.
    struct Frame
    {
      fs::path               file;
      dealii::Vector<double> positions;
      dealii::Vector<double> displacement;
      dealii::Vector<double> velocities; ///< empty unless dynamic
      CellResults            cells;
    };

    void
    write(const Frame &frame, const VtuWriter &writer)
    {
      VtuFields fields;
      fields.point_vectors.emplace_back("displacement", &frame.displacement);
      if (frame.velocities.size() > 0)
        fields.point_vectors.emplace_back("velocity", &frame.velocities);
      fields.cell_scalars = { { "strain_energy_density", &frame.cells.strain_energy_density },
                              { "det_F", &frame.cells.det_F },
                              { "von_mises_stress", &frame.cells.von_mises_stress } };
      writer.write(frame.file, frame.positions, fields);
    }

    void
    write_parameters(const SceneFile &scene, const fs::path &file)
    {
      AtomicFile atomic_file(file);
      atomic_file.stream() << RunDirectory::mark << '\n';
      print_keys(atomic_file.stream(), scene.get_keys(), false);
      atomic_file.commit();
    }
  } // namespace

  Results::Results(Problem &problem, const SceneFile &scene)
      : problem(problem), scene(scene), diagnostics(problem),
        directory(problem.parameters.output.directory), input_digests(digests_of(scene)),
        last_checkpoint(std::chrono::steady_clock::now()),
        vtu_writer(problem.parameters.output.every > 0
                       ? std::make_unique<const VtuWriter>(problem.body.mesh)
                       : nullptr),
        background(problem.parameters.solver.n_threads > 1)
  {
  }

  void
  Results::begin()
  {
    auto inputs = scene.input_files();
    inputs.push_back(scene.get_path());
    directory.check_for_new_run(inputs);

    {
      StepClock::Scope scope(problem.clock, Part::output);
      directory.clear();
      write_parameters(scene, directory.parameters_prm());
      write_original();
      statistics.emplace(directory.statistics());
      if (is_frame(0))
        write_frame();
      StatisticsRow row = diagnostics.row(problem.state, SolveReport());
      Diagnostics::append_seconds(row, {});
      statistics->write(row);
      accepted_bytes = statistics->n_bytes();
      save(); // so that a crash before the first interval can be resumed, too
    }
    end_reading();
    lap();
  }

  void
  Results::resume()
  {
    const Checkpoint checkpoint = load_checkpoint(directory.checkpoint());
    check_same_scene(checkpoint, scene, input_digests, directory.checkpoint());
    const State &state = checkpoint.state;
    if (state.step > problem.time_axis.n_steps()
        || state.time != problem.time_axis.time(state.step))
      throw UserError("Cannot resume from " + directory.checkpoint().string()
                      + ": it stands at t = " + shortest_text(state.time)
                      + ", which is no step of a run to Time/End = "
                      + shortest_text(problem.parameters.time.end)
                      + ". Choose a later end, or run the scene without --resume.");
    {
      StepClock::Scope scope(problem.clock, Part::output);
      statistics.emplace(directory.statistics(), checkpoint.statistics_bytes);
      write_original();
      write_parameters(scene, directory.parameters_prm());
    }
    const auto earlier_every = checkpoint.parameters.find("Output/Every");
    const bool was_only_last = earlier_every != checkpoint.parameters.end()
                               && state.step % std::max(1, std::stoi(earlier_every->second)) != 0;
    if (was_only_last && !is_frame(state.step)) // the run now ends later
      fs::remove(directory.get_path() / RunDirectory::frame_name(state.step));
    restore(checkpoint, directory.checkpoint(), problem);
    diagnostics.resume(checkpoint.work);
    accepted_bytes         = checkpoint.statistics_bytes;
    totals                 = checkpoint.totals;
    earlier_factorizations = totals.factorizations;
    end_reading();
    last_lap = problem.clock.read();
    for (unsigned int part = 0; part < n_parts; ++part)
      totals.seconds[part] += last_lap[part];
  }

  void
  Results::end_reading()
  {
    problem.clock.switch_to(Part::evaluate);
  }

  void
  Results::write_original() const
  {
    AtomicFile file(directory.original_prm());
    file.stream() << scene.get_text();
    file.commit();
  }

  PartSeconds
  Results::lap()
  {
    const PartSeconds now = problem.clock.read();
    PartSeconds       seconds;
    for (unsigned int part = 0; part < n_parts; ++part)
    {
      seconds[part] = now[part] - last_lap[part];
      totals.seconds[part] += seconds[part];
    }
    last_lap = now;
    return seconds;
  }

  void
  Results::add_step(const SolveReport &report)
  {
    const bool       accepted = is_success(report.status);
    StepClock::Scope scope(problem.clock, Part::output);

    totals.iterations += report.iterations;
    totals.factorizations = earlier_factorizations + problem.system.n_factorizations();
    totals.worst_residual = std::max(totals.worst_residual, report.residual);

    if (accepted)
      diagnostics.add_step();
    if (accepted && is_frame(problem.state.step))
      write_frame();
    State shown = problem.state;
    if (!accepted) // the row of a step that failed has its number and time
    {
      ++shown.step;
      shown.time = problem.time_axis.time(shown.step);
    }
    StatisticsRow row = diagnostics.row(shown, report);
    if (!accepted)
      keep_only_report(row);
    Diagnostics::append_seconds(row, lap());
    statistics->write(row);
    if (accepted)
      accepted_bytes = statistics->n_bytes();

    const std::chrono::duration<double> since = std::chrono::steady_clock::now() - last_checkpoint;
    if (accepted && since.count() > 60. * problem.parameters.output.checkpoint_minutes)
      save();
  }

  void
  Results::finish(const std::string &status)
  {
    {
      StepClock::Scope scope(problem.clock, Part::output);
      background.drain();
      write_final_pose();
      if (problem.parameters.output.every > 0)
        write_animation();
      save();
    }
    lap();
    const auto mesh_digest = input_digests.find(problem.parameters.mesh.file);
    write_summary(problem, totals,
                  mesh_digest != input_digests.end() ? mesh_digest->second : "generated", status,
                  directory.summary());
  }

  bool
  Results::is_frame(const unsigned int step) const
  {
    const unsigned int every = problem.parameters.output.every;
    return every > 0 && (step % every == 0 || step == problem.time_axis.n_steps());
  }

  void
  Results::write_frame()
  {
    const State &state = problem.state;
    Frame frame = { directory.get_path() / RunDirectory::frame_name(state.step), state.positions,
                    state.positions, state.velocities,
                    problem.potential.get_cells().cell_results(state.positions, state.weights) };
    frame.displacement -= problem.body.fe_space.rest_positions();
    background.submit([frame = std::move(frame), &writer = *vtu_writer] { write(frame, writer); });
  }

  void
  Results::write_final_pose() const
  {
    std::vector<dealii::Point<3>> nodes(problem.body.mesh.n_nodes());
    for (unsigned int dof = 0; dof < problem.body.fe_space.n_dofs(); ++dof)
      nodes[dof / 3][dof % 3] = problem.state.positions[dof];
    problem.body.mesh.write_pose(nodes, directory.final_pose());
  }

  void
  Results::write_animation() const
  {
    std::vector<std::pair<double, std::string>> frames;
    // every step, as Output/Every may have changed at a resume
    for (unsigned int step = 0; step <= problem.state.step; ++step)
      if (const std::string name = RunDirectory::frame_name(step);
          fs::exists(directory.get_path() / name))
        frames.emplace_back(problem.time_axis.time(step), name);
    write_pvd(directory.animation(), frames);
  }

  void
  Results::save()
  {
    background.drain(); // a resumed run writes no frame anew
    last_checkpoint = std::chrono::steady_clock::now();
    save_checkpoint({ values_of(scene), input_digests, problem.state, problem.solver_memory(),
                      diagnostics.get_work(), totals, accepted_bytes },
                    directory.checkpoint());
  }
} // namespace Exemplar
