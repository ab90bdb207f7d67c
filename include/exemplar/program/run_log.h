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
  /// Messages of a run other than its progress, on the terminal and in a file. With several
  /// processes, the root alone writes.
  class RunLog
  {
  public:
    /// If `quiet`, the terminal shows warnings alone.
    explicit RunLog(bool quiet);

    /// Print lines, each with its newline, and write them to the file.
    void
    say(const std::string &lines);

    /// Print a warning on stderr, and write it to the file.
    void
    warn(const std::string &warning);

    void
    warn(const std::vector<std::string> &all);

    /// Write lines to the file only.
    void
    note(const std::string &lines);

    /// Append all messages to this file from now on, after those so far. Throws std::runtime_error,
    /// as all functions do from now on, if it cannot be written.
    void
    keep_in(const std::filesystem::path &path);

    /// All warnings so far.
    const std::vector<std::string> &
    get_warnings() const
    {
      return warnings;
    }

  private:
    const ProcessGroup      &processes;
    const bool               quiet;
    std::vector<std::string> warnings;
    std::string              waiting; ///< text for the file, not yet written
    std::filesystem::path    path;    ///< empty: no file yet
    std::ofstream            file;
  };
} // namespace Exemplar

#endif
