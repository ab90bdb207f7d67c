// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_inputs_h
#define exemplar_inputs_h

#include <exemplar/body/weight_table.h>
#include <exemplar/mesh/mesh_inputs.h>
#include <exemplar/obstacles/obstacle.h>
#include <exemplar/run/inputs/surface_inputs.h>
#include <exemplar/surface/files/painted_map.h>
#include <exemplar/surface/files/point_cache.h>

#include <memory>
#include <optional>

namespace Exemplar
{
  class CompleteScene;

  /// A surface of Mesh/Carry.
  struct CarriedSurface
  {
    std::string name; ///< see name_of_carried()
    SurfaceMesh surface;
  };

  /// Contents of the files that a scene names, or arrays in their place; make_msh() makes a mesh of
  /// arrays. All lengths are in the mesh's unit, which Mesh/Scale converts to metres.
  struct Inputs
  {
    MshFile    mesh;
    NamedPoses poses; ///< of Examples/Poses, Handles/NAME/Follow pose and Initial/Pose
    NamedNodes nodes; ///< of Select = nodes FILE
    /// The surface Mesh/Surface; null unless the scene needs it.
    std::shared_ptr<const SurfaceMesh> surface = {};
    /// The surfaces of Mesh/Carry, in its order.
    std::vector<CarriedSurface> carried = {};
    NamedMaps                   maps    = {}; ///< on the surface's vertices, by FILE:ATTRIBUTE
    /// The caches of Follow cache, by handle names. Sequences of files keep a reference to the
    /// surface.
    std::map<std::string, std::shared_ptr<const PointCache>> caches    = {};
    ObstacleSurfaces                                         obstacles = {};
    WeightTable weights = {}; ///< of Examples/Weights file
    /// Report on meshes and poses made of surfaces; null if none were.
    std::shared_ptr<const MadeOfSurfaces> made = {};
    /// Walls around gmsh's geometry, see MshFile::geo_walls.
    std::optional<std::vector<std::string>> geo_walls = {};
  };

  /// Read or generate the inputs that a scene needs and `given` lacks. Example poses are read only
  /// if the importance is not 0. Throws UserError, naming the cause, for a file that cannot be read
  /// or does not belong to the mesh. Surfaces are checked before anything is made of them, which
  /// takes long unless the result is in the cache; `announce` is told of it.
  Inputs
  read_inputs(const CompleteScene &scene, Inputs given = {}, const Announce &announce = {});

  /// load_mesh(), or a mesh made inside of a surface.
  MshFile
  load_or_make_mesh(const MeshParameters &parameters);
} // namespace Exemplar

#endif
