// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_session_log_h
#define exemplar_live_session_log_h

#include <exemplar/run/session/session.h>

#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace Exemplar::Live
{
  /// Deleter that closes a file of std::fopen or std::tmpfile.
  struct CloseFile
  {
    void
    operator()(std::FILE *file) const
    {
      std::fclose(file);
    }
  };

  /// An owned file of C's library, as only these can be without a name.
  using CFile = std::unique_ptr<std::FILE, CloseFile>;

  /// The events since the beginning, on disk, so that hours of them take no memory. Functions throw
  /// std::runtime_error if the disk is full.
  class SessionLog
  {
  public:
    /// Makes a session file, which must not exist; with an empty path a file without a name, which
    /// vanishes with the program. Throws UserError if there can be none.
    explicit SessionLog(const std::filesystem::path &file);

    void
    add(const SessionEvent &event);

    /// Size of the events so far [bytes].
    long
    size() const
    {
      return n_bytes;
    }

    /// Truncates the log to its first `size` bytes of events.
    void
    cut(long size);

    /// Calls `action` for all events, in their order.
    void
    for_each(const std::function<void(const SessionEvent &)> &action);

    /// Flushes buffers to the system.
    void
    flush();

  private:
    void
    write(const std::string &text);

    std::string name; ///< name for messages
    CFile       file;
    long        n_bytes = 0; ///< size without the head
  };
} // namespace Exemplar::Live

#endif
