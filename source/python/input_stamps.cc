// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/python/input_stamps.h>

namespace Exemplar::Python
{
  namespace fs = std::filesystem;

  InputStamps::InputStamps(const SceneFile &scene)
  {
    for (const fs::path &file : scene.input_files())
      stamps.emplace_back(fs::absolute(file), stamp_of(file)); // Python may change its directory
  }

  std::vector<fs::path>
  InputStamps::files() const
  {
    std::vector<fs::path> all;
    for (const auto &[file, stamp] : stamps)
      all.push_back(file);
    return all;
  }

  void
  InputStamps::require_unchanged(const std::string &what) const
  {
    for (const auto &[file, before] : stamps)
      if (const Stamp now = stamp_of(file); now.size != before.size || now.time != before.time)
        throw UserError(
            what + ": " + file.string()
            + " has changed since this problem was made of it, and would be read again. "
              "Make the problem anew: exemplar.Problem(scene).");
  }

  InputStamps::Stamp
  InputStamps::stamp_of(const fs::path &file)
  {
    std::error_code none;
    Stamp           stamp;
    if (!fs::is_regular_file(file, none))
      return stamp;
    stamp.size = fs::file_size(file, none);
    stamp.time = fs::last_write_time(file, none);
    return stamp;
  }
} // namespace Exemplar::Python
