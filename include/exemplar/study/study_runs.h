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
  /// How a run ended, over all its repeats.
  struct StudyRecord
  {
    std::string         status; ///< the program's word, or refused, crash or timeout
    int                 exit_status = 0;
    std::string         message; ///< what the program said of a failure
    std::vector<double> seconds; ///< of each repeat
    double              timeout = 0.;

    bool
    succeeded() const
    {
      return exit_status == 0;
    }
  };

  /// A run to be made.
  struct PlannedRun
  {
    std::string               name; ///< follows from all that the results depend on
    std::vector<unsigned int> choice;
    std::vector<Assignment>   assignments;
  };

  /// Names of runs: 16 digits of the SHA-256 of the program, the scene, the settings and the
  /// input files. A change of any of them gives another name, so results never mix.
  class RunNames
  {
  public:
    explicit RunNames(const Study &study, const std::string &scene_text);

    std::string
    name(const std::vector<Assignment>            &assignments,
         const std::vector<std::filesystem::path> &input_files);

    /// Whether a name is one of these.
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
    /// The name of the directory in which a run is made.
    static const std::string scratch_name;

    /// What `options` say of runs.
    StudyRuns(std::filesystem::path directory, const Study &study, const StudyOptions &options);

    /// Throws UserError if something stands where a run is to be made that no run has left.
    void
    require_room_for(const std::vector<std::string> &names) const;

    /// Whether as many repeats are there as are asked for. What fails is not repeated.
    bool
    is_done(const std::string &name, unsigned int repeats) const;

    /// Run once more, in a process of its own. Throws Interrupted, and the run is as it was.
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

    /// Runs that are there, but not among `names`.
    std::vector<std::filesystem::path>
    others(const std::vector<std::string> &names) const;

    /// Remove what a run has left. Throws UserError, with nothing removed, if there is something else, too.
    void
    remove(const std::filesystem::path &run) const;

    /// Remove what a study has left that was killed while it made or removed a run.
    void
    empty_scratch() const;

  private:
    /// Read the record that an earlier call has left.
    void
    load(const std::string &name);

    /// Run in the directory `scratch()`; its record, with one repeat.
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
