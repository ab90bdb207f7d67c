// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/potential/patch_dilatation.h>
#include <exemplar/potential/stretch_stiffness.h>

// What displacements of held degrees of freedom change by the tangent of patches.

namespace Exemplar
{
  namespace
  {
    /// R^T dP of what couples the nodes of one cell, for a change dF of F.
    Matrix3<double>
    response_of_point(CellField             &cells,
                      const unsigned int     point,
                      const Tangent          kind,
                      const Matrix3<double> &F,
                      const Matrix3<double> &dF)
    {
      const Matrix3<double> R = cells.rotation(point);
      const Matrix3<double> M = transpose_times(R, dF);
      Matrix3<double>       dP
          = patch_cell(cells, point, F)
                .response(M, cells.get_dilatation().pressure(point), kind == Tangent::convex);
      if (kind == Tangent::convex && traits_of(cells.get_batches().law(point)).has_stretch_guard
          && is_strongly_stretched(cells, point, F))
      {
        const StretchModes modes = stretch_modes(cells, point, R, F);
        for (std::size_t m = 0; m < modes.stiffness.size(); ++m)
          dP = combine(1., dP, modes.stiffness[m] * contract(modes.direction[m], M),
                       modes.direction[m]);
      }
      return dP;
    }

    /// Add it for all points of a patch.
    void
    add_response_of_points(const std::vector<unsigned int> &points,
                           const FESpace                   &fe_space,
                           const Tangent                    kind,
                           const TermPoint                 &at,
                           const Vector                    &displacement,
                           CellField                       &cells,
                           Vector                          &gradient)
    {
      std::vector<double> forces;
      for (const unsigned int point : points)
      {
        if (!has_special_patch(cells, point))
          continue;
        const Matrix3<double> dP = response_of_point(
            cells, point, kind, fe_space.deformation_gradient(point, at.positions),
            fe_space.deformation_gradient(point, displacement));
        fe_space.nodal_forces(point, cells.rotation(point) * dP, forces);
        const auto nodes = fe_space.nodes(fe_space.cell_of(point));
        for (std::size_t i = 0; i < forces.size(); ++i)
          gradient[3 * nodes[i / 3] + i % 3] += forces[i];
      }
    }
  } // namespace

  void
  PatchDilatation::add_response(const TermPoint &at,
                                const Tangent    kind,
                                const Vector    &displacement,
                                ElasticSums     &sums)
  {
    const PatchProducts products = find_products(at.positions, kind);
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
      if (scatter->is_beside_held(patch))
      {
        add_response_of(patch, products, displacement, sums);
        add_response_of_points(patches.points(patch), fe_space, kind, at, displacement, *cells,
                               sums->gradient);
      }
    if (!volumes)
      return;
    const PatchProducts of_volumes = find_products_of_volumes(kind);
    for (unsigned int patch = 0; patch < patches.size(); ++patch)
      if (scatter->is_beside_held(patch))
        scatter->add(patch,
                     of_volumes.factors[patch]
                         * scatter->product(patch, of_volumes.vectors, displacement),
                     of_volumes.vectors, sums->gradient);
  }

  void
  PatchDilatation::add_response_of(const unsigned int   patch,
                                   const PatchProducts &products,
                                   const Vector        &displacement,
                                   ElasticSums         &sums) const
  {
    const double change = scatter->product(patch, products.vectors, displacement);
    scatter->add(patch, products.factors[patch] * change, products.vectors, sums->gradient);
    for (unsigned int weight = 0; weight < sums->weight_gradient.size(); ++weight)
      sums->weight_gradient[weight] -= patches.stiffness(patch) * change
                                       * examples.get_gram().patch_dilatation(patch, weight);
    if (products.squares.empty())
      return;
    const double of_square = scatter->product(patch, products.squares, displacement);
    const double of_sum    = scatter->product(patch, products.sums, displacement);
    const double a = products.of_squares[patch], b = products.of_products[patch];
    scatter->add(patch, a * of_square + b * of_sum, products.squares, sums->gradient);
    scatter->add(patch, b * of_square, products.sums, sums->gradient);
  }
} // namespace Exemplar
