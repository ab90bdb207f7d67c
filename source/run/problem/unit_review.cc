// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/agreement.h>
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/words.h>
#include <exemplar/prm/degrees.h>
#include <exemplar/prm/expression.h>
#include <exemplar/run/problem/unit_review.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace Exemplar
{
  namespace
  {
    using Warning = std::optional<std::string>;

    // Lengths [m] beyond which a body is probably in another unit: a hand in millimetres is 180
    // long, a metre that was scaled for millimetres .001.
    constexpr double great_length = 100., small_length = 0.005;

    // Length [m] beyond which a body as soft as this [Pa] is probably in another unit.
    constexpr double great_soft_length = 20., soft_as_rubber = 1e8;

    // Densities [kg/m^3] of air 1.2, light foam 10, osmium 22,600; in g/cm^3 steel has 7.8, copper
    // 8.96.
    constexpr double light = 9., heavy = 25000.;

    // Young's moduli [Pa] of jelly some 1,000, of diamond 1.2e12.
    constexpr double soft = 1000., stiff = 1e13;

    // Sag relative to length, and strain, below which gravity is plausible.
    constexpr double great_sag = 0.2, great_strain = 0.05;

    // Strain by its own weight with which a body on a floor is seen to sink, and one that is hardly seen.
    constexpr double great_standing_strain = 0.1, good_standing_strain = 0.02;

    // Strain by a load beyond which it is implausible for the body's section and stiffness.
    constexpr double great_pull = 5.;

    // Number of files that fill a disk.
    constexpr unsigned int many_frames = 1000000;

    // Angle [rad] in a run beyond which it was hardly intended.
    constexpr double great_angle = 4. * M_PI;

    const std::string scale_remedy = "Mesh/Scale = 0.001 makes metres of millimetres.";

    bool
    masses_matter(const Problem &problem)
    {
      return problem.actions.mass != nullptr
             || (problem.actions.loads != nullptr && problem.actions.loads->has_gravity());
    }

    Warning
    review_size(const Problem &problem, const BodyMeasures &measures)
    {
      const double          length = measures.length();
      const MeshParameters &mesh   = problem.parameters.mesh;
      const bool            is_soft_and_unscaled
          = masses_matter(problem) && measures.young.maximum < soft_as_rubber
            && !(mesh.file.empty() && mesh.files.empty()) && mesh.scale == 1.;
      if (length >= great_length || (length >= great_soft_length && is_soft_and_unscaled))
        return "The body is " + short_text(length)
               + " m long. If its mesh is in millimetres: " + scale_remedy;
      if (length <= small_length)
        return "The body is only " + short_text(length)
               + " m long. Lengths are in metres; look at the unit of the mesh, and at Mesh/Scale.";
      return {};
    }

    Warning
    review_density(const BodyMeasures &measures)
    {
      if (measures.density.minimum < light)
        return "A density of " + short_text(measures.density.minimum)
               + " kg/m^3 is less than that of light foam; water has 1000. Material/Density is in "
                 "kg/m^3, of "
                 "which "
                 "1000 are one g/cm^3.";
      if (measures.density.maximum > heavy)
        return "A density of " + short_text(measures.density.maximum)
               + " kg/m^3 is beyond that of all metals; water has 1000. Material/Density is in "
                 "kg/m^3.";
      return {};
    }

    Warning
    review_stiffness(const BodyMeasures &measures)
    {
      if (measures.young.maximum > stiff)
        return "Young's modulus of " + short_text(measures.young.maximum)
               + " Pa is beyond that of all materials; diamond has 1.2e12. Material/Young's "
                 "modulus "
                 "is in Pa: 210 GPa are 2.1e11.";
      if (measures.young.minimum >= soft)
        return {};
      return "Young's modulus of " + short_text(measures.young.minimum)
             + " Pa is less than that of jelly, which has some 1000 Pa. Material/Young's modulus "
               "is in Pa: 1 MPa are 1e6, 210 GPa 2.1e11.";
    }

    double
    gravity_of(const Problem &problem)
    {
      const auto &g = problem.parameters.loads.gravity;
      return std::sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
    }

    /// The bounding boxes of the handles in the whole body.
    std::vector<std::array<Range, 3>>
    boxes_of(const Handles &handles, const FESpace &fe_space)
    {
      std::vector<std::array<Range, 3>> boxes(handles.size());
      for (unsigned int handle = 0; handle < handles.size(); ++handle)
        for (unsigned int c = 0; c < 3; ++c)
        {
          Range &range = boxes[handle][c];
          for (const unsigned int node : handles.nodes(handle))
            range.add(fe_space.rest_position(node)[c]);
          range = range.over(fe_space.exchange());
        }
      return boxes;
    }

    /// Vector to a point from the nearest point of a box.
    dealii::Tensor<1, 3>
    way_from(const std::array<Range, 3> &box, const dealii::Point<3> &point)
    {
      dealii::Tensor<1, 3> way;
      for (unsigned int c = 0; c < 3; ++c)
        way[c] = point[c] - std::min(std::max(point[c], box[c].minimum), box[c].maximum);
      return way;
    }

    Warning
    review_weight(const Problem &problem, const BodyMeasures &measures)
    {
      if (problem.parameters.loads.balanced)
        return {}; // a balanced body does not sag
      const WeightEstimate estimate = estimate_weight(problem, measures);
      const double         sag      = estimate.sag / measures.length();
      if (!(sag >= great_sag) && !(estimate.strain >= great_strain))
        return {};
      const double ratio = measures.weight_over_stiffness(gravity_of(problem)) * measures.length();
      const std::string how_far
          = sag > 1. ? "further than it is long"
                     : fmt::format("by some {} % of its length", std::lround(100. * sag));
      return fmt::format(
          "Its own weight makes this body sag {} (rho g L / E = {}; estimated from where it is "
          "held and how slender it is). If that is not meant, look at the units: Young's modulus "
          "is in Pa (1e6 are one MPa), lengths are in m (Mesh/Scale), gravity is in m/s^2.",
          how_far, short_text(ratio));
    }

    /// Warn of a body that rests on obstacles or on itself and that its own weight strains much.
    Warning
    review_standing(const Problem &problem, const BodyMeasures &measures)
    {
      const bool rests
          = problem.actions.obstacles != nullptr || problem.actions.body_contacts != nullptr;
      const double gravity = gravity_of(problem);
      if (!rests || !(gravity > 0.) || problem.body.mesh.is_shell()
          || problem.parameters.loads.balanced)
        return {};
      double height = 0.; // of the box around the body, along gravity
      for (unsigned int c = 0; c < 3; ++c)
        height += std::abs(problem.parameters.loads.gravity[c]) / gravity * measures.size[c];
      const double strain = measures.weight_over_stiffness(gravity) * height;
      if (!(strain >= great_standing_strain))
        return {};
      const std::string costs = problem.actions.body_contacts != nullptr
                                    ? " Parts that then lie on each other make steps slow."
                                    : "";
      return fmt::format(
          "This body can hardly stand: its own weight strains it by some {} % at the foot (rho g L "
          "/ E = {}, with its "
          "height as L), so that it sinks down.{} If that is not meant, take a Young's modulus of "
          "{} Pa or more, "
          "or look at the units: lengths are in m (Mesh/Scale), gravity is in m/s^2.",
          std::lround(100. * strain), short_text(strain), costs,
          short_text(measures.soft_young * strain / good_standing_strain));
    }

    /// Warn of consistent masses in bodies that are heavier than stiff: a row of nodes beside a held one falls further than
    /// freely, as the mass that it shares with the held nodes pushes, and elasticity is too soft to even that out.
    Warning
    review_coupled_masses(const Problem &problem, const BodyMeasures &measures)
    {
      const double ratio = measures.weight_over_stiffness(gravity_of(problem)) * measures.length();
      if (problem.actions.mass == nullptr || problem.constraints.handles.size() == 0
          || problem.parameters.material.mass_matrix == MassMatrix::lumped || !(ratio > 1.))
        return {};
      return fmt::format(
          "This body is heavier than it is stiff (rho g L / E = {}): with coupled masses the nodes "
          "beside a handle at first fall further than freely, by a quarter and some by a half. Set "
          "Material/Mass matrix = lumped.",
          short_text(ratio));
    }

    Warning
    review_step(const Problem &problem)
    {
      const TimeParameters &time = problem.parameters.time;
      if (problem.actions.mass == nullptr || time.step <= time.end * (1. + 1e-12))
        return {};
      return "Time/Step = " + shortest_text(time.step)
             + " is longer than Time/End = " + shortest_text(time.end) + ": one step is made, of "
             + shortest_text(time.end) + " s. Take a smaller Time/Step or a greater Time/End.";
    }

    Warning
    review_frames(const Problem &problem)
    {
      const unsigned int every = problem.parameters.output.every, n = problem.time_axis.n_steps();
      if (every == 0 || n / every <= many_frames)
        return {};
      return fmt::format("The run makes {} and writes {}. If so many are not meant, "
                         "{}set Output/Every = {}, for 1000 frames.",
                         counted(n, "step"), counted(n / every, "frame"),
                         problem.actions.mass != nullptr ? "take a greater Time/Step, or " : "",
                         n / 1000);
    }

    Warning
    review_damping(const Problem &problem)
    {
      const TimeParameters &time = problem.parameters.time;
      if (problem.actions.mass == nullptr || time.stiffness_damping <= time.end)
        return {};
      return "Time/Stiffness damping = " + shortest_text(time.stiffness_damping)
             + " is longer than Time/End = " + shortest_text(time.end)
             + ". It is a time in s, not a part or per cent: what swings faster than it dies out.";
    }

    /// Warn of named loads whose sum at the end is large relative to E times the body's section.
    Warning
    review_force(const Problem &problem, const BodyMeasures &measures)
    {
      if (problem.actions.loads == nullptr || !problem.actions.loads->has_named_loads())
        return {};
      Vector force(problem.body.fe_space.n_dofs());
      try
      {
        problem.actions.loads->named_loads(problem.time_axis.time(problem.time_axis.n_steps()),
                                           force);
      }
      catch (const SolverFailure &)
      {
        return {}; // the step reports it
      }
      dealii::Tensor<1, 3> total;
      for (unsigned int dof = 0; dof < force.size(); ++dof)
        if (problem.body.exchange().owns(dof / 3))
          total[dof % 3] += force[dof];
      problem.body.exchange().sum(total.begin_raw(), 3);
      const double thickness = measures.thickness();
      const double strain    = total.norm() / (measures.soft_young * thickness * thickness);
      if (!(strain > great_pull))
        return {};
      return "The loads add up to " + short_text(total.norm()) + " N at the end, "
             + short_text(strain) + " times E times the body's section of some "
             + short_text(thickness * thickness)
             + " m^2. Forces are in N and of all nodes together: a pressure is to be multiplied by "
               "its area.";
    }

    /// The formulas of a scene by their keys.
    std::map<std::string, std::string>
    formulas_of(const SceneParameters &scene)
    {
      std::map<std::string, std::string> formulas
          = { { "Examples/Pose functions", scene.examples.pose_functions },
              { "Examples/Prescribed weights", scene.examples.prescribed_weights },
              { "Initial/Pose function", scene.initial.pose_function },
              { "Initial/Velocity", scene.initial.velocity } };
      for (const HandleParameters &handle : scene.handles)
      {
        formulas["Handles/" + handle.name + "/Motion"]   = handle.motion;
        formulas["Handles/" + handle.name + "/Progress"] = handle.progress;
      }
      for (const LoadParameters &load : scene.loads.named)
        formulas["Loads/" + load.name + "/Force"] = load.force;
      return formulas;
    }

    /// The greatest magnitude of an angle [rad], at the body's corners and a few times.
    double
    greatest_angle(const std::string  &argument,
                   const Problem      &problem,
                   const BodyMeasures &measures)
    {
      double maximum = 0.;
      try
      {
        const Expression angle("angle", argument, "xyzt", 1);
        const double     end = problem.time_axis.time(problem.time_axis.n_steps());
        for (unsigned int corner = 0; corner < 16; ++corner)
        {
          dealii::Point<3> point;
          for (unsigned int c = 0; c < 3; ++c)
            point[c] = (corner >> c & 1u) != 0 ? measures.size[c] : 0.;
          maximum = std::max(
              maximum, std::abs(angle.values(point, (corner & 8u) != 0 ? end : 0.5 * end)[0]));
        }
      }
      catch (const std::exception &)
      {
        // no formula on its own: no warning
      }
      return maximum;
    }

    /// Warn of the first formula with an angle that looks like degrees.
    Warning
    review_angles(const Problem &problem, const BodyMeasures &measures)
    {
      for (const auto &[key, formulas] : formulas_of(problem.parameters))
        for (const AngleInDegrees &angle : find_degrees(formulas))
        {
          const std::string call = key + ": " + angle.function + "(" + angle.argument + ")";
          if (angle.lacks_pi)
            return call + " divides by 180 without pi, but angles are in radians. Write "
                   + angle.number + "*pi/180.";
          if (const double maximum = greatest_angle(angle.argument, problem, measures);
              maximum >= great_angle)
            return call + " goes up to " + short_text(maximum / (2. * M_PI))
                   + " turns, as angles are in radians. If " + angle.number
                   + " means degrees, write " + angle.number + "*pi/180.";
        }
      return {};
    }
  } // namespace

  WeightEstimate
  estimate_weight(const Problem &problem, const BodyMeasures &measures)
  {
    const Handles &handles = problem.constraints.handles;
    const Loads   *loads   = problem.actions.loads.get();
    if (handles.size() == 0 || loads == nullptr || !loads->has_gravity())
      return { 0., 0. };
    const auto                &g       = problem.parameters.loads.gravity;
    const double               gravity = gravity_of(problem);
    const dealii::Tensor<1, 3> down({ g[0] / gravity, g[1] / gravity, g[2] / gravity });
    const double               factor   = measures.weight_over_stiffness(gravity);
    const double               squared  = measures.thickness() * measures.thickness();
    const FESpace             &fe_space = problem.body.fe_space;
    const auto                 boxes    = boxes_of(handles, fe_space);
    double                     sag = 0., distance = 0.;
    for (unsigned int node = 0; node < fe_space.n_nodes(); ++node)
    {
      dealii::Tensor<1, 3> way({ 1e300, 0., 0. });
      for (const auto &box : boxes)
        if (const auto from = way_from(box, fe_space.rest_position(node)); from.norm() < way.norm())
          way = from;
      const double across = way.norm_square() - (way * down) * (way * down);
      sag      = std::max(sag, 0.5 * way.norm_square() + 1.5 * across * across / squared);
      distance = std::max(distance, way.norm());
    }
    const Exchange &exchange = fe_space.exchange();
    WeightEstimate  estimate{ factor * exchange.max(sag), factor * exchange.max(distance) };
    const double    end  = problem.time_axis.time(problem.time_axis.n_steps());
    const double    fall = 0.5 * gravity * end * end;
    if (problem.actions.mass != nullptr && fall < estimate.sag)
      estimate = { fall, estimate.strain * fall / estimate.sag };
    return estimate;
  }

  std::vector<std::string>
  unit_warnings(const Problem &problem)
  {
    const BodyMeasures   measures = measure(problem.body);
    std::vector<Warning> found    = { review_size(problem, measures) };
    const Warning weight = masses_matter(problem) ? review_weight(problem, measures) : Warning();
    if (masses_matter(problem))
      found.insert(found.end(), { review_density(measures), review_stiffness(measures),
                                  weight ? weight : review_standing(problem, measures),
                                  review_coupled_masses(problem, measures) });
    found.insert(found.end(),
                 { review_step(problem), review_frames(problem), review_damping(problem),
                   review_force(problem, measures), review_angles(problem, measures) });
    std::vector<std::string> warnings;
    for (const Warning &warning : found)
      if (warning)
        warnings.push_back(*warning);
    return warnings;
  }
} // namespace Exemplar
