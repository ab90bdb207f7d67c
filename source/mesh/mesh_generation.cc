// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/mesh/mesh_generation.h>

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <unistd.h>
#include <utility>

namespace Exemplar
{
  namespace
  {
    using Triple = std::array<unsigned int, 3>;

    /// Node indices of the box, x fastest.
    class BoxNodes
    {
    public:
      explicit BoxNodes(const Triple &n_bricks) : n_cells(n_bricks) {}

      std::size_t
      index(const Triple &at) const
      {
        return at[0]
               + (n_cells[0] + std::size_t(1)) * (at[1] + (n_cells[1] + std::size_t(1)) * at[2]);
      }

      /// Call `visit` with every lattice point below `end`, x fastest.
      template <typename Visit>
      static void
      for_each(const Triple &end, const Visit &visit)
      {
        for (unsigned int k = 0; k < end[2]; ++k)
          for (unsigned int j = 0; j < end[1]; ++j)
            for (unsigned int i = 0; i < end[0]; ++i)
              visit(Triple{ { i, j, k } });
      }

    private:
      Triple n_cells;
    };

    void
    add_element(MshFile                        &box,
                const unsigned int              type,
                const unsigned int              tag,
                const std::vector<std::size_t> &nodes)
    {
      const int id = static_cast<int>(tag);
      box.elements.push_back({ box.elements.size() + 1, type, id, id, nodes });
    }

    /// Add the two triangles of a brick's side, facing outwards. They share the side's diagonal
    /// from its lowest to its highest corner, as the tetrahedra have it.
    void
    add_side(MshFile           &box,
             const BoxNodes    &nodes,
             const Triple      &lowest,
             const unsigned int axis,
             const bool         upper)
    {
      Triple b = lowest;
      Triple c = lowest;
      Triple d = lowest;
      b[(axis + 1) % 3] += 1;
      c[(axis + 2) % 3] += 1;
      d[(axis + 1) % 3] += 1;
      d[(axis + 2) % 3] += 1;
      const unsigned int tag = 2 * axis + (upper ? 2 : 1);
      for (const auto &[from, to] : { std::pair(b, d), std::pair(d, c) })
      {
        std::vector<std::size_t> triangle{ nodes.index(lowest), nodes.index(from),
                                           nodes.index(to) };
        if (!upper)
          std::swap(triangle[1], triangle[2]);
        add_element(box, MshElementType::triangle, tag, triangle);
      }
    }

    void
    add_boundary(MshFile &box, const BoxNodes &nodes, const Triple &n_cells)
    {
      for (unsigned int axis = 0; axis < 3; ++axis)
        for (const bool upper : { false, true })
        {
          Triple end = n_cells;
          end[axis]  = 1;
          BoxNodes::for_each(end,
                             [&](Triple lowest)
                             {
                               lowest[axis] = upper ? n_cells[axis] : 0;
                               add_side(box, nodes, lowest, axis, upper);
                             });
        }
    }

    /// Add a brick by Kuhn's subdivision: each permutation of the three axes is a path along the
    /// edges from the lowest to the highest corner, whose 4 corners are a tetrahedron.
    void
    add_brick(MshFile &box, const BoxNodes &nodes, const Triple &lowest)
    {
      Triple axes{ { 0, 1, 2 } };
      do
      {
        Triple                   at = lowest;
        std::vector<std::size_t> tetrahedron{ nodes.index(at) };
        for (const unsigned int axis : axes)
        {
          at[axis] += 1;
          tetrahedron.push_back(nodes.index(at));
        }
        const bool even = (axes[1] == (axes[0] + 1) % 3);
        if (!even)
          std::swap(tetrahedron[2], tetrahedron[3]);
        add_element(box, MshElementType::tetrahedron, 1, tetrahedron);
      } while (std::next_permutation(axes.begin(), axes.end()));
    }

    // Memory of a tetrahedron in the mesh alone [bytes]; a run takes several times as much.
    constexpr double least_bytes = 1000.;

    void
    check_box(const std::array<double, 3> &size, const Triple &n_cells)
    {
      double n_tetrahedra = 6.;
      for (unsigned int d = 0; d < 3; ++d)
      {
        if (!(size[d] > 0.) || size[d] > std::numeric_limits<double>::max())
          throw UserError(fmt::format("Mesh/Box size: the three lengths must be positive, found "
                                      "{}. Give them as e.g. 4, 1, 1.",
                                      size[d]));
        if (n_cells[d] == 0)
          throw UserError("Mesh/Box cells: the three counts must be at least 1, found 0. Give "
                          "them as e.g. 16, 4, 4.");
        n_tetrahedra *= n_cells[d];
      }
      if (n_tetrahedra > 1e9)
        throw UserError("Mesh/Box cells: these are more than 1e9 tetrahedra (6 a brick), which no "
                        "machine would hold. Give smaller counts.");
      const double memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * sysconf(_SC_PAGESIZE);
      if (memory > 0. && n_tetrahedra * least_bytes > memory)
        throw UserError(fmt::format(
            "Mesh/Box cells: there is not enough memory for {:.0f} million tetrahedra (6 a brick), "
            "which "
            "need {:.0f} GiB or more; this machine has {:.0f}. Give smaller counts.",
            1e-6 * n_tetrahedra, n_tetrahedra * least_bytes / (1 << 30), memory / (1 << 30)));
    }
  } // namespace

  MshFile
  generate_box(const std::array<double, 3> &size, const Triple &n_cells)
  {
    check_box(size, n_cells);
    MshFile           box;
    const BoxNodes    nodes(n_cells);
    const std::size_t x = n_cells[0], y = n_cells[1], z = n_cells[2];
    box.elements.reserve(6 * x * y * z + 4 * (x * y + y * z + z * x));
    BoxNodes::for_each({ { n_cells[0] + 1, n_cells[1] + 1, n_cells[2] + 1 } },
                       [&](const Triple &at)
                       {
                         dealii::Point<3> point;
                         point[0] = size[0] * at[0] / n_cells[0];
                         for (unsigned int d = 1; d < 3; ++d) // exactly symmetric about 0
                           point[d] = size[d] * (2. * at[d] - n_cells[d]) / (2. * n_cells[d]);
                         box.nodes.push_back(point);
                         box.node_numbers.push_back(box.nodes.size());
                       });
    add_boundary(box, nodes, n_cells);
    BoxNodes::for_each(n_cells, [&](const Triple &lowest) { add_brick(box, nodes, lowest); });

    for (const auto &[tag, name] :
         { std::pair(1, "x-"), { 2, "x+" }, { 3, "y-" }, { 4, "y+" }, { 5, "z-" }, { 6, "z+" } })
      box.physical_names[std::pair(2, tag)] = name;
    box.physical_names[std::pair(3, 1)] = "box";
    return box;
  }
} // namespace Exemplar
