// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/number_text.h>
#include <exemplar/mesh/map_name.h>
#include <exemplar/mesh/rigid_motion.h>
#include <exemplar/run/inputs/surface_readings.h>
#include <exemplar/run/scene/scene_parameters.h>
#include <exemplar/surface/skin/surface_selector.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Exemplar
{
  namespace
  {
    /// Of a map and of how it is used: MAP [from A to B] [absolute].
    struct MapUse
    {
      MapName map;
      bool    is_factor = true;
      bool    has_range = false;    ///< from A to B
      double  at_0 = 0., at_1 = 1.; ///< what values 0 and 1 stand for
    };

    MapUse
    parse_use(const std::string &text, const std::string &key)
    {
      MapUse             use{ split_map_name(text, key) };
      std::istringstream in(use.map.rest);
      bool               is_understood = true;
      for (std::string word; in >> word;)
        if (word == "absolute")
          use.is_factor = false;
        else if (std::string low, to, high; word == "from" && in >> low >> to >> high && to == "to")
        {
          use.has_range = true;
          use.at_0      = parse_number(low);
          use.at_1      = parse_number(high);
        }
        else
          is_understood = false;
      if (!is_understood || !std::isfinite(use.at_0) || !std::isfinite(use.at_1))
        throw UserError(
            key + " = '" + text
            + "' is not understood. Allowed: MAP, and 'from A to B' and 'absolute' behind "
              "it, where MAP is FILE.ply:ATTRIBUTE or FILE.csv[:COLUMN].");
      return use;
    }

    const std::vector<double> &
    find_map(const MapName &map, const Inputs &inputs, const std::string &key)
    {
      const auto found = inputs.maps.find(map.name());
      if (found == inputs.maps.end() || found->second.size() != inputs.surface->vertices.size())
        throw UserError(key + ": there is no map '" + map.name()
                        + "' with a value for each vertex of the surface among the inputs. Hand it "
                          "in by this name, or read it from its file.");
      return found->second;
    }

    /// All constants of a scene that one member points to.
    std::vector<double>
    values_in_scene(const MaterialParameters &material, double ElasticConstants::*const member)
    {
      std::vector<double> values{ material.everywhere.*member };
      for (const auto &region : material.regions)
        values.push_back(region.second.*member);
      for (const auto &region : material.named_regions)
        values.push_back(region.second.*member);
      return values;
    }

    /// What makes shares of per cent, of bytes, and of other values.
    double
    divisor_of(const double maximum)
    {
      for (const double unit : { 100., 255. })
        if (maximum > 0.8 * unit && maximum <= unit)
          return unit;
      return maximum;
    }

    /// Reads what a scene asks for off one surface.
    class SurfaceReader
    {
    public:
      SurfaceReader(const SceneParameters &scene, const Mesh &mesh, const Inputs &inputs)
          : scene(scene), mesh(mesh), inputs(inputs),
            selector(mesh, *inputs.surface, scene.mesh.scale, scene.mesh.surface_file())
      {
      }

      SurfaceReadings
      read()
      {
        const MaterialParameters &m = scene.material;
        readings.material
            = { painted("Young's modulus", m.youngs_modulus_map, &ElasticConstants::youngs_modulus,
                        0., 1e300),
                painted("Poisson's ratio", m.poissons_ratio_map, &ElasticConstants::poissons_ratio,
                        -1., 0.5),
                painted("Density", m.density_map, &ElasticConstants::density, 0., 1e300) };
        if (scene.examples.are_painted())
          for (const std::string &map : scene.examples.weight_maps)
            readings.shares.push_back(share(map));
        for (const HandleParameters &handle : scene.handles)
        {
          add_nodes(handle.select, "Handles/" + handle.name);
          if (!handle.follow_cache.empty())
            add_motion(handle);
        }
        for (const LoadParameters &load : scene.loads.named)
          add_nodes(load.select, "Loads/" + load.name);
        return std::move(readings);
      }

    private:
      void
      add_nodes(const Selection &selection, const std::string &key)
      {
        if (selection.is_of_surface() && readings.nodes.count(selection.text) == 0)
          readings.nodes[selection.text] = selector.select(selection.text, key, inputs.maps);
      }

      /// Linear over triangles, so that what holds at the vertices holds everywhere.
      PaintedConstant
      painted(const std::string &name,
              const std::string &text,
              double ElasticConstants::*const member,
              const double                    low,
              const double                    high)
      {
        if (text.empty())
          return {};
        const std::string   key    = "Material/" + name + " map";
        const MapUse        use    = parse_use(text, key);
        std::vector<double> values = find_map(use.map, inputs, key);
        if (use.has_range)
          doubt_range(key + " = '" + text + "'", values, use);
        const auto factors
            = use.is_factor ? values_in_scene(scene.material, member) : std::vector<double>{ 1. };
        for (std::size_t v = 0; v < values.size(); ++v)
        {
          const double painted_value = values[v];
          values[v]                  = use.at_0 + painted_value * (use.at_1 - use.at_0);
          for (const double factor : factors)
            if (!(values[v] * factor > low && values[v] * factor < high))
              throw UserError(
                  key + " = '" + text + "': vertex " + std::to_string(v + 1)
                  + (std::isnan(painted_value)
                         ? " has no value in the table."
                         : " has the value " + short_text(painted_value) + ", which makes "
                               + short_text(values[v] * factor) + " of it.")
                  + " It must be greater than " + short_text(low)
                  + (high < 1. ? " and less than " + short_text(high) : "")
                  + " everywhere. Paint other values there, or say 'from A to B' behind the map.");
        }
        const bool scales_one = *std::max_element(factors.begin(), factors.end()) <= 1.;
        if (low == 0. && use.is_factor != scales_one)
          doubt(key + " = '" + text + "'", values, use.is_factor);
        return { selector.at_cells(values), use.is_factor };
      }

      /// Warn of values that a range goes beyond its ends for.
      void
      doubt_range(const std::string &map, const std::vector<double> &values, const MapUse &use)
      {
        constexpr double rounding = 1e-3; // of a painting program
        double           minimum = 0., maximum = 1.;
        for (const double value : values)
        {
          minimum = std::min(minimum, value); // not if it is no number
          maximum = std::max(maximum, value);
        }
        if (minimum >= -rounding && maximum <= 1. + rounding)
          return;
        const double farthest = maximum > 1. + rounding ? maximum : minimum;
        readings.warnings.push_back(
            map + ": 'from A to B' says what the values 0 and 1 stand for, but the map has "
            + short_text(farthest) + ", of which "
            + short_text(use.at_0 + farthest * (use.at_1 - use.at_0)) + " is made. "
            + (maximum > 1. + rounding
                   ? "Divide its values by " + short_text(divisor_of(maximum)) + "."
                   : std::string("Paint values from 0 to 1.")));
      }

      /// Warn of values that look like those of the other use of a map. Nobody paints a body a hundred
      /// times as stiff or dense everywhere as its scene says, unless that says 1; jelly has some 1000 Pa.
      void
      doubt(const std::string &map, const std::vector<double> &values, const bool are_factors)
      {
        const auto [minimum, maximum] = std::minmax_element(values.begin(), values.end());
        const std::string range       = short_text(*minimum) + " to " + short_text(*maximum);
        if (are_factors && *minimum >= 100.)
          readings.warnings.push_back(map + ": its values " + range
                                      + " are factors of the constant that Material gives. If they "
                                        "are in Pa or kg/m^3, write 'absolute' behind the map.");
        if (!are_factors && *maximum < 100. && map.find("Young") != std::string::npos)
          readings.warnings.push_back(map + ": E is " + range
                                      + " Pa, less than that of jelly, which has some 1000 Pa. If "
                                        "these are factors of Material/Young's modulus, leave "
                                        "'absolute' out.");
      }

      std::vector<double>
      share(const std::string &text) const
      {
        const std::string key = "Examples/Weight maps";
        const MapName     map = split_map_name(text, key);
        if (!map.rest.empty())
          throw UserError(key + ": " + in_quotes(text)
                          + " is not understood. Give FILE.ply:ATTRIBUTE or FILE.csv[:COLUMN].");
        std::vector<double> values  = find_map(map, inputs, key);
        double              maximum = 0.;
        for (const double value : values)
          maximum = std::max(maximum, value); // not if it is no number
        for (std::size_t v = 0; v < values.size(); ++v)
        {
          values[v] = std::isnan(values[v]) ? 0. : values[v]; // not in the table
          if (!(values[v] >= 0. && values[v] <= 1. + 1e-6))
            throw UserError(
                key + ": in " + map.name() + " vertex " + std::to_string(v + 1) + " has the value "
                + short_text(values[v]) + ", but shares lie between 0 and 1. "
                + (values[v] > 1.
                       ? "The greatest value is " + short_text(maximum) + ": divide all by "
                             + short_text(divisor_of(maximum)) + ", or paint it anew."
                       : std::string("Paint it anew.")));
        }
        return selector.at_cells(values);
      }

      void
      add_motion(const HandleParameters &handle);

      void
      check_unit(const PointCache::Vertices &vertices,
                 const std::string          &sample,
                 const std::string          &key) const;

      std::string
      remedy_for_jump(const PointCache::Vertices &first, const std::string &key) const;

      void
      warn_of_unreached(const std::vector<double> &times, const HandleParameters &handle);

      const SceneParameters &scene;
      const Mesh            &mesh;
      const Inputs          &inputs;
      const SurfaceSelector  selector;
      SurfaceReadings        readings;
    };

    using Displacements = std::vector<dealii::Tensor<1, 3>>;

    /// Displacements of points at times, linear in between.
    struct Track
    {
      std::vector<double>        times; ///< [s]
      std::vector<Displacements> samples;

      Displacements
      at(const double time) const
      {
        const auto after = static_cast<std::size_t>(
            std::upper_bound(times.begin(), times.end(), time) - times.begin());
        if (after == 0)
          return samples.front();
        if (after == times.size())
          return samples.back();
        const double  share  = (time - times[after - 1]) / (times[after] - times[after - 1]);
        Displacements result = samples[after - 1];
        for (std::size_t i = 0; i < result.size() && share > 0.; ++i)
          result[i] += share * (samples[after][i] - result[i]);
        return result;
      }
    };

    /// How large a set of points is: the root of their mean squared distance from their middle.
    double
    spread(const PointCache::Vertices &points)
    {
      SurfaceMesh::Vertex sum{};
      double              squares = 0.;
      for (const auto &point : points)
        for (unsigned int c = 0; c < 3; ++c)
        {
          sum[c] += point[c];
          squares += point[c] * point[c];
        }
      const auto n = static_cast<double>(points.size());
      return std::sqrt(
          std::max(0., squares - (sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]) / n) / n);
    }

    /// No rig makes a surface so many times as large or as small.
    constexpr double other_unit = 20.;

    void
    SurfaceReader::check_unit(const PointCache::Vertices &vertices,
                              const std::string          &sample,
                              const std::string          &key) const
    {
      const double ratio = spread(vertices) / spread(inputs.surface->vertices);
      if (!(ratio < other_unit && ratio > 1. / other_unit))
        throw UserError(key + ": in " + sample + " the surface is " + short_text(ratio)
                        + " times as large as at rest. Export both in the same unit of length.");
    }

    using Points = std::vector<dealii::Point<3>>;

    Points
    points_of(const PointCache::Vertices &vertices)
    {
      Points points;
      for (const auto &x : vertices)
        points.emplace_back(x[0], x[1], x[2]);
      return points;
    }

    constexpr double in_degrees = 180. / 3.14159265358979324;

    /// Between two samples. A rig is sampled more often than it turns by so much.
    constexpr double great_turn = 60. / in_degrees;

    std::string
    turn_text(const AxisAngle &turn)
    {
      constexpr double rounding = 1e-3;
      std::string      axis;
      for (unsigned int d = 0; d < 3; ++d)
        axis += (d == 0 ? "" : ", ")
                + short_text(std::abs(turn.axis[d]) < rounding ? 0. : turn.axis[d]);
      return std::to_string(std::lround(turn.angle * in_degrees)) + " degrees about (" + axis + ")";
    }

    /// Of the nodes of a handle that are turned as a whole in one step of the cache, which lasts no
    /// longer than one of the scene: of longer ones the handle itself tells.
    std::string
    describe_great_turn(const Points &rest, const Track &track, const double scene_step)
    {
      for (std::size_t k = 1; k < track.samples.size(); ++k)
      {
        if (track.times[k] - track.times[k - 1] > scene_step)
          continue;
        Points before = rest, after = rest;
        for (std::size_t i = 0; i < rest.size(); ++i)
        {
          before[i] += track.samples[k - 1][i];
          after[i] += track.samples[k][i];
        }
        if (const AxisAngle turn = rigid_turn(before, after); turn.angle > great_turn)
          return "/Follow cache turns the held nodes by " + turn_text(turn) + " from sample "
                 + std::to_string(k)
                 + " to the next. Give the cache more samples, or, if its axes "
                   "are others from there on, export all with those of Mesh/Surface.";
      }
      return "";
    }

    std::string
    SurfaceReader::remedy_for_jump(const PointCache::Vertices &first, const std::string &key) const
    {
      const AxisAngle turn = rigid_turn(points_of(inputs.surface->vertices), points_of(first));
      if (turn.angle > great_turn)
        return " In its first sample the surface is the one at rest, turned by " + turn_text(turn)
               + ": export both with the same axes.";
      return " Let the cache begin with the surface at rest, or set " + key
             + "/Cache start or Initial/Pose.";
    }

    /// A cache that goes on when t of the scene has come to its end, which is 1 but in dynamics.
    void
    SurfaceReader::warn_of_unreached(const std::vector<double> &times,
                                     const HandleParameters    &handle)
    {
      if (scene.scene == SceneKind::dynamic || times.back() <= 1. + 1e-6)
        return;
      const std::string key       = "Handles/" + handle.name;
      const auto        n_reached = std::upper_bound(times.begin(), times.end(), 1. + 1e-6);
      const bool has_frames = std::filesystem::path(handle.follow_cache).extension() != ".mdd";
      readings.warnings.push_back(
          key + "/Follow cache goes to t = " + short_text(times.back())
          + " s, but t of a static scene ends at 1, after "
          + std::to_string(n_reached - times.begin()) + " of " + std::to_string(times.size())
          + " samples. Set Scene = dynamic and Time/End = " + shortest_text(times.back())
          + (has_frames ? ", or a greater " + key + "/Frames per second." : "."));
    }

    void
    SurfaceReader::add_motion(const HandleParameters &handle)
    {
      const std::string key   = "Handles/" + handle.name;
      const auto        cache = inputs.caches.find(handle.name);
      if (cache == inputs.caches.end())
        throw UserError(key
                        + ": there is no cache of this handle among the inputs. Hand it in, or "
                          "read it from its file.");
      NamedNodes named = inputs.nodes;
      named.insert(readings.nodes.begin(), readings.nodes.end());
      const auto nodes    = handle.select.nodes(mesh, key, named);
      const auto attached = selector.hang(nodes);
      auto       track    = std::make_shared<Track>();
      track->times        = cache->second->get_times();
      if (handle.cache_start != "file")
      {
        const double shift = parse_number(handle.cache_start) - track->times.front();
        for (double &time : track->times)
          time += shift;
      }
      warn_of_unreached(track->times, handle);
      const double farthest = 1e3 * mesh.diameter();
      for (std::size_t k = 0; k < track->times.size(); ++k)
      {
        auto vertices = cache->second->sample(k);
        check_unit(vertices, cache->second->name_of(k), key + "/Follow cache");
        for (auto &vertex : vertices)
          for (double &x : vertex)
            x *= scene.mesh.scale;
        const auto targets = attached.targets(vertices);
        track->samples.emplace_back();
        for (std::size_t i = 0; i < nodes.size(); ++i)
          track->samples.back().push_back(targets[i] - mesh.get_nodes()[nodes[i]]);
        for (const auto &displacement : track->samples.back())
          if (!(displacement.norm() < farthest))
            throw UserError(key + "/Follow cache: in sample " + std::to_string(k + 1)
                            + " the surface is farther from its rest than 1000 times the body's "
                              "size. Export the cache in the unit of the surface at rest.");
      }
      double jump = 0.;
      for (const auto &displacement : track->at(0.))
        jump = std::max(jump, displacement.norm());
      if (jump > 1e-3 * mesh.diameter() && scene.initial.pose.empty()
          && scene.initial.pose_function.empty())
        readings.warnings.push_back(
            key + "/Follow cache: at t = 0 the held nodes are up to " + short_text(jump)
            + " m from their rest, where the body starts, so they jump in the first step."
            + remedy_for_jump(cache->second->sample(0), key));
      Points rest;
      for (const unsigned int node : nodes)
        rest.push_back(mesh.get_nodes()[node]);
      const double step
          = scene.scene == SceneKind::dynamic ? scene.time.step : 1. / scene.time.increments;
      if (const std::string turn = describe_great_turn(rest, *track, step); !turn.empty())
        readings.warnings.push_back(key + turn);
      readings.motions[handle.name] = [track](const std::vector<dealii::Point<3>> &,
                                              const double time) { return track->at(time); };
    }
  } // namespace

  SurfaceReadings
  read_off_surface(const SceneParameters &scene, const Mesh &mesh, const Inputs &inputs)
  {
    if (!scene.reads_off_surface())
      return {};
    if (inputs.surface == nullptr)
      throw UserError("Mesh/Surface: the scene needs the surface of the body, but there is none "
                      "among the inputs. Hand it in, or read it from its file.");
    return SurfaceReader(scene, mesh, inputs).read();
  }
} // namespace Exemplar
