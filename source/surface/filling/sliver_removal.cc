// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/surface/filling/cell_angles.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace Exemplar
{
  namespace
  {
    /// Cells with smaller angles are improved [degrees].
    constexpr double poor_angle = 8.;
    /// Two boundary faces at a flatter angle are nearly one plane: their edge may be flipped.
    constexpr double flat_angle = 165.;
    /// How far a boundary node may be moved, over the length of its shortest boundary edge.
    constexpr double farthest_on_boundary = 0.1;

    using Triangle = std::array<unsigned int, 3>;
    using Edge     = std::array<unsigned int, 2>;

    Triangle
    sorted(Triangle t)
    {
      std::sort(t.begin(), t.end());
      return t;
    }

    Edge
    edge_of(const unsigned int a, const unsigned int b)
    {
      return { { std::min(a, b), std::max(a, b) } };
    }

    class SliverRemoval
    {
    public:
      SliverRemoval(TetrahedralMesh &m, const BoundaryNodes boundary_nodes)
          : mesh(m), boundary_nodes(boundary_nodes), nodes_before(m.nodes),
            cells_around(m.nodes.size()), on_boundary(m.nodes.size(), false),
            gone(m.cells.size(), false)
      {
        for (std::size_t c = 0; c < mesh.cells.size(); ++c)
          for (const unsigned int node : mesh.cells[c])
            cells_around[node].push_back(c);
        for (unsigned int t = 0; t < mesh.boundary.triangles.size(); ++t)
          add_boundary(t);
      }

      std::size_t
      run()
      {
        for (unsigned int pass = 0; pass < 5; ++pass)
        {
          const std::vector<std::size_t> poor = poor_cells();
          for (const std::size_t cell : poor)
            take_away(cell);
          bool moved = false;
          for (const std::size_t cell : poor)
            for (const unsigned int node : mesh.cells[cell])
              moved = (!gone[cell] && !on_boundary[node]
                       && improve(node, std::numeric_limits<double>::infinity()))
                      || moved;
          if (boundary_nodes == BoundaryNodes::moved_slightly)
            moved = improve_on_boundary() || moved;
          if (!moved)
            break;
        }
        return drop_gone();
      }

    private:
      void
      add_boundary(const unsigned int t)
      {
        const Triangle &nodes        = mesh.boundary.triangles[t];
        boundary_face[sorted(nodes)] = t;
        for (unsigned int k = 0; k < 3; ++k)
        {
          on_boundary[nodes[k]] = true;
          boundary_edges.insert(edge_of(nodes[k], nodes[(k + 1) % 3]));
        }
      }

      std::vector<std::size_t>
      poor_cells() const
      {
        std::vector<std::size_t> poor;
        for (std::size_t c = 0; c < mesh.cells.size(); ++c)
          if (!gone[c] && dihedral_angles(corners_of(mesh, c)).first < poor_angle)
            poor.push_back(c);
        return poor;
      }

      /// Move the boundary nodes of slivers slightly, except those on planes, which selections may name.
      bool
      improve_on_boundary()
      {
        bool moved = false;
        for (std::size_t c = 0; c < mesh.cells.size(); ++c)
          for (const unsigned int node : mesh.cells[c])
          {
            if (gone[c] || dihedral_angles(corners_of(mesh, c)).first >= sliver_angle)
              break;
            if (on_boundary[node] && !is_on_plane(node))
              moved = improve(node, farthest_on_boundary * shortest_boundary_edge(node)) || moved;
          }
        return moved;
      }

      std::vector<unsigned int>
      boundary_triangles_around(const unsigned int node) const
      {
        std::vector<unsigned int> around;
        for (unsigned int t = 0; t < mesh.boundary.triangles.size(); ++t)
        {
          const Triangle &nodes = mesh.boundary.triangles[t];
          if (std::find(nodes.begin(), nodes.end(), node) != nodes.end())
            around.push_back(t);
        }
        return around;
      }

      /// Whether two boundary triangles at a node are in one plane.
      bool
      is_on_plane(const unsigned int node) const
      {
        constexpr double                rounding = 1e-6;
        const std::vector<unsigned int> around   = boundary_triangles_around(node);
        for (std::size_t i = 0; i < around.size(); ++i)
          for (std::size_t j = 0; j < i; ++j)
            if (angle_between(around[i], around[j]) < rounding)
              return true;
        return false;
      }

      double
      shortest_boundary_edge(const unsigned int node) const
      {
        double shortest = std::numeric_limits<double>::infinity();
        for (const unsigned int t : boundary_triangles_around(node))
          for (const unsigned int other : mesh.boundary.triangles[t])
            if (other != node)
              shortest = std::min(shortest, norm(minus(nodes_before[other], nodes_before[node])));
        return shortest;
      }

      /// The smallest dihedral angle of the cells around a node [degrees]; negative if one of them
      /// is not of positive volume.
      double
      worst_around(const unsigned int node) const
      {
        double worst = 180.;
        for (const std::size_t c : cells_around[node])
          if (!gone[c])
          {
            const auto p = corners_of(mesh, c);
            worst        = std::min(
                       worst, six_volumes(p[0], p[1], p[2], p[3]) > 0. ? dihedral_angles(p).first : -1.);
          }
        return worst;
      }

      /// Moves a node by a search along the axes, with shorter and shorter steps, at most so far from its first place.
      bool
      improve(const unsigned int node, const double farthest)
      {
        const auto   cell   = corners_of(mesh, cells_around[node].front());
        double       step   = std::min(.2 * norm(minus(cell[1], cell[0])), farthest);
        const double before = worst_around(node);
        double       best   = before;
        for (unsigned int round = 0; round < 12; ++round)
        {
          bool better = false;
          for (unsigned int way = 0; way < 6; ++way)
          {
            const double old = mesh.nodes[node][way / 2];
            mesh.nodes[node][way / 2] += way % 2 == 0 ? step : -step;
            const double now = worst_around(node);
            if (now > best && norm(minus(mesh.nodes[node], nodes_before[node])) <= farthest)
              best = now;
            else
              mesh.nodes[node][way / 2] = old;
            better = better || now == best;
          }
          if (!better)
            step *= .5;
        }
        return best > before;
      }

      /// The boundary's triangles among the faces of a cell; corner k lies opposite of faces[k].
      std::array<int, 4>
      boundary_faces(const std::size_t cell) const
      {
        std::array<int, 4> faces;
        const auto        &n = mesh.cells[cell];
        for (unsigned int k = 0; k < 4; ++k)
        {
          const auto found
              = boundary_face.find(sorted({ { n[(k + 1) % 4], n[(k + 2) % 4], n[(k + 3) % 4] } }));
          faces[k] = found == boundary_face.end() ? -1 : static_cast<int>(found->second);
        }
        return faces;
      }

      /// A flat cell with two boundary faces, abc and bad, gives way to its faces acd and bdc.
      void
      take_away(const std::size_t cell)
      {
        if (gone[cell] || dihedral_angles(corners_of(mesh, cell)).first >= sliver_angle)
          return;
        const auto                faces = boundary_faces(cell);
        std::vector<unsigned int> bare; // corners opposite of boundary faces
        for (unsigned int k = 0; k < 4; ++k)
          if (faces[k] >= 0)
            bare.push_back(k);
        if (bare.size() != 2)
          return;
        const unsigned int first = static_cast<unsigned int>(faces[bare[0]]);
        const unsigned int other = static_cast<unsigned int>(faces[bare[1]]);
        const unsigned int c = mesh.cells[cell][bare[1]], d = mesh.cells[cell][bare[0]];
        if (boundary_edges.count(edge_of(c, d)) > 0
            || mesh.boundary.groups[first] != mesh.boundary.groups[other] || !is_flat(first, other))
          return;
        flip(first, other, c, d);
        gone[cell] = true;
      }

      /// Between the normals of two boundary triangles [rad].
      double
      angle_between(const unsigned int first, const unsigned int other) const
      {
        const auto normal = [&](const unsigned int t)
        {
          const Triangle &n = mesh.boundary.triangles[t];
          return cross(minus(mesh.nodes[n[1]], mesh.nodes[n[0]]),
                       minus(mesh.nodes[n[2]], mesh.nodes[n[0]]));
        };
        const SpaceVector a = normal(first), b = normal(other);
        return std::atan2(norm(cross(a, b)), dot(a, b));
      }

      bool
      is_flat(const unsigned int first, const unsigned int other) const
      {
        return angle_between(first, other) * 180. / std::acos(-1.) < 180. - flat_angle;
      }

      /// `first` has the corner c and `other` has d; both share the edge that goes.
      void
      flip(const unsigned int first,
           const unsigned int other,
           const unsigned int c,
           const unsigned int d)
      {
        Triangle one = mesh.boundary.triangles[first];
        std::rotate(one.begin(), std::find(one.begin(), one.end(), c), one.end());
        const unsigned int a = one[1], b = one[2]; // c, a, b
        for (const unsigned int t : { first, other })
          boundary_face.erase(sorted(mesh.boundary.triangles[t]));
        boundary_edges.erase(edge_of(a, b));
        mesh.boundary.triangles[first] = { { c, a, d } };
        mesh.boundary.triangles[other] = { { d, b, c } };
        add_boundary(first);
        add_boundary(other);
      }

      std::size_t
      drop_gone()
      {
        std::size_t n = 0;
        for (std::size_t c = 0; c < mesh.cells.size(); ++c)
          if (!gone[c])
          {
            mesh.cells[n]     = mesh.cells[c];
            mesh.regions[n++] = mesh.regions[c];
          }
        const std::size_t n_gone = mesh.cells.size() - n;
        mesh.cells.resize(n);
        mesh.regions.resize(n);
        return n_gone;
      }

      TetrahedralMesh                      &mesh;
      const BoundaryNodes                   boundary_nodes;
      const std::vector<SpaceVector>        nodes_before;
      std::vector<std::vector<std::size_t>> cells_around;
      std::vector<bool>                     on_boundary;
      std::vector<bool>                     gone;
      std::map<Triangle, unsigned int>      boundary_face; ///< by sorted nodes
      std::set<Edge>                        boundary_edges;
    };
  } // namespace

  std::size_t
  remove_slivers(TetrahedralMesh &mesh, const BoundaryNodes boundary_nodes)
  {
    return SliverRemoval(mesh, boundary_nodes).run();
  }
} // namespace Exemplar
