// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_told_h
#define exemplar_live_told_h

#include <exemplar/live/hand.h>
#include <exemplar/live/pace.h>
#include <exemplar/live/stage.h>

#include <string>

// The texts that viewers get, as JSON that doc/live.md describes.

namespace Exemplar::Live
{
  /// What a viewer has asked for that does nothing to the body.
  struct Wish
  {
    std::string colour    = "none";
    bool        is_paused = false;
  };

  /// What does not change while the server lives.
  std::string
  scene_text(Stage &stage, const Hand &hand, const BodySurface &surface);

  /// What is set, held and asked for: all that a page shows beside the body's places.
  std::string
  state_text(const Stage &stage, const Hand &hand, const BodySurface &surface, const Wish &wish);

  /// Whether state_text() gave this text.
  bool
  is_state(const std::string &text);

  /// How time goes.
  std::string
  status_text(const Problem       &problem,
              const Hand          &hand,
              const SolveReport   &report,
              const Pace::Summary &summary,
              bool                 is_paused);

  /// Words for the user.
  std::string
  words_text(const std::string &type, const std::string &words);
} // namespace Exemplar::Live

#endif
