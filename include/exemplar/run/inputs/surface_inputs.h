// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_inputs_h
#define exemplar_surface_inputs_h

#include <exemplar/mesh/mesh_inputs.h>
#include <exemplar/run/inputs/made_of_surfaces.h>

#include <filesystem>
#include <functional>
#include <memory>

namespace Exemplar
{
  struct SceneParameters;

  /// Is told what takes seconds before it begins.
  using Announce = std::function<void(const std::string &)>;

  /// Mesh and poses that a scene names as surfaces. They are made as `exemplar mesh` and `exemplar
  /// pose` make them, and kept (see kept_bytes()) under the SHA-256 of all that they follow from.
  class SurfaceInputs
  {
  public:
    /// `announce` may be empty; `scene` must outlive this.
    SurfaceInputs(const SceneParameters &scene, Announce announce);
    ~SurfaceInputs();

    /// Read and check a pose of the scene's surface, which takes no time. Throws UserError.
    void
    read_pose(const std::string &file);

    /// The mesh inside of Mesh/File. Throws UserError for a surface that bounds no body,
    /// SolverFailure for one that cannot be filled.
    MshFile
    make_mesh();

    /// The places of the mesh's nodes in a pose that has been read. Throws UserError if the mesh is
    /// not of the surface's inside, SolverFailure if cells stay inverted.
    std::vector<dealii::Point<3>>
    carry(const std::string &file, const MshFile &mesh);

    /// Null if nothing was made of surfaces.
    std::shared_ptr<const MadeOfSurfaces>
    get_made() const
    {
      return made;
    }

  private:
    struct Poses;

    /// Of the poses that have been read, by name, if the mesh depends on them: if sheets of the surface
    /// cross at rest.
    std::vector<std::filesystem::path>
    parting_poses() const;

    MadeOfSurfaces &
    get_made_anew();
    /// Once, if there is one.
    void
    add_warning(const std::string &warning);

    const SceneParameters          &scene;
    const Announce                  announce;
    std::unique_ptr<Poses>          poses; ///< null until one is read
    std::shared_ptr<MadeOfSurfaces> made;
  };
} // namespace Exemplar

#endif
