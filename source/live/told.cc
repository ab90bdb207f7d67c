// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/live/obstacle_frames.h>
#include <exemplar/live/told.h>
#include <exemplar/potential/fibre_tension_term.h>
#include <exemplar/run/output/weight_names.h>
#include <exemplar/run/problem/obstacle_start.h>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>

namespace Exemplar::Live
{
  namespace
  {
    using Json = nlohmann::json;

    /// The beginning of a state's text, by which it is recognised without being parsed.
    constexpr std::string_view begin_of_state = R"({"type":"state",)";

    /// JSON as text; bytes in names that are not UTF-8 are replaced.
    std::string
    text_of(const Json &json)
    {
      return json.dump(-1, ' ', false, Json::error_handler_t::replace);
    }

    Json
    vertices_of(const std::vector<unsigned int> &nodes, const BodySurface &surface)
    {
      Json vertices = Json::array();
      for (const unsigned int node : nodes)
      {
        const auto found = std::lower_bound(surface.nodes.begin(), surface.nodes.end(), node);
        if (found != surface.nodes.end() && *found == node)
          vertices.push_back(found - surface.nodes.begin());
      }
      return vertices;
    }

    Json
    handles_of(const Problem &problem, const BodySurface &surface)
    {
      Json           list = Json::array();
      const Handles &all  = problem.constraints.handles;
      for (unsigned int handle = 0; handle < all.size(); ++handle)
        list.push_back({ { "name", all.name(handle) },
                         { "vertices", vertices_of(all.nodes(handle), surface) } });
      return list;
    }

    Json
    names_of_examples(const Problem &problem)
    {
      Json names = Json::array();
      for (unsigned int i = 0; i < problem.examples.poses.size(); ++i)
        names.push_back(short_name_of_pose(problem.examples.poses, i));
      return names;
    }

    /// Numbers of the regions with weights of their own; empty where all cells have the same weights.
    std::vector<unsigned int>
    numbers_of_regions(const Problem &problem)
    {
      const ExamplePoses       &poses = problem.examples.poses;
      std::vector<unsigned int> numbers;
      for (unsigned int region = 0; poses.size() > 0 && region < poses.n_regions(); ++region)
        if (const auto number = poses.region_id(region))
          numbers.push_back(*number);
      return numbers;
    }

    Json
    bounds_of(const Hand &hand)
    {
      Json bounds = Json::object();
      for (const auto &[name, bound] : hand.get_settings().get_bounds())
        bounds[name] = { bound.first, bound.second };
      return bounds;
    }

    /// What was dragged, with its displacement [m].
    Json
    shifts_of(const std::map<std::string, Hand::Pull> &pulls)
    {
      Json list = Json::array();
      for (const auto &[name, pull] : pulls)
        list.push_back({ { "name", name }, { "shift", { pull.to[0], pull.to[1], pull.to[2] } } });
      return list;
    }

    /// The obstacles that are drawn, with their triangles and displacements [m] by hand.
    Json
    obstacles_of(const ObstacleFrames &obstacles, const Hand &hand)
    {
      Json        list    = Json::array();
      const auto &dragged = hand.get_held().obstacles;
      for (const ObstacleFrames::Shown &shown : obstacles.shown())
      {
        const auto             pull = dragged.find(shown.name);
        const dealii::Point<3> at   = pull == dragged.end() ? dealii::Point<3>() : pull->second.to;
        list.push_back({ { "name", shown.name },
                         { "triangles", shown.n_triangles },
                         { "movable", shown.is_movable },
                         { "there", !shown.has_left },
                         { "shift", { at[0], at[1], at[2] } } });
      }
      return list;
    }

    Json
    pins_of(const Hand &hand, const BodySurface &surface)
    {
      Json list = Json::array();
      for (const auto &[name, nodes] : hand.get_held().pins)
        list.push_back({ { "name", name }, { "vertices", vertices_of(nodes, surface) } });
      return list;
    }

    /// The target weights of the sliders, one for each example: those of the first region, as all
    /// have the same.
    Json
    wanted_weights(const Problem &problem, const Hand &hand)
    {
      const std::vector<double> &wanted = hand.get_held().weights.wanted();
      const std::size_t n = std::min<std::size_t>(wanted.size(), problem.examples.poses.size());
      return std::vector<double>(wanted.begin(), wanted.begin() + static_cast<std::ptrdiff_t>(n));
    }

    /// Of each region with active fibres, what a hand has set [Pa]; null: as the scene says.
    Json
    tensions_of(const Problem &problem)
    {
      const FibreTensions       &all  = problem.body.material.tensions();
      const std::vector<double> &held = problem.actions.held_tensions;
      Json                       list = Json::object();
      for (unsigned int law = 0; law < all.sources.size(); ++law)
      {
        Json &value = list[all.sources[law].region()];
        for (std::size_t cell = 0; cell < held.size(); ++cell)
          if (const double factor = all.factors.empty() ? 1. : all.factors[cell];
              all.of_cells[cell] == law + 1 && held[cell] != FibreTensionTerm::not_held
              && factor > 0.)
          {
            value = held[cell] / factor;
            break;
          }
      }
      return list;
    }

    /// The same as the scene begins, with the ends of their sliders.
    Json
    sliders_of_tensions(const Problem &problem)
    {
      const FibreTensions          &all  = problem.body.material.tensions();
      const FibreTensionTerm *const term = find_tension_term(problem.potential.get_terms());
      Json                          list = Json::array();
      for (unsigned int law = 0; law < all.sources.size(); ++law)
      {
        double greatest = 0.;
        for (std::size_t cell = 0; cell < all.of_cells.size(); ++cell)
          if (all.of_cells[cell] == law + 1)
            greatest = std::max(greatest, term->tensions()[cell]);
        list.push_back({ { "name", all.sources[law].region() },
                         { "value", greatest },
                         { "most", std::max(2. * greatest, young_of(problem).mean) } });
      }
      return list;
    }

    Json
    settings_of(const Problem &problem, const double young, const double poisson)
    {
      const CompleteScene &parameters = problem.parameters;
      return { { "young", young },
               { "poisson", poisson },
               { "importance", parameters.examples.importance },
               { "energy", name_of_energy(parameters.examples.energy) },
               { "gravity", parameters.loads.gravity },
               { "damping", { parameters.time.mass_damping, parameters.time.stiffness_damping } },
               { "tensions", tensions_of(problem) } };
    }

    /// Names of the settings whose values are means over different cells.
    Json
    means_of(const NumberOfCells &young, const NumberOfCells &poisson)
    {
      Json names = Json::array();
      if (young.varies)
        names.push_back("young");
      if (poisson.varies)
        names.push_back("poisson");
      return names;
    }

    /// Whether viewers choose between the scaled and the mixed energy: blended is chosen by scenes alone, which may need it.
    bool
    chooses_energy(const ExampleParameters &examples)
    {
      return examples.in_use() && examples.weights != WeightRule::prescribed
             && examples.energy != ExampleEnergy::blended;
    }

    Json
    surfaces_of(const SkinFrames &skin)
    {
      Json list = Json::array();
      for (const SkinFrames::Surface &surface : skin.get_surfaces())
        list.push_back({ { "name", surface.name }, { "vertices", surface.n_vertices } });
      return list;
    }
  } // namespace

  std::string
  scene_text(Stage              &stage,
             const Hand         &hand,
             const BodySurface  &surface,
             const SkinFrames   &skin,
             const SpaceVector3 &up)
  {
    const Problem       &problem    = stage.get_problem();
    const CompleteScene &parameters = problem.parameters;
    const Floor          floor(problem, up);
    return text_of(
        { { "type", "scene" },
          { "name", std::filesystem::path(parameters.name).stem().string() },
          { "step_size", stage.get_step_size() },
          { "diameter", problem.body.mesh.diameter() },
          { "up", { up[0], up[1], up[2] } },
          { "draws_surface", !skin.topology().empty() },
          { "surfaces", surfaces_of(skin) },
          { "scale", parameters.mesh.scale },
          { "floor", floor.level ? Json(*floor.level) : Json() },
          { "cells", problem.body.mesh.n_cells() },
          { "vertices", surface.nodes.size() },
          { "triangles", surface.triangles.size() },
          { "examples", names_of_examples(problem) },
          { "weight_regions", numbers_of_regions(problem) },
          { "handles", handles_of(problem, surface) },
          { "stiffness", hand.unit_stiffness() },
          { "grab_radius", hand.grab_radius() },
          { "young", parameters.material.everywhere.youngs_modulus },
          { "poisson", parameters.material.everywhere.poissons_ratio },
          { "importance", parameters.examples.importance },
          { "energy", name_of_energy(parameters.examples.energy) },
          { "bounds", bounds_of(hand) },
          { "tensions", sliders_of_tensions(problem) },
          { "chooses_energy", chooses_energy(parameters.examples) },
          { "finds_weights", parameters.examples.are_bounded() },
          { "weights_add", parameters.examples.weights == WeightRule::additive },
          { "gravity", parameters.loads.gravity },
          { "damping", { parameters.time.mass_damping, parameters.time.stiffness_damping } },
          { "tolerance", parameters.solver.tolerance },
          { "saves_poses", stage.get_recording() != nullptr },
          { "has_contact", !touching_terms(problem).empty() },
          { "takes_examples", parameters.examples.importance > 0.
                                  && parameters.examples.weights != WeightRule::prescribed } });
  }

  std::string
  state_text(const Stage          &stage,
             const Hand           &hand,
             const BodySurface    &surface,
             const ObstacleFrames &obstacles,
             const Wish           &wish)
  {
    const Problem      &problem = stage.get_problem();
    const NumberOfCells young = young_of(problem), poisson = poisson_of(problem);
    const Json          state = { { "paused", wish.is_paused },
                                  { "colour", wish.colour },
                                  { "undo", stage.n_moments() },
                                  { "settings", settings_of(problem, young.mean, poisson.mean) },
                                  { "means", means_of(young, poisson) },
                                  { "with_examples", !hand.get_settings().is_without_examples(problem) },
                                  { "importance_with_examples", hand.importance_with_examples(problem) },
                                  { "weights_by_hand", hand.get_held().weights.are_in_use() },
                                  { "weights_wanted", wanted_weights(problem, hand) },
                                  { "handles", shifts_of(hand.get_held().handles) },
                                  { "obstacles", obstacles_of(obstacles, hand) },
                                  { "pins", pins_of(hand, surface) } };
    return std::string(begin_of_state) + text_of(state).substr(1); // without its brace
  }

  bool
  is_state(const std::string &text)
  {
    return text.compare(0, begin_of_state.size(), begin_of_state) == 0;
  }

  std::string
  status_text(const Problem       &problem,
              const Hand          &hand,
              const SolveReport   &report,
              const Pace::Summary &summary,
              const bool           is_paused)
  {
    const auto finite = [](const double x) { return std::isfinite(x) ? Json(x) : Json(); };
    return text_of({ { "type", "status" },
                     { "step", problem.state.step },
                     { "time", problem.state.time },
                     { "paused", is_paused },
                     { "rate", summary.rate },
                     { "behind", summary.behind },
                     { "milliseconds", summary.milliseconds },
                     { "processor_milliseconds", summary.processor },
                     { "iterations", report.iterations },
                     { "residual", finite(report.residual) },
                     { "energy", finite(problem.evaluation.elastic.energy) },
                     { "min_det_F", finite(problem.evaluation.elastic.min_det_F) },
                     { "weights", problem.state.weights },
                     { "weights_by_hand", hand.get_held().weights.are_in_use() } });
  }

  std::string
  words_text(const std::string &type, const std::string &words)
  {
    return text_of({ { "type", type }, { "text", words } });
  }
} // namespace Exemplar::Live
