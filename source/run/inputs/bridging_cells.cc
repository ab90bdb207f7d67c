// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/number_text.h>
#include <exemplar/mesh/mesh_checks.h>
#include <exemplar/run/inputs/bridging_cells.h>

#include <deal.II/base/symmetric_tensor.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// A cell that is stretched more than this connects parts that the pose separates: limbs that bend, and the
    /// published animals, stretch cells up to eight times.
    constexpr double great_stretch = 10.;

    /// Poses that stretch more than one cell of this many are as long as that, or have another unit of length.
    constexpr std::size_t few = 20;

    dealii::Tensor<2, 3>
    edges_of_cell(const std::vector<dealii::Point<3>> &places,
                  const std::array<unsigned int, 4>   &cell)
    {
      dealii::Tensor<2, 3> edges;
      for (unsigned int v = 0; v < 3; ++v)
        for (unsigned int c = 0; c < 3; ++c)
          edges[c][v] = places[cell[v + 1]][c] - places[cell[0]][c];
      return edges;
    }

    /// The greatest stretch of a cell if it is more than great_stretch, else 1.
    double
    great_stretch_of(const dealii::Tensor<2, 3> &rest, const dealii::Tensor<2, 3> &pose)
    {
      const dealii::Tensor<2, 3> F = pose * dealii::invert(rest);
      if (!(F.norm_square() > great_stretch * great_stretch) || !std::isfinite(F.norm_square()))
        return 1.;
      const double stretch
          = std::sqrt(dealii::eigenvalues(dealii::symmetrize(dealii::transpose(F) * F))[0]);
      return stretch > great_stretch ? stretch : 1.;
    }
  } // namespace

  BridgingCells
  find_bridging_cells(const ExampleParameters &examples, const Mesh &mesh, const NamedPoses &poses)
  {
    BridgingCells bridging;
    if (mesh.is_shell() || !examples.in_use())
      return bridging;
    const auto         &cells = mesh.get_cells();
    std::vector<double> stretches(cells.size(), 1.);
    double              greatest = 1.;
    std::string         name; // of the pose with the greatest stretch
    for (const std::string &pose : examples.poses)
    {
      const std::vector<dealii::Point<3>> places = mesh.find_pose(poses, pose, "Examples/Poses");
      for (std::size_t cell = 0; cell < cells.size(); ++cell)
      {
        const double stretch = great_stretch_of(edges_of_cell(mesh.get_nodes(), cells[cell]),
                                                edges_of_cell(places, cells[cell]));
        stretches[cell]      = std::max(stretches[cell], stretch);
        if (stretch > greatest)
        {
          greatest = stretch;
          name     = pose;
        }
      }
    }
    std::vector<unsigned int> found;
    for (std::size_t cell = 0; cell < cells.size(); ++cell)
      if (stretches[cell] > 1.)
        found.push_back(static_cast<unsigned int>(cell));
    if (found.empty() || few * found.size() > cells.size())
      return bridging;
    for (const double stretch : stretches)
      bridging.factors.push_back(std::exp2(-2. * std::round(std::log2(stretch))));
    const auto elements = whole_elements(mesh, found);
    bridging.warning    = fmt::format("Examples/Poses stretch {} {} up to {} times, most in {} "
                                         "(element {}): they connect parts of the surface that "
                                         "the pose separates, as closed lips. Young's modulus is divided "
                                         "there by about the square of the stretch, so that "
                                         "they do not hold these together. Better make the mesh with the "
                                         "pose (exemplar mesh --poses), or of more cells.",
                                      found.size(), found.size() == 1 ? "cell" : "cells",
                                      short_text(greatest), name, list_numbers(elements));
    return bridging;
  }
} // namespace Exemplar
