// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/inputs/inputs.h>
#include <exemplar/run/output/final_pose.h>
#include <exemplar/run/output/run_files.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    std::vector<double>
    nodal_volumes(const Mesh &mesh)
    {
      std::vector<double> volumes(mesh.n_nodes());
      const auto         &nodes = mesh.get_nodes();
      for (unsigned int cell = 0; mesh.is_shell() && cell < mesh.n_cells(); ++cell)
        for (const unsigned int node :
             mesh.corners(cell)) // by area; the thickness is not known here
          volumes[node] += dealii::cross_product_3d(
                               nodes[mesh.corners(cell)[1]] - nodes[mesh.corners(cell)[0]],
                               nodes[mesh.corners(cell)[2]] - nodes[mesh.corners(cell)[0]])
                               .norm()
                           / 6.;
      for (const auto &cell : mesh.get_cells())
      {
        const dealii::Tensor<1, 3> normal
            = cross_product_3d(nodes[cell[1]] - nodes[cell[0]], nodes[cell[2]] - nodes[cell[0]]);
        const double volume = std::abs(normal * (nodes[cell[3]] - nodes[cell[0]])) / 6.;
        for (const unsigned int node : cell)
          volumes[node] += volume / 4.;
      }
      return volumes;
    }

    std::string
    key_of_mesh(const SceneFile &scene)
    {
      std::string key;
      for (const DeclaredKey &declared : scene.get_keys())
        if (declared.subsections == std::vector<std::string>{ "Mesh" })
          key += declared.value + "\n";
      return key;
    }
  } // namespace

  FinalPose::FinalPose(const Mesh &mesh, const std::filesystem::path &final_msh)
      : rest(mesh.get_nodes()), positions(mesh.read_pose(final_msh)), volumes(nodal_volumes(mesh))
  {
  }

  double
  FinalPose::max_displacement() const
  {
    double maximum = 0.;
    for (unsigned int i = 0; i < rest.size(); ++i)
      maximum = std::max(maximum, positions[i].distance(rest[i]));
    return maximum;
  }

  dealii::Tensor<1, 3>
  FinalPose::displacement_near(const dealii::Point<3> &point) const
  {
    const auto nearest
        = std::min_element(rest.begin(), rest.end(),
                           [&](const auto &a, const auto &b)
                           { return a.distance_square(point) < b.distance_square(point); });
    return positions[nearest - rest.begin()] - *nearest;
  }

  FinalPose
  FinalPoseReader::read(const SceneFile &scene, const std::filesystem::path &directory)
  {
    std::unique_ptr<const Mesh> &mesh = meshes[key_of_mesh(scene)];
    if (mesh == nullptr)
    {
      const MeshParameters &parameters = scene.get_parameters().mesh;
      mesh = std::make_unique<const Mesh>(load_or_make_mesh(parameters), parameters.name(),
                                          parameters.scale, parameters.kind);
    }
    return { *mesh, RunFiles{ directory }.final_pose() };
  }
} // namespace Exemplar
