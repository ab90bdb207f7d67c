// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_scene_review_h
#define exemplar_scene_review_h

#include <exemplar/run/problem/problem.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// Warnings of settings that are valid but hardly intended: constants beyond the range of the
  /// elements, very loose tolerances, weights without examples, motions of components that are not
  /// held.
  std::vector<std::string>
  scene_warnings(const Problem &problem);

  /// Sentences on flaws of the present pose of an example, see describe_pose(); empty if there are
  /// none.
  std::string
  pose_warning(const Problem &problem, unsigned int example);
} // namespace Exemplar

#endif
