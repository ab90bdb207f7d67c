// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/text_file.h>
#include <exemplar/base/words.h>
#include <exemplar/run/session/session.h>

#include <fmt/core.h>

#include <sstream>

namespace Exemplar
{
  namespace
  {
    const std::string head = "exemplar session 1";

    constexpr std::size_t max_name = 200; ///< bytes; names of the live page are shorter

    template <typename Number>
    std::vector<Number>
    numbers_in(const std::string &text, const std::string &place)
    {
      std::vector<Number> numbers;
      std::istringstream  words(text);
      for (std::string word; words >> word;)
      {
        const auto number = decimal_number<Number>(word);
        if (!number)
          throw UserError(place + ": " + in_quotes(word) + " is no number of a session.");
        numbers.push_back(*number);
      }
      return numbers;
    }

    std::string
    kind_of(const std::string &what)
    {
      if (what == "grab" || what == "move" || what == "release")
        return "spring";
      if (what == "ball" || what == "block" || what == "carry" || what == "take away")
        return "obstacle";
      if (what == "hold" || what == "shift" || what == "let go")
        return "handle";
      return what;
    }
  } // namespace

  SessionEvent
  event_of_line(const std::string &line, const std::string &place)
  {
    const std::vector<std::string> fields = split_trimmed(line, '|');
    if (fields.size() != 5)
      throw UserError(place
                      + ": a line of a session is STEP | WHAT | NAME | NODES | NUMBERS. Take the "
                        "file as exemplar live --record has written it.");
    const auto step = decimal_number<unsigned int>(fields[0]);
    if (!step || *step == 0)
      throw UserError(place + ": " + in_quotes(fields[0])
                      + " is no number of a step, which is 1 or more.");
    for (const std::string &word : { fields[1], fields[2] })
      if (word.size() > max_name || find_unprintable(word) != std::string::npos)
        throw UserError(
            fmt::format("{}: {} is no name of a session, which has at most {} bytes, all "
                        "of them text.",
                        place, in_quotes(word), max_name));
    return { *step, fields[1], fields[2], numbers_in<unsigned int>(fields[3], place),
             numbers_in<double>(fields[4], place) };
  }

  std::string
  head_of_session()
  {
    return head + "\n";
  }

  std::string
  line_of(const SessionEvent &event)
  {
    std::string line = fmt::format("{} | {} | {} |", event.step, event.what, event.name);
    for (const unsigned int node : event.nodes)
      line += fmt::format(" {}", node);
    line += " |";
    for (const double number : event.numbers)
      line += " " + shortest_text(number);
    return line + "\n";
  }

  RecordedSession
  read_session(const std::filesystem::path &file)
  {
    std::string reason;
    const auto  text = read_text_file(file, &reason);
    if (!text)
      throw UserError("Session/File " + file.string() + " cannot be read: " + reason + ".");
    std::istringstream lines(*text);
    std::string        line;
    if (!std::getline(lines, line) || line != head)
      throw UserError("Session/File " + file.string() + " does not begin with '" + head
                      + "'. Give a file that exemplar live --record has written.");
    RecordedSession session;
    for (unsigned int number = 2; std::getline(lines, line); ++number)
    {
      const std::string place = fmt::format("{}:{}", file.string(), number);
      if (lines.eof()) // no newline at the end: the last number may be cut
      {
        session.warnings.push_back(place
                                   + ": the last line has no end, as if the program that wrote it "
                                     "was killed. It is left out.");
        break;
      }
      SessionEvent event = event_of_line(line, place);
      event.line         = number;
      if (!session.events.empty() && event.step < session.events.back().step)
        throw UserError(fmt::format("{}: step {} comes after step {}. Steps must ascend.", place,
                                    event.step, session.events.back().step));
      session.events.push_back(std::move(event));
    }
    return session;
  }

  void
  LastingEvents::add(const SessionEvent &event)
  {
    if (event.what == "forget")
      return;
    // the name of an energy is its value
    const std::string name = event.what == "energy" ? "" : event.name;
    const auto [place, is_new]
        = indices.emplace(std::make_pair(kind_of(event.what), name), subjects.size());
    if (is_new)
      subjects.emplace_back();
    Subject &subject = subjects[place->second];
    if (event.what == "move" || event.what == "shift" || event.what == "carry")
      subject.moved = event;
    else if (event.what == "release" || event.what == "let go" || event.what == "take away")
    {
      subject.moved.reset();
      subject.ended = event;
    }
    else
      subject = { event, {}, {} };
  }

  Session
  LastingEvents::get() const
  {
    Session session;
    // static bodies must always be held, so that handles are released only after all are held
    for (const Subject &subject : subjects)
      for (const auto &event : { subject.made, subject.moved })
        if (event)
          session.push_back(*event);
    for (const Subject &subject : subjects)
      if (subject.ended)
        session.push_back(*subject.ended);
    return session;
  }
} // namespace Exemplar
