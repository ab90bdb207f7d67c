// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/prm/degrees.h>
#include <exemplar/prm/expression.h>
#include <exemplar/run/agreement.h>
#include <exemplar/run/unit_review.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace Exemplar
{
  namespace
  {
    using Warning = std::optional<std::string>;

    // Lengths [m] beyond which a body is more likely of another unit: a hand in millimetres is
    // 180 long, a metre that was scaled for millimetres .001.
    constexpr double great_length = 100., small_length = 0.005;

    // Beyond this length [m] what is as soft as this [Pa] is more likely of another unit.
    constexpr double great_soft_length = 20., soft_as_rubber = 1e8;

    // Air has 1.2 kg/m^3, light foam 10, osmium 22,600; in g/cm^3 steel has 7.8, copper 8.96.
    constexpr double light = 9., heavy = 25000.;

    // Jelly has some 1,000 Pa.
    constexpr double soft = 100.;

    // What sags by less of its length, or is strained by less, may well be meant.
    constexpr double great_sag = 0.2, great_strain = 0.05;

    // A handle that goes further than so many times the body's size was given in another unit, and
    // one that does so in a step is not followed.
    constexpr double great_way = 20., great_step = 2.;

    // More files fill a disk.
    constexpr unsigned int many_frames = 1000000;

    // So many turns in a run were not meant [rad].
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
      const double          length               = measures.length();
      const MeshParameters &mesh                 = problem.parameters.mesh;
      const bool            is_soft_and_unscaled = masses_matter(problem)
                                        && measures.young.greatest < soft_as_rubber
                                        && !mesh.file.empty() && mesh.scale == 1.;
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
      if (measures.density.least < light)
        return "A density of " + short_text(measures.density.least)
               + " kg/m^3 is less than that of light foam; water has 1000. Material/Density is in "
                 "kg/m^3, of "
                 "which "
                 "1000 are one g/cm^3.";
      if (measures.density.greatest > heavy)
        return "A density of " + short_text(measures.density.greatest)
               + " kg/m^3 is beyond that of all metals; water has 1000. Material/Density is in "
                 "kg/m^3.";
      return {};
    }

    Warning
    review_stiffness(const BodyMeasures &measures)
    {
      if (measures.young.least >= soft)
        return {};
      return "Young's modulus of " + short_text(measures.young.least)
             + " Pa is less than that of jelly, which has some 1000 Pa. Material/Young's modulus "
               "is "
               "in Pa, of which 1e6 are one MPa.";
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

    /// From the nearest place in a box to a point.
    dealii::Tensor<1, 3>
    way_from(const std::array<Range, 3> &box, const dealii::Point<3> &point)
    {
      dealii::Tensor<1, 3> way;
      for (unsigned int c = 0; c < 3; ++c)
        way[c] = point[c] - std::min(std::max(point[c], box[c].least), box[c].greatest);
      return way;
    }

    Warning
    review_weight(const Problem &problem, const BodyMeasures &measures)
    {
      const WeightEstimate estimate = estimate_weight(problem, measures);
      const double         sag      = estimate.sag / measures.length();
      if (!(sag >= great_sag) && !(estimate.strain >= great_strain))
        return {};
      const double ratio = measures.weight_over_stiffness(gravity_of(problem)) * measures.length();
      const std::string how_far
          = sag > 1. ? "further than it is long"
                     : "by some " + std::to_string(std::lround(100. * sag)) + " % of its length";
      return "Its own weight makes this body sag " + how_far
             + " (rho g L / E = " + short_text(ratio)
             + "; estimated from where it is held and how slender it is). If that is not meant, "
               "look at the units: Young's modulus is in Pa (1e6 are one MPa), lengths are in m "
               "(Mesh/Scale), gravity is in m/s^2.";
    }

    double
    greatest_difference(const Vector &a, const Vector &b)
    {
      MaxMagnitude greatest;
      for (unsigned int dof = 0; dof < a.size(); ++dof)
        greatest.add(a[dof] - b[dof]);
      return greatest.value();
    }

    /// The greatest ways of held nodes, by component [m].
    struct Travel
    {
      double in_step = 0., in_all = 0.;
    };

    /// Of the nodes that this process has, in a few of the steps.
    Travel
    look_at_travel(const Handles &handles, const TimeAxis &axis, const Vector &rest)
    {
      const unsigned int n_looks = std::min(axis.n_steps(), 8u);
      Travel             travel;
      Vector             before = rest, after = rest;
      for (unsigned int look = 1; look <= n_looks; ++look)
      {
        const auto step = static_cast<unsigned int>(std::size_t(look) * axis.n_steps() / n_looks);
        handles.move(axis.time(step - 1), before);
        handles.move(axis.time(step), after);
        travel.in_step = std::max(travel.in_step, greatest_difference(before, after));
        travel.in_all  = std::max(travel.in_all, greatest_difference(rest, after));
      }
      return travel;
    }

    Warning
    review_motion(const Problem &problem)
    {
      if (problem.constraints.handles == nullptr)
        return {};
      const Exchange &exchange = problem.body.exchange();
      const double    size     = problem.body.mesh.diameter();
      Travel          travel;
      try
      {
        do_in_agreement(exchange,
                        [&]
                        {
                          travel = look_at_travel(*problem.constraints.handles, problem.time_axis,
                                                  problem.body.fe_space.rest_positions());
                        });
      }
      catch (const SolverFailure &)
      {
        return {}; // the step will say so
      }
      travel                    = { exchange.max(travel.in_step), exchange.max(travel.in_all) };
      const std::string of_size = " times the size of the body (" + short_text(size) + " m)";
      if (travel.in_step > great_step * size)
        return "Handles move by up to " + short_text(travel.in_step) + " m in a step, "
               + short_text(travel.in_step / size) + of_size
               + ". Motions are in metres, angles in radians. If this is meant, take smaller "
                 "steps.";
      if (travel.in_all > great_way * size)
        return "Handles move by up to " + short_text(travel.in_all) + " m, "
               + short_text(travel.in_all / size) + of_size + ". Motions are in metres.";
      return {};
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
      return "The run makes " + std::to_string(n) + " steps and writes " + std::to_string(n / every)
             + " frames. If so many are not meant, "
             + (problem.actions.mass != nullptr ? "take a greater Time/Step, or " : "")
             + "set Output/Every = " + std::to_string(n / 1000) + ", for 1000 frames.";
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

    /// The greatest magnitude of an angle [rad] at the corners of the body and at a few times.
    double
    greatest_angle(const std::string  &argument,
                   const Problem      &problem,
                   const BodyMeasures &measures)
    {
      double greatest = 0.;
      try
      {
        const Expression angle("angle", argument, "xyzt", 1);
        const double     end = problem.time_axis.time(problem.time_axis.n_steps());
        for (unsigned int corner = 0; corner < 16; ++corner)
        {
          dealii::Point<3> point;
          for (unsigned int c = 0; c < 3; ++c)
            point[c] = (corner >> c & 1u) != 0 ? measures.size[c] : 0.;
          greatest = std::max(
              greatest, std::abs(angle.values(point, (corner & 8u) != 0 ? end : 0.5 * end)[0]));
        }
      }
      catch (const std::exception &)
      {
        // it is none by itself: it says nothing
      }
      return greatest;
    }

    /// The first formula with an angle that looks like degrees.
    Warning
    review_angles(const Problem &problem, const BodyMeasures &measures)
    {
      for (const auto &[key, formulas] : formulas_of(problem.parameters))
        for (const AngleInDegrees &angle : find_degrees(formulas))
          if (const double greatest = greatest_angle(angle.argument, problem, measures);
              greatest >= great_angle)
            return key + ": " + angle.function + "(" + angle.argument + ") goes up to "
                   + short_text(greatest / (2. * M_PI)) + " turns, as angles are in radians. If "
                   + angle.number + " means degrees, write " + angle.number + "*pi/180.";
      return {};
    }
  } // namespace

  WeightEstimate
  estimate_weight(const Problem &problem, const BodyMeasures &measures)
  {
    const Handles *handles = problem.constraints.handles.get();
    const Loads   *loads   = problem.actions.loads.get();
    if (handles == nullptr || handles->size() == 0 || loads == nullptr || !loads->has_gravity())
      return { 0., 0. };
    const auto                &g       = problem.parameters.loads.gravity;
    const double               gravity = gravity_of(problem);
    const dealii::Tensor<1, 3> down({ g[0] / gravity, g[1] / gravity, g[2] / gravity });
    const double               factor   = measures.weight_over_stiffness(gravity);
    const double               squared  = measures.thickness() * measures.thickness();
    const FESpace             &fe_space = problem.body.fe_space;
    const auto                 boxes    = boxes_of(*handles, fe_space);
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
    if (masses_matter(problem))
      found.insert(found.end(), { review_density(measures), review_stiffness(measures),
                                  review_weight(problem, measures) });
    found.insert(found.end(), { review_motion(problem), review_step(problem),
                                review_frames(problem), review_angles(problem, measures) });
    std::vector<std::string> warnings;
    for (const Warning &warning : found)
      if (warning)
        warnings.push_back(*warning);
    return warnings;
  }
} // namespace Exemplar
