// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_from_python_h
#define exemplar_from_python_h

#include <exemplar/body/handles.h>
#include <exemplar/run/inputs.h>
#include <exemplar/run/scene_parameters.h>

#include <pybind11/pybind11.h>

// What Python's objects mean to exemplar.

namespace Exemplar::Python
{
  /// A scene and what stands in for its files.
  struct Given
  {
    SceneParameters scene;
    Inputs          inputs;
  };

  /// The arguments of exemplar.Problem: the path of a .prm file, its text or a dictionary of
  /// sections; None or a tuple (nodes, cells) or (nodes, cells, material ids); None or a list of
  /// poses. Throws UserError for what these cannot be, and pybind11's exceptions.
  Given
  from_python(const pybind11::object &scene,
              const pybind11::object &mesh,
              const pybind11::object &poses);

  /// A motion that calls function(rest (k,3), t) -> (k,3), with Python's lock held. Exceptions of
  /// the function pass through.
  Motion
  motion_of(const pybind11::function &function);
} // namespace Exemplar::Python

#endif
