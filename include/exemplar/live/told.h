// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_told_h
#define exemplar_live_told_h

#include <exemplar/live/hand.h>
#include <exemplar/live/obstacle_frames.h>
#include <exemplar/live/pace.h>
#include <exemplar/live/skin_frames.h>
#include <exemplar/live/stage.h>

#include <string>

// The texts that viewers get, as JSON that doc/live.md describes.

namespace Exemplar::Live
{
  /// Choices of a viewer that do not affect the body.
  struct Wish
  {
    std::string colour    = "none";
    bool        is_paused = false;
  };

  /// The constant data of a scene, sent once.
  std::string
  scene_text(Stage              &stage,
             const Hand         &hand,
             const BodySurface  &surface,
             const SkinFrames   &skin,
             const SpaceVector3 &up);

  /// Settings, held parts and choices: all that a page shows beside the body's positions.
  std::string
  state_text(const Stage          &stage,
             const Hand           &hand,
             const BodySurface    &surface,
             const ObstacleFrames &obstacles,
             const Wish           &wish);

  /// Whether a text is one of state_text().
  bool
  is_state(const std::string &text);

  /// The pace of the simulation and the report on its last step.
  std::string
  status_text(const Problem       &problem,
              const Hand          &hand,
              const SolveReport   &report,
              const Pace::Summary &summary,
              bool                 is_paused);

  /// A message for the user.
  std::string
  words_text(const std::string &type, const std::string &words);
} // namespace Exemplar::Live

#endif
