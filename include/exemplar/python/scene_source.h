// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_scene_source_h
#define exemplar_scene_source_h

#include <exemplar/run/scene/scene_file.h>

#include <pybind11/pybind11.h>

#include <filesystem>
#include <string>
#include <vector>

namespace Exemplar::Python
{
  /// The scene of a problem as Python gave it, as text, so that it can be written for another
  /// program.
  struct SceneSource
  {
    std::filesystem::path    file;             ///< path as given; empty: none
    std::string              text;             ///< text of the scene; empty: a dictionary was given
    std::vector<Assignment>  assignments;      ///< assignments after the text
    std::vector<std::string> warnings = {};    ///< keys that do nothing in Python
    std::filesystem::path    place    = {};    ///< absolute, from whose directory files are named
    bool                     has_mesh = false; ///< an array stands in for the mesh
    std::size_t              n_poses  = 0;     ///< arrays that stand in for Examples/Poses
  };

  /// The value str(object) of a key, a value or a name. Throws UserError for a NUL character, at
  /// which a message would end; `what` names the object there.
  std::string
  text_of(const pybind11::handle &object, const std::string &what);

  /// The source of a scene given by the path of a .prm file, its text or a dictionary of sections.
  /// `assignments` come after it. Throws UserError for anything else, and pybind11's exceptions.
  SceneSource
  scene_source(const pybind11::object        &scene,
               const std::vector<Assignment> &assignments,
               bool                           has_mesh);
} // namespace Exemplar::Python

#endif
