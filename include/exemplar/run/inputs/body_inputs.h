// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_body_inputs_h
#define exemplar_body_inputs_h

#include <exemplar/body/handles.h>
#include <exemplar/body/material.h>
#include <exemplar/body/supports.h>
#include <exemplar/body/weight_regions.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/run/inputs/inputs.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// The scene's data at the nodes and cells of its mesh, or of a process' part of it.
  struct BodyFields
  {
    Material                         material;
    std::vector<double>              thicknesses = {}; ///< of a shell's triangles [m]
    std::vector<unsigned int>        patches; ///< patch of each cell, see Patches; empty: none
    std::vector<std::vector<double>> shares; ///< of Examples/Weight maps or Regions, a value a cell
    NamedPoses                       poses;
    NamedNodes                       nodes;     ///< of all selections, by their texts
    ObstacleSurfaces                 obstacles; ///< [m]; all of them in each process
    WeightTable                      weights;   ///< of Examples/Weights file
    /// Support of an interpolation; its nodes are those of the whole body.
    std::optional<StaticallyDeterminateSupport> support;

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      archive &material &patches &shares &poses &nodes &obstacles &weights;
      bool     has_support = support.has_value();
      archive &has_support;
      if (has_support && !support)
        support.emplace();
      if (has_support)
        archive &*support;
    }
  };

  /// Inputs that are not distributed: if processes share a body, the root alone has them.
  struct UndividedInputs
  {
    NamedMotions                            motions; ///< of handles that follow a cache
    std::vector<std::string>                warnings;
    std::shared_ptr<const SurfaceMesh>      surface;   ///< see Inputs
    std::vector<CarriedSurface>             carried;   ///< see Inputs
    std::shared_ptr<const MadeOfSurfaces>   made;      ///< see Inputs
    std::optional<std::vector<std::string>> geo_walls; ///< see Inputs
    std::shared_ptr<const Inputs>           inputs; ///< null unless Output/Space error needs them
    std::vector<WeightRegion>               weight_regions = {}; ///< of Examples/Regions = auto
  };

  /// The body of a scene, or the part of it that a process has.
  struct BodyInputs
  {
    Mesh            mesh;
    BodyFields      fields;
    UndividedInputs undivided;
  };

  /// The regions of Examples/Regions = auto, whose shares the fields get; without that key nothing.
  std::vector<WeightRegion>
  find_regions(const ExampleParameters &examples, const Mesh &mesh, BodyFields &fields);

  /// The whole body of a scene from its inputs. Throws UserError if they do not fit the scene.
  BodyInputs
  make_body_inputs(const CompleteScene &scene, Inputs inputs);

  /// The whole body of a scene, from the files that read_inputs() reads.
  BodyInputs
  read_body(const CompleteScene &scene, const Announce &announce = {});
} // namespace Exemplar

#endif
