// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/live/mailbox.h>

#include <algorithm>
#include <limits>

namespace Exemplar::Live
{
  namespace
  {
    constexpr std::size_t max_commands = 1000;

    /// Greatest length of the queue at which a command is accepted. The end of a pull has room of
    /// its own, as else a viewer who has asked for too much would leave the body on its spring.
    std::size_t
    room_for(const Command &command)
    {
      if (command.type
          == "let go of all") // sent by the server, when the mouse goes to another viewer
        return std::numeric_limits<std::size_t>::max();
      return command.type == "release" ? 2 * max_commands : max_commands;
    }
  } // namespace

  bool
  Mailbox::put(Command command)
  {
    const std::lock_guard<std::mutex> lock(mutex);
    // merge only within one run of moves: not across a grab or release in between
    for (auto before = commands.rbegin();
         before != commands.rend() && command.type == "move" && before->type == "move"; ++before)
      if (before->name == command.name)
      {
        *before = std::move(command);
        return true;
      }
    if (command.type == "let go of all" && !commands.empty()
        && commands.back().type == command.type)
      return true;
    if (commands.size() >= room_for(command))
      return false;
    commands.push_back(std::move(command));
    news.notify_one();
    return true;
  }

  std::vector<Command>
  Mailbox::take(const bool waits, const std::chrono::steady_clock::time_point until)
  {
    std::unique_lock<std::mutex> lock(mutex);
    if (waits)
      news.wait_until(lock, until,
                      [this] { return has_ended || viewers_are_new || !commands.empty(); });
    viewers_are_new = false;
    std::vector<Command> taken;
    std::swap(taken, commands);
    return taken;
  }

  void
  Mailbox::stop()
  {
    const std::lock_guard<std::mutex> lock(mutex);
    has_ended = true;
    news.notify_one();
  }

  bool
  Mailbox::is_stopped() const
  {
    const std::lock_guard<std::mutex> lock(mutex);
    return has_ended;
  }

  void
  Mailbox::set_n_viewers(const unsigned int n)
  {
    const std::lock_guard<std::mutex> lock(mutex);
    n_viewers       = n;
    viewers_are_new = true;
    news.notify_one();
  }

  unsigned int
  Mailbox::get_n_viewers() const
  {
    const std::lock_guard<std::mutex> lock(mutex);
    return n_viewers;
  }
} // namespace Exemplar::Live
