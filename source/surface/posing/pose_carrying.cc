// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/mesh/mesh_checks.h>
#include <exemplar/surface/posing/pose_carrying.h>
#include <exemplar/surface/shape/surface_poses.h>

namespace Exemplar
{
  namespace
  {
    SurfaceMesh
    read_checked(const std::filesystem::path &file)
    {
      SurfaceMesh surface = read_surface(file);
      require_surface(surface, file.string());
      return surface;
    }
  } // namespace

  RestSurface::RestSurface(const std::filesystem::path &file)
      : name(file.string()), surface(read_checked(file))
  {
  }

  SurfaceMesh
  read_pose_surface(const std::filesystem::path &file, const RestSurface &rest)
  {
    SurfaceMesh pose = read_checked(file);
    check_same_order(rest.surface, rest.name, pose, file.string());
    check_pose(rest.surface, rest.name, pose, file.string());
    return pose;
  }

  PoseTransfer
  make_pose_transfer(const Mesh        &mesh,
                     const RestSurface &rest,
                     const double       attach,
                     const unsigned int n_threads)
  {
    const SurfaceAttachment attachment(mesh.get_nodes(), mesh.get_boundary_faces(),
                                       triangulate(rest.surface));
    check_attachment(attachment, mesh, rest.name);
    PoseTransfer transfer(mesh.get_nodes(), mesh.get_cells(), attachment, attach, n_threads);
    transfer.follow_skin(rest.surface, mesh);
    return transfer;
  }

  bool
  is_surface_of(const Mesh &mesh, const SurfaceMesh &surface)
  {
    try
    {
      check_attachment({ mesh.get_nodes(), mesh.get_boundary_faces(), triangulate(surface) }, mesh,
                       "");
      return true;
    }
    catch (const UserError &)
    {
      return false;
    }
  }

  std::string
  inverted_elements(const PoseTransfer                  &transfer,
                    const Mesh                          &mesh,
                    const std::vector<dealii::Point<3>> &x)
  {
    const std::vector<double> determinants = transfer.determinants(x);
    std::vector<std::size_t>  numbers;
    for (unsigned int c = 0; c < determinants.size(); ++c)
      if (!(determinants[c] > FoldSolver::margin))
        numbers.push_back(mesh.element_number(c));
    return numbers.empty() ? "" : list_numbers(numbers);
  }
} // namespace Exemplar
