// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_skin_springs_h
#define exemplar_skin_springs_h

#include <exemplar/surface/skin/surface_skin.h>

#include <deal.II/base/point.h>

#include <vector>

namespace Exemplar
{
  /// Springs between the vertices of a surface, where the body carries them, and places: each pulls at
  /// all nodes that its vertex goes with. Their energy is sum_v stiffness_v |r_v|^2 / 2 with
  /// r_v = offset_v + sum_i share_vi x_i, the way of vertex v from its place.
  class SkinSprings
  {
  public:
    using Points = std::vector<dealii::Point<3>>;

    /// None.
    SkinSprings() = default;

    /// One for each of `vertices`, without stiffness. `nodes` are those of the mesh at rest and `places`
    /// those of all vertices of the skin [m].
    SkinSprings(const SurfaceSkin              &skin,
                const std::vector<std::size_t> &vertices,
                const Points                   &nodes,
                const Points                   &places);

    /// [1/m^2]
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

    /// Add its derivative, by degree of freedom [1/m].
    void
    add_gradient(const Points &x, std::vector<double> &gradient) const;

    /// Add the second derivative times `vector`.
    void
    add_product(const Vector &vector, Vector &product) const;

    /// For each node a number, such that the matrix with them on its diagonal is not less than the second
    /// derivative.
    std::vector<double>
    diagonal_bound(std::size_t n_nodes) const;

    /// The nodes that a vertex goes with.
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
