// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/output_directory.h>
#include <exemplar/run/run_directory.h>

#include <algorithm>

namespace Exemplar
{
  namespace fs = std::filesystem;

  const std::string RunDirectory::mark = "# exemplar: all parameters in force";

  namespace
  {
    const std::string remedy = " Give another one by --output or Output/Directory.";
  } // namespace

  RunDirectory::RunDirectory(fs::path path, const std::vector<FrameFormat> &formats)
      : path(std::move(path)), formats(formats)
  {
  }

  bool
  RunDirectory::is_own_name(const std::string &name) const
  {
    const fs::path file
        = path / (fs::path(name).extension() == ".tmp" ? fs::path(name).stem() : fs::path(name));
    return file == original_prm() || file == parameters_prm() || file == statistics()
           || file == summary() || file == final_pose() || file == checkpoint()
           || std::any_of(formats.begin(), formats.end(),
                          [&](const FrameFormat &format)
                          { return format.owns(file.filename().string()); });
  }

  bool
  RunDirectory::is_ours() const
  {
    return begins_with(parameters_prm(), mark);
  }

  std::vector<fs::path>
  RunDirectory::own_files() const
  {
    std::vector<fs::path> files;
    for (const auto &entry : fs::directory_iterator(path))
      if (is_own_name(entry.path().filename().string()))
        files.push_back(entry.path());
    return files;
  }

  void
  RunDirectory::check_for_new_run(const std::vector<fs::path> &input_files) const
  {
    require_writable(path, remedy);
    if (!fs::exists(path) || fs::is_empty(path))
      return;
    if (!is_ours())
      throw UserError("Output directory " + path.string()
                      + " is not empty and was not written by exemplar." + remedy);
    for (const fs::path &own : own_files())
      for (const fs::path &input : input_files)
        if (fs::exists(input) && fs::equivalent(own, input))
          throw UserError("Output directory " + path.string() + " holds the input file "
                          + input.string() + ", which this run would clear away." + remedy);
  }

  void
  RunDirectory::clear() const
  {
    make_directory(path, remedy);
    for (const fs::path &file : own_files())
      if (file != parameters_prm())
        fs::remove(file);
    fs::remove(parameters_prm()); // last: by it the directory is known as ours
  }
} // namespace Exemplar
