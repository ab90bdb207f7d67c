// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/message_text.h>
#include <exemplar/base/number_text.h>
#include <exemplar/body/pose_checks.h>
#include <exemplar/prm/assignments.h>
#include <exemplar/run/problem/scene_review.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace Exemplar
{
  namespace
  {
    using Warning = std::optional<std::string>;

    // Poisson's ratios up to which elements are verified (doc/measured.md), and from which linear
    // elements without patches lock.
    constexpr double max_verified_ratio = 0.4999, locking_ratio = 0.49;

    // Residual tolerances beyond which states are no equilibria, and step tolerances beyond which
    // they are far from the limit.
    constexpr double great_tolerance = 0.05, great_step_tolerance = 0.2;

    // Time constants of damping in a step beyond which no motion is left.
    constexpr double great_damping = 100.;

    // Ratios of edge lengths from which cells are badly shaped.
    constexpr double great_aspect = 50.;

    Warning
    review_poissons_ratio(const Problem &problem)
    {
      const MaterialParameters &material = problem.parameters.material;
      double                    maximum  = material.everywhere.poissons_ratio;
      for (const auto &[id, constants] : material.regions)
        maximum = std::max(maximum, constants.poissons_ratio);
      for (const auto &[name, constants] : material.named_regions)
        maximum = std::max(maximum, constants.poissons_ratio);
      if (maximum > max_verified_ratio * (1. + 1e-9))
        return "A Poisson's ratio of " + shortest_text(maximum)
               + " is beyond 0.4999, up to which the program is verified: steps take many more "
                 "iterations, and hardly differ. Take 0.4999 at most.";
      const bool may_lock
          = traits_of(problem.parameters.model.element).locks && problem.body.patches.size() == 0;
      if (may_lock && maximum > locking_ratio)
        return "With a Poisson's ratio of " + shortest_text(maximum)
               + " linear tetrahedra without patches lock: the body is far too stiff. Set "
                 "Model/Dilatation = auto, or Model/Element = P2.";
      return {};
    }

    // Poisson's ratio from which the rest pose minimises the stable neo-Hookean energy, Eq. (34).
    constexpr double least_neo_hookean_ratio = -0.88;

    Warning
    review_background(const Problem &problem)
    {
      const MaterialParameters &material = problem.parameters.material;
      double                    minimum  = material.everywhere.poissons_ratio;
      for (const auto &[id, constants] : material.regions)
        minimum = std::min(minimum, constants.poissons_ratio);
      for (const auto &[name, constants] : material.named_regions)
        minimum = std::min(minimum, constants.poissons_ratio);
      if (!problem.parameters.model.is_neo_hookean() || minimum >= least_neo_hookean_ratio)
        return {};
      return "With a Poisson's ratio of " + shortest_text(minimum)
             + " a neo-Hookean cell of half its size and turned inside out has less energy than at "
               "rest, so that cells may stay like that. Take "
             + shortest_text(least_neo_hookean_ratio)
             + " at least, or Model/Background = corotational.";
    }

    // Relative stiffness of fibres, and yield stress over Young's modulus, at which states with
    // tolerances 1e-8 and 1e-12 were found to differ by 1e-2 of the body's size.
    constexpr double great_fibres = 1e4, little_yield = 1e-5;

    Warning
    review_extremes(const Problem &problem)
    {
      Warning found;
      problem.parameters.material.for_each_section(
          [&](const ElasticConstants &constants, const std::string &section)
          {
            const double young  = constants.youngs_modulus;
            const double fibres = constants.own.at("Fibre stiffness"),
                         yield  = constants.own.at("Yield stress");
            const bool hardens  = constants.own.at("Kinematic hardening") > 0.
                                 || constants.own.at("Isotropic hardening") > 0.;
            if (fibres > great_fibres * young)
              found = section + "/Fibre stiffness = " + short_text(fibres) + " Pa is "
                      + short_text(fibres / young)
                      + " times Young's modulus: forces in balance to Solver/Tolerance may leave "
                        "places that are off by a "
                        "hundredth of the body. Take less stiff fibres, or compare with "
                        "Solver/Tolerance = 1e-12.";
            else if (yield > 0. && yield < little_yield * young && !hardens)
              found = section + "/Yield stress = " + short_text(yield)
                      + " Pa without hardening, with a Young's modulus of " + short_text(young)
                      + " Pa: such a body flows nearly without resistance, and has more than one "
                        "state "
                        "of equilibrium. Set "
                      + section + "/Isotropic hardening, or a greater yield stress.";
          });
      return found;
    }

    Warning
    review_mass_damping(const Problem &problem)
    {
      const TimeParameters &time = problem.parameters.time;
      if (problem.actions.mass == nullptr || !(time.mass_damping * time.step > great_damping))
        return {};
      return "Time/Mass damping = " + shortest_text(time.mass_damping)
             + " per s stops all motion within " + short_text(1. / time.mass_damping)
             + " s, a small part of Time/Step = " + shortest_text(time.step)
             + ": the body hardly moves. It is a rate in 1/s.";
    }

    Warning
    review_tolerance(const Problem &problem)
    {
      const SolverParameters &solver = problem.parameters.solver;
      if (solver.method == Method::one_pass)
        return {};
      if (solver.method != Method::quasi_newton && solver.tolerance > great_tolerance)
        return "Solver/Tolerance = " + shortest_text(solver.tolerance)
               + " accepts forces that are out of balance by " + short_text(100. * solver.tolerance)
               + " %: steps may end before their first iteration. The default is "
               + shortest_text(SolverParameters().tolerance) + ".";
      if (solver.method == Method::quasi_newton && solver.step_tolerance > great_step_tolerance)
        return "Solver/Step tolerance = " + shortest_text(solver.step_tolerance)
               + " accepts steps that are off by " + short_text(100. * solver.step_tolerance)
               + " %. The default is " + shortest_text(SolverParameters().step_tolerance) + ".";
      return {};
    }

    Warning
    review_prescribed_weights(const Problem &problem)
    {
      const ExampleWeights &weights = problem.examples.weights;
      if (!weights.are_prescribed())
        return {};
      const bool         of_file      = !weights.get_table().empty();
      bool               extrapolates = false;
      double             minimum = 0., maximum = 1.;
      const unsigned int n_looks = std::min(problem.time_axis.n_steps(), 100u);
      for (unsigned int look = 0; look <= n_looks; ++look)
      {
        const auto step
            = static_cast<unsigned int>(std::size_t(look) * problem.time_axis.n_steps() / n_looks);
        const std::vector<double> values = weights.at(problem.time_axis.time(step));
        minimum = std::min(minimum, *std::min_element(values.begin(), values.end()));
        maximum = std::max(maximum, *std::max_element(values.begin(), values.end()));
        for (unsigned int weight = 0; weight < values.size(); ++weight)
          if (problem.examples.poses.is_strained(
                  weight)) // the rest pose asks for nothing, whatever its weight
            extrapolates = extrapolates || values[weight] < -0.01 || values[weight] > 1.01;
      }
      if (!extrapolates)
        return {};
      return fmt::format(
          "Examples/{} go{} from {} to {}: beyond 0 and 1 the examples are extrapolated. {}",
          of_file ? "Weights file" : "Prescribed weights", of_file ? "es" : "", short_text(minimum),
          short_text(maximum),
          of_file ? "Bound the values of the file if that is not intended."
                  : "If t is to go further, bound them, as by min(t, 1).");
    }

    /// Warn of times of a table of weights that the scene does not reach, but for a dynamic scene that ends before.
    Warning
    review_weight_table(const Problem &problem)
    {
      const std::vector<double> &times = problem.examples.weights.get_table().times;
      if (times.size() < 2)
        return {};
      const std::string key = "Examples/Weights file";
      const double      end = end_of_scene(problem);
      if (times.front() >= end)
        return fmt::format("{} begins at t = {}, and the scene ends at t = {}: its first weights "
                           "are taken all the time. "
                           "Change its times or the scene's.",
                           key, short_text(times.front()), short_text(end));
      if (problem.parameters.scene == SceneKind::dynamic || times.back() <= end * (1. + 1e-6))
        return {};
      return fmt::format("{} goes to t = {}, but t of a scene that is not dynamic ends at 1. "
                         "Divide its times by {}, or "
                         "set Scene = dynamic and Time/End = {}.",
                         key, short_text(times.back()), shortest_text(times.back()),
                         shortest_text(times.back()));
    }

    /// Warn of motions in components that are not held, which have no effect.
    Warning
    review_components(const HandleParameters &handle)
    {
      const std::vector<std::string> formulas   = split_trimmed(handle.motion, ';');
      const std::vector<std::string> components = split_trimmed(handle.components, ',');
      std::vector<std::string>       ignored;
      for (std::size_t c = 0; c < std::min<std::size_t>(formulas.size(), 3); ++c)
        if (const std::string name(1, "xyz"[c]);
            parse_number(formulas[c]) != 0.
            && std::count(components.begin(), components.end(), name) == 0)
          ignored.push_back(name);
      if (ignored.empty())
        return {};
      return "Handles/" + handle.name + "/Motion = '" + handle.motion + "' moves along "
             + joined(ignored) + ", too, but Handles/" + handle.name + "/Components = '"
             + handle.components + "' leaves that free: this part of the motion does nothing. Add "
             + joined(ignored) + " to Components, or write 0 there.";
    }

    Warning
    review_box(const MeshParameters &mesh)
    {
      if (mesh.generator != MeshGenerator::box)
        return {};
      std::array<double, 3> edge;
      for (unsigned int c = 0; c < 3; ++c)
        edge[c] = mesh.box_size[c] / mesh.box_cells[c];
      const double aspect = *std::max_element(edge.begin(), edge.end())
                            / *std::min_element(edge.begin(), edge.end());
      if (!(aspect > great_aspect))
        return {};
      return "The cells of the box have edges of " + short_text(edge[0]) + ", "
             + short_text(edge[1]) + " and " + short_text(edge[2])
             + " m: so long ones for their width compute badly. Choose Mesh/Box cells in the "
               "proportions of Mesh/Box size.";
    }

    Warning
    review_lone_example(const Problem &problem)
    {
      if (problem.examples.poses.size() != 1 || problem.examples.weights.are_additive()
          || problem.parameters.scene == SceneKind::interpolation)
        return {};
      return "There is one example, and Examples/Include rest pose is false: its weight is always "
             "1, "
             "so it pulls at the body all the time. Set Examples/Include rest pose = true for a "
             "body that rests in its rest pose.";
    }

    /// Warn of flaws of an initial pose from a file; a formula may turn the body inside out on
    /// purpose.
    Warning
    review_initial_pose(const Problem &problem)
    {
      if (problem.parameters.initial.pose.empty() || problem.state.step > 0)
        return {};
      const std::string doubt
          = describe_pose(problem.body.mesh, problem.body.fe_space, problem.state.positions, true);
      return doubt.empty() ? Warning() : "Initial/Pose " + doubt;
    }

    Warning
    review_surface(const MeshParameters &mesh)
    {
      const std::string surface = mesh.surface_file();
      if (surface.empty() || is_surface_file(surface))
        return {};
      return "Mesh/Surface = " + surface
             + " is no surface, and nothing in this scene is read off one. Give an .obj, "
               ".ply or .stl file, or remove it.";
    }
  } // namespace

  std::vector<std::string>
  scene_warnings(const Problem &problem)
  {
    std::vector<Warning> found
        = { review_poissons_ratio(problem),      review_background(problem),
            review_mass_damping(problem),        review_tolerance(problem),
            review_prescribed_weights(problem),  review_lone_example(problem),
            review_box(problem.parameters.mesh), review_extremes(problem),
            review_initial_pose(problem),        review_surface(problem.parameters.mesh),
            review_weight_table(problem) };
    for (const HandleParameters &handle : problem.parameters.handles)
      found.push_back(review_components(handle));
    std::vector<std::string> warnings;
    for (const Warning &warning : found)
      if (warning)
        warnings.push_back(*warning);
    return warnings;
  }

  std::string
  pose_warning(const Problem &problem, const unsigned int example)
  {
    const std::string doubt = describe_pose(problem.body.mesh, problem.body.fe_space,
                                            problem.examples.poses.pose(example));
    return doubt.empty()
               ? doubt
               : fmt::format("Example {} {}", problem.examples.poses.number(example), doubt);
  }
} // namespace Exemplar
