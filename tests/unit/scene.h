// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tests_scene_h
#define exemplar_tests_scene_h

#include <exemplar/verification/verification_scene.h>

#include <string>

// Whole problems from the text of a scene.
namespace Exemplar::Testing
{
  using Verification::max_difference;
  using Verification::Scene;

  inline const std::string bar = "subsection Mesh\n set Generator = box\n set Box size = 4, 1, 1\n"
                                 "set Box cells = 4, 1, 1\nend\n";

  inline const std::string held_left = "subsection left\n set Select = boundary 1\nend\n";

  inline const std::string drag = "subsection Handles\n set Names = left, right\n" + held_left
                                  + "subsection right\n set Select = boundary 2\n"
                                    "set Motion = 0.2*t; 0.6*t; 0.3*t\nend\nend\n";

  /// Twisted, and stretched.
  inline const std::string two_poses
      = "set Pose functions = " + Verification::twist(60., 4.) + " | 1.2*x; 0.9*y; z\n";

  inline std::string
  examples(const std::string &keys)
  {
    return "subsection Examples\n" + keys + "end\n";
  }
} // namespace Exemplar::Testing

#endif
