// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/nearest_word.h>
#include <exemplar/body/grain_axes.h>
#include <exemplar/run/scene/files_of_keys.h>
#include <exemplar/run/scene/ignored_keys.h>
#include <exemplar/run/scene/named_subsections.h>
#include <exemplar/run/scene/scene_file.h>

#include <algorithm>
#include <set>

namespace Exemplar
{
  namespace
  {
    const EnumTable<SceneKind> scene_kinds = { { SceneKind::interpolation, "interpolation" },
                                               { SceneKind::statics, "static" },
                                               { SceneKind::dynamic, "dynamic" } };

    std::vector<Assignment>
    parse_overrides(const std::vector<std::string> &texts)
    {
      std::vector<Assignment> overrides;
      for (const std::string &text : texts)
        overrides.push_back(parse_override(text));
      return overrides;
    }

    /// Warnings of keys that the command line sets more than once.
    std::vector<std::string>
    warnings_of_doubles(const std::vector<Assignment> &overrides)
    {
      std::vector<std::string> warnings;
      for (auto later = overrides.begin(); later != overrides.end(); ++later)
        for (auto earlier = overrides.begin(); earlier != later; ++earlier)
          if (later->place == "--set" && earlier->place == "--set"
              && later->path() == earlier->path() && later->value != earlier->value)
            warnings.push_back("--set " + later->path() + " is given twice, as "
                               + in_quotes(earlier->value) + " and " + in_quotes(later->value)
                               + ": the last one holds.");
      return warnings;
    }

    /// Whether the subsection is named, that is two deep: Handles/NAME, Loads/NAME, Obstacles/NAME,
    /// Ties/NAME, Mesh/NAME, Material/region N.
    bool
    is_named(const Assignment &assignment)
    {
      return assignment.subsections.size() > 1;
    }

    std::set<std::string>
    sections_of(const std::vector<DeclaredKey> &keys)
    {
      std::set<std::string> sections;
      for (const DeclaredKey &key : keys)
        if (!key.subsections.empty())
          sections.insert(key.subsections[0]);
      return sections;
    }

    /// The regions with subsections of Material, by material id or by name.
    struct Regions
    {
      std::set<unsigned int> ids;
      std::set<std::string>  names;
    };

    Regions
    material_regions(const std::vector<Assignment> &assignments)
    {
      const std::string prefix = "region ";
      Regions           regions;
      for (const Assignment &a : assignments)
        if (is_named(a) && a.subsections[0] == "Material")
        {
          const std::string &subsection = a.subsections[1];
          if (subsection.compare(0, prefix.size(), prefix) != 0
              || subsection.size() == prefix.size())
            throw UnknownKey(a.place + ": subsection Material/" + subsection
                             + " is not understood. Subsections of Material are 'region ID' with a "
                               "material id of the mesh or the name of a Physical Volume.");
          const std::string name = subsection.substr(prefix.size());
          const bool        is_number
              = name.size() < 10 && name.find_first_not_of("0123456789") == std::string::npos;
          if (is_number)
            regions.ids.insert(static_cast<unsigned int>(std::stoul(name)));
          else
            regions.names.insert(name);
        }
      return regions;
    }
  } // namespace

  SceneFile::SceneFile(const std::filesystem::path &file, const std::vector<std::string> &overrides)
      : SceneFile(file, read_prm(file), overrides)
  {
  }

  SceneFile::SceneFile(const std::filesystem::path    &file,
                       const std::string              &text,
                       const std::vector<std::string> &overrides)
      : SceneFile(file, text, parse_overrides(overrides))
  {
  }

  SceneFile::SceneFile(const std::filesystem::path   &file,
                       const std::string             &text,
                       const std::vector<Assignment> &overrides)
      : file(file), text(text)
  {
    if (!file.empty())
      parameters.name = file.string();
    declare_sections();
    std::vector<Assignment> assignments
        = read_assignments(text, parameters.name, sections_of(keys.keys()));
    assignments.insert(assignments.end(), overrides.begin(), overrides.end());
    assignments = MaterialParameters::with_presets(assignments);

    const auto first_named = std::stable_partition(
        assignments.begin(), assignments.end(), [](const Assignment &a) { return !is_named(a); });
    std::vector<Assignment> named(first_named, assignments.end());
    assignments.erase(first_named, assignments.end());

    // refused after the named subsections are declared, so that their keys can be suggested
    const auto first_unknown
        = std::stable_partition(assignments.begin(), assignments.end(),
                                [&](const Assignment &a) { return keys.declares(a.path()); });
    const std::vector<Assignment> unknown(first_unknown, assignments.end());
    assignments.erase(first_unknown, assignments.end());
    keys.apply(assignments, directory());
    check_names(handle_names, "Handles");
    check_names(load_names, "Loads");
    check_names(obstacle_names, "Obstacles");
    check_names(tie_names, "Ties");
    refuse_misspelt_names(unknown);
    const std::vector<std::string> mesh_names = parameters.mesh.names_of_files();
    std::vector<std::string>       warnings
        = drop_unlisted(named, assignments, overrides, "Mesh", mesh_names, "Files");
    for (const auto &[section, names] :
         { std::pair("Handles", &handle_names), std::pair("Loads", &load_names),
           std::pair("Obstacles", &obstacle_names), std::pair("Ties", &tie_names) })
      for (const std::string &warning :
           drop_unlisted(named, assignments, overrides, section, *names))
        warnings.push_back(warning);
    declare_named_subsections(named);
    keys.apply(unknown, directory());
    keys.apply(named, directory());
    if (find_assignment(assignments, "Scene") == nullptr) // after misspelt keys, which may be it
      throw UserError(parameters.name + ": Scene is not set"
                      + (trim(text).empty() && !file.empty() ? ", as the file is empty" : "")
                      + ". Add a line 'set Scene = dynamic' (or static, or "
                        "interpolation).");

    make_selections_absolute();
    if (parameters.output.directory.empty())
      keys.set("Output/Directory",
               "output/" + std::filesystem::path(parameters.name).stem().string());
    complete.emplace(parameters);
    if (parameters.scene == SceneKind::interpolation)
      set_interpolation(assignments);
    const auto is_overridden = [&](const std::string &key)
    { return !text.empty() && find_assignment(overrides, key) != nullptr; };
    if (!is_overridden("Scene") && !is_overridden("Mesh/Generator")) // else ignored keys are fine
      complete->warnings = warn_of_ignored_keys(*complete, keys, assignments);
    for (const std::string &double_warning : warnings_of_doubles(overrides))
      warnings.push_back(double_warning);
    complete->warnings.insert(complete->warnings.end(), warnings.begin(), warnings.end());
  }

  void
  SceneFile::refuse_misspelt_names(const std::vector<Assignment> &unknown)
  {
    for (const Assignment &a : unknown)
      if (a.subsections == std::vector<std::string>{ "Handles" }
          || a.subsections == std::vector<std::string>{ "Loads" }
          || a.subsections == std::vector<std::string>{ "Obstacles" }
          || a.subsections == std::vector<std::string>{ "Ties" })
        if (is_near(a.key, "Names"))
          keys.apply({ a }, directory());
  }

  std::filesystem::path
  SceneFile::directory() const
  {
    return file.empty() ? file : std::filesystem::absolute(file).parent_path();
  }

  void
  SceneFile::declare_sections()
  {
    keys.add("Scene", parameters.scene, scene_kinds,
             "What to solve: interpolation between poses, static equilibrium in increments, or "
             "dynamic. To be set in every scene.");
    parameters.mesh.declare(keys);
    parameters.material.declare(keys);
    parameters.model.declare(keys);
    parameters.examples.declare(keys);
    keys.enter_subsection("Handles");
    keys.add_names("Names", handle_names,
                   "Names of the handles, separated by commas; each has a subsection.");
    keys.leave_subsection();
    keys.enter_subsection("Loads");
    parameters.loads.declare(keys);
    keys.add_names("Names", load_names,
                   "Names of dead forces, separated by commas; each has a subsection.");
    keys.leave_subsection();
    keys.enter_subsection("Obstacles");
    keys.add_names(
        "Names", obstacle_names,
        "Names of what the body may not pass, separated by commas; each has a subsection.");
    parameters.obstacles.declare(keys);
    keys.leave_subsection();
    parameters.contact.declare(keys);
    keys.enter_subsection("Ties");
    keys.add_names("Names", tie_names,
                   "Names of what ties nodes of a piece of the mesh to places of another one, "
                   "separated by commas; each has a subsection.");
    keys.leave_subsection();
    parameters.initial.declare(keys);
    parameters.time.declare(keys);
    parameters.solver.declare(keys);
    keys.enter_subsection("Session");
    keys.add_file("File", parameters.session,
                  "What a hand did to the body, as exemplar live --record writes it: played again "
                  "step by step, in the steps in which it was done. Empty: nothing.");
    keys.leave_subsection();
    parameters.output.declare(keys);
  }

  void
  SceneFile::declare_named_subsections(const std::vector<Assignment> &assignments)
  {
    const Regions regions = material_regions(assignments);
    parameters.material.declare_regions(keys, regions.ids, regions.names);
    // deal.II rounds default texts to six digits: take over the text that was set
    for (const DeclaredKey &key : keys.keys())
      if (key.subsections.size() == 2 && key.subsections[0] == "Material")
        keys.set(key.path(), keys.get("Material/" + key.key));
    const auto declare_named
        = [&](const std::string &section, const std::vector<std::string> &names, auto &entries)
    {
      entries.resize(names.size()); // before binding: entries must not move
      keys.enter_subsection(section);
      for (std::size_t i = 0; i < names.size(); ++i)
      {
        entries[i].name = names[i];
        entries[i].declare(keys);
      }
      keys.leave_subsection();
    };
    declare_named("Mesh", parameters.mesh.names_of_files(), parameters.mesh.placed);
    declare_named("Handles", handle_names, parameters.handles);
    declare_named("Loads", load_names, parameters.loads.named);
    declare_named("Obstacles", obstacle_names, parameters.obstacles.named);
    declare_named("Ties", tie_names, parameters.ties);
  }

  void
  SceneFile::make_selections_absolute()
  {
    for (const auto &[selection, key] : parameters.selects())
      keys.set(key, Selection::absolute(selection.text, directory()));
    for (const DeclaredKey &key : keys.keys())
      if (key.key == "Fibre direction")
        keys.set(key.path(), absolute_fibre_direction(key.value, directory()));
    keys.set("Contact/Leave out",
             ContactParameters::absolute_leave_out(parameters.contact.leave_out, directory()));
    for (const ObstacleParameters &obstacle : parameters.obstacles.named)
      keys.set("Obstacles/" + obstacle.name + "/Shape",
               ObstacleParameters::absolute_shape(obstacle.shape, directory()));
  }

  void
  SceneFile::set_interpolation(const std::vector<Assignment> &assignments)
  {
    const auto require = [&](const std::string &key, const std::string &value, const bool agrees)
    {
      const Assignment *assignment = find_assignment(assignments, "Examples/" + key);
      if (assignment != nullptr && !agrees)
        throw UserError(assignment->place + ": Examples/" + key + " = " + assignment->value
                        + ", but an interpolation has " + key + " = " + value
                        + ". Remove the line, or choose Scene = static.");
      keys.set("Examples/" + key, value);
    };
    const ExampleParameters given = parameters.examples; // before completion
    require("Importance", "1", given.importance == complete->examples.importance);
    require("Weights", "prescribed", given.weights == complete->examples.weights);
    if (given.prescribed_weights.empty())
      keys.set("Examples/Prescribed weights", complete->examples.prescribed_weights);
  }

  std::vector<DeclaredKey>
  SceneFile::reference()
  {
    SceneFile samples;
    samples.declare_sections();
    samples.parameters.mesh.files = { "NAME.msh" };
    samples.handle_names          = { "NAME" };
    samples.load_names            = { "NAME" };
    samples.obstacle_names        = { "NAME" };
    samples.tie_names             = { "NAME" };
    samples.declare_named_subsections({ { { "Material", "region 1" }, "", "", "" } });
    return samples.get_keys();
  }

  std::vector<DeclaredKey>
  SceneFile::get_keys() const
  {
    return keys.keys();
  }

  std::vector<std::filesystem::path>
  SceneFile::input_files() const
  {
    std::vector<std::filesystem::path> files;
    for (const DeclaredKey &key : get_keys())
      if ((key.path() != "Examples/Poses" && key.path() != "Examples/Weight maps"
           && key.path() != "Examples/Weights file")
          || parameters.examples.in_use())
        append_files(key, files); // with importance 0 they need not exist
    return files;
  }

  std::vector<std::filesystem::path>
  SceneFile::named_files() const
  {
    std::vector<std::filesystem::path> files;
    for (const DeclaredKey &key : get_keys())
      append_files(key, files);
    return files;
  }
} // namespace Exemplar
