// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_scene_review_h
#define exemplar_scene_review_h

#include <exemplar/run/problem/problem.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// Warnings of what a scene says that is allowed and may be meant, but hardly is: constants beyond
  /// what the elements can do, tolerances that accept anything, weights beyond the examples, motions
  /// of components that are not held.
  std::vector<std::string>
  scene_warnings(const Problem &problem);

  /// What looks wrong in the present pose of an example, see describe_pose(); empty if nothing does.
  std::string
  pose_warning(const Problem &problem, unsigned int example);
} // namespace Exemplar

#endif
