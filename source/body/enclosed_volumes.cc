// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/body/enclosed_volumes.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace Exemplar
{
  namespace
  {
    /// Volumes below this part of the cube of the square root of the area are rounding, as those of two sheets that lie on each other.
    constexpr double nothing_enclosed = 1e-9;

    std::string
    text_of(const Vector3<double> &place)
    {
      return fmt::format("({:.6g}, {:.6g}, {:.6g})", place[0], place[1], place[2]);
    }

    void
    refuse_border(const ShellMesh &mesh, const ShellTriangle &triangle)
    {
      for (const unsigned int number : triangle.edges)
        if (const ShellEdge &edge = mesh.edges()[number]; edge.is_border())
          throw UserError("Material/Volume stiffness: the shell is open at the edge from "
                          + text_of(mesh.vertex(edge.begin)) + " to "
                          + text_of(mesh.vertex(edge.end))
                          + ", so that it encloses no volume. Close it, or set Volume stiffness to "
                            "0.");
    }

    /// The triangles that edges connect with one, ascending; they are marked as found.
    std::vector<unsigned int>
    connected(const ShellMesh &mesh, const unsigned int first, std::vector<bool> &found)
    {
      std::vector<unsigned int> piece{ first };
      found[first] = true;
      for (std::size_t k = 0; k < piece.size(); ++k)
        for (const unsigned int edge : mesh.triangles()[piece[k]].edges)
          for (const unsigned int other : mesh.edges()[edge].triangles)
            if (other != ShellEdge::none && !found[other])
            {
              found[other] = true;
              piece.push_back(other);
            }
      std::sort(piece.begin(), piece.end());
      return piece;
    }
  } // namespace

  EnclosedVolumes::EnclosedVolumes(const ShellMesh &mesh) : mesh(&mesh)
  {
    Vector at_rest(3 * mesh.n_vertices());
    for (unsigned int i = 0; i < mesh.n_vertices(); ++i)
      for (unsigned int c = 0; c < 3; ++c)
        at_rest[3 * i + c] = mesh.vertex(i)[c];
    std::vector<bool> found(mesh.triangles().size(), false);
    for (unsigned int t = 0; t < mesh.triangles().size(); ++t)
    {
      if (found[t])
        continue;
      Piece piece;
      piece.triangles = connected(mesh, t, found);
      for (const unsigned int of_piece : piece.triangles)
      {
        const double area = mesh.triangles()[of_piece].area;
        refuse_border(mesh, mesh.triangles()[of_piece]);
        piece.area += area;
        piece.greatest_triangle = std::max(piece.greatest_triangle, area);
      }
      pieces.push_back(std::move(piece));
      const double signed_volume = sum_of_products(pieces.size() - 1, at_rest);
      pieces.back().rest         = std::abs(signed_volume);
      if (!(pieces.back().rest > nothing_enclosed * std::pow(pieces.back().area, 1.5)))
        throw UserError(
            "Material/Volume stiffness: the piece of the shell at "
            + text_of(mesh.vertex(mesh.triangles()[t].nodes[0]))
            + " encloses no volume at rest, which would be the unit of its change. Give it "
              "one, or set Volume stiffness to 0.");
      pieces.back().factor /= signed_volume;
    }
  }

  double
  EnclosedVolumes::sum_of_products(const unsigned int piece, const Vector &positions) const
  {
    const Vector3<double> origin = place_in(positions, origin_of(piece));
    double                sum    = 0.;
    for (const unsigned int t : pieces[piece].triangles)
    {
      const std::array<unsigned int, 3> &nodes = mesh->triangles()[t].nodes;
      const auto                         from_origin
          = [&](const unsigned int i) { return difference(place_in(positions, nodes[i]), origin); };
      sum += pieces[piece].factor * dot(from_origin(0), cross(from_origin(1), from_origin(2)));
    }
    return sum;
  }

  double
  EnclosedVolumes::change(const unsigned int piece, const Vector &positions) const
  {
    return sum_of_products(piece, positions) - 1.;
  }

  void
  EnclosedVolumes::add_gradient(const unsigned int piece,
                                const Vector      &positions,
                                const double       factor,
                                Vector            &gradient) const
  {
    // each pair of a triangle's vertices stands for the third: dx_c.(x_a x x_b)
    const Vector3<double> origin = place_in(positions, origin_of(piece));
    for (const unsigned int t : pieces[piece].triangles)
      for (unsigned int i = 0; i < 3; ++i)
      {
        const std::array<unsigned int, 3> &nodes = mesh->triangles()[t].nodes;
        const Vector3<double>              product
            = cross(difference(place_in(positions, nodes[(i + 1) % 3]), origin),
                    difference(place_in(positions, nodes[(i + 2) % 3]), origin));
        for (unsigned int c = 0; c < 3; ++c)
          gradient[3 * nodes[i] + c] += factor * pieces[piece].factor * product[c];
      }
  }
} // namespace Exemplar
