// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/nearest_word.h>
#include <exemplar/python/scene_source.h>

#include <fmt/core.h>
#include <pybind11/numpy.h>

#include <algorithm>
#include <cmath>
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
    /// The separator of the entries of a list in the text of a scene.
    std::string
    separator(const std::vector<std::string> &path, const std::string &key)
    {
      static const std::vector<DeclaredKey> keys = SceneFile::reference();
      for (const DeclaredKey &declared : keys) // handles and loads have names of their own
        if (declared.key == key && declared.subsections.size() == path.size()
            && (path.empty() || declared.subsections[0] == path[0]))
          return declared.separator;
      return DeclaredKey().separator;
    }

    bool
    is_list(const py::handle &value)
    {
      if (py::isinstance<py::array>(value))
        return py::reinterpret_borrow<py::array>(value).ndim() > 0;
      return py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value);
    }

    /// Whether a list is one of numbers alone, or has a list in it.
    bool
    holds_arrays(const py::handle &list)
    {
      bool only_numbers = true, has_list = false;
      for (const py::handle entry : list)
      {
        only_numbers = only_numbers && !py::isinstance<py::str>(entry);
        has_list     = has_list || is_list(entry);
      }
      return only_numbers || has_list;
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
      if (py::isinstance<py::dict>(value))
        throw UserError(what
                        + " holds a dictionary in a list. Sections are dictionaries in "
                          "dictionaries: \"Handles\": {\"left\": {\"Select\": ...}}.");
      if (is_list(value))
        throw UserError(what
                        + " holds lists within lists of lists. Allowed: a value, a list of values, "
                          "or of poses a list of lists of three formulas.");
      if (value.is_none())
        throw UserError(what + " is None. Leave the key out, and it has its default.");
      if (py::isinstance<py::float_>(value)) // 2.0 may count steps
        if (const auto number = value.cast<double>();
            number == std::floor(number) && std::abs(number) < 1e9)
          return fmt::format("{}", std::lround(number));
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
    text_for_key(const py::handle               &value,
                 const std::vector<std::string> &path,
                 const std::string              &key,
                 const std::string              &what)
    {
      const auto of_value = [&](const py::handle &entry) { return text_of_value(entry, what); };
      const auto of_entry = [&](const py::handle &entry)
      {
        if (is_list(entry) && key == "Poses")
          throw UserError(what
                          + " names files. Arrays are handed in by exemplar.Problem(scene, mesh, "
                            "poses=[...]).");
        return is_list(entry) ? join(entry, "; ", of_value) : of_value(entry);
      };
      if (!is_list(value))
        return of_value(value);
      if (key == "Select" && holds_arrays(value))
        throw UserError(
            what
            + " holds numbers of nodes. Nodes of an array are held by problem.hold(name, nodes); a "
              "scene "
              "selects by places, such as [\"sphere\", x, y, z, radius], or by [\"nodes\", FILE].");
      if (path.size() == 1 && path[0] == "Material" && py::len(value) > 21)
        throw UserError(what + " is a list of " + std::to_string(py::len(value))
                        + " entries, but a scene gives one value. Values of cells are given by "
                          "problem.set_material(young=..., poisson=..., density=...).");
      const auto entries = py::reinterpret_borrow<py::sequence>(value);
      // weights are a list, or a list of lists, one a region
      const bool is_by_region
          = key == "Prescribed weights" && py::len(entries) > 0 && is_list(py::object(entries[0]));
      return join(value, is_by_region ? " | " : separator(path, key), of_entry);
    }

    /// Adds the key Names to sections that list subsections: without it, the dictionary has listed
    /// all.
    void
    add_names(const py::dict                 &section,
              const std::vector<std::string> &path,
              std::vector<Assignment>        &assignments)
    {
      if (path.size() != 1
          || (path[0] != "Handles" && path[0] != "Loads" && path[0] != "Obstacles"
              && path[0] != "Ties")
          || section.contains("Names"))
        return;
      std::string names;
      for (const auto &[key, value] : section)
        if (py::isinstance<py::dict>(value))
          names += (names.empty() ? "" : ", ") + std::string(py::str(key));
      assignments.push_back({ path, "Names", names, "scene" });
    }

    /// Refuses a list as the value of handles or loads, which need keys of their own.
    void
    require_no_list_of_names(const py::handle               &value,
                             const std::vector<std::string> &path,
                             const std::string              &what)
    {
      if (!path.empty() || !is_list(value))
        return;
      for (const py::handle entry : value)
        if (!py::isinstance<py::str>(entry))
          return;
      throw UserError(what
                      + " is a list of names. Sections are dictionaries, and so is each handle "
                        "and load: \"Handles\": {\"left\": {\"Select\": ...}}.");
    }

    /// The sections that have keys of fixed names.
    std::vector<std::string>
    known_sections()
    {
      std::vector<std::string> names;
      for (const DeclaredKey &declared : SceneFile::reference())
        if (!declared.subsections.empty()
            && std::find(names.begin(), names.end(), declared.subsections[0]) == names.end())
          names.push_back(declared.subsections[0]);
      return names;
    }

    /// Refuses a section or subsection of unknown name; one without keys would otherwise pass
    /// unnoticed.
    void
    require_known_section(const std::vector<std::string> &path)
    {
      const std::vector<std::string> known   = known_sections();
      const std::string             &section = path.front();
      if (std::find(known.begin(), known.end(), section) == known.end())
      {
        const std::string nearest = nearest_word(section, known);
        std::string       all;
        for (const std::string &name : known)
          all += (all.empty() ? "" : ", ") + name;
        throw UserError(fmt::format("scene: there is no section '{}'. {}", section,
                                    nearest.empty() ? "The sections are " + all + "."
                                                    : "Did you mean '" + nearest + "'?"));
      }
      const bool has_names = section == "Handles" || section == "Loads" || section == "Obstacles"
                             || section == "Ties"
                             || (section == "Material" && path.back().rfind("region ", 0) == 0);
      if (path.size() == 2 && !has_names)
        throw UserError(
            fmt::format("scene: section {} has no section '{}'. Remove it.", section, path.back()));
    }

    void
    add_section(const py::dict                 &given,
                const std::vector<std::string> &path,
                std::vector<Assignment>        &assignments)
    {
      const py::dict section = given.attr("copy")(); // str() of a key or a value may change `given`
      if (!path.empty() && section.size() == 0)
        require_known_section(path);
      add_names(section, path, assignments);
      for (const auto &[key, value] : section)
      {
        std::string where = "scene: ";
        for (const std::string &outer : path)
          where += outer + "/";
        const std::string name = text_of(key, where + "a key");
        if (!py::isinstance<py::dict>(value))
        {
          require_no_list_of_names(value, path, where + name);
          assignments.push_back(
              { path, name, text_for_key(value, path, name, where + name), "scene" });
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

    /// The source of a scene given as a dictionary; `assignments` put the given poses= in place of
    /// its own. Only here keys that do nothing in Python cause warnings: files are read by the
    /// program, too.
    SceneSource
    source_of_dictionary(const py::dict                &scene,
                         const std::vector<Assignment> &assignments,
                         const bool                     has_mesh)
    {
      SceneSource source;
      add_section(scene, {}, source.assignments);
      for (const Assignment &a : source.assignments)
        if (a.path().rfind("Output/", 0) == 0)
          source.warnings.push_back(
              a.path()
              + " does nothing in Python, where no files are written. Remove it, and "
                "save what you need, such as problem.positions.");
        else if (has_mesh
                 && (a.path() == "Mesh/File" || a.path() == "Mesh/Files"
                     || a.path() == "Mesh/Generator")
                 && !is_surface_file(a.value)) // a surface may be the skin of the mesh
          source.warnings.push_back(a.path() + " = " + a.value
                                    + " does nothing, as mesh= is given, too. Remove one of them.");
        else if (!assignments.empty() && a.path() == "Examples/Poses")
          source.warnings.push_back(
              a.path() + " = " + a.value
              + " does nothing, as poses= is given, too. Remove one of them, or "
                "hand in all poses as arrays.");
      source.assignments.insert(source.assignments.end(), assignments.begin(), assignments.end());
      return source;
    }

    SceneSource
    source_of_text(const py::object &scene, const std::vector<Assignment> &assignments)
    {
      if (!py::isinstance<py::str>(scene) && !py::hasattr(scene, "__fspath__"))
        throw py::type_error("scene must be the path of a .prm file, its text, or a dictionary of "
                             "sections, but is a "
                             + py::type::of(scene).attr("__name__").cast<std::string>() + ".");
      const std::string text = text_of(py::module_::import("os").attr("fspath")(scene), "scene");
      if (text.find('\n') != std::string::npos || text.compare(0, 4, "set ") == 0)
        return { {}, text, assignments };
      if (is_study(text))
        throw UserError(text + " is a study. Run it by: exemplar study " + text
                        + ". In Python a loop varies a scene: doc/python/sweep.py.");
      return { text, read_prm(text), assignments };
    }
  } // namespace

  SceneSource
  scene_source(const py::object              &scene,
               const std::vector<Assignment> &assignments,
               const bool                     has_mesh)
  {
    SceneSource source
        = py::isinstance<py::dict>(scene)
              ? source_of_dictionary(py::reinterpret_borrow<py::dict>(scene), assignments, has_mesh)
              : source_of_text(scene, assignments);
    source.place    = std::filesystem::absolute(source.file.empty() ? "scene.prm" : source.file);
    source.has_mesh = has_mesh;
    return source;
  }
} // namespace Exemplar::Python
