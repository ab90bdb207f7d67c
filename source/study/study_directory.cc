// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/errors.h>
#include <exemplar/run/output/output_directory.h>
#include <exemplar/study/study_directory.h>
#include <exemplar/study/study_runs.h>

#include <algorithm>
#include <fstream>
#include <utility>

namespace Exemplar
{
  namespace fs = std::filesystem;

  namespace
  {
    /// The first line of study.prm, which marks directories of studies.
    const std::string mark = "# exemplar: the study of this directory";

    const std::string remedy = " Give another one by --output.";

    /// Whether the file is empty or has the fixed columns of study.csv; its first columns vary.
    bool
    has_head_of_table(const fs::path &file)
    {
      const std::string end = ",exit_status,run,message";
      std::ifstream     in(file);
      std::string       head;
      std::getline(in, head);
      return head.empty()
             || (head.size() > end.size()
                 && head.compare(head.size() - end.size(), end.size(), end) == 0);
    }

    /// Whether the file is, or lies in, a run of a study, its scratch or a log.
    bool
    is_of_a_run(const fs::path &file, const fs::path &runs)
    {
      const fs::path inner
          = fs::weakly_canonical(file).lexically_relative(fs::weakly_canonical(runs));
      if (inner.empty())
        return false;
      const std::string first = inner.begin()->string();
      return first == StudyRuns::scratch_name || fs::path(first).extension() == ".log"
             || RunNames::is_name(first);
    }
  } // namespace

  StudyDirectory::StudyDirectory(fs::path path) : path(std::move(path)) {}

  bool
  StudyDirectory::is_ours() const
  {
    return fs::is_regular_file(fs::symlink_status(study_prm())) && begins_with(study_prm(), mark);
  }

  void
  StudyDirectory::refuse_directory_of_others() const
  {
    // a study killed before its first file was complete leaves only the temporary
    const bool has_only_temporaries = std::all_of(
        fs::directory_iterator(path), fs::directory_iterator(),
        [&](const auto &entry) { return entry.path() == AtomicFile::temporary_of(study_prm()); });
    if (!is_ours() && !has_only_temporaries)
      throw UserError("Output directory " + path.string()
                      + " is not empty and holds no study of exemplar." + remedy);
  }

  void
  StudyDirectory::refuse_what_is_foreign() const
  {
    const auto refuse = [&](const fs::path &file, const std::string &objection)
    {
      if (!objection.empty())
        throw UserError(
            "Output directory " + path.string() + " holds " + file.filename().string() + ", which "
            + objection
            + ", but a study writes a file of this name. Nothing has been removed. Move "
              "it away, or give another directory by --output.");
    };
    const auto require = [&](const fs::path &file, const std::string &beginning)
    {
      if (!is_absent(file))
        refuse(file, objection_to(file, beginning));
    };
    const std::vector<std::pair<fs::path, std::string>> files
        = { { study_prm(), mark + "\n" },
            { csv(), "" },
            { markdown(), "# Study " },
            { gnuplot(), "# Drawn by exemplar" } };
    for (const auto &[file, beginning] : files)
    {
      require(file, beginning);
      require(AtomicFile::temporary_of(file), beginning);
    }
    for (const fs::path &table : { csv(), AtomicFile::temporary_of(csv()) })
      if (!is_absent(table) && !has_head_of_table(table))
        refuse(table, "was not written by exemplar");
    require(svg(), "<?xml ");
    if (!is_absent(runs()) && !fs::is_directory(runs()))
      throw UserError("Output directory " + path.string() + " holds runs, which is no directory."
                      + remedy);
    require(runs() / "running.log", "");
    require(runs() / "gnuplot.log", "");
  }

  void
  StudyDirectory::refuse_inputs(const std::set<fs::path> &input_files) const
  {
    const fs::path files[] = { study_prm(), csv(), markdown(), svg(), gnuplot() };
    for (const fs::path &input : input_files)
      if (fs::exists(input)
          && (is_of_a_run(input, runs())
              || std::any_of(std::begin(files), std::end(files),
                             [&](const fs::path &file)
                             { return fs::exists(file) && fs::equivalent(file, input); })))
        throw UserError("Output directory " + path.string() + " holds the input file "
                        + input.string() + " where this study writes or removes files." + remedy);
  }

  void
  StudyDirectory::take(const std::set<fs::path> &input_files)
  {
    require_writable(path, remedy);
    make_directory(path, remedy);
    taken = std::make_unique<const DirectoryLock>(
        path, "Another study is running in the output directory " + path.string() + "." + remedy);
    refuse_directory_of_others();
    refuse_inputs(input_files);
    refuse_what_is_foreign();
    if (!is_ours())
      write_study(""); // first, as it marks the directory
    fs::create_directories(runs());
  }

  void
  StudyDirectory::write_study(const std::string &study_text) const
  {
    AtomicFile file(study_prm());
    file.stream() << mark << '\n' << study_text;
    file.commit();
  }

  void
  StudyDirectory::remove_results() const
  {
    for (const fs::path &file : { csv(), markdown(), svg(), gnuplot() })
      fs::remove(file);
  }
} // namespace Exemplar
