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

  /// Callback before work that takes seconds, with its description.
  using Announce = std::function<void(const std::string &)>;

  /// Mesh and poses that a scene gives as surfaces, made as by `exemplar mesh` and `exemplar pose`.
  /// They are cached (see kept_bytes()) under the SHA-256 of all data that they depend on.
  class SurfaceInputs
  {
  public:
    /// `announce` may be empty; `scene` must outlive this.
    SurfaceInputs(const SceneParameters &scene, Announce announce);
    ~SurfaceInputs();

    /// Read and check a pose of the scene's surface, which is fast. Throws UserError.
    void
    read_pose(const std::string &file);

    /// Mesh the inside of Mesh/File. Throws UserError for a surface that bounds no body,
    /// SolverFailure for one that cannot be filled.
    MshFile
    make_mesh();

    /// The positions of the mesh's nodes in a pose that has been read. Throws UserError if the mesh
    /// does not fill the surface, SolverFailure if cells stay inverted.
    std::vector<dealii::Point<3>>
    carry(const std::string &file, const MshFile &mesh);

    /// The report; null if nothing was made of surfaces.
    std::shared_ptr<const MadeOfSurfaces>
    get_made() const
    {
      return made;
    }

  private:
    struct Poses;

    /// Files of the poses read so far, by name, if the mesh depends on them, that is if sheets of
    /// the surface cross at rest; else none.
    std::vector<std::filesystem::path>
    parting_poses() const;

    MadeOfSurfaces &
    get_made_anew();
    /// Add to the report's warnings, unless it is empty or there already.
    void
    add_warning(const std::string &warning);

    const SceneParameters          &scene;
    const Announce                  announce;
    std::unique_ptr<Poses>          poses; ///< null until one is read
    std::shared_ptr<MadeOfSurfaces> made;
  };
} // namespace Exemplar

#endif
