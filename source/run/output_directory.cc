// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/output_directory.h>

#include <unistd.h>

#include <fstream>

namespace Exemplar
{
  namespace fs = std::filesystem;

  void
  require_writable(const fs::path &path, const std::string &remedy)
  {
    fs::path parent = fs::absolute(path);
    while (!fs::exists(parent))
      parent = parent.parent_path();
    if (!fs::is_directory(parent))
      throw UserError("Output directory " + path.string() + ": " + parent.string() + " is a file."
                      + remedy);
    if (access(parent.c_str(), W_OK | X_OK) != 0)
      throw UserError("Output directory " + path.string() + ": no right to write in "
                      + parent.string() + "." + remedy);
  }

  void
  make_directory(const fs::path &path, const std::string &remedy)
  {
    std::error_code error;
    fs::create_directories(path, error);
    if (error)
      throw UserError("Output directory " + path.string() + " cannot be made: " + error.message()
                      + "." + remedy);
  }

  bool
  begins_with(const fs::path &file, const std::string &line)
  {
    std::ifstream in(file);
    std::string   first;
    return std::getline(in, first) && first == line;
  }
} // namespace Exemplar
