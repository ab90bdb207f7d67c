// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_input_stamps_h
#define exemplar_input_stamps_h

#include <exemplar/run/scene/scene_file.h>

#include <filesystem>
#include <string>
#include <vector>

namespace Exemplar::Python
{
  /// Names, sizes and times of the input files that a problem was made of, so that files read again
  /// are those read before.
  class InputStamps
  {
  public:
    InputStamps() = default;

    explicit InputStamps(const SceneFile &scene);

    std::vector<std::filesystem::path>
    files() const;

    /// Throws UserError, with its name, for a file that was changed, removed or replaced; `what` is
    /// the name of the caller that reads them.
    void
    require_unchanged(const std::string &what) const;

  private:
    /// Size and time of the last change of a file; zeros if it is no file.
    struct Stamp
    {
      std::uintmax_t                  size = 0;
      std::filesystem::file_time_type time = {};
    };

    static Stamp
    stamp_of(const std::filesystem::path &file);

    std::vector<std::pair<std::filesystem::path, Stamp>> stamps;
  };
} // namespace Exemplar::Python

#endif
