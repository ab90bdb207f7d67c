// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_patch_guard_h
#define exemplar_patch_guard_h

#include <exemplar/body/patches.h>
#include <exemplar/kernels/stretch_guard.h>
#include <exemplar/potential/cell_field.h>

#include <map>
#include <vector>

namespace Exemplar
{
  /// The guard G of strongly stretched cells, Eq. (24), where patches know the dilatation: q
  /// follows the slope lambda_p theta_p - 2 mu across the kink, which is the patch's. So G depends
  /// on theta_p, too. Hardly any step needs it; then there is nothing in it.
  class PatchGuard
  {
  public:
    /// `material` and all else must outlive it.
    PatchGuard(const Patches &patches, const FESpace &fe_space, const Material &material);

    /// Anew for these positions, their rotations and mean dilatations.
    void
    find(const CellField &cells, const Vector &positions, const std::vector<double> &means);

    /// The slope across the kink at a point for a pressure of its patch, without examples [Pa].
    KinkSlope<double>
    kink(unsigned int point, double elastic_pressure) const;

    bool
    acts() const
    {
      return !guards.empty();
    }

    /// G at a point [J/m^3].
    double
    density(unsigned int point) const;

    /// sum V G over the points [J].
    double
    energy() const;

    /// First and second derivative of sum V G by theta_p [J].
    double
    by_mean(unsigned int patch) const;

    double
    second_by_mean(unsigned int patch) const;

    /// Add the forces of G with theta_p held fixed, by degree of freedom [N].
    void
    add_forces(const CellField &cells, Vector &gradient) const;

    /// Add the derivative by theta_p of these forces in a patch, for the three components of each
    /// of its nodes, which ascend.
    void
    add_forces_by_mean(const CellField                 &cells,
                       unsigned int                     patch,
                       const std::vector<unsigned int> &nodes,
                       std::vector<double>             &forces) const;

  private:
    struct Sums
    {
      double by_mean = 0., second_by_mean = 0.;
    };

    void
    find_at(const CellField &cells,
            const Vector    &positions,
            unsigned int     patch,
            unsigned int     point,
            double           elastic_pressure);

    /// Call function(node, force) for the nodal forces of R^T P at a point.
    template <typename Function>
    void
    for_each_force(const CellField       &cells,
                   unsigned int           point,
                   const Matrix3<double> &P,
                   const Function        &function) const;

    const Patches                               &patches;
    const FESpace                               &fe_space;
    const Material                              &material;
    std::vector<double>                          least_pressures; ///< of a patch that needs it
    std::map<unsigned int, StretchGuard<double>> guards;          ///< by point, where they act
    std::map<unsigned int, Sums>                 sums;            ///< by patch
  };
} // namespace Exemplar

#endif
