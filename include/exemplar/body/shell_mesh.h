// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_shell_mesh_h
#define exemplar_shell_mesh_h

#include <exemplar/algebra/vector.h>
#include <exemplar/kernels/triangle_strain.h>

#include <array>
#include <vector>

namespace Exemplar
{
  /// Three numbers of a vector by degree of freedom.
  inline Vector3<double>
  place_in(const Vector &positions, const unsigned int node)
  {
    const double *x = positions.begin() + 3 * node;
    return { { x[0], x[1], x[2] } };
  }

  /// An edge of a shell at rest. It runs from begin to end as its first triangle has it, whose third
  /// vertex is opposite[0]; the second triangle, if there is one, runs from end to begin.
  struct ShellEdge
  {
    static constexpr unsigned int none = static_cast<unsigned int>(-1);

    unsigned int                begin, end;
    std::array<unsigned int, 2> triangles = { { none, none } };
    std::array<unsigned int, 2> opposite  = { { none, none } };
    double                      length    = 0.; ///< [m]
    double                      angle     = 0.; ///< HingeAngle of its triangles; 0 at a border
    Vector3<double> normal = {}; ///< of its director: unit bisector of the normals of its triangles

    bool
    is_border() const
    {
      return triangles[1] == none;
    }
  };

  /// A triangle of a shell at rest. Its frame has the first axis along the first edge, and the second
  /// in its plane.
  struct ShellTriangle : TriangleShape<double>
  {
    std::array<unsigned int, 3> nodes;
    std::array<unsigned int, 3> edges;
    std::array<double, 3>       signs; ///< 1 for the first triangle of an edge, -1 for the second
    double                      thickness = 0.; ///< [m]
    double                      area      = 0.; ///< [m^2]
    std::array<Vector3<double>, 3> axes;        ///< of the frame; the third is the normal

    /// [m^3]
    double
    volume() const
    {
      return area * thickness;
    }
  };

  /// A surface of triangles with a thickness, which share edges two by two. Its nodes are the vertices,
  /// in their order, then those of slopes, one an edge of a plate; edges ascend by their ends, the lesser first.
  class ShellMesh
  {
  public:
    /// Requires triangles with an area that are turned consistently, at most two an edge, and a
    /// thickness [m] for each.
    ShellMesh(const std::vector<Vector3<double>>             &vertices,
              const std::vector<std::array<unsigned int, 3>> &triangles,
              const std::vector<double>                      &thickness,
              ShellKind                                       kind = ShellKind::plate);

    ShellKind
    kind() const
    {
      return of_kind;
    }

    unsigned int
    n_vertices() const
    {
      return vertices.size();
    }

    const std::vector<ShellTriangle> &
    triangles() const
    {
      return all_triangles;
    }

    const std::vector<ShellEdge> &
    edges() const
    {
      return all_edges;
    }

    /// With those of slopes.
    unsigned int
    n_nodes() const
    {
      return n_vertices() + n_slopes();
    }

    /// One an edge of a plate, none with hinges.
    unsigned int
    n_slopes() const
    {
      return of_kind == ShellKind::plate ? all_edges.size() : 0;
    }

    unsigned int
    slope_node(const unsigned int edge) const
    {
      return n_vertices() + edge;
    }

    const Vector3<double> &
    vertex(const unsigned int i) const
    {
      return vertices[i];
    }

    /// Where the tip of an edge's director is at rest: above its middle by its length, along its normal.
    Vector3<double>
    tip(unsigned int edge) const;

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    void
    find_edges();

    void
    find_rest_shape();

    /// Let curvatures be those of hinges.
    void
    bend_by_hinges();

    ShellKind of_kind;

    std::vector<Vector3<double>> vertices;
    std::vector<ShellTriangle>   all_triangles;
    std::vector<ShellEdge>       all_edges;
  };
} // namespace Exemplar

#endif
