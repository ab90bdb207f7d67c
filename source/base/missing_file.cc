// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/missing_file.h>
#include <exemplar/base/nearest_word.h>
#include <exemplar/base/text_file.h>

#include <algorithm>
#include <cctype>
#include <vector>

namespace Exemplar
{
  namespace fs = std::filesystem;

  namespace
  {
    bool
    holds(const std::string &text, const char *const part)
    {
      return text.find(part) != std::string::npos;
    }

    /// Whether a blank follows an extension, as in "a.msh b.msh".
    bool
    is_list_by_blanks(const std::string &name)
    {
      const std::size_t point = name.find('.');
      return point != std::string::npos && holds(name.substr(point), " ");
    }

    /// Path of C:\\directory\\file in Windows' subsystem for Linux.
    std::string
    path_in_wsl(const std::string &path)
    {
      std::string linux_path = "/mnt/";
      linux_path += static_cast<char>(std::tolower(static_cast<unsigned char>(path[0])));
      linux_path += path.substr(2);
      std::replace(linux_path.begin(), linux_path.end(), '\\', '/');
      return linux_path;
    }

    /// The first missing directory on the path of a file; empty if all exist.
    fs::path
    missing_directory(const fs::path &file)
    {
      fs::path        missing;
      std::error_code ignored;
      for (fs::path d = file.parent_path(); !d.empty() && !fs::exists(d, ignored);
           d          = d.parent_path())
        missing = d;
      return missing;
    }

    /// The names in the directory of a file.
    std::vector<std::string>
    names_beside(const fs::path &file)
    {
      constexpr std::size_t    maximum = 2000; // limits the time in directories with more files
      std::vector<std::string> names;
      std::error_code          ignored;
      const fs::path directory = file.has_parent_path() ? file.parent_path() : fs::path(".");
      for (fs::directory_iterator entry(directory, ignored), end;
           entry != end && names.size() < maximum; entry.increment(ignored))
        names.push_back(entry->path().filename().string());
      std::sort(names.begin(), names.end()); // the order in a directory is unspecified
      return names;
    }

    /// The name beside a file that is nearest to its name; empty if none is near. A correct
    /// extension does not make names nearer; a missing one does not make them farther.
    std::string
    near_name(const fs::path &file, const fs::path &not_meant)
    {
      std::vector<std::string> names = names_beside(file);
      for (const std::string &name : names)
        if (name == file.filename().string() + fs::path(name).extension().string())
          return name;
      names.erase(std::remove(names.begin(), names.end(), not_meant.filename().string()),
                  names.end());
      const std::string near        = nearest_word(file.filename().string(), names);
      const bool        is_near_too = is_near(file.stem().string(), fs::path(near).stem().string());
      return is_near_too ? near : "";
    }
  } // namespace

  std::string
  missing_file_remedy(const fs::path &file, const fs::path &not_meant)
  {
    const std::string name = file.string();
    std::error_code   ignored;
    if (fs::exists(file, ignored))
      return "";
    if (name.find_first_of("\"'") != std::string::npos)
      return " Names of files are written without quotes.";
    if (holds(name, "/~") || name[0] == '~' || holds(name, "$"))
      return " Neither ~ nor $ is replaced here: write the path in full.";
    if (const std::size_t colon = name.find(":\\"); colon != std::string::npos && colon > 0)
      return " It is a path of Windows: directories are separated by /, not by \\, and there is no "
             "drive. In WSL it is "
             + path_in_wsl(name.substr(colon - 1)) + ".";
    if (holds(name, "\\"))
      return " Directories are separated by /, not by \\.";
    if (name.find_first_of("*?") != std::string::npos)
      return " Patterns are not replaced here: write all names, separated by commas.";
    if (holds(name, ";") || is_list_by_blanks(file.filename().string()))
      return " Names of files are separated by commas.";
    if (const fs::path directory = missing_directory(file); !directory.empty())
      return " There is no directory " + directory.string() + ".";
    if (file.is_absolute() && fs::exists(file.filename(), ignored))
      return " Names in a scene are relative to its directory, not to the working directory, where "
             "there is a "
             + file.filename().string() + ".";
    if (const std::string near = near_name(file, not_meant); !near.empty())
      return " Did you mean " + near + "?";
    return "";
  }

  void
  require_file(const fs::path &file, const std::string &what, const fs::path &not_meant)
  {
    std::error_code   ignored;
    const std::string reason
        = fs::exists(file, ignored) ? reason_not_to_read(file) : "No such file or directory";
    if (!reason.empty())
      throw UserError(file.string() + ": cannot be opened (" + reason + "). Give the path of "
                      + what + "." + missing_file_remedy(file, not_meant));
  }
} // namespace Exemplar
