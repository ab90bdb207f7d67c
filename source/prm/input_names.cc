// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/prm/assignments.h>
#include <exemplar/prm/input_names.h>

namespace Exemplar
{
  namespace
  {
    /// The absolute name of one file. Throws UserError for characters in `unwanted` or unprintable
    /// ones.
    std::string
    absolute_file(const std::string           &file,
                  const std::filesystem::path &directory,
                  const std::string           &unwanted)
    {
      const std::string path
          = directory.empty()
                ? file
                : std::filesystem::absolute(directory / file).lexically_normal().string();
      if (path.find_first_of(unwanted) != std::string::npos)
        throw UserError("The path " + path
                        + (path.find('#') == std::string::npos
                               ? " holds a comma, which separates the names of a list"
                               : " holds a #, which begins a comment in scene files")
                        + ". Rename the file or its directory.");
      if (find_unprintable(path) != std::string::npos)
        throw UserError("The path " + path
                        + " holds bytes that are no text in UTF-8, which a scene file cannot hold. "
                          "Rename the file or its directory.");
      return path;
    }
  } // namespace

  std::string
  absolute_files(const std::string           &value,
                 const bool                   is_list,
                 const std::filesystem::path &directory)
  {
    if (!is_list)
      return value.empty() ? value : absolute_file(value, directory, "#");
    std::string files;
    for (const std::string &file : split_trimmed(value, ','))
      files += (files.empty() ? "" : ", ") + absolute_file(file, directory, "#,");
    return files;
  }
} // namespace Exemplar
