// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_session_log_h
#define exemplar_live_session_log_h

#include <exemplar/live/c_file.h>
#include <exemplar/run/session/session.h>

#include <filesystem>
#include <functional>
#include <string>

namespace Exemplar::Live
{
  /// All that was done since the beginning, on disk, so that hours of it take no memory. Functions throw
  /// std::runtime_error if the disk is full.
  class SessionLog
  {
  public:
    /// A session file, which must not be there yet; with an empty path a file without a name, which ends with the program. Throws
    /// UserError if there can be none.
    explicit SessionLog(const std::filesystem::path &file);

    void
    add(const SessionEvent &event);

    /// How much was done so far [bytes].
    long
    size() const
    {
      return n_bytes;
    }

    /// All is as if only the first so many bytes had been done.
    void
    cut(long size);

    /// For all that was done, in its order.
    void
    for_each(const std::function<void(const SessionEvent &)> &action);

    /// Give to the system what is not on disk yet.
    void
    flush();

  private:
    void
    write(const std::string &text);

    std::string name; ///< for messages
    CFile       file;
    long        n_bytes = 0; ///< without the head
  };
} // namespace Exemplar::Live

#endif
