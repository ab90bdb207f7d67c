// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_input_stamps_h
#define exemplar_input_stamps_h

#include <exemplar/run/scene/scene_file.h>

#include <filesystem>
#include <string>
#include <vector>

namespace Exemplar::Python
{
  /// Which input files a problem was made of, and how they were then: what is read again must be what was
  /// read.
  class InputStamps
  {
  public:
    InputStamps() = default;

    explicit InputStamps(const SceneFile &scene);

    std::vector<std::filesystem::path>
    files() const;

    /// Throws UserError, with its name, for a file that was changed, removed or replaced; `what` reads them.
    void
    require_unchanged(const std::string &what) const;

  private:
    /// The size and the time of the last change; zeros of what is no file.
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
