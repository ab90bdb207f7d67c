// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_final_pose_h
#define exemplar_final_pose_h

#include <exemplar/mesh/mesh.h>
#include <exemplar/run/scene/scene_file.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace Exemplar
{
  /// A body at the end of a run.
  struct FinalPose
  {
    FinalPose(const Mesh &mesh, const std::filesystem::path &final_msh);

    /// The greatest displacement [m].
    double
    max_displacement() const;

    /// The displacement [m] of the node nearest to a rest position [m].
    dealii::Tensor<1, 3>
    displacement_near(const dealii::Point<3> &point) const;

    const std::vector<dealii::Point<3>> rest;
    const std::vector<dealii::Point<3>> positions;
    std::vector<double>                 volumes; ///< of nodes: a quarter of each of their cells
  };

  /// Reads the final poses of runs, and a mesh once for all runs that have it.
  class FinalPoseReader
  {
  public:
    /// The final pose that a run of the scene has left in a directory. Throws UserError if it is
    /// missing, or of another mesh.
    FinalPose
    read(const SceneFile &scene, const std::filesystem::path &directory);

  private:
    std::map<std::string, std::unique_ptr<const Mesh>> meshes; ///< by the values of subsection Mesh
  };
} // namespace Exemplar

#endif
