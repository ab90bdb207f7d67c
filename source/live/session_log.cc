// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/exemplar.h>
#include <exemplar/live/session_log.h>

#include <fstream>
#include <stdexcept>
#include <unistd.h>

namespace Exemplar::Live
{
  SessionLog::SessionLog(const std::filesystem::path &path)
      : name(path.empty() ? "A temporary file in " P_tmpdir : path.string()),
        file(path.empty() ? std::tmpfile() : std::fopen(path.c_str(), "wbx"))
  {
    if (!file)
      throw UserError(name + " cannot be written, which keeps what is done. Give "
                      + (path.empty() ? "a directory by --record." : "another directory."));
    write(head_of_session());
    flush();
  }

  void
  SessionLog::write(const std::string &text)
  {
    if (std::fwrite(text.data(), 1, text.size(), file.get()) != text.size())
      throw std::runtime_error(name + " cannot be written: is the disk full?");
  }

  void
  SessionLog::add(const SessionEvent &event)
  {
    const std::string line = line_of(event);
    write(line);
    n_bytes += static_cast<long>(line.size());
  }

  void
  SessionLog::flush()
  {
    if (std::fflush(file.get()) != 0)
      throw std::runtime_error(name + " cannot be written: is the disk full?");
  }

  void
  SessionLog::cut(const long size)
  {
    flush();
    if (ftruncate(fileno(file.get()), static_cast<long>(head_of_session().size()) + size) != 0
        || std::fseek(file.get(), 0, SEEK_END) != 0)
      throw std::runtime_error(name + " cannot be cut.");
    n_bytes = size;
  }

  void
  SessionLog::for_each(const std::function<void(const SessionEvent &)> &action)
  {
    flush();
    // opened by its descriptor, as it may have no name
    std::ifstream lines("/proc/self/fd/" + std::to_string(fileno(file.get())));
    std::string   line;
    if (!std::getline(lines, line)) // the head is not an event
      throw std::runtime_error(name + " cannot be read.");
    while (std::getline(lines, line))
      action(event_of_line(line, name));
  }
} // namespace Exemplar::Live
