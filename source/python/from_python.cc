// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/python/from_python.h>
#include <exemplar/run/scene_file.h>

#include <pybind11/numpy.h>

#include <functional>

namespace Exemplar::Python
{
  namespace py = pybind11;

  std::string
  text_of(const py::handle &object, const std::string &what)
  {
    std::string text = py::str(object);
    if (text.find('\0') != std::string::npos)
      throw UserError(what + " holds a NUL character ('\\0'). Remove it.");
    return text;
  }

  namespace
  {
    /// What separates the entries of a list in the text of a scene.
    std::string
    separator(const std::string &key)
    {
      if (key == "Select")
        return " ";
      for (const char *formulas :
           { "Motion", "Force", "Velocity", "Pose function", "Prescribed weights" })
        if (key == formulas)
          return "; ";
      return key == "Pose functions" ? " | " : ", ";
    }

    bool
    is_list(const py::handle &value)
    {
      if (py::isinstance<py::array>(value))
        return py::reinterpret_borrow<py::array>(value).ndim() > 0;
      return py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value);
    }

    std::string
    text_of_value(const py::handle &value, const std::string &what)
    {
      if (PyCallable_Check(value.ptr()) != 0)
        throw UserError(what
                        + " is a function, but a scene holds formulas, as text. A function moves "
                          "a handle by problem.set_motion(name, function).");
      if (py::isinstance<py::bool_>(value))
        return value.cast<bool>() ? "true" : "false";
      if (is_list(value) || py::isinstance<py::dict>(value))
        throw UserError(what
                        + " holds lists within lists of lists, or a dictionary in a list. "
                          "Allowed: a value, a list of values, or of poses a list of lists of "
                          "three formulas.");
      return text_of(value, what);
    }

    std::string
    join(const py::handle                                     &list,
         const std::string                                    &separator,
         const std::function<std::string(const py::handle &)> &text_of_entry)
    {
      std::string text;
      bool        is_first = true;
      for (const py::handle entry : list)
      {
        text += (is_first ? "" : separator) + text_of_entry(entry);
        is_first = false;
      }
      return text;
    }

    /// The text of a value, of a list, or of a list of lists, such as a pose's three formulas.
    std::string
    text_for_key(const py::handle &value, const std::string &key, const std::string &what)
    {
      const auto of_value = [&](const py::handle &entry) { return text_of_value(entry, what); };
      const auto of_entry = [&](const py::handle &entry)
      { return is_list(entry) ? join(entry, "; ", of_value) : of_value(entry); };
      return is_list(value) ? join(value, separator(key), of_entry) : of_value(value);
    }

    /// Sections of a dictionary that name their subsections: who leaves out Names has listed all.
    void
    add_names(const py::dict                 &section,
              const std::vector<std::string> &path,
              std::vector<Assignment>        &assignments)
    {
      if (path.size() != 1 || (path[0] != "Handles" && path[0] != "Loads")
          || section.contains("Names"))
        return;
      std::string names;
      for (const auto &[key, value] : section)
        if (py::isinstance<py::dict>(value))
          names += (names.empty() ? "" : ", ") + std::string(py::str(key));
      assignments.push_back({ path, "Names", names, "scene" });
    }

    void
    add_section(const py::dict                 &given,
                const std::vector<std::string> &path,
                std::vector<Assignment>        &assignments)
    {
      const py::dict section = given.attr("copy")(); // str() of a key or a value may change `given`
      add_names(section, path, assignments);
      for (const auto &[key, value] : section)
      {
        std::string where = "scene: ";
        for (const std::string &outer : path)
          where += outer + "/";
        const std::string name = text_of(key, where + "a key");
        if (!py::isinstance<py::dict>(value))
        {
          assignments.push_back({ path, name, text_for_key(value, name, where + name), "scene" });
          continue;
        }
        if (path.size() == 2)
          throw UserError(where + name
                          + " is a dictionary. The sections of a scene are at most two "
                            "deep, as Handles/NAME is: give it a value.");
        std::vector<std::string> deeper = path;
        deeper.push_back(name);
        add_section(py::reinterpret_borrow<py::dict>(value), deeper, assignments);
      }
    }

    SceneParameters
    read_scene(const py::object &scene, std::vector<Assignment> assignments)
    {
      if (py::isinstance<py::dict>(scene))
      {
        std::vector<Assignment> sections;
        add_section(scene, {}, sections);
        sections.insert(sections.end(), assignments.begin(), assignments.end());
        return SceneFile({}, "", sections).get_parameters();
      }
      if (!py::isinstance<py::str>(scene) && !py::hasattr(scene, "__fspath__"))
        throw py::type_error("scene must be the path of a .prm file, its text, or a dictionary of "
                             "sections, but is a "
                             + py::type::of(scene).attr("__name__").cast<std::string>() + ".");
      const std::string text = text_of(py::module_::import("os").attr("fspath")(scene), "scene");
      if (text.find('\n') != std::string::npos || text.compare(0, 4, "set ") == 0)
        return SceneFile({}, text, assignments).get_parameters();
      return SceneFile(text, read_prm(text), assignments).get_parameters();
    }

    /// In words, as in "an array of shape (9, 2)" or "a NoneType".
    std::string
    description(const py::handle &object, const py::array &array)
    {
      if (!array || array.ndim() == 0)
        return "a " + std::string(py::str(py::type::of(object).attr("__name__")));
      return "an array of shape " + std::string(py::str(array.attr("shape")));
    }

    /// The rows of an array (n, width), or any number of them where n is negative; `what` stands for
    /// it in messages.
    template <typename Number>
    py::array_t<Number, py::array::c_style | py::array::forcecast>
    rows_of(const py::handle  &object,
            const std::string &what,
            const py::ssize_t  n,
            const py::ssize_t  width)
    {
      const auto any = py::array::ensure(object);
      if (!any || any.ndim() != 2 || any.shape(1) != width || (n >= 0 && any.shape(0) != n))
        throw UserError(what + " must be an array of shape (" + (n < 0 ? "n" : std::to_string(n))
                        + ", " + std::to_string(width) + "), but is " + description(object, any)
                        + ".");
      const char kind = any.dtype().kind();
      if (std::is_integral_v<Number> && kind != 'i' && kind != 'u')
        throw UserError(what + " must be an array of integers.");
      py::array_t<Number, py::array::c_style | py::array::forcecast> rows;
      if (kind != 'c') // of which the real parts alone would be taken
        rows = decltype(rows)::ensure(any);
      if (kind == 'c' || !rows)
        throw UserError(what + " must be an array of real numbers.");
      return rows;
    }

    std::vector<dealii::Point<3>>
    points_of(const py::handle &object, const std::string &what, const py::ssize_t n = -1)
    {
      const auto                    rows = rows_of<double>(object, what, n, 3);
      const auto                    x    = rows.unchecked<2>();
      std::vector<dealii::Point<3>> points;
      for (py::ssize_t i = 0; i < x.shape(0); ++i)
        points.emplace_back(x(i, 0), x(i, 1), x(i, 2));
      return points;
    }

    /// Refuses what is negative, which would become large.
    unsigned int
    index_of(const long long value, const std::string &what)
    {
      if (value < 0 || value > std::numeric_limits<unsigned int>::max())
        throw UserError(what + " has " + std::to_string(value)
                        + ", which is not allowed. Allowed: indices from 0; if 1 was subtracted "
                          "from such ones, add it to all.");
      return static_cast<unsigned int>(value);
    }

    MshFile
    mesh_of(const py::object &mesh)
    {
      const auto parts = py::tuple(mesh);
      if (parts.size() != 2 && parts.size() != 3)
        throw UserError("mesh must be (nodes (n, 3), cells (m, 4)) or (nodes, cells, material ids "
                        "(m)). A file is "
                        "named by the scene: Mesh/File.");
      const auto rows  = rows_of<long long>(parts[1], "mesh: cells", -1, 4);
      const auto nodes = rows.unchecked<2>();
      std::vector<std::array<unsigned int, 4>> cells(nodes.shape(0));
      for (py::ssize_t c = 0; c < nodes.shape(0); ++c)
        for (py::ssize_t v = 0; v < 4; ++v)
          cells[c][v] = index_of(nodes(c, v), "mesh: cells");
      std::vector<unsigned int> material_ids;
      if (parts.size() == 3)
        for (const py::handle id : parts[2])
          material_ids.push_back(index_of(id.cast<long long>(), "mesh: material ids"));
      return make_msh(points_of(parts[0], "mesh: nodes"), cells, material_ids);
    }
  } // namespace

  Given
  from_python(const py::object &scene, const py::object &mesh, const py::object &poses)
  {
    Given                   given;
    std::vector<Assignment> assignments;
    if (py::isinstance<py::dict>(poses)
        || (py::isinstance<py::array>(poses)
            && py::reinterpret_borrow<py::array>(poses).ndim() != 3))
      throw UserError("poses must be a list of arrays (n, 3), such as [bent], but is "
                      + description(poses, py::array::ensure(poses)) + ".");
    const auto list = poses.is_none() ? py::list() : py::list(poses);
    if (!poses.is_none())
    {
      std::string names;
      for (std::size_t i = 0; i < list.size(); ++i)
        names += (i == 0 ? "pose_" : ", pose_") + std::to_string(i);
      assignments.push_back({ { "Examples" }, "Poses", names, "poses" });
    }
    given.scene = read_scene(scene, assignments);
    for (std::size_t i = 0; i < list.size(); ++i)
      given.inputs.poses[given.scene.examples.poses[i]]
          = points_of(list[i], "poses[" + std::to_string(i) + "]");
    if (!mesh.is_none())
      given.inputs.mesh = mesh_of(mesh);
    return given;
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
      for (const dealii::Point<3> &u :
           points_of(function(points, time),
                     "Handles/" + handle + ": what the function of its motion returns", n))
        displacements.push_back(u);
      return displacements;
    };
  }
} // namespace Exemplar::Python
