// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/python/arrays_from_python.h>
#include <exemplar/python/from_python.h>
#include <exemplar/run/scene/scene_file.h>

#include <fmt/core.h>

namespace Exemplar::Python
{
  namespace fs = std::filesystem;
  namespace py = pybind11;

  namespace
  {
    /// Refuses a file name where arrays are needed, as in `poses`.
    void
    refuse_file_name(const py::handle &object, const std::string &what)
    {
      if (py::isinstance<py::str>(object) || py::hasattr(object, "__fspath__"))
        throw UserError(what
                        + " names a file, but poses= takes arrays (n, 3), such as "
                          "poses=[bent]. Files are named by the scene: Examples/Poses.");
    }

    SceneParameters
    parameters_of(const SceneFile &file, const SceneSource &source)
    {
      SceneParameters parameters = file.get_parameters();
      parameters.warnings.insert(parameters.warnings.end(), source.warnings.begin(),
                                 source.warnings.end());
      return parameters;
    }
  } // namespace

  InputStamps::InputStamps(const SceneFile &scene)
  {
    for (const fs::path &file : scene.input_files())
      stamps.emplace_back(fs::absolute(file), stamp_of(file)); // Python may change its directory
  }

  std::vector<fs::path>
  InputStamps::files() const
  {
    std::vector<fs::path> all;
    for (const auto &[file, stamp] : stamps)
      all.push_back(file);
    return all;
  }

  void
  InputStamps::require_unchanged(const std::string &what) const
  {
    for (const auto &[file, before] : stamps)
      if (const Stamp now = stamp_of(file); now.size != before.size || now.time != before.time)
        throw UserError(
            what + ": " + file.string()
            + " has changed since this problem was made of it, and would be read again. "
              "Make the problem anew: exemplar.Problem(scene).");
  }

  InputStamps::Stamp
  InputStamps::stamp_of(const fs::path &file)
  {
    std::error_code none;
    Stamp           stamp;
    if (!fs::is_regular_file(file, none))
      return stamp;
    stamp.size = fs::file_size(file, none);
    stamp.time = fs::last_write_time(file, none);
    return stamp;
  }

  Given
  from_python(const py::object &scene, const py::object &mesh, const py::object &poses)
  {
    Given                   given;
    std::vector<Assignment> assignments;
    refuse_file_name(poses, "poses");
    if (py::isinstance<py::dict>(poses)
        || (py::isinstance<py::array>(poses)
            && py::reinterpret_borrow<py::array>(poses).ndim() != 3))
      throw UserError("poses must be a list of arrays (n, 3), such as [bent], but is "
                      + description(poses) + ".");
    const auto list = poses.is_none() ? py::list() : py::list(poses);
    if (!poses.is_none())
    {
      std::string names;
      for (std::size_t i = 0; i < list.size(); ++i)
        names += fmt::format("{}{}", i == 0 ? "pose_" : ", pose_", i);
      assignments.push_back({ { "Examples" }, "Poses", names, "poses" });
    }
    given.source         = scene_source(scene, assignments, !mesh.is_none());
    given.source.n_poses = list.size();
    const SceneFile file(given.source.file, given.source.text, given.source.assignments);
    given.scene  = parameters_of(file, given.source);
    given.stamps = InputStamps(file);
    for (std::size_t i = 0; i < list.size(); ++i)
    {
      const std::string what = fmt::format("poses[{}]", i);
      refuse_file_name(list[i], what);
      given.inputs.poses[given.scene.examples.poses[i]] = points_of(list[i], what);
    }
    if (!mesh.is_none())
      given.inputs.mesh = mesh_of(mesh, given.scene.mesh.kind);
    return given;
  }

  py::object
  call(const py::object &function, const py::tuple &arguments, const std::string &usage)
  {
    try
    {
      return function(*arguments);
    }
    catch (py::error_already_set &error)
    {
      if (!error.matches(PyExc_TypeError) || error.trace()) // raised inside of the function
        throw;
      throw py::type_error(std::string(py::str(error.value())) + ". " + usage);
    }
  }

  Motion
  motion_of(const std::string &handle, const py::object &function)
  {
    return [handle, &function](const std::vector<dealii::Point<3>> &rest, const double time)
    {
      const py::gil_scoped_acquire lock;
      const auto                   n = py::ssize_t(rest.size());
      py::array_t<double>          points({ n, py::ssize_t(3) });
      auto                         x = points.mutable_unchecked<2>();
      for (std::size_t i = 0; i < rest.size(); ++i)
        for (unsigned int c = 0; c < 3; ++c)
          x(i, c) = rest[i][c];
      std::vector<dealii::Tensor<1, 3>> displacements;
      for (const dealii::Point<3> &u : points_of(
               call(function, py::make_tuple(points, time), "set_motion calls function(rest, t)."),
               "Handles/" + handle
                   + ": what the function of its motion returns at t = " + shortest_text(time),
               n))
        displacements.push_back(u);
      return displacements;
    };
  }
} // namespace Exemplar::Python
