// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/mesh/selection.h>
#include <exemplar/run/scene/scene_parameters.h>

namespace Exemplar
{
  namespace
  {
    /// Settings that do not go together, and what to say where they are.
    struct Contradiction
    {
      bool        is_there;
      std::string words;
    };

    /// Throws UserError with the words of the first contradiction.
    void
    refuse(const std::vector<Contradiction> &all)
    {
      for (const auto &[is_there, words] : all)
        if (is_there)
          throw UserError(words);
    }
  } // namespace

  CompleteScene::CompleteScene(SceneParameters scene) : SceneParameters(std::move(scene))
  {
    complete();
    check();
  }

  void
  CompleteScene::complete()
  {
    if (scene == SceneKind::interpolation)
    {
      refuse({ { examples.weights == WeightRule::additive,
                 "Scene = interpolation follows prescribed weights that sum to 1, but "
                 "Examples/Weights = additive. Remove that, or choose Scene = static." } });
      examples.importance = 1.;
      examples.weights    = WeightRule::prescribed;
      if (examples.prescribed_weights.empty() && examples.weights_file.empty()
          && examples.n_examples() == 2)
        examples.prescribed_weights = "1-t; t"; // from the first to the second
      // there are no squeezing loads, and cells may be rotated by more than 540 degrees
      if (model.dilatation == DilatationKind::automatic)
        model.dilatation = DilatationKind::cells;
    }
    if (const std::optional<CellLaw> law = material.law_of_grain(); law)
      model.strain = law_of_grain(*law);
    if (mesh.kind == MeshKind::shell && model.dilatation == DilatationKind::automatic)
      model.dilatation = DilatationKind::cells; // no cell of it has a volume of its own
    model.complete();
    // else the ridge alone would move the balanced rest pose
    if (loads.balanced && examples.are_bounded() && examples.weight_penalty == "auto")
      examples.weight_penalty = "weak";
    if (solver.method != Method::automatic)
      return;
    if (model.is_frozen())
      solver.method = Method::fixed_point;
    else
    {
      // where a limp sheet touches in many places that come and go, a kept factor takes four times the iterations
      const bool touches_as_shell = mesh.kind == MeshKind::shell && !obstacles.empty();
      solver.method = scene == SceneKind::dynamic && !touches_as_shell ? Method::quasi_newton
                                                                       : Method::newton;
    }
  }

  CellLaw
  CompleteScene::law_of_grain(const CellLaw law) const
  {
    const std::string keys = "Material/Fibre stiffness and Material/Orthotropy";
    refuse(
        { { model.is_frozen(),
            keys
                + " are not for Model/Gradient = frozen: the frozen force would turn a free body "
                  "with fibres, also without examples. Set Model/Gradient = consistent." },
          { model.strain != CellLaw::corotational && model.strain != law,
            keys + " are for Model/Strain = corotational, not for " + traits_of(model.strain).name
                + ". Set that, or remove the fibres (Fibre stiffness = 0, Orthotropy empty)." } });
    return law;
  }

  void
  CompleteScene::check() const
  {
    const bool interpolates = scene == SceneKind::interpolation;
    refuse({ { interpolates && !examples.in_use(),
               "Scene = interpolation needs example poses. Give Examples/Poses or Examples/Pose "
               "functions." },
             { interpolates && !(handles.empty() && loads.empty()),
               "Scene = interpolation has neither handles nor loads: it follows its prescribed "
               "weights. Remove Handles/Names and Loads, or choose Scene = static." } });
    check_shell();
    model.check();
    material.check();
    examples.check();
    refuse({ { examples.in_use() && examples.creep_viscosity > 0. && scene != SceneKind::dynamic,
               "Examples/Creep viscosity resists the rate at which weights change, but only a "
               "dynamic scene has rates. Set Scene = dynamic, or hold weights with Examples/Yield "
               "instead." },
             { !initial.pose.empty() && !initial.pose_function.empty(),
               "Initial/Pose and Initial/Pose function are both given. Keep one of them." },
             { loads.ramp == LoadRamp::increments && scene != SceneKind::statics,
               "Loads/Ramp = increments lets loads grow with the increments of a static scene, but "
               "this scene has none. Set Loads/Ramp = none, and a Force that grows with t." },
             { examples.need_fibres() && !material.has_fibres(),
               "Examples/Acts on speaks of fibres, but no material has any. Set Material/Fibre "
               "stiffness or Fibre tension and Material/Fibre direction, or Examples/Acts on = "
               "all." } });
    check_tension();
    check_ties();
    check_laws();
    check_starts();
    check_solver();
    if (!obstacles.empty())
      check_obstacles();
    contact.check();
    if (!contact.empty())
      check_contact();
    if (mesh.surface_file().empty() && mesh.kind == MeshKind::solid)
      check_without_surface();
    mesh.check_carried();
    refuse(
        { { output.final_pose == FinalTetrahedra::quadratic
                && !traits_of(model.element).has_edge_nodes(),
            "Output/Final pose = quadratic writes the nodes in the middles of edges, but "
            "Model/Element = P1 has none. Set Model/Element = P2, or Output/Final pose = linear." },
          { output.space_error != SpaceErrorUse::never && !has_richer(model.element),
            "Output/Space error compares linear elements with quadratic ones, but Model/Element = "
            "P2. Set Model/Element = P1, or Output/Space error = false." },
          { output.keep_states && output.every == 0,
            "Output/Keep states = true keeps the state of each frame, but Output/Every = 0 makes "
            "no frames. Set Output/Every, or Output/Keep states = false." } });
  }

  void
  CompleteScene::check_tension() const
  {
    if (!material.has_tension())
      return;
    const std::string key = "Material/Fibre tension ";
    refuse({ { scene == SceneKind::interpolation,
               key
                   + "is a force, and an interpolation has none. Set Scene = static or dynamic, or "
                     "Fibre tension = 0." },
             { model.is_frozen() || solver.method == Method::one_pass
                   || solver.method == Method::fixed_point,
               key
                   + "needs steps that minimise an energy. Set Model/Gradient = consistent and "
                     "Solver/Method = auto, or Fibre tension = 0." },
             { loads.balanced,
               key
                   + "is no load that initial stresses bear. Set Loads/Balanced = false, or Fibre "
                     "tension = 0." } });
  }

  void
  CompleteScene::check_ties() const
  {
    if (ties.empty())
      return;
    for (const TieParameters &tie : ties)
      tie.check();
    const std::string key = "Ties/Names lists what ties pieces of the mesh to each other, but ";
    refuse({ { scene == SceneKind::interpolation,
               key
                   + "an interpolation has no forces. Set Scene = static or dynamic, or leave "
                     "Ties/Names empty." },
             { loads.balanced,
               key
                   + "Loads/Balanced = true lets handles bear the loads. Set Loads/Balanced = "
                     "false, or leave Ties/Names empty." },
             { output.space_error != SpaceErrorUse::never,
               key
                   + "Output/Space error compares with a body that is tied at other nodes, too. "
                     "Set Output/Space error = false." } });
  }

  void
  CompleteScene::check_starts() const
  {
    const bool        is_asked = solver.starts != Starts::state;
    const std::string key
        = "Solver/Starts = examples looks for the equilibrium of least energy from each example, ";
    refuse({ { is_asked
                   && (scene != SceneKind::statics || !examples.in_use()
                       || examples.weights == WeightRule::prescribed),
               key
                   + "which is for static scenes with examples whose weights are unknown. Set "
                     "Solver/Starts = state." },
             { is_asked && (model.is_frozen() || solver.method != Method::newton),
               key
                   + "which needs a descent on the energy. Set Solver/Method = newton and "
                     "Model/Gradient = consistent, or Solver/Starts = state." },
             { is_asked && (material.has("Yield stress") || examples.yield > 0.),
               key + "but what yields depends on the whole way. Set Solver/Starts = state." } });
  }

  void
  CompleteScene::check_solver() const
  {
    const bool is_dynamic      = scene == SceneKind::dynamic;
    const bool is_quasi_newton = solver.method == Method::quasi_newton;
    const bool descends        = is_quasi_newton || solver.method == Method::newton;
    const bool bounded         = examples.in_use() && examples.are_bounded();
    refuse(
        { { descends && model.is_frozen(),
            "Solver/Method = " + method_name(solver.method)
                + " needs a force that is the gradient of an energy, but Model/Gradient = frozen "
                  "is not. Set Model/Gradient = consistent, or Solver/Method = fixed point." },
          { is_quasi_newton && !is_dynamic,
            "Solver/Method = quasi newton goes from step to step of a dynamic scene; this one has "
            "none. Set Solver/Method = newton, or Scene = dynamic." },
          { solver.rotations == PassRotations::predicted && !is_dynamic,
            "Solver/Rotations = predicted follows the velocities of a dynamic scene; this one has "
            "none. Set Solver/Rotations = last, or Scene = dynamic." },
          { solver.linear_solver == LinearSolver::umfpack && (bounded || descends),
            "Solver/Linear solver = umfpack solves linear systems without bounds and cannot tell "
            "an indefinite one. Set Solver/Method = fixed point and Examples/Weights = free, or "
            "Solver/Linear solver = cholesky." } });
  }

  void
  CompleteScene::refuse_beside_barriers(const std::string &all, const std::string &remedy) const
  {
    refuse(
        { { scene == SceneKind::interpolation,
            all + "an interpolation follows its prescribed weights. Set Scene = static, or "
                + remedy + "." },
          { model.is_frozen() || solver.method == Method::one_pass
                || solver.method == Method::fixed_point,
            all
                + "Model/Gradient = frozen and Solver/Method = one pass or fixed point minimise no "
                  "energy, so that nothing keeps it out. Set Model/Gradient = consistent and "
                  "Solver/Method = auto, or "
                + remedy + "." },
          { solver.starts == Starts::examples,
            all + "Solver/Starts = examples puts it anywhere. Set Solver/Starts = state." },
          { output.space_error != SpaceErrorUse::never,
            all
                + "Output/Space error compares with a body whose other nodes may be inside of "
                  "them. Set Output/Space error = false." },
          { loads.balanced, all
                                + "Loads/Balanced = true lets handles bear it. Set Loads/Balanced "
                                  "= false, or "
                                + remedy + "." } });
  }

  void
  CompleteScene::check_obstacles() const
  {
    refuse_beside_barriers("Obstacles/Names lists what the body may not pass, but ",
                           "leave Obstacles/Names empty");
    obstacles.check();
  }

  void
  CompleteScene::check_contact() const
  {
    refuse_beside_barriers(std::string(contact.self ? "Contact/Self" : "Contact/Bodies")
                               + " = true keeps surfaces of the body out of each other, but ",
                           "set Contact/Self and Contact/Bodies = false");
  }

  void
  CompleteScene::check_without_surface() const
  {
    const std::string remedy       = "Set Mesh/Surface to the surface that the mesh was made from";
    const std::string key          = key_read_off_surface();
    std::vector<Contradiction> all = {
      { !key.empty(),
        key + " is read off the surface of the body, but the scene names none. " + remedy + "." },
      { output.shows_surface(),
        "Output/Formats has a format that shows the surface of the body, but the scene names none. "
            + remedy + ", or Output/Formats = vtu." }
    };
    const auto add_pose = [&](const std::string &file, const std::string &key_of_pose)
    {
      all.push_back(
          { is_surface_file(file),
            key_of_pose + ": " + file
                + " is a surface, but the scene names none at rest that it could be a pose of. "
                + remedy + ", or Mesh/File to that surface." });
    };
    if (examples.in_use())
      for (const std::string &pose : examples.poses)
        add_pose(pose, "Examples/Poses");
    for (const HandleParameters &handle : handles)
      add_pose(handle.follow_pose, "Handles/" + handle.name + "/Follow pose");
    add_pose(initial.pose, "Initial/Pose");
    refuse(all);
  }

  KeyedSelections
  SceneParameters::selects() const
  {
    KeyedSelections all;
    for (const HandleParameters &handle : handles)
      all.emplace_back(handle.select, "Handles/" + handle.name + "/Select");
    for (const LoadParameters &load : loads.named)
      all.emplace_back(load.select, "Loads/" + load.name + "/Select");
    for (const TieParameters &tie : ties)
    {
      all.emplace_back(tie.select, "Ties/" + tie.name + "/Select");
      if (!tie.to.text.empty())
        all.emplace_back(tie.to, "Ties/" + tie.name + "/To");
    }
    return all;
  }

  KeyedSelections
  SceneParameters::choices() const
  {
    KeyedSelections       all        = selects();
    const KeyedSelections of_contact = contact.selections();
    all.insert(all.end(), of_contact.begin(), of_contact.end());
    return all;
  }

  KeyedSelections
  SceneParameters::selections() const
  {
    KeyedSelections       all         = choices();
    const KeyedSelections of_material = material.selections();
    all.insert(all.end(), of_material.begin(), of_material.end());
    return all;
  }

  bool
  SceneParameters::needs_surface() const
  {
    return output.shows_surface() || reads_off_surface();
  }

  bool
  SceneParameters::reads_off_surface() const
  {
    return !key_read_off_surface().empty();
  }

  std::string
  SceneParameters::key_read_off_surface() const
  {
    for (const HandleParameters &handle : handles)
      if (!handle.follow_cache.empty())
        return "Handles/" + handle.name + "/Follow cache";
    for (const auto &[selection, key] : selections())
      if (selection.is_of_surface())
        return key;
    if (material.is_painted())
      return "Material/... map";
    return examples.are_painted() ? "Examples/Weight maps" : "";
  }
} // namespace Exemplar
