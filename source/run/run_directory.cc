// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/output_directory.h>
#include <exemplar/run/run_directory.h>

#include <algorithm>
#include <regex>

namespace Exemplar
{
  namespace fs = std::filesystem;

  const std::string RunDirectory::mark = "# exemplar: all parameters in force";

  namespace
  {
    const std::string remedy = " Give another one by --output or Output/Directory.";

    bool
    is_own_name(const std::string &name)
    {
      static const std::regex pattern(
          "(frame_[0-9]+\\.vtu|animation\\.pvd|final\\.msh|statistics\\.csv|"
          "summary\\.json|original\\.prm|parameters\\.prm|checkpoint\\.bin)"
          "(\\.tmp)?");
      return std::regex_match(name, pattern);
    }
  } // namespace

  RunDirectory::RunDirectory(fs::path path) : path(std::move(path)) {}

  std::string
  RunDirectory::frame_name(const unsigned int step)
  {
    const std::string digits = std::to_string(step);
    return "frame_" + std::string(digits.size() < 4 ? 4 - digits.size() : 0, '0') + digits + ".vtu";
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
