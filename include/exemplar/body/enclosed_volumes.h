// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_enclosed_volumes_h
#define exemplar_enclosed_volumes_h

#include <exemplar/algebra/vector.h>
#include <exemplar/body/shell_mesh.h>

#include <vector>

namespace Exemplar
{
  /// What the pieces of a closed shell enclose. Positions are by degree of freedom, the vertices first [m].
  class EnclosedVolumes
  {
  public:
    /// Of no pieces.
    EnclosedVolumes() = default;

    /// Those of all pieces of a shell, in the order of their first triangles. The shell must outlive this. Throws UserError
    /// for a piece with a border, or one that encloses nothing at rest.
    explicit EnclosedVolumes(const ShellMesh &mesh);

    /// Number of pieces.
    unsigned int
    size() const
    {
      return pieces.size();
    }

    /// Whose normals point outwards, or inwards: at rest [m^3], not negative.
    double
    rest(const unsigned int piece) const
    {
      return pieces[piece].rest;
    }

    /// The area of a piece at rest [m^2].
    double
    area(const unsigned int piece) const
    {
      return pieces[piece].area;
    }

    /// That of its greatest triangle.
    double
    greatest_triangle(const unsigned int piece) const
    {
      return pieces[piece].greatest_triangle;
    }

    /// Triangles of a piece, ascending.
    const std::vector<unsigned int> &
    triangles(const unsigned int piece) const
    {
      return pieces[piece].triangles;
    }

    /// The volume over that at rest, less 1.
    double
    change(unsigned int piece, const Vector &positions) const;

    /// Add factor times the derivative of change() by the positions [1/m].
    void
    add_gradient(unsigned int  piece,
                 const Vector &positions,
                 double        factor,
                 Vector       &gradient) const;

    /// Call function(a, b, v) for the three pairs of vertices of each triangle, b after a around it: the second derivative of
    /// change() by the places of these two vertices, along dx_a and dx_b, is the sum of dx_a.(dx_b x v) over its pairs [1/m^2].
    template <typename Function>
    void
    for_each_second_derivative(const unsigned int piece,
                               const Vector      &positions,
                               const Function    &function) const
    {
      const Vector3<double> origin = place_in(positions, origin_of(piece));
      for (const unsigned int t : pieces[piece].triangles)
        for (unsigned int i = 0; i < 3; ++i)
        {
          const std::array<unsigned int, 3> &nodes = mesh->triangles()[t].nodes;
          const unsigned int                 a = nodes[i], b = nodes[(i + 1) % 3];
          const Vector3<double> third = difference(place_in(positions, nodes[(i + 2) % 3]), origin);
          function(a, b, times(pieces[piece].factor, third));
        }
    }

  private:
    /// A closed surface of triangles.
    struct Piece
    {
      std::vector<unsigned int> triangles;
      double                    rest = 0., area = 0., greatest_triangle = 0.;
      double factor = 1. / 6.; ///< of triple products, over the volume at rest [1/m^3]
    };

    /// The node from which places are measured: a body far from the origin would lose its volume in rounding.
    unsigned int
    origin_of(const unsigned int piece) const
    {
      return mesh->triangles()[pieces[piece].triangles.front()].nodes[0];
    }

    /// The sum of factor times the triple products of all triangles.
    double
    sum_of_products(unsigned int piece, const Vector &positions) const;

    const ShellMesh   *mesh = nullptr;
    std::vector<Piece> pieces;
  };
} // namespace Exemplar

#endif
