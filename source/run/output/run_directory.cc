// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/output/output_directory.h>
#include <exemplar/run/output/run_directory.h>

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <map>
#include <regex>
#include <stdexcept>

namespace Exemplar
{
  namespace fs = std::filesystem;

  const std::string RunDirectory::mark     = "# exemplar: all parameters in force";
  const std::string RunDirectory::log_mark = "exemplar: what the run has said";

  namespace
  {
    const std::string remedy = " Give another one by --output or Output/Directory.";

    /// Whether this is a temporary file, not yet renamed.
    bool
    is_temporary(const std::string &name)
    {
      return fs::path(name).extension() == ".tmp";
    }

    /// The step of the file of a kept state.
    std::optional<unsigned int>
    step_of_state(const std::string &name)
    {
      static const std::regex pattern("state_([0-9]{4}|[1-9][0-9]{4,8})\\.bin");
      std::smatch             parts;
      if (!std::regex_match(name, parts, pattern))
        return std::nullopt;
      return static_cast<unsigned int>(std::stoul(parts[1]));
    }

    /// The name without the number that copies of earlier scenes have, otherwise unchanged.
    std::string
    without_number(const std::string &name)
    {
      static const std::regex pattern(
          "(original|parameters|statistics)_[1-9][0-9]{0,5}(\\.prm|\\.csv)");
      return std::regex_replace(name, pattern, "$1$2");
    }

    /// Files that exist once in a run, with their beginnings; empty: any beginning.
    const std::map<std::string, std::string> &
    single_files()
    {
      static const std::map<std::string, std::string> files
          = { { "parameters.prm", RunDirectory::mark + "\n" },
              { "log.txt", RunDirectory::log_mark + "\n" },
              { "original.prm", "" }, // as the user wrote it
              { "statistics.csv", "step,time,status," },
              { "summary.json", "{\n  \"program\": \"exemplar\"" },
              { "final.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" },
              { "rest.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" },
              { "checkpoint.bin", "exemplar checkpoint " } };
      return files;
    }

    /// The surface at rest or in the pose of an example.
    bool
    is_shape(const std::string &name)
    {
      static const std::regex shape("(rest|weight_[0-9]+(_[0-9]+)?)(_.+)?\\.obj");
      return std::regex_match(name, shape);
    }
  } // namespace

  RunDirectory::RunDirectory(fs::path path, const std::vector<FrameFormat> &formats)
      : files{ std::move(path) }, formats(formats)
  {
  }

  std::optional<std::string>
  RunDirectory::beginning_of(const std::string &name) const
  {
    if (is_temporary(name))
      return beginning_of(fs::path(name).stem().string());
    if (step_of_state(name))
      return single_files().at("checkpoint.bin");
    if (const auto found = single_files().find(without_number(name)); found != single_files().end())
      return found->second;
    if (is_shape(name))
      return "# a shape by exemplar\n";
    for (const FrameFormat &format : formats)
      if (auto beginning = format.beginning_of(name))
        return beginning;
    return std::nullopt;
  }

  std::string
  RunDirectory::objection_to(const std::string &name) const
  {
    const auto beginning = beginning_of(name);
    return beginning ? Exemplar::objection_to(get_path() / name, *beginning) : "no run writes";
  }

  bool
  RunDirectory::is_ours() const
  {
    return fs::is_regular_file(fs::symlink_status(files.parameters_prm()))
           && begins_with(files.parameters_prm(), mark);
  }

  std::vector<std::string>
  RunDirectory::own_names() const
  {
    std::vector<std::string> names;
    for (const auto &entry : fs::directory_iterator(get_path()))
      if (const std::string name = entry.path().filename().string(); beginning_of(name))
        names.push_back(name);
    std::sort(names.begin(), names.end()); // so that messages do not depend on the file system
    return names;
  }

  void
  RunDirectory::lock()
  {
    taken = std::make_unique<const DirectoryLock>(
        get_path(), "Another run is writing into the output directory " + get_path().string()
                        + ". Wait for its end or stop it." + remedy);
  }

  void
  RunDirectory::watch()
  {
    if (taken == nullptr)
      watched = std::make_unique<const OpenDirectory>(get_path());
  }

  void
  RunDirectory::require_in_place() const
  {
    if ((taken != nullptr && !taken->is_in_place())
        || (watched != nullptr && !watched->is_in_place()))
      throw std::runtime_error(
          "The output directory " + get_path().string()
          + " has been removed or replaced while the run was writing into it.");
  }

  void
  RunDirectory::do_inside(const std::function<void()> &action) const
  {
    require_in_place();
    try
    {
      action();
    }
    catch (...)
    {
      require_in_place();
      throw;
    }
  }

  void
  RunDirectory::refuse_inputs(const std::vector<std::string> &names,
                              const std::vector<fs::path>    &input_files,
                              const std::string              &what_would_happen) const
  {
    for (const std::string &name : names)
      for (const fs::path &input : input_files)
        if (fs::exists(get_path() / name) && fs::exists(input)
            && fs::equivalent(get_path() / name, input))
          throw UserError("Output directory " + get_path().string() + " holds the input file "
                          + input.string() + ", which this run would " + what_would_happen + "."
                          + remedy);
  }

  void
  RunDirectory::refuse_directory_of_others(const std::vector<std::string> &names) const
  {
    const auto n_files
        = std::distance(fs::directory_iterator(get_path()), fs::directory_iterator());
    // a run killed before its first file was complete leaves only the temporary
    const bool has_only_temporaries = static_cast<std::size_t>(n_files) == names.size()
                                      && std::all_of(names.begin(), names.end(), is_temporary);
    if (!is_ours() && !has_only_temporaries)
      throw UserError(
          "Output directory " + get_path().string()
          + (fs::exists(get_path() / "study.prm") && fs::is_directory(get_path() / "runs")
                 ? " holds a study."
                 : " is not empty and was not written by exemplar.")
          + remedy);
  }

  std::string
  RunDirectory::refusal_of(const std::string &name, const std::string &objection) const
  {
    return "Output directory " + get_path().string() + " holds " + name + ", which " + objection
           + ", but a run writes a file of this name.";
  }

  void
  RunDirectory::take_for_new_run(const std::vector<fs::path> &input_files)
  {
    require_writable(get_path(), remedy);
    make_directory(get_path(), remedy);
    lock();
    const std::vector<std::string> names = own_names();
    refuse_directory_of_others(names);
    refuse_inputs(names, input_files, "clear away");
    for (const std::string &name : names)
      if (const std::string objection = objection_to(name); !objection.empty())
        throw UserError(refusal_of(name, objection)
                        + " Nothing has been removed. Move it away, or give another directory by "
                          "--output or Output/Directory.");
    clear();
  }

  void
  RunDirectory::take_for_resume(const std::vector<fs::path> &input_files)
  {
    if (!fs::is_directory(get_path()))
      return;
    lock();
    const std::vector<std::string> names = own_names();
    refuse_inputs(names, input_files, "replace");
    for (const std::string &name : names)
    {
      // these two are checked by their readers, with better messages
      const bool is_read
          = name == files.statistics().filename() || name == files.checkpoint().filename();
      const bool is_regular = fs::is_regular_file(fs::symlink_status(get_path() / name));
      if (const std::string objection = objection_to(name);
          !objection.empty() && !(is_read && is_regular))
        throw UserError(
            refusal_of(name, objection)
            + " Move it away, or run the scene without --resume into another directory.");
    }
  }

  void
  RunDirectory::remove_shapes() const
  {
    for (const std::string &name : own_names())
      if (is_shape(name) && objection_to(name).empty())
        fs::remove(get_path() / name);
  }

  void
  RunDirectory::remove_animations() const
  {
    for (const std::string &name : own_names())
      if (std::any_of(formats.begin(), formats.end(),
                      [&](const FrameFormat &format) { return format.is_animation(name); })
          && objection_to(name).empty())
        fs::remove(get_path() / name);
  }

  void
  RunDirectory::remove_frames_after(const unsigned int step) const
  {
    const auto is_later = [&](const std::string &name)
    {
      if (step_of_state(name).value_or(0) > step)
        return true;
      return std::any_of(formats.begin(), formats.end(),
                         [&](const FrameFormat &format)
                         { return format.step_of(name).value_or(0) > step; });
    };
    for (const std::string &name : own_names())
      if ((is_temporary(name) || is_later(name)) && objection_to(name).empty())
        fs::remove(get_path() / name);
  }

  fs::path
  RunFiles::state(const unsigned int step) const
  {
    return directory / fmt::format("state_{:04}.bin", step);
  }

  std::vector<unsigned int>
  RunDirectory::kept_states() const
  {
    std::vector<unsigned int> steps;
    for (const auto &entry : fs::directory_iterator(get_path()))
      if (const auto step = step_of_state(entry.path().filename().string()))
        steps.push_back(*step);
    std::sort(steps.begin(), steps.end());
    return steps;
  }

  std::string
  RunDirectory::keep_earlier_scene() const
  {
    const auto numbered = [&](const fs::path &file, const unsigned int number)
    {
      return get_path()
             / fmt::format("{}_{}{}", file.stem().string(), number, file.extension().string());
    };
    const std::array<fs::path, 3> kept{ { files.parameters_prm(), files.statistics(),
                                          files.original_prm() } };
    unsigned int                  number = 1;
    while (std::any_of(kept.begin(), kept.end(),
                       [&](const fs::path &file) { return !is_absent(numbered(file, number)); }))
      ++number;
    for (const fs::path &file : kept)
      fs::copy_file(file, numbered(file, number));
    return numbered(files.original_prm(), number).filename().string();
  }

  void
  RunDirectory::clear() const
  {
    fs::remove(files.checkpoint()); // first: an incomplete run cannot be resumed
    for (const std::string &name : own_names())
      if (get_path() / name != files.parameters_prm()) // replaced later, as it marks the directory
        fs::remove(get_path() / name);
  }
} // namespace Exemplar
