// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_skin_springs_h
#define exemplar_skin_springs_h

#include <exemplar/surface/skin/surface_skin.h>

#include <deal.II/base/point.h>

#include <vector>

namespace Exemplar
{
  /// Springs from the vertices of a surface, as the body carries them, to fixed places: each acts
  /// on all nodes that its vertex depends on. Their energy is sum_v stiffness_v |r_v|^2 / 2 with
  /// the residual r_v = offset_v + sum_i share_vi x_i of vertex v from its place.
  class SkinSprings
  {
  public:
    using Points = std::vector<dealii::Point<3>>;

    /// No springs.
    SkinSprings() = default;

    /// A spring for each of `vertices`, of stiffness 0. `nodes` are those of the mesh at rest and
    /// `places` those of all vertices of the skin [m].
    SkinSprings(const SurfaceSkin              &skin,
                const std::vector<std::size_t> &vertices,
                const Points                   &nodes,
                const Points                   &places);

    /// Stiffness of each spring [1/m^2].
    std::vector<double> stiffness;

    bool
    empty() const
    {
      return stiffness.empty();
    }

    /// The mean and the greatest |r_v| [m], where the nodes are at `x`.
    struct Ways
    {
      double mean = 0., greatest = 0.;
    };

    Ways
    ways(const Points &x) const;

    double
    energy(const Points &x) const;

    /// Add the derivative of the energy, by degree of freedom [1/m].
    void
    add_gradient(const Points &x, std::vector<double> &gradient) const;

    /// Add the Hessian of the energy times `vector`.
    void
    add_product(const Vector &vector, Vector &product) const;

    /// An upper bound of the Hessian by a diagonal matrix, one number for each node.
    std::vector<double>
    diagonal_bound(std::size_t n_nodes) const;

    /// The nodes that a vertex depends on, with their shares.
    const std::vector<NodalSum::Share> &
    shares_of(const std::size_t v) const
    {
      return shares[v];
    }

  private:
    dealii::Tensor<1, 3>
    way(std::size_t v, const Points &x) const;

    std::vector<std::vector<NodalSum::Share>> shares;
    std::vector<dealii::Tensor<1, 3>>         offset; ///< [m]
  };
} // namespace Exemplar

#endif
