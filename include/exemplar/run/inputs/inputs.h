// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_inputs_h
#define exemplar_inputs_h

#include <exemplar/mesh/mesh_inputs.h>
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

  /// What the files hold that a scene names, or arrays that stand in for them; make_msh() makes
  /// a mesh of arrays. All lengths are in the mesh's unit: Mesh/Scale makes metres of them.
  struct Inputs
  {
    MshFile    mesh;
    NamedPoses poses; ///< of Examples/Poses, Handles/NAME/Follow pose and Initial/Pose
    NamedNodes nodes; ///< of Select = nodes FILE
    /// Of Mesh/Surface; null unless the scene needs it.
    std::shared_ptr<const SurfaceMesh> surface = {};
    /// Of Mesh/Carry, in its order.
    std::vector<CarriedSurface> carried = {};
    NamedMaps                   maps    = {}; ///< by FILE:ATTRIBUTE, of the surface's vertices
    /// Of Follow cache, by the names of handles. Sequences of files keep a reference to the surface.
    std::map<std::string, std::shared_ptr<const PointCache>> caches = {};
    /// How mesh and poses became of surfaces; null if none did.
    std::shared_ptr<const MadeOfSurfaces> made = {};
    /// What stood around gmsh, see MshFile::geo_walls.
    std::optional<std::vector<std::string>> geo_walls = {};
  };

  /// Read or generate what a scene needs and `given` does not hold. Without importance no
  /// example pose is read. Throws UserError for a file that cannot be read or is none of the
  /// mesh, naming what is wrong. Surfaces are checked before anything is made of them, which may take
  /// long unless it is kept; `announce` is told of it.
  Inputs
  read_inputs(const CompleteScene &scene, Inputs given = {}, const Announce &announce = {});

  /// load_mesh(), also of a surface.
  MshFile
  load_or_make_mesh(const MeshParameters &parameters);
} // namespace Exemplar

#endif
