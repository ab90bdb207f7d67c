// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_study_runs_h
#define exemplar_study_runs_h

#include <exemplar/study/study.h>
#include <exemplar/study/study_file.h>

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Outcome of a run over all its repeats.
  struct StudyRecord
  {
    std::string         status; ///< as in summary.json, or refused, crash or timeout
    int                 exit_status = 0;
    std::string         message; ///< the program's message on a failure
    std::vector<double> seconds; ///< of each repeat
    double              timeout = 0.;

    bool
    succeeded() const
    {
      return exit_status == 0;
    }
  };

  /// A run of the plan.
  struct PlannedRun
  {
    std::string               name; ///< hash of all data that the results depend on
    std::vector<unsigned int> choice;
    std::vector<Assignment>   assignments;
  };

  /// Names of runs: 16 digits of the SHA-256 of the program, the scene, the settings and the input
  /// files. A change of any of them gives another name, so that results never mix.
  class RunNames
  {
  public:
    explicit RunNames(const Study &study, const std::string &scene_text);

    std::string
    name(const std::vector<Assignment>            &assignments,
         const std::vector<std::filesystem::path> &input_files);

    /// Whether a text has the form of a name.
    static bool
    is_name(const std::string &name);

  private:
    const std::string                  common;
    std::map<std::string, std::string> digests; ///< of input files
  };

  /// The directory `runs`: each run in a directory of its name, with its log and record.
  class StudyRuns
  {
  public:
    /// The directory in which the current run is made.
    static const std::string scratch_name;

    /// Takes the settings for runs from `options`.
    StudyRuns(std::filesystem::path directory, const Study &study, const StudyOptions &options);

    /// Throws UserError if a run's place is taken by files that no run has left.
    void
    require_room_for(const std::vector<std::string> &names) const;

    /// Whether `repeats` repeats exist. Failed runs are not repeated.
    bool
    is_done(const std::string &name, unsigned int repeats) const;

    /// Run once more, in a process of its own. Throws Interrupted, with the run as before.
    const StudyRecord &
    run(const PlannedRun &planned);

    const StudyRecord &
    record(const std::string &name) const
    {
      return records.at(name);
    }

    /// The directory of a run.
    std::filesystem::path
    path(const std::string &name) const
    {
      return directory / name;
    }

    /// Runs on disk that are not among `names`.
    std::vector<std::filesystem::path>
    others(const std::vector<std::string> &names) const;

    /// Remove a run's files. Throws UserError, with nothing removed, if there are other files.
    void
    remove(const std::filesystem::path &run) const;

    /// Remove the remains of a study that was killed while making or removing a run.
    void
    empty_scratch() const;

  private:
    /// Read the record of a run on disk.
    void
    load(const std::string &name);

    /// Run in the directory scratch(); returns the record of one repeat.
    StudyRecord
    run_in_scratch(const PlannedRun &planned) const;

    std::filesystem::path
    scratch() const
    {
      return directory / scratch_name;
    }

    const std::filesystem::path        directory;
    const Study                       &study;
    const std::function<bool()>        stop;
    const RunProgram                   run_program;
    std::map<std::string, StudyRecord> records;
  };
} // namespace Exemplar

#endif
