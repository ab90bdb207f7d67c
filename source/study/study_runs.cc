// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/digest.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/text_file.h>
#include <exemplar/run/output/output_directory.h>
#include <exemplar/run/output/run_directory.h>
#include <exemplar/study/study_runs.h>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstring>

namespace Exemplar
{
  namespace fs = std::filesystem;
  using Json   = nlohmann::ordered_json;

  namespace
  {
    const char *const program = "/proc/self/exe"; // valid also if the file has been replaced

    /// The object in a JSON file; empty if it is missing or damaged.
    Json
    read_json(const fs::path &file)
    {
      const auto text = read_text_file(file);
      const auto json = Json::parse(text.value_or(""), nullptr, false);
      return json.is_object() ? json : Json::object();
    }

    fs::path
    record_file(const fs::path &run)
    {
      return run / "record.json";
    }

    /// Why the directory of a run must not be removed, in words that follow its name; empty if it
    /// holds only files of a run in a study.
    std::string
    objection_to_removal(const fs::path &run)
    {
      if (!fs::is_directory(fs::symlink_status(run)))
        return "is no directory";
      static const std::map<std::string, std::string> of_studies
          = { { "record.json", "{\n  \"status\"" }, { "record.json.tmp", "" }, { "log.txt", "" } };
      const RunDirectory directory(run);
      for (const auto &entry : fs::directory_iterator(run))
      {
        const std::string name      = entry.path().filename().string();
        const auto        of_study  = of_studies.find(name);
        const std::string objection = of_study != of_studies.end()
                                          ? objection_to(entry.path(), of_study->second)
                                          : directory.objection_to(name);
        if (!objection.empty())
          return "holds " + name + ", which " + objection;
      }
      return "";
    }

    /// Throws UserError if foreign files are in a run's place.
    void
    require_removable(const fs::path &run)
    {
      if (is_absent(run))
        return;
      if (const std::string objection = objection_to_removal(run); !objection.empty())
        throw UserError(
            run.string() + " " + objection
            + ", but is where this study makes a run. Nothing of it has been removed. Move "
              "away what is yours, or give another directory by --output.");
    }

    /// Remove a run's files, if any. Throws UserError, with nothing removed, if there are other
    /// files.
    void
    remove_run(const fs::path &run)
    {
      require_removable(run);
      if (is_absent(run))
        return;
      fs::remove(record_file(run)); // first: an incomplete run must not count as done
      std::vector<fs::path> files;
      for (const auto &entry : fs::directory_iterator(run))
        files.push_back(entry.path());
      for (const fs::path &file : files)
        fs::remove(file);
      fs::remove(run);
    }

    /// Whether a study has made this directory of a run, even if it holds other files now.
    bool
    is_of_a_study(const fs::path &run)
    {
      return fs::is_directory(fs::symlink_status(run))
             && (fs::is_regular_file(fs::symlink_status(record_file(run)))
                 || RunDirectory(run).is_ours());
    }

    void
    write_record(const StudyRecord &record, const fs::path &file)
    {
      Json json;
      json["status"]      = record.status;
      json["exit_status"] = record.exit_status;
      json["message"]     = record.message;
      json["seconds"]     = record.seconds;
      json["timeout"]     = record.timeout;
      AtomicFile atomic_file(file);
      atomic_file.stream() << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
      atomic_file.commit();
    }

    /// The message of a failed program in one line; it is the last one in its log.
    std::string
    message_in(const fs::path &log)
    {
      const std::string text  = "\n" + read_text_file(log).value_or("");
      const std::string start = "\nexemplar: ";
      const auto        found = text.rfind(start);
      if (found == std::string::npos)
        return "";
      std::string message = trim(text.substr(found + start.size()));
      std::replace(message.begin(), message.end(), '\n', ' ');
      return message;
    }

    StudyRecord
    make_record(const ChildEnd &end, const Json &summary, const fs::path &log, const double timeout)
    {
      StudyRecord record;
      record.exit_status = end.exit_status;
      record.timeout     = timeout;
      record.message     = end.exit_status == 0 ? "" : message_in(log);
      if (!end.exceeded.empty() && end.signal != 0)
      {
        record.status  = "timeout";
        record.message = "Ended after " + end.exceeded + ", by the study's Timeout.";
      }
      else if (end.signal != 0)
      {
        record.status = "crash";
        record.message
            = fmt::format("Killed by signal {} ({}).", end.signal, strsignal(end.signal));
      }
      else if (end.exit_status == 1)
        record.status = "refused";
      else if (end.exit_status == 0 || end.exit_status == 2)
        record.status = summary.value("status", "failed");
      else
        record.status = "crash";
      return record;
    }

    /// Seconds of the time stepping alone: reading and set-up are the same for all methods, and
    /// writing depends on the disk.
    double
    seconds_of(const ChildEnd &end, const Json &summary)
    {
      if (!summary.contains("seconds"))
        return end.seconds;
      const Json &parts = summary.at("seconds");
      return parts.at("total").get<double>() - parts.at("read").get<double>()
             - parts.at("output").get<double>();
    }
  } // namespace

  RunNames::RunNames(const Study &study, const std::string &scene_text)
      : common(fmt::format(
          "{}\n{}\n{}\n{}", sha256(program), study.threads, study.scene.string(), scene_text))
  {
  }

  std::string
  RunNames::name(const std::vector<Assignment> &assignments,
                 const std::vector<fs::path>   &input_files)
  {
    std::string text = common;
    for (const Assignment &assignment : assignments)
      text += "\n" + assignment.path() + "=" + assignment.value;
    for (const fs::path &file : input_files)
    {
      std::string &digest = digests[file.string()];
      if (digest.empty())
        digest = fs::is_regular_file(file) ? sha256(file) : "absent";
      text += "\n" + file.string() + " " + digest;
    }
    return sha256_of_text(text).substr(0, 16);
  }

  bool
  RunNames::is_name(const std::string &name)
  {
    return name.size() == 16 && name.find_first_not_of("0123456789abcdef") == std::string::npos;
  }

  const std::string StudyRuns::scratch_name = "running";

  StudyRuns::StudyRuns(fs::path path, const Study &study, const StudyOptions &options)
      : directory(std::move(path)), study(study), stop(options.stop),
        run_program(options.run_program)
  {
    if (fs::exists(directory))
      for (const auto &entry : fs::directory_iterator(directory))
        load(entry.path().filename().string());
  }

  void
  StudyRuns::load(const std::string &name)
  {
    if (!fs::is_regular_file(fs::symlink_status(record_file(path(name)))))
      return;
    StudyRecord record;
    try
    {
      const Json json    = read_json(record_file(path(name)));
      record.status      = json.at("status");
      record.exit_status = json.at("exit_status");
      record.message     = json.at("message");
      record.seconds     = json.at("seconds").get<std::vector<double>>();
      record.timeout     = json.at("timeout");
    }
    catch (const Json::exception &)
    {
      return; // none, or of another version
    }
    if (record.seconds.empty())
      return; // not written by a study
    if (record.status == "timeout" && (study.timeout == 0. || study.timeout > record.timeout))
      return; // the timeout is longer now
    records[name] = record;
  }

  bool
  StudyRuns::is_done(const std::string &name, const unsigned int repeats) const
  {
    const auto found = records.find(name);
    return found != records.end()
           && (!found->second.succeeded() || found->second.seconds.size() >= repeats);
  }

  StudyRecord
  StudyRuns::run_in_scratch(const PlannedRun &planned) const
  {
    std::vector<std::string> command = {
      program,    study.scene.string(), "--quiet", "--threads", fmt::format("{}", study.threads),
      "--output", scratch().string()
    };
    for (const Assignment &assignment : planned.assignments)
      command.insert(command.end(), { "--set", assignment.path() + "=" + assignment.value });
    const fs::path log = directory / "running.log"; // a run needs its directory for itself

    remove_run(scratch());
    const ChildEnd end = run_program(command, log, study.timeout, stop);
    if (end.exit_status == 130)
      throw Interrupted("A run has been interrupted.");

    fs::create_directories(scratch());
    const RunFiles run{ scratch() };
    fs::rename(log, scratch() / "log.txt");
    fs::remove(run.checkpoint());
    const Json  summary = read_json(run.summary());
    StudyRecord record  = make_record(end, summary, scratch() / "log.txt", study.timeout);
    record.seconds      = { seconds_of(end, summary) };
    return record;
  }

  const StudyRecord &
  StudyRuns::run(const PlannedRun &planned)
  {
    StudyRecord now     = run_in_scratch(planned);
    const auto  earlier = records.find(planned.name);
    if (earlier != records.end() && earlier->second.succeeded())
    {
      // results are the same, unless the repeat was killed or timed out
      if (now.succeeded())
        earlier->second.seconds.push_back(now.seconds[0]);
      now = earlier->second;
      remove_run(scratch());
      write_record(now, record_file(path(planned.name)));
    }
    else
    {
      remove_run(path(planned.name));            // without a record, or of a shorter timeout
      write_record(now, record_file(scratch())); // first: a named run must be complete
      fs::rename(scratch(), path(planned.name));
    }
    return records[planned.name] = now;
  }

  std::vector<fs::path>
  StudyRuns::others(const std::vector<std::string> &names) const
  {
    std::vector<fs::path> found;
    if (fs::exists(directory))
      for (const auto &entry : fs::directory_iterator(directory))
        if (const std::string name = entry.path().filename().string();
            RunNames::is_name(name) && std::count(names.begin(), names.end(), name) == 0
            && is_of_a_study(entry.path()))
          found.push_back(entry.path());
    return found;
  }

  void
  StudyRuns::require_room_for(const std::vector<std::string> &names) const
  {
    require_removable(scratch());
    for (const std::string &name : names)
      if (records.count(name) == 0)
        require_removable(path(name));
  }

  void
  StudyRuns::remove(const fs::path &run) const
  {
    if (const std::string objection = objection_to_removal(run); !objection.empty())
      throw UserError(run.string() + " " + objection + ", and so it stays. Remove it by hand.");
    remove_run(scratch());
    fs::rename(run, scratch()); // atomically: a run is on disk completely or not at all
    remove_run(scratch());
  }

  void
  StudyRuns::empty_scratch() const
  {
    remove_run(scratch());
  }
} // namespace Exemplar
