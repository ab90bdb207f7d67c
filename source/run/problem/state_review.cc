// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/words.h>
#include <exemplar/mesh/mesh_checks.h>
#include <exemplar/mesh/rigid_motion.h>
#include <exemplar/potential/body_contact_term.h>
#include <exemplar/potential/fibre_tension_term.h>
#include <exemplar/potential/obstacle_term.h>
#include <exemplar/run/problem/example_starts.h>
#include <exemplar/run/problem/state_review.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

namespace Exemplar
{
  namespace
  {
    using CellTest = std::function<bool(unsigned int cell, const Matrix3<double> &F)>;

    /// Element numbers of cells in which `test` holds at a point, at the problem's state.
    std::vector<std::size_t>
    elements_with(const Problem &problem, const CellTest &test)
    {
      std::vector<unsigned int> cells;
      const FESpace            &fe_space = problem.body.fe_space;
      for (unsigned int point = 0; !fe_space.is_shell() && point < fe_space.n_points(); ++point)
      {
        const unsigned int cell = fe_space.cell_of(point);
        if (test(cell, fe_space.deformation_gradient(point, problem.state.positions))
            && (cells.empty() || cells.back() != cell))
          cells.push_back(cell);
      }
      return whole_elements(problem.body.mesh, cells);
    }

    std::vector<std::size_t>
    inverted_elements(const Problem &problem)
    {
      return elements_with(problem, [](unsigned int, const Matrix3<double> &F)
                           { return determinant(F) <= 0.; });
    }

    double
    max_stretch(const Matrix3<double> &F)
    {
      const auto squares = symmetric_eigensystem(transpose_times(F, F)).values;
      return std::sqrt(std::max({ squares[0], squares[1], squares[2] }));
    }

    /// 1 + 1/nu: a free cell that is stretched further would have a negative thickness.
    double
    stretch_limit(const CellMaterial<double> &material)
    {
      return 3. + 2. * material.mu / std::max(material.lambda, 0.);
    }

    std::string
    describe_end(const Problem &problem, const std::vector<std::size_t> &inverted)
    {
      const bool is_equilibrium = problem.parameters.scene != SceneKind::dynamic
                                  && problem.parameters.solver.method != Method::one_pass;
      return fmt::format(
          "{} inverted at the end: element {}{}{}), or let the body turn: handles with "
          "fewer nodes or Components.",
          inverted.size() == 1 ? "1 cell is" : counted(inverted.size(), "cell") + " are",
          list_numbers(inverted),
          is_equilibrium ? ". The state is an equilibrium, but there may be one of less energy: "
                           "look at the frames, or take smaller steps ("
                         : ". Look at the frames, take smaller steps (",
          problem.parameters.scene == SceneKind::dynamic
              ? "Time/Step"
              : fmt::format("Time/Increments, now {}", problem.parameters.time.increments));
    }

    std::optional<std::string>
    describe_stretched(const Problem &problem)
    {
      if (!traits_of(problem.parameters.model.law()).has_stretch_guard)
        return {};
      double     limit = std::numeric_limits<double>::max();
      const auto elements
          = elements_with(problem,
                          [&](const unsigned int cell, const Matrix3<double> &F)
                          {
                            const double of_cell
                                = stretch_limit(problem.body.material.elasticity(cell));
                            if (!(contract(F, F) > of_cell * of_cell && max_stretch(F) > of_cell))
                              return false;
                            limit = std::min(limit, of_cell);
                            return true;
                          });
      limit = min_of_all(problem.body.exchange(), limit);
      if (elements.empty())
        return {};
      return fmt::format(
          "{} cells are stretched to more than 1 + 1/nu = {} times their length at the end: "
          "element {}. Poisson's ratio nu would make them thinner than nothing, so their forces "
          "mean little. Pull less, or take a smaller Material/Poisson's ratio.",
          elements.size(), short_text(limit), list_numbers(elements));
    }

    std::optional<std::string>
    describe_crushed(const Problem &problem)
    {
      const FibreTensions &tensions = problem.body.material.tensions();
      const auto           elements
          = elements_with(problem,
                          [&](const unsigned int cell, const Matrix3<double> &F)
                          {
                            if (tensions.of_cells.empty() || tensions.of_cells[cell] == 0)
                              return false;
                            const auto           &a = problem.body.material.grain_axes(cell).along;
                            const Vector3<double> now = F * Vector3<double>{ { a[0], a[1], a[2] } };
                            return std::sqrt(dot(now, now)) < TensionCurve::least_stretch;
                          });
      if (elements.empty())
        return {};
      return fmt::format(
          "{} cells are shorter along their fibres than {} times their length at the end, where "
          "tension no longer pulls as Material/Fibre tension says: element {}. Take a smaller "
          "tension, "
          "or a greater Young's modulus.",
          elements.size(), short_text(TensionCurve::least_stretch), list_numbers(elements));
    }

    /// Rotation [rad] beyond which the linear strain is no useful measure.
    constexpr double great_linear_turn = M_PI / 9.;

    std::optional<std::string>
    describe_turned(const Problem &problem)
    {
      const ModelTraits traits = traits_of(problem.parameters.model.law());
      if (traits.is_frame_indifferent)
        return {};
      double         maximum  = 0.;
      const FESpace &fe_space = problem.body.fe_space;
      for (unsigned int point = 0; point < fe_space.n_points(); ++point)
      {
        const Matrix3<double> R
            = closest_rotation(fe_space.deformation_gradient(point, problem.state.positions));
        maximum = std::max(maximum, std::acos(std::clamp(0.5 * (trace(R) - 1.), -1., 1.)));
      }
      maximum = problem.body.exchange().max(maximum);
      if (!(maximum > great_linear_turn))
        return {};
      return "Cells have turned by up to " + short_text(maximum * 180. / M_PI)
             + " degrees, but Model/Strain = " + traits.name
             + " takes turns for strains: beyond some 10 "
               "degrees "
               "its shapes mean little. Set Model/Strain = corotational.";
    }

    /// The example with the prescribed weight 1 in all regions; nothing if there is none.
    std::optional<unsigned int>
    only_example(const Problem &problem)
    {
      const ExamplePoses &poses = problem.examples.poses;
      if (poses.constants().importance != 1.
          || problem.body.exchange().any(problem.body.material.importance_varies()))
        return {};
      std::optional<unsigned int> only;
      for (unsigned int weight = 0; weight < problem.state.weights.size(); ++weight)
      {
        const double       value   = problem.state.weights[weight];
        const unsigned int example = weight % poses.size();
        if (std::abs(value) < 1e-12)
          continue;
        if (std::abs(value - 1.) > 1e-12 || (only && *only != example))
          return {};
        only = example;
      }
      return only;
    }

    std::vector<dealii::Point<3>>
    points_of(const Vector &positions)
    {
      std::vector<dealii::Point<3>> points;
      for (unsigned int dof = 0; dof < positions.size(); dof += 3)
        points.emplace_back(positions[dof], positions[dof + 1], positions[dof + 2]);
      return points;
    }

    /// A sentence on an interpolation that has missed its example; nothing if it has not.
    std::optional<std::string>
    describe_miss(const Problem &problem)
    {
      const auto example = only_example(problem);
      if (problem.parameters.scene != SceneKind::interpolation || !example)
        return {};
      const Exchange &exchange = problem.body.exchange();
      auto            reached  = points_of(whole(exchange, problem.state.positions, true));
      auto pose = points_of(whole(exchange, problem.examples.poses.pose(*example), true));
      if (const NodeNumbering &nodes = problem.body.fe_space.numbering(); nodes.has_slopes())
        for (auto *const points : { &reached, &pose })
          points->resize(nodes.n_places());
      const RigidMotion motion = best_rigid_motion(pose, reached);
      double            miss   = 0.;
      for (std::size_t node = 0; node < pose.size(); ++node)
        miss = std::max(miss, reached[node].distance(motion(pose[node])));
      miss /= problem.body.mesh.diameter();
      if (!(miss > 1e-4))
        return {};
      return fmt::format("The interpolation ends beside example {} ({}), by up to {} % of the "
                         "body's size: another state has its strains, or less energy, as where an "
                         "example has inverted cells. Look at the frames, or take smaller steps{}",
                         *example, problem.examples.poses.name(*example), short_text(100. * miss),
                         problem.body.patches.size() > 0 ? ", or Model/Dilatation = cells." : ".");
    }

    /// Whether there are no loads, and held nodes allow the rest pose.
    bool
    is_unloaded(const Problem &problem)
    {
      if (problem.parameters.scene != SceneKind::statics || problem.actions.loads != nullptr
          || problem.actions.obstacles != nullptr || problem.parameters.material.has_tension()
          || problem.examples.weights.are_prescribed())
        return false;
      const Vector &rest = problem.body.fe_space.rest_positions();
      Vector        held = rest;
      problem.constraints.handles.move(problem.state.time, held);
      held -= rest;
      return problem.body.exchange().max(max_entry(held.begin(), held.end()))
             < 1e-10 * problem.body.mesh.diameter();
    }
    bool
    has_friction_of_obstacles(const Problem &problem)
    {
      return problem.actions.obstacles != nullptr && problem.actions.obstacles->have_friction();
    }

    /// Of normal forces, in words.
    std::string
    allowed_change(const Problem &problem)
    {
      return has_friction_of_obstacles(problem)
                 ? "Obstacles/Lag tolerance, "
                       + shortest_text(problem.actions.obstacles->lag_tolerance)
                 : shortest_text(BodyContactTerm::lag_tolerance);
    }
  } // namespace

  bool
  friction_has_settled(const Problem &problem)
  {
    const PotentialTerms &terms = problem.potential.get_terms();
    return std::all_of(terms.begin(), terms.end(),
                       [](const auto &term) { return term->has_settled(); });
  }

  std::string
  how_to_settle(const Problem &problem)
  {
    constexpr double    least_tolerance = 1e-10; // smaller changes may be rounding
    const bool          of_obstacles    = has_friction_of_obstacles(problem);
    const PieceLengths &now             = of_obstacles ? problem.actions.obstacles->slip_speeds
                                                       : problem.actions.body_contacts->slip_speeds;
    if (of_obstacles && problem.actions.obstacles->lag_tolerance < least_tolerance)
      return "Set Obstacles/Lag tolerance to " + shortest_text(least_tolerance)
             + " or more, as smaller changes may be rounding.";
    return fmt::format(
        "Set {}/Slip speed to a greater value, such as {} m/s, which is ten times the "
        "present one. Where contacts slide, smaller steps help, too.",
        of_obstacles ? "Obstacles" : "Contact", short_text(10. * now.greatest()));
  }

  StateReview::StateReview(const Problem &problem) : problem(problem) {}

  void
  StateReview::add_step(const SolveReport &report)
  {
    if (report.load_stages > 0 && first_raised == 0)
      first_raised = problem.state.step;
    if (!friction_has_settled(problem) && n_unsettled++ == 0)
      first_unsettled = problem.state.step;
    add_displacement();
    const unsigned int n_cells = problem.evaluation.elastic.inverted_cells;
    if (n_cells == 0)
      return;
    if (inversions.n_steps == 0)
    {
      inversions.first_step = problem.state.step;
      inversions.elements   = inverted_elements(problem);
    }
    ++inversions.n_steps;
    if (n_cells <= inversions.n_cells)
      return;
    inversions.n_cells    = n_cells;
    inversions.worst_step = problem.state.step;
  }

  void
  StateReview::add_displacement()
  {
    if (problem.actions.obstacles == nullptr && problem.actions.body_contacts == nullptr)
      return;
    const Vector &velocities = problem.state.velocities; // empty in statics
    const double  distance
        = problem.body.exchange().max(max_entry(velocities.begin(), velocities.end()))
          * problem.time_axis.step_size(problem.state.step);
    if (distance > farthest.distance)
      farthest = { problem.state.step, distance };
  }

  std::vector<std::string>
  StateReview::warnings() const
  {
    std::vector<std::string> all;
    if (const auto inverted = inverted_elements(problem); !inverted.empty())
      all.push_back(describe_end(problem, inverted));
    else if (inversions.n_steps > 0)
      all.push_back(fmt::format(
          "Cells were inverted in {} on the way, up to {} in step {}, first in step {}: element "
          "{}. At the end none is. Smaller steps may avoid it.",
          counted(inversions.n_steps, "step"), inversions.n_cells, inversions.worst_step,
          inversions.first_step, list_numbers(inversions.elements)));
    if (first_raised > 0)
      all.push_back(fmt::format(
          "Step {} stalled under its whole load, so its loads were raised in stages within the "
          "step. {}",
          first_raised,
          problem.parameters.scene == SceneKind::statics
              ? "Loads/Ramp = increments raises them over the increments, with frames of the way."
              : "Smaller steps (Time/Step) may avoid it."));
    if (n_unsettled > 0)
      all.push_back(fmt::format("Friction had not settled in {}, first in step {}: its normal "
                                "forces differ from those of "
                                "the end of the step by more than {} of the greatest. {}",
                                counted(n_unsettled, "step"), first_unsettled,
                                allowed_change(problem), how_to_settle(problem)));
    if (farthest.distance > 2. * problem.body.mesh.diameter())
      all.push_back(fmt::format(
          "The body moved by {} m in step {}, more than twice its size. It may pass around an "
          "obstacle or another body in such a step. Take smaller steps (Time/Step).",
          short_text(farthest.distance), farthest.step));
    for (const auto &warning : { describe_stretched(problem), describe_turned(problem),
                                 describe_miss(problem), describe_crushed(problem) })
      if (warning)
        all.push_back(*warning);
    if (problem.get_audit() != nullptr)
      for (const std::string &warning : problem.get_audit()->warnings())
        all.push_back(warning);
    // strains of 1e-4 are no rounding, unless cells or weights have memory
    const double energy = problem.evaluation.elastic.energy;
    const bool   remembers
        = problem.elastic->remembers() || problem.potential.get_weights().get_memory().in_use();
    if (!remembers && is_unloaded(problem)
        && energy > 1e-8 * unit_energy(problem.body.fe_space, problem.body.material))
      all.push_back(
          "Nothing loads the body, but it has come to rest in a local minimum of its energy at "
          + shortest_text(energy)
          + " J, where the rest pose has less: Initial/Pose may be too far from it.");
    return all;
  }

  std::vector<std::string>
  missed_example_warnings(Problem &problem)
  {
    const std::optional<ExampleStart> missed = missed_example(problem);
    if (!missed)
      return {};
    return { fmt::format(
        "The body has come to rest at {:.3g} J, but in example {}, with the held nodes at "
        "their places, it has {:.3g} J: the pose that was meant may be another one's "
        "neighbour. Set Solver/Starts = examples, which looks from there, too, or "
        "Initial/Pose.",
        problem.evaluation.potential, missed->from, missed->energy) };
  }
} // namespace Exemplar
