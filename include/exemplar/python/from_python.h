// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_from_python_h
#define exemplar_from_python_h

#include <exemplar/python/scene_source.h>
#include <exemplar/run/inputs/inputs.h>
#include <exemplar/run/problem/problem.h>
#include <exemplar/run/scene/scene_file.h>
#include <exemplar/run/scene/scene_parameters.h>

#include <pybind11/pybind11.h>

#include <filesystem>
#include <string>
#include <vector>

// Conversion of Python's objects.

namespace Exemplar::Python
{
  /// Names, sizes and times of the input files that a problem was made of, so that files read again
  /// are those read before.
  class InputStamps
  {
  public:
    InputStamps() = default;

    explicit InputStamps(const SceneFile &scene);

    std::vector<std::filesystem::path>
    files() const;

    /// Throws UserError, with its name, for a file that was changed, removed or replaced; `what` is
    /// the name of the caller that reads them.
    void
    require_unchanged(const std::string &what) const;

  private:
    /// Size and time of the last change of a file; zeros if it is no file.
    struct Stamp
    {
      std::uintmax_t                  size = 0;
      std::filesystem::file_time_type time = {};
    };

    static Stamp
    stamp_of(const std::filesystem::path &file);

    std::vector<std::pair<std::filesystem::path, Stamp>> stamps;
  };

  /// A scene and the inputs that replace its files.
  struct Given
  {
    SceneSource     source;
    SceneParameters scene;
    InputStamps     stamps; ///< stamps of its files
    Inputs          inputs;
  };

  /// The arguments of exemplar.Problem: the path of a .prm file, its text or a dictionary of
  /// sections; None or a tuple (nodes, cells) or (nodes, cells, material ids); None or a list of
  /// poses. Throws UserError for what these cannot be, and pybind11's exceptions.
  Given
  from_python(const pybind11::object &scene,
              const pybind11::object &mesh,
              const pybind11::object &poses);

  /// The result of a call of a Python function. If it does not take such arguments, the TypeError
  /// is reported with `usage`. Throws what the function raises.
  pybind11::object
  call(const pybind11::object &function,
       const pybind11::tuple  &arguments,
       const std::string      &usage);

  /// A motion of a handle that calls function(rest (k,3), t) -> (k,3), with Python's lock held.
  /// `function` is looked at in each call and must outlive them. Exceptions of the function pass
  /// through; UserError is thrown if it returns anything else.
  Motion
  motion_of(const std::string &handle, const pybind11::object &function);
} // namespace Exemplar::Python

#endif
