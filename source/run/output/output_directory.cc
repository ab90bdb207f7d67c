// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/errors.h>
#include <exemplar/run/output/output_directory.h>

#include <unistd.h>

#include <fstream>
#include <regex>

namespace Exemplar
{
  namespace fs = std::filesystem;

  void
  require_writable(const fs::path &path, const std::string &remedy)
  {
    static const std::regex unusual("~.*|[a-zA-Z]:\\\\.*");
    if (std::regex_match(path.string(), unusual))
      throw UserError(
          "Output directory " + path.string()
          + (path.string()[0] == '~'
                 ? ": ~ is not replaced here; write the path in full."
                 : " is a path of Windows: directories are separated by /, and there is "
                   "no drive.")
          + remedy);
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

  namespace
  {
    /// Whether a file ends in these bytes.
    bool
    ends_in(const fs::path &file, const std::string &end)
    {
      std::ifstream in(file, std::ios::binary);
      in.seekg(-static_cast<std::streamoff>(end.size()), std::ios::end);
      std::string bytes(end.size(), '\0');
      in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      return in && bytes == end;
    }

    void
    refuse_foreign(const fs::path    &file,
                   const std::string &beginning,
                   const std::string &end,
                   const std::string &remedy)
    {
      if (is_absent(file))
        return;
      std::string objection = objection_to(file, beginning);
      if (objection.empty() && !ends_in(file, end))
        objection = "was not written by exemplar";
      if (!objection.empty())
        throw UserError(file.string() + ": is to be written, but " + objection
                        + ". Nothing has been changed. Move it away." + remedy);
    }
  } // namespace

  void
  require_replaceable(const OwnFile               &file,
                      const std::vector<fs::path> &inputs,
                      const std::string           &remedy)
  {
    const fs::path temporary = AtomicFile::temporary_of(file.path);
    for (const fs::path &written : { file.path, temporary })
      for (const fs::path &input : inputs)
        if (std::error_code none; fs::equivalent(written, input, none))
          throw UserError(written.string() + ": is to be written, but is the input "
                          + input.string() + "." + remedy);
    refuse_foreign(file.path, file.beginning, file.end, remedy);
    refuse_foreign(temporary, file.beginning, "",
                   remedy); // a killed command's file may be truncated
  }

  bool
  begins_with(const fs::path &file, const std::string &line)
  {
    std::ifstream in(file);
    std::string   first;
    return std::getline(in, first) && first == line;
  }

  bool
  is_absent(const fs::path &file)
  {
    return fs::symlink_status(file).type() == fs::file_type::not_found;
  }

  std::string
  objection_to(const fs::path &file, const std::string &beginning)
  {
    const fs::file_status status = fs::symlink_status(file);
    if (fs::is_symlink(status))
      return "is a link";
    if (fs::is_directory(status))
      return "is a directory";
    if (!fs::is_regular_file(status))
      return "is no regular file";
    const fs::perms write
        = fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
    if ((status.permissions() & write) == fs::perms::none)
      return "is protected against writing";
    std::string   bytes(beginning.size(), '\0');
    std::ifstream in(file, std::ios::binary);
    in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    const auto n = static_cast<std::size_t>(in.gcount());
    return bytes.compare(0, n, beginning, 0, n) == 0 ? "" : "was not written by exemplar";
  }
} // namespace Exemplar
