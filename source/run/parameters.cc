// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/parameters.h>

#include <algorithm>
#include <set>

namespace Exemplar
{
  namespace
  {
    const EnumTable<SceneKind> scene_kinds = { { SceneKind::interpolation, "interpolation" },
                                               { SceneKind::statics, "static" },
                                               { SceneKind::dynamic, "dynamic" } };

    const dealii::Patterns::List names_pattern{ dealii::Patterns::Anything() };

    std::vector<Assignment>
    parse_overrides(const std::vector<std::string> &texts)
    {
      std::vector<Assignment> overrides;
      for (const std::string &text : texts)
        overrides.push_back(parse_override(text));
      return overrides;
    }

    /// Named subsections are the ones two deep: Handles/NAME, Loads/NAME, Material/region N.
    bool
    is_named(const Assignment &assignment)
    {
      return assignment.subsections.size() > 1;
    }

    void
    check_names(const std::vector<std::string> &names, const std::string &section)
    {
      std::set<std::string> seen;
      for (const std::string &name : names)
      {
        if (!seen.insert(name).second)
          throw UserError(section + "/Names lists '" + name + "' twice. Names must differ.");
        if (name.empty() || name.find_first_of("/\";|") != std::string::npos)
          throw UserError(section + "/Names: '" + name
                          + "' is no name. Use letters, digits, blanks, - and _.");
      }
    }

    /// A subsection that Names does not list would be an unknown key without a hint.
    void
    check_listed(const std::vector<Assignment>  &assignments,
                 const std::string              &section,
                 const std::vector<std::string> &names)
    {
      std::string listed;
      for (const std::string &name : names)
        listed += (listed.empty() ? "" : ", ") + name;
      for (const Assignment &a : assignments)
        if (a.subsections[0] == section
            && std::find(names.begin(), names.end(), a.subsections[1]) == names.end())
          throw UnknownKey(a.place + ": subsection " + section + "/" + a.subsections[1]
                           + " is not in " + section
                           + "/Names (there: " + (listed.empty() ? "none" : listed)
                           + "). Add it there, or remove the subsection.");
    }

    std::set<unsigned int>
    material_regions(const std::vector<Assignment> &assignments)
    {
      const std::string      prefix = "region ";
      std::set<unsigned int> ids;
      for (const Assignment &a : assignments)
        if (is_named(a) && a.subsections[0] == "Material")
        {
          const std::string &name = a.subsections[1];
          if (name.compare(0, prefix.size(), prefix) != 0 || name.size() == prefix.size()
              || name.size() > prefix.size() + 9
              || name.find_first_not_of("0123456789", prefix.size()) != std::string::npos)
            throw UnknownKey(a.place + ": subsection Material/" + name
                             + " is not understood. Subsections of Material are 'region ID' with a "
                               "material id of the mesh.");
          ids.insert(static_cast<unsigned int>(std::stoul(name.substr(prefix.size()))));
        }
      return ids;
    }
  } // namespace

  Parameters::Parameters()
  {
    declare_sections();
    handle_names = { "NAME" };
    load_names   = { "NAME" };
    declare_named_subsections({ { { "Material", "region 1" }, "", "", "" } });
  }

  Parameters::Parameters(const std::filesystem::path    &scene_file,
                         const std::vector<std::string> &overrides)
      : Parameters(scene_file, read_prm(scene_file), overrides)
  {
  }

  Parameters::Parameters(const std::filesystem::path    &scene_file,
                         const std::string              &scene_text,
                         const std::vector<std::string> &overrides)
      : Parameters(scene_file, scene_text, parse_overrides(overrides))
  {
  }

  Parameters::Parameters(const std::filesystem::path   &scene_file,
                         const std::string             &scene_text,
                         const std::vector<Assignment> &overrides)
      : scene_file(scene_file), scene_text(scene_text)
  {
    std::vector<Assignment> assignments = read_assignments(scene_text, scene_file.string());
    assignments.insert(assignments.end(), overrides.begin(), overrides.end());
    if (find_assignment(assignments, "Scene") == nullptr)
      throw UserError(scene_file.string()
                      + ": Scene is not set. Add a line 'set Scene = dynamic' (or static, or "
                        "interpolation).");

    const auto directory   = std::filesystem::absolute(scene_file).parent_path();
    const auto first_named = std::stable_partition(
        assignments.begin(), assignments.end(), [](const Assignment &a) { return !is_named(a); });
    const std::vector<Assignment> named(first_named, assignments.end());
    assignments.erase(first_named, assignments.end());

    declare_sections();
    apply_assignments(prm, assignments, directory);
    check_names(handle_names, "Handles");
    check_names(load_names, "Loads");
    check_listed(named, "Handles", handle_names);
    check_listed(named, "Loads", load_names);
    declare_named_subsections(named);
    apply_assignments(prm, named, directory);

    make_selections_absolute();
    if (scene == SceneKind::interpolation)
      complete_interpolation(assignments);
    if (output.directory.empty())
      set({ "Output" }, "Directory", "output/" + scene_file.stem().string());
    choose_method();
    check();
  }

  void
  Parameters::declare_sections()
  {
    declare_enum(prm, "Scene", scene, scene_kinds,
                 "What to solve: interpolation between poses, static equilibrium in increments, or "
                 "dynamic. To be set in every scene.");
    mesh.declare(prm);
    material.declare(prm);
    model.declare(prm);
    examples.declare(prm);
    prm.enter_subsection("Handles");
    prm.add_parameter("Names", handle_names,
                      "Names of the handles, separated by commas; each has a subsection.",
                      names_pattern);
    prm.leave_subsection();
    prm.enter_subsection("Loads");
    prm.add_parameter(
        "Gravity", gravity,
        "Acceleration of gravity [m/s^2]. It acts in full from the start, also in a static "
        "scene; a weight that grows is a force of Loads/Names on a region.");
    prm.add_parameter("Names", load_names,
                      "Names of dead forces, separated by commas; each has a subsection.",
                      names_pattern);
    prm.leave_subsection();
    initial.declare(prm);
    time.declare(prm);
    solver.declare(prm);
    output.declare(prm);
  }

  void
  Parameters::declare_named_subsections(const std::vector<Assignment> &assignments)
  {
    const std::set<unsigned int> regions = material_regions(assignments);
    material.declare_regions(prm, regions);
    // deal.II rounds the text of a default to six digits: take over the text that was set
    for (const std::string key : { "Young's modulus", "Poisson's ratio", "Density" })
      for (const unsigned int id : regions)
        set({ "Material", "region " + std::to_string(id) }, key, prm.get({ "Material" }, key));
    handles.resize(handle_names.size()); // before binding: entries must not move afterwards
    loads.resize(load_names.size());
    prm.enter_subsection("Handles");
    for (unsigned int i = 0; i < handles.size(); ++i)
    {
      handles[i].name = handle_names[i];
      handles[i].declare(prm);
    }
    prm.leave_subsection();
    prm.enter_subsection("Loads");
    for (unsigned int i = 0; i < loads.size(); ++i)
    {
      loads[i].name = load_names[i];
      loads[i].declare(prm);
    }
    prm.leave_subsection();
  }

  void
  Parameters::set(const std::vector<std::string> &subsections,
                  const std::string              &key,
                  const std::string              &value)
  {
    for (const std::string &subsection : subsections)
      prm.enter_subsection(subsection);
    prm.set(key, value);
    for (std::size_t i = 0; i < subsections.size(); ++i)
      prm.leave_subsection();
  }

  void
  Parameters::make_selections_absolute()
  {
    const auto directory = std::filesystem::absolute(scene_file).parent_path();
    for (const HandleParameters &handle : handles)
      set({ "Handles", handle.name }, "Select", Selection::absolute(handle.select.text, directory));
    for (const LoadParameters &load : loads)
      set({ "Loads", load.name }, "Select", Selection::absolute(load.select.text, directory));
  }

  void
  Parameters::complete_interpolation(const std::vector<Assignment> &assignments)
  {
    const auto require = [&](const std::string &key, const std::string &value, const bool agrees)
    {
      const Assignment *given = find_assignment(assignments, "Examples/" + key);
      if (given != nullptr && !agrees)
        throw UserError(given->place + ": Examples/" + key + " = " + given->value
                        + ", but an interpolation has " + key + " = " + value
                        + ". Remove the line, or choose Scene = static.");
      set({ "Examples" }, key, value);
    };
    require("Importance", "1", examples.importance == 1.);
    require("Weights", "prescribed", examples.weights == ExampleWeights::prescribed);
    if (!examples.in_use())
      throw UserError("Scene = interpolation needs example poses. Give Examples/Poses or "
                      "Examples/Pose functions.");
    if (!handles.empty() || !loads.empty() || gravity.norm() > 0.)
      throw UserError("Scene = interpolation has neither handles nor loads: it follows its "
                      "prescribed weights. Remove Handles/Names and Loads, or choose Scene = "
                      "static.");
  }

  void
  Parameters::choose_method()
  {
    // in the file it stays auto, so that parameters.prm says what the scene said
    if (solver.method != Method::automatic)
      return;
    if (model.is_frozen())
      solver.method = Method::fixed_point;
    else
      solver.method = scene == SceneKind::dynamic && solver.linear_solver != LinearSolver::iterative
                          ? Method::quasi_newton
                          : Method::newton;
  }

  void
  Parameters::check() const
  {
    material.check();
    examples.check();
    const bool descends = solver.method == Method::newton || solver.method == Method::quasi_newton;
    if (descends && model.is_frozen())
      throw UserError("Solver/Method = " + method_name(solver.method)
                      + " needs a force that is the gradient of an energy, but "
                        "Model/Gradient = frozen is not. Set Model/Gradient = consistent, or "
                        "Solver/Method = fixed point.");
    if (solver.method == Method::quasi_newton && scene != SceneKind::dynamic)
      throw UserError("Solver/Method = quasi newton goes from step to step of a dynamic scene; "
                      "this one has none. Set Solver/Method = newton, or Scene = dynamic.");
    if (solver.method == Method::quasi_newton && solver.linear_solver == LinearSolver::iterative)
      throw UserError("Solver/Method = quasi newton keeps a factor, but Solver/Linear solver = "
                      "iterative makes none. Set it to cholesky, or Solver/Method = newton.");
    if (solver.rotations == PassRotations::predicted && scene != SceneKind::dynamic)
      throw UserError(
          "Solver/Rotations = predicted follows the velocities of a dynamic scene; this "
          "one has none. Set Solver/Rotations = last, or Scene = dynamic.");
    const bool bounded = examples.in_use() && examples.weights == ExampleWeights::simplex;
    if (solver.linear_solver == LinearSolver::umfpack && (bounded || descends))
      throw UserError("Solver/Linear solver = umfpack solves linear systems without bounds and "
                      "cannot tell an indefinite one. Set Solver/Method = fixed point and "
                      "Examples/Weights = free, or Solver/Linear solver = cholesky.");
  }

  std::vector<DeclaredKey>
  Parameters::keys() const
  {
    return declared_keys(prm);
  }

  std::vector<std::filesystem::path>
  Parameters::input_files() const
  {
    std::vector<std::filesystem::path> files;
    for (const DeclaredKey &key : keys())
      if (key.path() == "Examples/Poses" && !examples.in_use())
        continue; // with importance 0 the poses need not be there
      else if (key.is_input_file)
        for (const std::string &file : split_trimmed(key.value, key.is_list ? ',' : '\n'))
          files.emplace_back(file);
      else if (key.key == "Select" && key.value.compare(0, 6, "nodes ") == 0)
        files.emplace_back(key.value.substr(6));
    return files;
  }
} // namespace Exemplar
