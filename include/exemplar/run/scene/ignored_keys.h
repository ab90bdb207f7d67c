// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_ignored_keys_h
#define exemplar_ignored_keys_h

#include <exemplar/prm/key_table.h>
#include <exemplar/run/scene/scene_parameters.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// A warning for each key in `given` that has no effect in this scene, with its place and a
  /// remedy.
  std::vector<std::string>
  warn_of_ignored_keys(const SceneParameters         &scene,
                       const KeyTable                &keys,
                       const std::vector<Assignment> &given);
} // namespace Exemplar

#endif
