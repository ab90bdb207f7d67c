// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/mesh/selection.h>
#include <exemplar/run/scene/scene_parameters.h>

namespace Exemplar
{
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
      examples.importance = 1.;
      examples.weights    = WeightRule::prescribed;
      if (examples.prescribed_weights.empty() && examples.n_examples() == 2)
        examples.prescribed_weights = "1-t; t"; // from the first to the second
      // there are no squeezing loads, and cells may be rotated by more than 540 degrees
      if (model.dilatation == DilatationKind::automatic)
        model.dilatation = DilatationKind::cells;
    }
    if (const std::optional<CellLaw> law = material.law_of_grain(); law)
      model.strain = law_of_grain(*law);
    model.complete();
    // else the ridge alone would move the balanced rest pose
    if (loads.balanced && examples.weights == WeightRule::simplex
        && examples.weight_penalty == "auto")
      examples.weight_penalty = "weak";
    if (solver.method != Method::automatic)
      return;
    if (model.is_frozen())
      solver.method = Method::fixed_point;
    else
      solver.method = scene == SceneKind::dynamic ? Method::quasi_newton : Method::newton;
  }

  CellLaw
  CompleteScene::law_of_grain(const CellLaw law) const
  {
    const std::string keys = "Material/Fibre stiffness and Material/Orthotropy";
    if (model.is_frozen())
      throw UserError(
          keys
          + " are not for Model/Gradient = frozen: the frozen force would turn a free body with "
            "fibres, also without examples. Set Model/Gradient = consistent.");
    if (model.strain != CellLaw::corotational && model.strain != law)
      throw UserError(
          keys + " are for Model/Strain = corotational, not for " + traits_of(model.strain).name
          + ". Set that, or remove the fibres (Fibre stiffness = 0, Orthotropy empty).");
    return law;
  }

  void
  CompleteScene::check() const
  {
    if (scene == SceneKind::interpolation)
      check_interpolation();
    model.check();
    material.check();
    examples.check();
    if (examples.in_use() && examples.creep_viscosity > 0. && scene != SceneKind::dynamic)
      throw UserError(
          "Examples/Creep viscosity resists the rate at which weights change, but only a "
          "dynamic scene has rates. Set Scene = dynamic, or hold weights with "
          "Examples/Yield instead.");
    initial.check();
    if (loads.ramp == LoadRamp::increments && scene != SceneKind::statics)
      throw UserError(
          "Loads/Ramp = increments lets loads grow with the increments of a static scene, "
          "but this scene has none. Set Loads/Ramp = none, and a Force that grows with t.");
    if (examples.need_fibres() && !material.law_of_grain())
      throw UserError(
          "Examples/Acts on speaks of fibres, but no material has any. Set Material/Fibre "
          "stiffness and Material/Fibre direction, or Examples/Acts on = all.");
    check_laws();
    check_solver();
    check_surface();
    mesh.check_carried();
    if (output.final_pose == FinalTetrahedra::quadratic
        && !traits_of(model.element).has_edge_nodes())
      throw UserError("Output/Final pose = quadratic writes the nodes in the middles of edges, but "
                      "Model/Element = P1 has none. Set Model/Element = P2, or Output/Final pose = "
                      "linear.");
    if (output.space_error != SpaceErrorUse::never && !has_richer(model.element))
      throw UserError("Output/Space error compares linear elements with quadratic ones, but "
                      "Model/Element = P2. Set Model/Element = P1, or Output/Space error = false.");
    if (output.keep_states && output.every == 0)
      throw UserError(
          "Output/Keep states = true keeps the state of each frame, but Output/Every = 0 "
          "makes no frames. Set Output/Every, or Output/Keep states = false.");
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
      if (handle.select.is_of_surface() || !handle.follow_cache.empty())
        return "Handles/" + handle.name
               + (handle.follow_cache.empty() ? "/Select" : "/Follow cache");
    for (const LoadParameters &load : loads.named)
      if (load.select.is_of_surface())
        return "Loads/" + load.name + "/Select";
    for (const auto &[selection, key] : material.selections())
      if (selection.is_of_surface())
        return key;
    if (material.is_painted())
      return "Material/... map";
    return examples.are_painted() ? "Examples/Weight maps" : "";
  }

  void
  SceneParameters::check_surface() const
  {
    if (!mesh.surface_file().empty())
      return;
    if (const std::string key = key_read_off_surface(); !key.empty())
      throw UserError(key
                      + " is read off the surface of the body, but the scene names none. Set "
                        "Mesh/Surface to the surface that the mesh was made from.");
    if (output.shows_surface())
      throw UserError("Output/Formats has a format that shows the surface of the body, but the "
                      "scene names none. Set Mesh/Surface to the surface that the mesh was made "
                      "from, or Output/Formats = vtu.");
    const auto check_pose = [&](const std::string &file, const std::string &key)
    {
      if (is_surface_file(file) && mesh.surface_file().empty())
        throw UserError(key + ": " + file
                        + " is a surface, but the scene names none at rest that it could be a pose "
                          "of. Set Mesh/Surface to the surface that the mesh was made from, or "
                          "Mesh/File to that surface.");
    };
    for (const std::string &pose : examples.in_use() ? examples.poses : std::vector<std::string>())
      check_pose(pose, "Examples/Poses");
    for (const HandleParameters &handle : handles)
      check_pose(handle.follow_pose, "Handles/" + handle.name + "/Follow pose");
    check_pose(initial.pose, "Initial/Pose");
  }

  void
  SceneParameters::check_interpolation() const
  {
    if (!examples.in_use())
      throw UserError("Scene = interpolation needs example poses. Give Examples/Poses or "
                      "Examples/Pose functions.");
    if (!handles.empty() || !loads.empty())
      throw UserError("Scene = interpolation has neither handles nor loads: it follows its "
                      "prescribed weights. Remove Handles/Names and Loads, or choose Scene = "
                      "static.");
  }

  void
  SceneParameters::check_starts() const
  {
    if (solver.starts == Starts::state)
      return;
    const auto refuse = [](const std::string &why)
    {
      throw UserError(
          "Solver/Starts = examples looks for the equilibrium of least energy from each "
          "example, "
          + why + " Solver/Starts = state.");
    };
    if (scene != SceneKind::statics || !examples.in_use()
        || examples.weights == WeightRule::prescribed)
      refuse("which is for static scenes with examples whose weights are unknown. Set");
    if (model.is_frozen() || solver.method != Method::newton)
      refuse("which needs a descent on the energy. Set Solver/Method = newton and Model/Gradient = "
             "consistent, or");
    if (material.has("Yield stress") || examples.yield > 0.)
      refuse("but what yields depends on the whole way. Set");
  }

  void
  SceneParameters::check_solver() const
  {
    check_starts();
    const bool descends = solver.method == Method::newton || solver.method == Method::quasi_newton;
    if (descends && model.is_frozen())
      throw UserError("Solver/Method = " + method_name(solver.method)
                      + " needs a force that is the gradient of an energy, but "
                        "Model/Gradient = frozen is not. Set Model/Gradient = consistent, or "
                        "Solver/Method = fixed point.");
    if (solver.method == Method::quasi_newton && scene != SceneKind::dynamic)
      throw UserError("Solver/Method = quasi newton goes from step to step of a dynamic scene; "
                      "this one has none. Set Solver/Method = newton, or Scene = dynamic.");
    if (solver.rotations == PassRotations::predicted && scene != SceneKind::dynamic)
      throw UserError(
          "Solver/Rotations = predicted follows the velocities of a dynamic scene; this "
          "one has none. Set Solver/Rotations = last, or Scene = dynamic.");
    const bool bounded = examples.in_use() && examples.weights == WeightRule::simplex;
    if (solver.linear_solver == LinearSolver::umfpack && (bounded || descends))
      throw UserError("Solver/Linear solver = umfpack solves linear systems without bounds and "
                      "cannot tell an indefinite one. Set Solver/Method = fixed point and "
                      "Examples/Weights = free, or Solver/Linear solver = cholesky.");
  }
} // namespace Exemplar
