// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_body_inputs_h
#define exemplar_body_inputs_h

#include <exemplar/body/handles.h>
#include <exemplar/body/material.h>
#include <exemplar/body/supports.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/run/inputs/inputs.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// What a scene says of the nodes and cells of its mesh, or of those that a process has of it.
  struct BodyFields
  {
    Material                         material;
    std::vector<unsigned int>        patches; ///< of each cell, as Patches wants it; empty: none
    std::vector<std::vector<double>> shares;  ///< of Examples/Weight maps, a value a cell
    NamedPoses                       poses;
    NamedNodes                       nodes; ///< of all selections, by their text
    /// Of an interpolation; its nodes are those of the whole body.
    std::optional<StaticallyDeterminateSupport> support;

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      archive &material &patches &shares &poses &nodes;
      bool                                       has_support = support.has_value();
      archive                                   &has_support;
      if (has_support && !support)
        support.emplace();
      if (has_support)
        archive &*support;
    }
  };

  /// What is not divided: of a body that several processes share, the root alone has it.
  struct UndividedInputs
  {
    NamedMotions                            motions; ///< of handles that follow a cache
    std::vector<std::string>                warnings;
    std::shared_ptr<const SurfaceMesh>      surface;   ///< as Inputs have it
    std::vector<CarriedSurface>             carried;   ///< the same
    std::shared_ptr<const MadeOfSurfaces>   made;      ///< the same
    std::optional<std::vector<std::string>> geo_walls; ///< the same
    std::shared_ptr<const Inputs>           inputs; ///< null unless Output/Space error needs them
  };

  /// What the body of a scene is made of: all of it, or the part of a process.
  struct BodyInputs
  {
    Mesh            mesh;
    BodyFields      fields;
    UndividedInputs undivided;
  };

  /// The whole body of a scene, of its inputs. Throws UserError for whatever these and the scene do
  /// not fit.
  BodyInputs
  make_body_inputs(const CompleteScene &scene, Inputs inputs);

  /// The same of what read_inputs() reads.
  BodyInputs
  read_body(const CompleteScene &scene, const Announce &announce = {});
} // namespace Exemplar

#endif
