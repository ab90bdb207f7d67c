// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/number_text.h>
#include <exemplar/body/pose_checks.h>
#include <exemplar/kernels/matrix3.h>
#include <exemplar/mesh/mesh_checks.h>
#include <exemplar/prm/assignments.h>
#include <exemplar/prm/expression.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// A ratio of sizes beyond this, either way, comes from other units, not from deformation.
    constexpr double max_size_ratio = 100.;

    /// Tolerance of |det F|, relative to size_ratio^3, for flat cells.
    constexpr double flat_tolerance = 1e-9;

    /// Tolerance of the Green strain for rigid motions.
    constexpr double rigid_tolerance = 1e-9;

    struct PoseMeasures
    {
      double                   size_ratio; ///< size of the pose over that of the rest pose
      double                   max_strain     = 0.;
      double                   max_abs_volume = 0.; ///< det F over size_ratio^3
      std::vector<std::size_t> inverted;            ///< element numbers
    };

    PoseMeasures
    measure(const Mesh &mesh, const FESpace &fe_space, const dealii::Vector<double> &positions)
    {
      PoseMeasures              pose;
      double                    square = 0., volume = 0.;
      std::vector<unsigned int> inverted;
      for (unsigned int point = 0; point < fe_space.n_points(); ++point)
      {
        const Matrix3<double> F = fe_space.deformation_gradient(point, positions);
        square += fe_space.volume(point) * contract(F, F) / 3.;
        volume += fe_space.volume(point);
        const double det        = determinant(F);
        pose.max_abs_volume     = std::max(pose.max_abs_volume, std::abs(det));
        const unsigned int cell = fe_space.cell_of(point);
        if (det <= 0. && (inverted.empty() || inverted.back() != cell))
          inverted.push_back(cell);
        const Matrix3<double> C = transpose_times(F, F);
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            pose.max_strain
                = std::max(pose.max_strain, std::abs(C[i][j] - (i == j ? 1. : 0.)) / 2.);
      }
      const Exchange &exchange = fe_space.exchange();
      pose.max_abs_volume      = exchange.max(pose.max_abs_volume);
      pose.max_strain          = exchange.max(pose.max_strain);
      pose.inverted            = whole_elements(mesh, inverted);
      pose.size_ratio          = std::sqrt(exchange.sum(square) / exchange.sum(volume));
      pose.max_abs_volume /= std::pow(std::max(pose.size_ratio, 1e-100), 3);
      return pose;
    }

    /// If at least one in this many cells is inverted, the order of the nodes is wrong.
    constexpr std::size_t inverted_share = 4;

    /// Whether `positions` may be displacements: as positions they invert cells and are small, but
    /// added to the rest positions they make a valid pose.
    bool
    may_be_displacements(const PoseMeasures           &pose,
                         const Mesh                   &mesh,
                         const FESpace                &fe_space,
                         const dealii::Vector<double> &positions)
    {
      constexpr double large = 0.75; // a body made flat has .8
      if (inverted_share * pose.inverted.size() < mesh.whole().n_cells || pose.size_ratio > large)
        return false;
      dealii::Vector<double> sum = positions;
      sum += fe_space.rest_positions();
      return measure(mesh, fe_space, sum).inverted.empty();
    }

    std::string
    describe_size(const double size_ratio)
    {
      if (size_ratio * max_size_ratio < 1.)
        return "has collapsed: it has " + short_text(size_ratio)
               + " of the rest pose's size. If its unit of length is another one, scale it.";
      if (size_ratio > max_size_ratio)
        return "is " + short_text(size_ratio)
               + " times as large as the rest pose. If its unit of length is another one, scale "
                 "it.";
      return "";
    }

    const std::string no_strain = "is the rest pose, moved rigidly at most: it has no strain, and "
                                  "pulls the body nowhere.";

    /// A shell may be flat, folded or turned inside out.
    std::string
    describe_pose_of_shell(const FESpace                &fe_space,
                           const dealii::Vector<double> &positions,
                           const bool                    may_be_rest)
    {
      const ShellMesh &shell = fe_space.shell();
      double           area = 0., area_at_rest = 0.;
      for (const ShellTriangle &triangle : shell.triangles())
      {
        const Vector3<double> a = place_in(positions, triangle.nodes[0]);
        area += 0.5
                * norm(cross(difference(place_in(positions, triangle.nodes[1]), a),
                             difference(place_in(positions, triangle.nodes[2]), a)));
        area_at_rest += triangle.area;
      }
      const std::string size = describe_size(std::sqrt(area / area_at_rest));
      if (!size.empty() || may_be_rest)
        return size;
      for (const ShellStrain &of_triangle : fe_space.shell_strains(positions))
        for (const double number : of_triangle)
          if (!(std::abs(number) < rigid_tolerance))
            return "";
      return no_strain;
    }

    std::string
    describe_inverted(const PoseMeasures &pose, const unsigned int n_cells)
    {
      if (pose.max_abs_volume < flat_tolerance)
        return "is flat: none of its cells has a volume, and their strain is ambiguous. Give "
               "another pose.";
      if (pose.inverted.size() == n_cells)
        return "is a mirror image: all of its cells are inside out, and their strain is ambiguous. "
               "Mirror it back: negate one coordinate.";
      return fmt::format(
          "has {} inverted cells: element {}; their strain is ambiguous.{}", pose.inverted.size(),
          list_numbers(pose.inverted),
          inverted_share * pose.inverted.size() < n_cells
              ? ""
              : " So many are inverted where the nodes are in another order than the mesh's. Take "
                "a pose that was made on this mesh, such as a final.msh.");
    }
  } // namespace

  std::string
  describe_displacements(const std::string            &functions,
                         const Mesh                   &mesh,
                         const FESpace                &fe_space,
                         const dealii::Vector<double> &positions)
  {
    std::string  places, coordinates = "xyz";
    unsigned int n_lacking = 0;
    for (const std::string &formula : split_formulas(functions, 3))
    {
      const std::string coordinate     = coordinates.substr(0, 1);
      const bool        needs_brackets = formula.find_first_of("?<>=&|") != std::string::npos;
      n_lacking += formula.find(coordinate) == std::string::npos ? 1 : 0;
      places += (places.empty() ? "" : "; ") + coordinate;
      if (needs_brackets)
        places += " + (" + formula + ")";
      else if (parse_number(formula) != 0.)
        places += formula[0] == '-' ? " - " + trim(formula.substr(1)) : " + " + formula;
      coordinates.erase(0, 1);
    }
    if (fe_space.is_shell() || n_lacking < 2
        || measure(mesh, fe_space, positions).max_abs_volume >= flat_tolerance)
      return "";
    return " = '" + functions
           + "' makes the body flat. It gives positions, not displacements: did you mean '" + places
           + "'?";
  }

  std::string
  describe_pose(const Mesh                   &mesh,
                const FESpace                &fe_space,
                const dealii::Vector<double> &positions,
                const bool                    may_be_rest)
  {
    if (fe_space.is_shell())
      return describe_pose_of_shell(fe_space, positions, may_be_rest);
    const PoseMeasures pose = measure(mesh, fe_space, positions);
    if (may_be_displacements(pose, mesh, fe_space, positions))
      return "makes flat or inverted cells, but is a pose when it is added to the rest pose: is it "
             "displacements? A pose is positions: rest + displacements.";
    if (const std::string size = describe_size(pose.size_ratio); !size.empty())
      return size;
    if (!pose.inverted.empty())
      return describe_inverted(pose, mesh.whole().n_cells);
    if (!may_be_rest && pose.max_strain < rigid_tolerance)
      return no_strain;
    return "";
  }
} // namespace Exemplar
