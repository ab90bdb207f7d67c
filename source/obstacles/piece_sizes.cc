// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/number_text.h>
#include <exemplar/obstacles/box_tree.h>
#include <exemplar/obstacles/contact_parameters.h>
#include <exemplar/obstacles/piece_sizes.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    std::vector<double>
    diameters_of_pieces(const Mesh &mesh)
    {
      if (mesh.n_pieces() == 1)
        return { mesh.diameter() };
      std::vector<AxisBox> boxes(mesh.n_pieces());
      for (unsigned int cell = 0; cell < mesh.n_cells(); ++cell)
        for (const unsigned int node : mesh.corners(cell))
          boxes[mesh.piece_of(cell)].add(mesh.get_nodes()[node]);
      std::vector<double> diameters;
      for (const AxisBox &box : boxes)
      {
        dealii::Tensor<1, 3> size;
        for (unsigned int c = 0; c < 3; ++c)
          size[c] = mesh.exchange().max(box.high[c]) + mesh.exchange().max(-box.low[c]);
        diameters.push_back(size.norm());
      }
      return diameters;
    }
  } // namespace

  PieceSizes::PieceSizes(const Mesh &mesh, const FESpace &fe_space)
      : pieces(fe_space.numbering().pieces()), diameters(diameters_of_pieces(mesh))
  {
  }

  double
  PieceLengths::greatest() const
  {
    return *std::max_element(of_pieces.begin(), of_pieces.end());
  }

  namespace
  {
    PieceLengths
    part_of_diameters(const double part, const PieceSizes &sizes)
    {
      PieceLengths result;
      for (const double diameter : sizes.diameters)
        result.of_pieces.push_back(part * diameter);
      if (sizes.diameters.size() > 1)
        result.pieces = sizes.pieces;
      return result;
    }
  } // namespace

  PieceLengths
  contact_distances(const std::string &text,
                    const std::string &key,
                    const double       diameter,
                    const PieceSizes  &sizes)
  {
    constexpr double part = 5e-3;
    if (text == "auto")
      return part_of_diameters(part, sizes);
    return { { contact_distance(text, key, diameter) }, {} };
  }

  PieceLengths
  contact_slip_speeds(const std::string &text, const PieceSizes &sizes)
  {
    constexpr double part = 1e-3;
    if (text == "auto")
      return part_of_diameters(part, sizes);
    return { { parse_number(text) }, {} };
  }
} // namespace Exemplar
