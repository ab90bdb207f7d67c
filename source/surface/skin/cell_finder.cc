// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/mesh/mesh.h>
#include <exemplar/surface/skin/cell_finder.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/tensor.h>
#include <deal.II/numerics/rtree.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    using Entry = std::pair<dealii::BoundingBox<3>, unsigned int>; // a cell's box and number

    constexpr double rounding = 1e-12; ///< tolerance of barycentric coordinates

    /// Barycentric coordinates by ratios of volumes.
    std::array<double, 4>
    barycentric(const std::array<dealii::Point<3>, 4> &corners, const dealii::Point<3> &point)
    {
      const auto six_volumes = [](const auto &a, const auto &b, const auto &c, const auto &d)
      { return dealii::cross_product_3d(b - a, c - a) * (d - a); };
      const double          whole = six_volumes(corners[0], corners[1], corners[2], corners[3]);
      std::array<double, 4> shares;
      for (int a = 0; a < 4; ++a)
      {
        auto of_node = corners;
        of_node[a]   = point;
        shares[a]    = six_volumes(of_node[0], of_node[1], of_node[2], of_node[3]) / whole;
      }
      return shares;
    }
  } // namespace

  struct CellFinder::Tree
  {
    dealii::RTree<Entry> boxes;
  };

  CellFinder::CellFinder(const Mesh &mesh) : mesh(mesh), tree(std::make_unique<Tree>())
  {
    std::vector<Entry> entries;
    entries.reserve(mesh.n_cells());
    for (unsigned int cell = 0; cell < mesh.n_cells(); ++cell)
    {
      std::vector<dealii::Point<3>> corners;
      for (const unsigned int node : mesh.get_cells()[cell])
        corners.push_back(mesh.get_nodes()[node]);
      dealii::BoundingBox<3> box(corners);
      box.extend(rounding * corners[0].distance(corners[1]));
      entries.emplace_back(box, cell);
    }
    tree->boxes = dealii::pack_rtree(entries);
  }

  CellFinder::~CellFinder() = default;

  std::optional<CellFinder::Place>
  CellFinder::find(const dealii::Point<3> &point) const
  {
    std::vector<Entry> found;
    tree->boxes.query(boost::geometry::index::intersects(point), std::back_inserter(found));
    std::sort(found.begin(), found.end(),
              [](const Entry &a, const Entry &b) { return a.second < b.second; });
    std::optional<Place> best;
    double               depth = -rounding;
    for (const auto &[box, cell] : found)
    {
      std::array<dealii::Point<3>, 4> corners;
      for (int a = 0; a < 4; ++a)
        corners[a] = mesh.get_nodes()[mesh.get_cells()[cell][a]];
      const auto   shares  = barycentric(corners, point);
      const double minimum = *std::min_element(shares.begin(), shares.end());
      if (minimum > depth || (!best && minimum == depth))
      {
        best  = Place{ cell, shares };
        depth = minimum;
      }
    }
    return best;
  }
} // namespace Exemplar
