// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_patch_dilatation_h
#define exemplar_patch_dilatation_h

#include <exemplar/body/example_poses.h>
#include <exemplar/body/patches.h>
#include <exemplar/potential/evaluation.h>
#include <exemplar/potential/patch_scatter.h>
#include <exemplar/potential/strain_damping.h>

#include <deal.II/base/aligned_vector.h>

#include <vector>

namespace Exemplar
{
  /// The volume part of Psi by patches, Eq. (25): sum lambda_p/2 V_p (theta_p - eta theta_p(E(w)))^2 with the
  /// mean theta_p of tr(e) over a patch. The cells' own energy is then that of a material without
  /// lambda, and the patch adds to their stress the pressure lambda_p (theta_p - eta theta_p(E(w))) I.
  class PatchDilatation
  {
  public:
    /// `examples` may be null. All must outlive it.
    PatchDilatation(const Patches          &patches,
                    const ExamplePoses     *examples,
                    const FESpace          &fe_space,
                    const SymmetricPattern &pattern,
                    const FreeDofs         &free_dofs);

    /// Where loops write tr(e) of the cells, and where they find the pressures of set_pressures().
    DilatationArrays
    arrays();

    /// The damping as it is now, with the strains that it remembers. A patch with a cell that is left out has
    /// none.
    void
    set_damping(const StrainDamping &damping);

    /// From the cells' tr(e) and these weights find the pressures and their scales.
    void
    set_pressures(const std::vector<double> &weights);

    /// After set_pressures(): add the energies, and the derivatives by the weights if there are any [J].
    void
    add_energies(const std::vector<double> &weights, ElasticEvaluation &result) const;

    /// After set_pressures(): sum V (|C:e| + eta |C:E(w)|)^2 of the volume part.
    double
    stress_square() const;

    /// Add its part of c_i with dPsi/dw = H w - c, from the cells' tr(e) [J].
    void
    add_linear_term(std::vector<double> &linear_term);

    /// In a cell, of set_pressures() [Pa]: with examples and damping, or lambda_p theta_p alone.
    double
    pressure(const unsigned int cell) const
    {
      return pressures[cell];
    }

    double
    elastic_pressure(const unsigned int cell) const
    {
      return patches.lambda(patches.of_cell(cell)) * means[patches.of_cell(cell)];
    }

    /// lambda_p theta_p^2 / 2 in a cell, after set_pressures() [J/m^3].
    double
    elastic_density(const unsigned int cell) const
    {
      return 0.5 * elastic_pressure(cell) * means[patches.of_cell(cell)];
    }

    /// Add its part of A with the rotations of `cells`: lambda_p V_p b b^T for b = dtheta_p/dx, times 1 + s.
    /// With `damp_all` no patch is left out of the damping.
    void
    add_tangent(const CellField &cells, bool damp_all, std::vector<double> &values) const;

    /// Add its part of the columns G, as ElasticPotential::assemble_tangent() has them.
    void
    add_coupling(const CellField &cells, std::vector<double> &columns) const;

    /// Add what a displacement changes, as ElasticPotential::add_response().
    void
    add_response(const CellField   &cells,
                 const Vector      &displacement,
                 ElasticEvaluation &result) const;

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    void
    find_means();

    /// lambda_p V_p.
    double
    stiffness(const unsigned int patch) const
    {
      return patches.lambda(patch) * patches.volume(patch);
    }

    /// eta theta_p(E(w)); 0 without examples.
    double
    target(unsigned int patch, const std::vector<double> &weights) const;

    /// s of a patch.
    double
    damping_factor(const unsigned int patch) const
    {
      return past_means.empty() ? 0. : damping_factors[patch];
    }

    const Patches                &patches;
    const ExamplePoses           *examples;
    const FreeDofs               &free_dofs;
    const PatchScatter            scatter;
    std::vector<double>           fractions;          ///< of each cell in the volume of its patch
    std::vector<double>           means;              ///< theta_p
    std::vector<double>           past_means;         ///< that damping remembers; empty without it
    std::vector<double>           damping_factors;    ///< s, or 0
    double                        whole_damping = 0.; ///< s where no patch is left out
    dealii::AlignedVector<double> traces, pressures, scales; ///< a cell, in batches
  };
} // namespace Exemplar

#endif
