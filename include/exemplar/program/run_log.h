// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_run_log_h
#define exemplar_run_log_h

#include <exemplar/base/process_group.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace Exemplar
{
  /// What a run says beside its progress: on the terminal, and in a file that keeps it. Of several
  /// processes the root alone speaks.
  class RunLog
  {
  public:
    /// If `quiet`, the terminal shows warnings alone.
    explicit RunLog(bool quiet);

    /// Lines, each of which is ended.
    void
    say(const std::string &lines);

    /// What goes wrong, but ends nothing. It is shown on stderr.
    void
    warn(const std::string &warning);

    void
    warn(const std::vector<std::string> &all);

    /// Lines for the file alone.
    void
    note(const std::string &lines);

    /// From now on all goes to this file, too, behind what it holds, and first what was said before.
    /// Throws std::runtime_error, as all functions do from now on, if it cannot be written.
    void
    keep_in(const std::filesystem::path &path);

    /// All so far.
    const std::vector<std::string> &
    get_warnings() const
    {
      return warnings;
    }

  private:
    const ProcessGroup      &processes;
    const bool               quiet;
    std::vector<std::string> warnings;
    std::string              waiting; ///< for the file
    std::filesystem::path    path;    ///< empty: there is none yet
    std::ofstream            file;
  };
} // namespace Exemplar

#endif
