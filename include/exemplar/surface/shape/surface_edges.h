// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_surface_edges_h
#define exemplar_surface_edges_h

#include <exemplar/surface/shape/triangle_surface.h>

#include <array>
#include <vector>

namespace Exemplar
{
  /// A side of a triangle, from corner k to corner k + 1.
  struct TriangleSide
  {
    std::array<unsigned int, 2> vertices; ///< ascending
    unsigned int                triangle;
    unsigned int                corner;  ///< k
    bool                        forward; ///< whether corner k has the smaller vertex
  };

  /// All sides, sorted by their vertices, so that sides of an edge follow one another; sides
  /// without length, from a vertex to itself, are left out.
  std::vector<TriangleSide>
  sorted_sides(const TriangleSurface &surface);

  /// Call `visit(first, last)`, pointers to sides, for every edge.
  template <typename Visit>
  void
  for_each_edge(const std::vector<TriangleSide> &sides, const Visit &visit)
  {
    for (std::size_t i = 0, end = 0; i < sides.size(); i = end)
    {
      while (end < sides.size() && sides[end].vertices == sides[i].vertices)
        ++end;
      visit(sides.data() + i, sides.data() + end);
    }
  }

  /// Disjoint sets of the numbers 0 to n - 1, which can be joined.
  class UnionFind
  {
  public:
    explicit UnionFind(std::size_t n);

    /// The smallest element of the set of i.
    unsigned int
    root(unsigned int i);

    void
    join(unsigned int i, unsigned int j);

    /// Number the sets, in the order of their smallest elements; `sets` gets the number of each
    /// element's set. Returns the number of sets.
    unsigned int
    number(std::vector<unsigned int> &sets);

  private:
    std::vector<unsigned int> parent;
  };

  /// The shell of each triangle, and their number: triangles that share an edge are of one.
  unsigned int
  number_shells(const TriangleSurface           &surface,
                const std::vector<TriangleSide> &sides,
                std::vector<unsigned int>       &shells);

  /// The triangles of one shell, with all vertices.
  TriangleSurface
  shell_of(const TriangleSurface           &surface,
           const std::vector<unsigned int> &shells,
           unsigned int                     shell);
} // namespace Exemplar

#endif
