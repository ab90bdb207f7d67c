// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/number_text.h>
#include <exemplar/body/grain_axes.h>
#include <exemplar/body/patches.h>
#include <exemplar/mesh/mesh_checks.h>
#include <exemplar/mesh/mesh_edges.h>
#include <exemplar/run/inputs/body_inputs.h>
#include <exemplar/run/inputs/bridging_cells.h>
#include <exemplar/run/inputs/surface_readings.h>
#include <exemplar/run/scene/scene_parameters.h>

#include <fmt/core.h>

#include <utility>

namespace Exemplar
{
  namespace
  {
    /// The nodes of all selections by their texts; `named` has those of files and of the surface.
    NamedNodes
    choose_nodes(const SceneParameters &scene, const Mesh &mesh, const NamedNodes &named)
    {
      NamedNodes nodes;
      for (const auto &[selection, key] : scene.choices())
        if (nodes.count(selection.text) == 0)
          nodes[selection.text] = selection.choose(mesh, key, named);
      return nodes;
    }

    /// The thickness of each triangle [m]. Throws UserError for one that is thick beside the edges.
    std::vector<double>
    thicknesses_of(const MaterialParameters &parameters,
                   const Mesh               &mesh,
                   const PaintedConstant    &painted)
    {
      constexpr double thickest = 0.5; // of the mean length of edges
      const auto       edges    = edges_of(mesh.get_triangles());
      double           mean     = 0.;
      for (const auto &[a, b] : edges)
        mean += mesh.get_nodes()[a].distance(mesh.get_nodes()[b]) / double(edges.size());
      const auto          regions = regions_by_id(parameters, mesh.get_contents());
      std::vector<double> thicknesses;
      for (std::size_t cell = 0; cell < mesh.get_material_ids().size(); ++cell)
      {
        const auto region = regions.find(mesh.get_material_ids()[cell]);
        thicknesses.push_back(
            (region == regions.end() ? parameters.everywhere : region->second).thickness);
        if (!painted.values.empty())
          thicknesses.back() = (painted.is_factor ? thicknesses.back() : 1.) * painted.values[cell];
        if (!(thicknesses.back() >= least_thickness))
          throw UserError(too_thin_text("Material/Thickness", thicknesses.back()));
        if (thicknesses.back() > thickest * mean)
          throw UserError(fmt::format(
              "Material/Thickness = {}: is more than half of the edges' mean length, {} m, for "
              "which the body is no "
              "shell. Take a coarser mesh, or fill the surface with cells by Mesh/Kind = solid.",
              shortest_text(thicknesses.back()), short_text(mean)));
      }
      return thicknesses;
    }

    /// From the unit of the mesh file to metres.
    void
    scale(ObstacleSurface &surface, const double factor)
    {
      const auto multiply = [factor](std::vector<std::array<double, 3>> &places)
      {
        for (auto &place : places)
          for (double &x : place)
            x *= factor;
      };
      multiply(surface.vertices);
      for (auto &sample : surface.samples)
        multiply(sample);
      for (RigidTrack::Frame &frame : surface.track.frames)
        for (unsigned int c = 0; c < 3; ++c)
          frame[c] *= factor;
    }

    /// Multiply the painted Young's modulus by the factors of cells that bridge what a pose separates.
    void
    soften_bridging_cells(const ExampleParameters &examples,
                          const Mesh              &mesh,
                          const NamedPoses        &poses,
                          SurfaceReadings         &readings)
    {
      const BridgingCells bridging = find_bridging_cells(examples, mesh, poses);
      if (bridging.factors.empty())
        return;
      std::vector<double> &painted = readings.material.youngs_modulus.values;
      painted.resize(bridging.factors.size(), 1.); // factors, where nothing is painted
      for (std::size_t cell = 0; cell < painted.size(); ++cell)
        painted[cell] *= bridging.factors[cell];
      readings.warnings.push_back(bridging.warning);
    }

    /// Fields of the whole body, with the readings off the surface, to whose warnings more are added. Moves the poses out
    /// of the inputs.
    BodyFields
    make_fields(const SceneParameters &scene,
                const Mesh            &mesh,
                Inputs                &inputs,
                SurfaceReadings       &readings)
    {
      NamedNodes named = inputs.nodes;
      named.insert(readings.nodes.begin(), readings.nodes.end());
      BodyFields fields;
      soften_bridging_cells(scene.examples, mesh, inputs.poses, readings);
      if (mesh.is_shell())
        fields.thicknesses = thicknesses_of(scene.material, mesh, readings.material.thickness);
      fields.material = Material(
          scene.material, mesh.get_material_ids(), mesh.get_contents(), readings.material,
          find_grain_axes(scene.material, mesh, named, readings.material.fibre_direction,
                          readings.warnings));
      if (scene.model.has_patches())
        fields.patches = Patches::choose(mesh, fields.material, scene.model.element);
      fields.shares    = readings.shares;
      fields.poses     = std::move(inputs.poses);
      fields.nodes     = choose_nodes(scene, mesh, named);
      fields.obstacles = std::move(inputs.obstacles);
      fields.weights   = std::move(inputs.weights);
      for (auto &[name, surface] : fields.obstacles)
        scale(surface, scene.mesh.scale);
      if (scene.scene == SceneKind::interpolation && mesh.n_pieces() > 1)
        throw UserError(fmt::format(
            "{}: has {} pieces that no common face connects, beginning with element {}, but Scene "
            "= interpolation goes the way of one body between its poses. Interpolate each piece by "
            "itself, or set Scene = static with handles that hold each.",
            mesh.get_name(), mesh.n_pieces(), list_numbers(mesh.whole().pieces.first_elements)));
      if (scene.scene == SceneKind::interpolation)
        fields.support = mesh.is_shell()
                             ? support_near_centroid(mesh.get_nodes(), mesh.get_triangles())
                             : support_near_centroid(mesh.get_nodes(), mesh.get_cells());
      return fields;
    }
  } // namespace

  std::vector<WeightRegion>
  find_regions(const ExampleParameters &examples, const Mesh &mesh, BodyFields &fields)
  {
    if (!examples.finds_regions())
      return {};
    WeightRegions found = find_weight_regions(mesh, poses_of_body(examples, mesh, fields.poses),
                                              examples.region_blend_length);
    fields.shares       = std::move(found.shares);
    return std::move(found.regions);
  }

  BodyInputs
  make_body_inputs(const CompleteScene &scene, Inputs inputs)
  {
    const bool needs_inputs = scene.output.space_error != SpaceErrorUse::never;
    auto       kept         = needs_inputs ? std::make_shared<const Inputs>(inputs) : nullptr;
    Mesh       mesh(std::move(inputs.mesh), scene.mesh.name(), scene.mesh.scale, scene.mesh.kind);
    SurfaceReadings           readings = read_off_surface(scene, mesh, inputs);
    BodyFields                fields   = make_fields(scene, mesh, inputs, readings);
    std::vector<WeightRegion> regions  = find_regions(scene.examples, mesh, fields);
    return { std::move(mesh),
             std::move(fields),
             { readings.motions, readings.warnings, inputs.surface, std::move(inputs.carried),
               inputs.made, inputs.geo_walls, std::move(kept), std::move(regions) } };
  }

  BodyInputs
  read_body(const CompleteScene &scene, const Announce &announce)
  {
    return make_body_inputs(scene, read_inputs(scene, {}, announce));
  }
} // namespace Exemplar
