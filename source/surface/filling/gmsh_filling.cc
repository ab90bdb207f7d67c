// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/mesh/gmsh_session.h>
#include <exemplar/mesh/msh_file.h>
#include <exemplar/surface/filling/tetrahedra_inside.h>
#include <exemplar/surface/shape/surface_edges.h>
#include <exemplar/surface/shape/surface_geometry.h>
#include <exemplar/surface/shape/vectors.h>

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace Exemplar
{
  namespace
  {
    void
    set_options()
    {
      const std::map<std::string, double> options{
        { "General.Terminal", 0. },
        { "General.NumThreads", 1. },
        { "Mesh.Algorithm3D", 1. },
        { "Mesh.Optimize", 1. },
        { "Mesh.OptimizeThreshold", .3 },
        { "Mesh.MeshSizeExtendFromBoundary", 1. },
        { "Mesh.Renumber", 0. },
        { "Mesh.RandomSeed", 1. },
        { "Mesh.AngleToleranceFacetOverlap", 1e-3 } // degrees: thin wedges may be
      };
      for (const auto &[name, value] : options)
        gmsh::option::setNumber(name, value);
    }

    [[noreturn]] void
    throw_unfilled(const std::string &reason)
    {
      throw SolverFailure(
          "gmsh could not fill the surface with cells: " + reason
          + ". Ask for more cells (--cells), or mend the surface where it is very thin.");
    }

    int
    tag(const unsigned int number)
    {
      return static_cast<int>(number) + 1;
    }

    /// A surface of gmsh for each shell; nodes and triangles are numbered from 1.
    void
    add_shells(const TriangleSurface           &surface,
               const std::vector<unsigned int> &shells,
               const unsigned int               n_shells)
    {
      std::vector<unsigned int> shell_of_vertex(surface.vertices.size(), n_shells);
      for (std::size_t t = 0; t < shells.size(); ++t)
        for (const unsigned int vertex : surface.triangles[t])
          shell_of_vertex[vertex] = shells[t];
      for (unsigned int shell = 0; shell < n_shells; ++shell)
      {
        std::vector<std::size_t> nodes, corners;
        std::vector<double>      places;
        for (std::size_t i = 0; i < surface.vertices.size(); ++i)
          if (shell_of_vertex[i] == shell)
          {
            nodes.push_back(i + 1);
            places.insert(places.end(), surface.vertices[i].begin(), surface.vertices[i].end());
          }
        for (std::size_t t = 0; t < shells.size(); ++t)
          if (shells[t] == shell)
            for (const unsigned int vertex : surface.triangles[t])
              corners.push_back(vertex + std::size_t(1));
        gmsh::model::addDiscreteEntity(2, tag(shell));
        gmsh::model::mesh::addNodes(2, tag(shell), nodes, places);
        gmsh::model::mesh::addElementsByType(tag(shell), MshElementType::triangle, {}, corners);
        gmsh::model::geo::addSurfaceLoop({ tag(shell) }, tag(shell));
      }
    }

    /// Adds a volume for each shell that bounds a region from outside, tagged by region; returns
    /// the number of regions.
    unsigned int
    add_volumes(const TriangleSurface           &surface,
                const std::vector<unsigned int> &shells,
                const unsigned int               n_shells)
    {
      const auto   around    = enclosing_shells(surface, shells, n_shells);
      unsigned int n_regions = 0;
      for (unsigned int shell = 0; shell < n_shells; ++shell)
      {
        if (enclosed_volume(shell_of(surface, shells, shell)) < 0.)
          continue;
        std::vector<int> loops{ tag(shell) };
        for (unsigned int inner = 0; inner < n_shells; ++inner)
          if (around[inner] == shell)
            loops.push_back(tag(inner));
        gmsh::model::geo::addVolume(loops, tag(n_regions++));
      }
      gmsh::model::geo::synchronize();
      return n_regions;
    }

    /// gmsh's node tags -> places; those of the surface come first and keep their order.
    std::vector<unsigned int>
    take_nodes(TetrahedralMesh &mesh, const std::size_t n_surface)
    {
      std::vector<std::size_t> tags;
      std::vector<double>      places, parameters;
      gmsh::model::mesh::getNodes(tags, places, parameters);
      std::vector<std::pair<std::size_t, std::size_t>> order;
      for (std::size_t i = 0; i < tags.size(); ++i)
        if (tags[i] > n_surface)
          order.emplace_back(tags[i], i);
        else if (places[3 * i] != mesh.nodes[tags[i] - 1][0])
          throw_unfilled("it changed the numbers of the surface's vertices");
      std::sort(order.begin(), order.end());
      std::vector<unsigned int> index(order.empty() ? n_surface + 1 : order.back().first + 1);
      for (std::size_t i = 0; i < n_surface; ++i)
        index[i + 1] = static_cast<unsigned int>(i);
      for (const auto &[number, i] : order)
      {
        index[number] = static_cast<unsigned int>(mesh.nodes.size());
        mesh.nodes.push_back({ { places[3 * i], places[3 * i + 1], places[3 * i + 2] } });
      }
      return index;
    }

    void
    take_cells(TetrahedralMesh                 &mesh,
               const std::vector<unsigned int> &index,
               const unsigned int               n_regions)
    {
      for (unsigned int region = 0; region < n_regions; ++region)
      {
        std::vector<std::size_t> tags, corners;
        gmsh::model::mesh::getElementsByType(MshElementType::tetrahedron, tags, corners,
                                             tag(region));
        for (std::size_t c = 0; c < corners.size(); c += 4)
        {
          std::array<unsigned int, 4> cell;
          for (unsigned int k = 0; k < 4; ++k)
            cell[k] = index[corners[c + k]];
          if (six_volumes(mesh.nodes[cell[0]], mesh.nodes[cell[1]], mesh.nodes[cell[2]],
                          mesh.nodes[cell[3]])
              < 0.)
            std::swap(cell[2], cell[3]);
          mesh.cells.push_back(cell);
          mesh.regions.push_back(region);
        }
      }
    }

    /// Checks that the volumes of the cells sum to that of the body.
    void
    check_volume(const TetrahedralMesh &mesh, const double expected)
    {
      double volume = 0.;
      for (const auto &c : mesh.cells)
        volume
            += six_volumes(mesh.nodes[c[0]], mesh.nodes[c[1]], mesh.nodes[c[2]], mesh.nodes[c[3]])
               / 6.;
      if (!(std::abs(volume - expected) <= 1e-6 * expected))
        throw_unfilled("its cells have another volume than the surface encloses");
    }

    /// The volume that the outermost shells enclose, less the cavities.
    double
    filled_volume(const TriangleSurface           &surface,
                  const std::vector<unsigned int> &shells,
                  const unsigned int               n_shells)
    {
      const auto around = enclosing_shells(surface, shells, n_shells);
      double     volume = 0.;
      for (unsigned int shell = 0; shell < n_shells; ++shell)
      {
        const double part = enclosed_volume(shell_of(surface, shells, shell));
        volume += around[shell] == n_shells || part < 0. ? part : 0.;
      }
      return volume;
    }

    std::string
    last_error()
    {
      std::string message;
      gmsh::logger::getLastError(message);
      return message.empty() ? "it gave no reason" : message;
    }
  } // namespace

  TetrahedralMesh
  fill(const TriangleSurface &surface)
  {
    std::vector<unsigned int> shells;
    const unsigned int        n_shells = number_shells(surface, sorted_sides(surface), shells);
    const GmshSession         session;
    set_options();
    gmsh::model::add("surface");
    TetrahedralMesh mesh{ surface.vertices, {}, {}, surface };
    mesh.boundary.vertices.clear();
    try
    {
      add_shells(surface, shells, n_shells);
      const unsigned int n_regions = add_volumes(surface, shells, n_shells);
      gmsh::model::mesh::generate(3);
      take_cells(mesh, take_nodes(mesh, surface.vertices.size()), n_regions);
    }
    catch (const SolverFailure &)
    {
      throw;
    }
    catch (...) // gmsh's own error has no useful message
    {
      throw_unfilled(last_error());
    }
    check_volume(mesh, filled_volume(surface, shells, n_shells));
    return mesh;
  }
} // namespace Exemplar
