// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/body/example_poses.h>
#include <exemplar/body/example_sums.h>
#include <exemplar/mesh/mesh_checks.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

// What keys ask for together.

namespace Exemplar
{
  namespace
  {
    struct Direction3
    {
      double          eigenvalue; ///< the least one of a symmetric matrix
      Vector3<double> vector;     ///< of length 1
    };

    Direction3
    shortest_direction(const Matrix3<double> &E)
    {
      const Eigensystem<double> all = symmetric_eigensystem(E);
      const auto e = std::min_element(&all.values[0], &all.values[0] + 3) - &all.values[0];
      return { all.values[e], { { all.vectors[0][e], all.vectors[1][e], all.vectors[2][e] } } };
    }

    double
    stretch_along(const Vector3<double> &v, const Matrix3<double> &E)
    {
      double sum = 0.;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          sum += v[i] * E[i][j] * v[j];
      return sum;
    }

    /// The sum of those that shorten a direction.
    Matrix3<double>
    sum_along(const Vector3<double> &v, const std::vector<Matrix3<double>> &strains)
    {
      Matrix3<double> sum{};
      for (const Matrix3<double> &E : strains)
        if (stretch_along(v, E) < 0.)
          sum = combine(1., sum, 1., E);
      return sum;
    }
  } // namespace

  AddedStrain
  least_sum_of_strains(const std::vector<Matrix3<double>> &strains)
  {
    constexpr unsigned int max_turns = 20;
    constexpr double       hardly    = -0.01;
    Direction3             least{ 0., {} };
    for (const Matrix3<double> &E : strains)
    {
      Direction3 now = shortest_direction(E);
      for (unsigned int turn = 0; turn < max_turns; ++turn)
      {
        const Direction3 next = shortest_direction(sum_along(now.vector, strains));
        if (!(next.eigenvalue < now.eigenvalue))
          break;
        now = next;
      }
      if (now.eigenvalue < least.eigenvalue)
        least = now;
    }
    AddedStrain found{ least.eigenvalue, {} };
    for (unsigned int i = 0; i < strains.size(); ++i)
      if (stretch_along(least.vector, strains[i]) < hardly)
        found.parts.push_back(i);
    return found;
  }

  namespace
  {
    /// A cell in which keys together ask for no thickness.
    struct ThinCell
    {
      unsigned int cell;
      double       thickness; ///< what they ask for; with Green's strain its square with its sign
      AddedStrain  sum;
    };

    double
    thickness(const CellLaw law, const double strain)
    {
      return law == CellLaw::green ? 1. + 2. * strain : 1. + strain;
    }

    /// Add what is found at a point, if it is less than what others of its cell ask for.
    void
    add_thin(ThinCell found, std::vector<ThinCell> &all)
    {
      if (found.thickness > 0.)
        return;
      if (all.empty() || all.back().cell != found.cell)
        all.push_back(std::move(found));
      else if (found.thickness < all.back().thickness)
        all.back() = std::move(found);
    }

    std::vector<unsigned int>
    cells_thinner_than(const double most, const std::vector<ThinCell> &all)
    {
      std::vector<unsigned int> cells;
      for (const ThinCell &one : all)
        if (one.thickness <= most)
          cells.push_back(one.cell);
      return cells;
    }
  } // namespace

  void
  ExamplePoses::review_sums(const Mesh &mesh, const Material &material)
  {
    std::vector<ThinCell>        thin;
    std::vector<Matrix3<double>> asked(size());
    double                       least = 0.;
    for (unsigned int point = 0; point < fe_space.n_points(); ++point)
    {
      const CellLaw law   = laws[fe_space.cell_of(point)];
      double        norms = 0.;
      for (unsigned int i = 0; i < size(); ++i)
      {
        asked[i] = strain_of_pose(point, i, material).acting;
        norms += std::sqrt(contract(asked[i], asked[i]));
      }
      if (thickness(law, -norms) > 0.)
        continue; // whichever keys act
      AddedStrain sum = least_sum_of_strains(asked);
      if (sum.parts.size() < 2)
        continue; // inverted by one key alone, of which its pose is warned
      least = std::min(least, thickness(law, sum.least));
      add_thin({ fe_space.cell_of(point), thickness(law, sum.least), std::move(sum) }, thin);
    }
    const Exchange &exchange = fe_space.exchange();
    const auto      elements = whole_elements(mesh, cells_thinner_than(0., thin));
    if (elements.empty())
      return;
    // rounding must not choose between cells that are alike
    const double      rounding = 1e-9;
    const std::size_t worst
        = whole_elements(mesh, cells_thinner_than(min_of_all(exchange, least) + rounding, thin))
              .front();
    std::string keys;
    for (const ThinCell &one : thin)
      if (mesh.element_number(one.cell) == worst)
      {
        for (const unsigned int i : one.sum.parts)
          keys += fmt::format("{}{} ({})", keys.empty() ? "" : ", ", number(i), name(i));
        keys = fmt::format("keys {} want a strain of {:.3g}", keys, one.sum.least);
      }
    warnings.push_back(fmt::format(
        "Examples/Weights = additive: strains of keys add, and where keys act on one place they "
        "may want a stretch of 0 or less, with which a cell is flat or inside out. They do in {} "
        "{}, element {}; most in element {}, where {}. Let these keys ask for less there, or share "
        "1 among them by Examples/Weights = simplex.",
        elements.size(), elements.size() == 1 ? "cell" : "cells", list_numbers(elements), worst,
        exchange.first_text(keys)));
  }
} // namespace Exemplar
