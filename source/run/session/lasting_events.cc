// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/session/lasting_events.h>

namespace Exemplar
{
  namespace
  {
    std::string
    kind_of(const std::string &what)
    {
      if (what == "grab" || what == "move" || what == "release")
        return "spring";
      if (what == "hold" || what == "shift" || what == "let go")
        return "handle";
      return what;
    }
  } // namespace

  void
  LastingEvents::add(const SessionEvent &event)
  {
    if (event.what == "forget")
      return;
    const auto [place, is_new]
        = indices.emplace(std::make_pair(kind_of(event.what), event.name), subjects.size());
    if (is_new)
      subjects.emplace_back();
    Subject &subject = subjects[place->second];
    if (event.what == "move" || event.what == "shift")
      subject.moved = event;
    else if (event.what == "release" || event.what == "let go")
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
