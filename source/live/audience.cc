// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/live/viewer.h>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <iostream>
#include <stdexcept>

namespace Exemplar::Live
{
  namespace
  {
    using Json = nlohmann::json;

    constexpr std::size_t  max_viewers  = 8;
    constexpr unsigned int max_mistakes = 100, max_lines_a_second = 10;

    std::string
    told(const std::string &type, const std::string &text)
    {
      return Json{ { "type", type }, { "text", text } }.dump();
    }

    /// The frame number of an acknowledgement, which is no command; 0: the message is none.
    unsigned int
    acknowledged(const std::string &message)
    {
      const std::string begin = "ack ";
      if (message.compare(0, begin.size(), begin) != 0 || message.size() > begin.size() + 10)
        return 0;
      unsigned long long number = 0;
      for (std::size_t i = begin.size(); i < message.size(); ++i)
      {
        if (message[i] < '0' || message[i] > '9')
          return 0;
        number = 10 * number + static_cast<unsigned int>(message[i] - '0');
      }
      return static_cast<unsigned int>(number);
    }
  } // namespace

  void
  ServerLog::refuse(const std::string &what)
  {
    const auto now = std::chrono::steady_clock::now();
    if (now - second > std::chrono::seconds(1))
    {
      if (n_silent > 0)
        std::cerr << "exemplar: Refused " << n_silent << " more." << std::endl;
      second  = now;
      n_lines = n_silent = 0;
    }
    if (++n_lines > max_lines_a_second)
    {
      ++n_silent;
      return;
    }
    std::string line;
    for (const char letter : what.substr(0, 200)) // partly chosen by strangers
      line += letter >= ' ' && letter <= '~' ? letter : '?';
    std::cerr << "exemplar: Refused: " << line << "." << std::endl;
  }

  bool
  Audience::join(const std::shared_ptr<Viewer> &viewer)
  {
    if (viewers.size() >= max_viewers)
    {
      log.refuse("one more viewer than may be");
      return false;
    }
    viewers.insert(viewer);
    send_welcome(*viewer);
    if (newest != nullptr)
      viewer->send_frame(newest);
    give_mouse_to(holder == nullptr ? viewer.get() : holder);
    mailbox.set_n_viewers(viewers.size());
    return true;
  }

  void
  Audience::send_welcome(Viewer &viewer) const
  {
    viewer.send_text(welcome.scene);
    viewer.send_text(welcome.state);
    for (const Bytes &binary : welcome.binaries)
      viewer.send_binary(binary);
  }

  void
  Audience::welcome_again(Welcome other)
  {
    welcome = std::move(other);
    newest  = nullptr;
    for (const auto &viewer : std::set<std::shared_ptr<Viewer>>(viewers)) // a copy: one may leave
      send_welcome(*viewer);
  }

  void
  Audience::show_obstacles(Welcome other, const std::vector<Bytes> &binaries)
  {
    welcome = std::move(other);
    for (const auto &viewer : std::set<std::shared_ptr<Viewer>>(viewers)) // a copy: one may leave
      for (const Bytes &binary : binaries)
        viewer->send_binary(binary);
  }

  void
  Audience::leave(Viewer *viewer)
  {
    for (const auto &other : viewers)
      if (other.get() == viewer)
      {
        viewers.erase(std::shared_ptr<Viewer>(other));
        break;
      }
    if (viewer == holder) // who may be in the middle of a pull
    {
      mailbox.put({ "let go of all" });
      holder = nullptr;
      if (!viewers.empty())
        give_mouse_to(viewers.begin()->get());
    }
    mailbox.set_n_viewers(viewers.size());
  }

  void
  Audience::dismiss()
  {
    viewers.clear();
    holder = nullptr;
  }

  void
  Audience::give_mouse_to(Viewer *viewer)
  {
    if (holder != nullptr && holder != viewer)
      mailbox.put({ "let go of all" });
    holder = viewer;
    for (const auto &other : std::set<std::shared_ptr<Viewer>>(viewers))
      other->send_text(Json{
          { "type", "mouse" }, { "yours", other.get() == holder }, { "viewers", viewers.size() } }
                           .dump());
  }

  void
  Audience::show(const Bytes &frame)
  {
    newest = frame;
    for (const auto &viewer : std::set<std::shared_ptr<Viewer>>(viewers)) // a copy: one may leave
      viewer->send_frame(frame);
  }

  void
  Audience::tell(const std::string &text)
  {
    if (is_state(text))
      welcome.state = text;
    for (const auto &viewer : std::set<std::shared_ptr<Viewer>>(viewers))
      viewer->send_text(text);
  }

  bool
  Audience::hear(Viewer *viewer, const std::string &message)
  {
    if (const unsigned int frame = acknowledged(message); frame > 0)
    {
      viewer->acknowledge(frame);
      return true;
    }
    try
    {
      Command command = parse_command(message);
      if (command.type == "take mouse")
        give_mouse_to(viewer);
      else if (viewer != holder)
        viewer->send_text(told("refused", "Another viewer has the mouse. Ask for it first."));
      else if (!mailbox.put(std::move(command)))
        viewer->send_text(told("refused", "Too much is asked for at once."));
      return true;
    }
    catch (const std::invalid_argument &error)
    {
      viewer->send_text(
          told("refused", std::string("This message is none: ") + error.what() + "."));
      if (++viewer->n_mistakes < max_mistakes)
        return true;
      log.refuse("a viewer whose messages are none");
      return false;
    }
  }
} // namespace Exemplar::Live
