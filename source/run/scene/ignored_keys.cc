// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/kernels/cell_model.h>
#include <exemplar/run/scene/ignored_keys.h>

#include <fmt/core.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    /// Keys without effect in some scenes.
    struct Ignored
    {
      bool                     are_ignored;
      std::vector<std::string> keys;
      std::string              why; ///< reason and remedy, after "does nothing "
    };

    bool
    has_pose_by_surface(const SceneParameters &scene)
    {
      const std::vector<std::string> &poses = scene.examples.poses;
      return std::any_of(poses.begin(), poses.end(), is_surface_file)
             || is_surface_file(scene.initial.pose)
             || std::any_of(scene.handles.begin(), scene.handles.end(),
                            [](const HandleParameters &handle)
                            { return is_surface_file(handle.follow_pose); });
    }

    /// The constants of laws that the first of their constants chooses, which is 0 everywhere.
    std::vector<Ignored>
    constants_of_absent_laws(const MaterialParameters &material)
    {
      std::vector<Ignored> kinds;
      for (const CellLaw law : all_laws())
        if (const auto chosen_by = traits_of(law).chosen_by;
            chosen_by[0] != nullptr && chosen_by[1] == nullptr)
        {
          Ignored kind{ !material.has(chosen_by[0]),
                        {},
                        fmt::format("without a Material/{}. Set that, or remove it.",
                                    chosen_by[0]) };
          for (const LawConstant &constant : own_constants(law))
            if (constant.name != chosen_by[0])
              kind.keys.push_back(std::string("Material/") + constant.name);
          kinds.push_back(std::move(kind));
        }
      return kinds;
    }

    std::vector<Ignored>
    kinds_of_ignored(const SceneParameters &scene)
    {
      const bool is_dynamic = scene.scene == SceneKind::dynamic;
      const bool has_examples
          = scene.examples.n_examples() > (scene.examples.has_rest_pose() ? 1 : 0);
      std::vector<Ignored>       kinds       = constants_of_absent_laws(scene.material);
      const std::vector<Ignored> of_sections = {
        { !is_dynamic,
          { "Time/Step", "Time/End", "Time/Scheme", "Time/Mass damping", "Time/Stiffness damping",
            "Initial/Velocity" },
          fmt::format("in a scene that is not dynamic: its t goes from 0 to 1 in Time/Increments = "
                      "{} steps. Remove it, or set Scene = dynamic.",
                      scene.time.increments) },
        { is_dynamic,
          { "Time/Increments" },
          "in a dynamic scene, whose steps come from Time/Step and Time/End. Remove it, or "
          "set Scene = static." },
        { !has_examples && scene.examples.importance > 0.,
          { "Examples/Importance", "Examples/Weights", "Examples/Energy", "Examples/Weight penalty",
            "Examples/Acts on", "Examples/Yield", "Examples/Creep viscosity",
            "Examples/Weights per region", "Examples/Regions", "Examples/Weight maps",
            "Examples/Example modulus", "Examples/Example Poisson ratio",
            "Material/Importance factor", "Material/Importance map" },
          "without examples. Give Examples/Poses or Examples/Pose functions, or remove it." },
        { scene.examples.weights == WeightRule::prescribed,
          { "Examples/Weight penalty" },
          "with prescribed weights, of which none is looked for. Remove it." },
        { scene.examples.weights == WeightRule::additive,
          { "Examples/Include rest pose" },
          "with additive weights, whose keys are added to the rest pose. Remove it." },
        { scene.contact.empty(),
          { "Contact/Distance", "Contact/Friction", "Contact/Slip speed", "Contact/Leave out" },
          "without Contact/Self or Contact/Bodies. Set one of them, or remove it." },
        { !scene.contact.empty() && scene.contact.friction == 0.,
          { "Contact/Slip speed" },
          "without friction. Set Contact/Friction, or remove it." },
        { scene.obstacles.empty(),
          { "Obstacles/Distance", "Obstacles/Slip speed", "Obstacles/Lag tolerance",
            "Obstacles/Free" },
          "without Obstacles/Names. Set that, or remove it." },
        { !scene.obstacles.empty() && scene.scene != SceneKind::statics,
          { "Obstacles/Free" },
          "in a scene that is not static. Remove it." },
        { !scene.obstacles.empty() && !scene.obstacles.has_friction(),
          { "Obstacles/Slip speed", "Obstacles/Lag tolerance" },
          "without friction. Set Obstacles/NAME/Friction, or remove it." },
        { !is_dynamic,
          { "Solver/Step tolerance" },
          "in a scene that is not dynamic, whose steps are solved to Solver/Tolerance. Set that "
          "instead, or remove it." },
        { !is_dynamic,
          { "Solver/Background factor" },
          "in a scene that is not dynamic, whose factors serve for one step. Remove it." },
        { !is_dynamic,
          { "Solver/Prediction order" },
          "in a scene that is not dynamic, in which nodes have no velocities. Remove it." },
        { !has_pose_by_surface(scene),
          { "Examples/Attach" },
          "without a pose by a surface (.obj, .ply, .stl) in Examples/Poses. Remove it." },
        { !scene.material.has_fibres(),
          { "Material/Fibre direction", "Material/Fibre direction maps" },
          "without a Material/Fibre stiffness, Fibre tension or Orthotropy. Set one of these, or "
          "remove "
          "it." },
        { !scene.material.has_tension(),
          { "Material/Fibre tension curve", "Material/Fibre tension map" },
          "without a Material/Fibre tension. Set that, or remove it." },
        { scene.material.law_of_grain() != CellLaw::anisotropic,
          { "Material/Cross direction" },
          "without a Material/Orthotropy. Set that, or remove it." },
        { scene.mesh.kind != MeshKind::shell,
          { "Model/Shell", "Examples/Bending importance" },
          "without Mesh/Kind = shell. Set that, or remove it." },
        { scene.mesh.generator != MeshGenerator::box,
          { "Mesh/Box size", "Mesh/Box cells" },
          "without Mesh/Generator = box. Remove it, or set that instead of Mesh/File." },
        { !scene.mesh.is_surface(),
          { "Mesh/Cells", "Mesh/Repair" },
          "unless Mesh/File is a surface. Remove it." }
      };
      kinds.insert(kinds.end(), of_sections.begin(), of_sections.end());
      return kinds;
    }
  } // namespace

  std::vector<std::string>
  warn_of_ignored_keys(const SceneParameters         &scene,
                       const KeyTable                &keys,
                       const std::vector<Assignment> &given)
  {
    std::vector<std::string>       warnings;
    const std::vector<DeclaredKey> all    = keys.keys();
    const auto                     n_keys = std::count_if(
                            all.begin(), all.end(), [](const DeclaredKey &key) { return key.subsections.size() < 2; });
    const bool is_printed
        = static_cast<std::ptrdiff_t>(given.size()) >= n_keys; // as in parameters.prm
    for (const Ignored &kind : kinds_of_ignored(scene))
      for (const DeclaredKey &key : all)
      {
        const bool is_one = std::count(kind.keys.begin(), kind.keys.end(), key.path()) > 0;
        const bool is_set = !is_printed || key.value != key.default_value;
        const Assignment *const first = find_assignment(given, key.path());
        if (kind.are_ignored && is_one && is_set && first != nullptr)
          warnings.push_back(first->place + ": " + key.path() + " = " + first->value
                             + " does nothing " + kind.why);
      }
    for (const LoadParameters &load : scene.loads.named)
      if (load.force == LoadParameters().force)
        warnings.push_back("Loads/" + load.name + " does nothing: its Force is " + load.force
                           + ". Set Loads/" + load.name + "/Force, or remove it from Loads/Names.");
    for (const auto &[selection, key] : scene.choices())
      if (const std::string doubt = selection.doubt(); !doubt.empty())
        warnings.push_back(key + " = '" + selection.text + "': " + doubt);
    return warnings;
  }
} // namespace Exemplar
