// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/exemplar.h>
#include <exemplar/live/page_files.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace Exemplar::Live
{
  namespace fs = std::filesystem;

  namespace
  {
    std::string
    bytes_of(const fs::path &file, const std::string &remedy)
    {
      std::ifstream      in(file, std::ios::binary);
      std::ostringstream bytes;
      if (!in || !(bytes << in.rdbuf()))
        throw UserError(file.string() + " cannot be read, which the page needs. " + remedy);
      return bytes.str();
    }

    /// The directory of the page's files: beside the program in a build, under share where it is
    /// installed.
    fs::path
    directory_of_page()
    {
      const fs::path program = fs::read_symlink("/proc/self/exe").parent_path();
      for (const fs::path &directory : { program / "live", program / "../share/exemplar/live" })
        if (fs::exists(directory / "index.html"))
          return directory;
      throw UserError("The files of the page (live/index.html) are neither beside the program nor "
                      "under share/exemplar. Install exemplar anew.");
    }
  } // namespace

  std::string
  page_file(const std::string &name)
  {
    return bytes_of(directory_of_page() / name, "Install exemplar anew.");
  }

  std::string
  three_file(const std::string &name)
  {
    return bytes_of(fs::path("/usr/share/javascript/three") / name,
                    "Install three.js (Debian: libjs-three).");
  }
} // namespace Exemplar::Live
