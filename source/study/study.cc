// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/median.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/progress.h>
#include <exemplar/base/words.h>
#include <exemplar/run/output/final_pose.h>
#include <exemplar/run/output/run_directory.h>
#include <exemplar/run/scene/scene_file.h>
#include <exemplar/study/study.h>
#include <exemplar/study/study_directory.h>
#include <exemplar/study/study_plan.h>
#include <exemplar/study/study_report.h>
#include <exemplar/study/study_runs.h>
#include <exemplar/study/study_table.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <unistd.h>

namespace Exemplar
{
  namespace
  {
    namespace fs = std::filesystem;

    /// Fills rows with the results of runs on disk.
    class RowMaker
    {
    public:
      RowMaker(const StudyPlan &plan, const StudyRuns &runs)
          : plan(plan), runs(runs), columns(plan.study.columns), probe(plan.study.probe)
      {
        if (!plan.reference || !runs.record(plan.reference->name).succeeded())
          return;
        reference = std::make_unique<const FinalPose>(final_pose(*plan.reference));
        reference_energy
            = read_run_statistics(RunFiles{ runs.path(plan.reference->name) }.statistics()).energy;
      }

      StudyRow
      make(const PlannedRun &planned)
      {
        const StudyRecord &record    = runs.record(planned.name);
        const fs::path     directory = runs.path(planned.name);
        StudyRow           row;
        row.choice      = planned.choice;
        row.status      = record.status;
        row.exit_status = record.exit_status;
        row.message     = record.message;
        row.run         = planned.name;
        row.statistics  = read_run_statistics(RunFiles{ directory }.statistics());
        row.summary     = read_run_summary(RunFiles{ directory }.summary());
        row.extra       = read_last_values(RunFiles{ directory }.statistics(), columns);
        if (record.status != "refused")
        {
          row.seconds.median  = median(record.seconds);
          row.seconds.minimum = *std::min_element(record.seconds.begin(), record.seconds.end());
        }
        row.extra.resize(columns.size() + (probe ? 3 : 0), std::nan(""));
        if (record.succeeded())
          compare(planned, row);
        return row;
      }

    private:
      FinalPose
      final_pose(const PlannedRun &run)
      {
        const SceneFile scene(plan.study.scene, plan.scene_text, run.assignments);
        return poses.read(scene, runs.path(run.name));
      }

      void
      compare(const PlannedRun &planned, StudyRow &row)
      {
        const FinalPose pose = final_pose(planned);
        row.max_displacement = pose.max_displacement();
        for (unsigned int c = 0; probe && c < 3; ++c)
          row.extra[columns.size() + c] = pose.displacement_near(*probe)[c];
        if (reference == nullptr)
          return;
        row.errors = pose_errors(pose, *reference);
        if (reference_energy != 0.)
          row.error_energy
              = std::abs(row.statistics.energy - reference_energy) / std::abs(reference_energy);
      }

      const StudyPlan                       &plan;
      const StudyRuns                       &runs;
      FinalPoseReader                        poses;
      const std::vector<std::string>        &columns;
      const std::optional<dealii::Point<3>> &probe;
      std::unique_ptr<const FinalPose>       reference; ///< null if there is none
      double                                 reference_energy = 0.;
    };

    std::string
    values_text(const Study &study, const std::vector<unsigned int> &choice)
    {
      std::string text;
      for (unsigned int a = 0; a < choice.size(); ++a)
        text += (a == 0 ? "" : ", ") + study.axes[a].text(choice[a]);
      return text.empty() ? "reference" : text;
    }

    unsigned int
    count_done(const StudyPlan &plan, const StudyRuns &runs)
    {
      unsigned int n = plan.reference && runs.is_done(plan.reference->name, 1) ? 1 : 0;
      for (const PlannedRun &run : plan.runs)
        for (unsigned int repeat = 1; repeat <= plan.study.repeats; ++repeat)
          n += runs.is_done(run.name, repeat) ? 1 : 0;
      return n;
    }

    /// Throws SolverFailure if the reference has failed, without which no other run has an error.
    void
    require_reference(const StudyPlan &plan, const StudyRuns &runs)
    {
      const StudyRecord &record = runs.record(plan.reference->name);
      if (record.succeeded())
        return;
      throw SolverFailure("The reference run has ended with the status " + record.status
                          + ", so the errors of the other runs could not be computed. "
                          + record.message
                          + " Change Reference: a Solver/Tolerance of 1e-9 is small enough for "
                            "most studies. Or leave it out, then the runs are not compared.");
    }

    /// Make the reference, then the first repeat of all runs, then the second, so that a temporary
    /// slowdown of the machine does not affect all repeats of one run.
    void
    make_runs(const StudyPlan &plan, StudyRuns &runs, const StudyOptions &options)
    {
      Progress   progress(std::cout, isatty(STDOUT_FILENO) != 0, options.quiet,
                          count_done(plan, runs), plan.n_repeats(), "run");
      const auto make = [&](const PlannedRun &run, const unsigned int repeat)
      {
        if (runs.is_done(run.name, repeat))
          return;
        if (options.stop && options.stop())
          throw Interrupted("Interrupted.");
        const StudyRecord &record = runs.run(run);
        progress.update(count_done(plan, runs),
                        values_text(plan.study, run.choice) + ": " + record.status);
      };
      try
      {
        if (plan.reference)
        {
          make(*plan.reference, 1);
          require_reference(plan, runs);
        }
        for (unsigned int repeat = 1; repeat <= plan.study.repeats; ++repeat)
          for (const PlannedRun &run : plan.runs)
            make(run, repeat);
      }
      catch (const SolverFailure &)
      {
        progress.finish();
        throw;
      }
      catch (const Interrupted &)
      {
        progress.finish();
        throw Interrupted(fmt::format(
            "Interrupted after {} of {} runs. The same command goes on with the others.",
            count_done(plan, runs), plan.n_repeats()));
      }
      progress.finish();
    }

    void
    print_header(const StudyPlan &plan, const StudyRuns &runs, const StudyDirectory &directory)
    {
      const unsigned int n_done   = count_done(plan, runs);
      const std::size_t  n_others = runs.others(plan.names()).size();
      std::cout << "Study     " << plan.study.file.string() << '\n'
                << "Scene     " << plan.study.scene.string() << '\n'
                << "Runs      " << counted(plan.runs.size(), "combination") << ", "
                << counted(plan.n_repeats(), "run") << " with repeats"
                << (plan.reference ? " and the reference" : "") << '\n';
      if (n_done > 0)
        std::cout << "          " << n_done << " of them are there from an earlier call\n";
      if (n_others > 0)
        std::cout << "          " << n_others
                  << " others are there, of other settings, inputs or another program: they are "
                     "not used, and removed at the end\n";
      std::cout << "Output    " << directory.get_path().string() << std::endl;
    }

    void
    warn(const std::string &warning)
    {
      if (!warning.empty())
        std::cerr << "Warning: " << message_text(warning) << std::endl;
    }

    void
    warn_of(const StudyPlan &plan)
    {
      for (const std::string &warning : plan.warnings)
        warn(warning);
    }

    void
    warn_of_empty_columns(const StudyTable &table)
    {
      for (unsigned int i = 0; i < table.extra_columns.size(); ++i)
        if (std::all_of(table.rows.begin(), table.rows.end(),
                        [&](const StudyRow &row) { return std::isnan(row.extra[i]); }))
          warn("No run has a value in the column " + table.extra_columns[i]
               + ". The first line of a run's statistics.csv names those that there are.");
    }

    StudyTable
    make_table(const StudyPlan &plan, const StudyRuns &runs)
    {
      StudyTable table{
        plan.study.axes, {}, plan.reference.has_value(), extra_columns_of(plan.study)
      };
      RowMaker rows(plan, runs);
      for (const PlannedRun &run : plan.runs)
        table.rows.push_back(rows.make(run));
      warn_of_empty_columns(table);
      return table;
    }

    /// Remove runs of other settings, inputs or programs, except those that hold foreign files.
    void
    remove_others(const StudyPlan &plan, const StudyRuns &runs)
    {
      for (const fs::path &other : runs.others(plan.names()))
        try
        {
          runs.remove(other);
        }
        catch (const UserError &error)
        {
          warn(error.what());
        }
    }

    void
    print_end(const StudyTable &table, const StudyDirectory &directory)
    {
      std::map<std::string, std::vector<std::string>> messages; // by status
      for (const StudyRow &row : table.rows)
        messages[row.status].push_back(row.message);
      std::cout << '\n';
      for (const auto &[status, all] : messages)
        std::cout << all.size() << ' ' << status
                  << (all[0].empty() ? "" : ": " + message_text(all[0])) << '\n';
      std::cout << "The tables are in " << directory.markdown().string() << " and "
                << directory.csv().string();
      if (fs::exists(directory.svg()))
        std::cout << ", the figure in " << directory.svg().string();
      std::cout << std::endl;
    }
  } // namespace

  void
  run_study(const StudyOptions &options)
  {
    const Study     study(options.file);
    const StudyPlan plan(study);
    warn_of(plan);
    StudyDirectory directory(options.output.empty() ? fs::path("output") / options.file.stem()
                                                    : options.output);
    std::optional<StudyRuns> kept_runs;
    try
    {
      directory.take(plan.named_files);
      kept_runs.emplace(directory.runs(), study, options);
      kept_runs->require_room_for(plan.names());
    }
    catch (const fs::filesystem_error &error)
    {
      throw UserError("The output directory cannot be used: " + trouble_with_path(error)
                      + ". Give another one by --output.");
    }
    directory.write_study(study.text);

    StudyRuns &runs = *kept_runs;
    if (!options.quiet)
      print_header(plan, runs, directory);
    directory.remove_results();
    runs.empty_scratch();
    make_runs(plan, runs, options);

    const StudyTable table = make_table(plan, runs);
    write_study_csv(table, directory.csv());
    write_study_report(study, table, directory.markdown());
    warn(plot_study(table, options.file.stem().string(), directory));
    remove_others(plan, runs);
    if (!options.quiet)
      print_end(table, directory);
  }

  void
  validate_study(const fs::path &file)
  {
    const Study     study(file);
    const StudyPlan plan(study);
    warn_of(plan);
    std::cout << file.string() << ": valid; " << counted(plan.runs.size(), "combination") << ", "
              << counted(plan.n_repeats(), "run") << " with repeats"
              << (plan.reference ? " and the reference" : "") << std::endl;
  }

  void
  print_study_parameters()
  {
    std::cout << "# All keys of a study with their defaults.\n\n";
    print_keys(std::cout, study_keys(), true);
  }
} // namespace Exemplar
