// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_patch_dilatation_h
#define exemplar_patch_dilatation_h

#include <exemplar/body/example_poses.h>
#include <exemplar/body/patches.h>
#include <exemplar/kernels/corotational_cell.h>
#include <exemplar/potential/evaluation.h>
#include <exemplar/potential/patch_guard.h>
#include <exemplar/potential/patch_scatter.h>
#include <exemplar/potential/strain_damping.h>

#include <deal.II/base/aligned_vector.h>

#include <vector>

namespace Exemplar
{
  /// The volume part of Psi by patches, Eq. (25): sum lambda_p/2 V_p (theta_p - eta
  /// theta_p(E(w)))^2 with the mean theta_p of tr(e) over a patch. The points' own energy is then
  /// that of a material without lambda, and the patch adds to their stress the pressure lambda_p
  /// (theta_p - eta theta_p(E(w))) I.
  class PatchDilatation
  {
  public:
    /// `examples` may be null; `pattern` has PatchScatter::couplings(). All must outlive it.
    PatchDilatation(const Patches          &patches,
                    const ExamplePoses     *examples,
                    const FESpace          &fe_space,
                    const Material         &material,
                    const SymmetricPattern &pattern,
                    const FreeDofs         &free_dofs);

    /// Where loops write tr(e) of the points, and where they find the pressures of update().
    DilatationArrays
    arrays();

    /// The damping as it is now, with the strains that it remembers. A patch with a point that is
    /// left out has none.
    void
    set_damping(const StrainDamping &damping);

    /// From tr(e) of the points at these positions, and from these weights, find the pressures.
    void
    update(const CellField &cells, const Vector &positions, const std::vector<double> &weights);

    /// After update(): add energies and, if there are any, the derivatives by the weights [J].
    void
    add_energies(const std::vector<double> &weights, ElasticEvaluation &result) const;

    /// After update(): the guard of strongly stretched cells.
    const PatchGuard &
    stretch_guard() const
    {
      return guard;
    }

    /// After update(): add the forces that loops do not add, by degree of freedom [N].
    void
    add_forces_of_few_cells(const CellField &cells, Vector &gradient) const
    {
      guard.add_forces(cells, gradient);
      thin.add_forces(cells, pressures.data(), gradient);
    }

    /// After update(): sum V (|C:e| + eta |C:E(w)|)^2 of the volume part.
    double
    stress_square() const;

    /// Add its part of c_i with dPsi/dw = H w - c, from tr(e) of the points at these positions [J].
    void
    add_linear_term(const CellField     &cells,
                    const Vector        &positions,
                    std::vector<double> &linear_term);

    /// After update(), in a point [Pa]: with examples and damping.
    double
    pressure(const unsigned int point) const
    {
      return pressures[point];
    }

    /// lambda_p theta_p of the patch of a point [Pa].
    double
    elastic_pressure(const unsigned int point) const
    {
      return patches.lambda(patches.of_point(point)) * means[patches.of_point(point)];
    }

    /// After update(): lambda_p theta_p^2 / 2 and what the guard adds at a point [J/m^3].
    double
    elastic_density(const unsigned int point) const
    {
      return 0.5 * elastic_pressure(point) * means[patches.of_point(point)] + guard.density(point);
    }

    /// After update(): add its part of A with the rotations of `cells`, lambda_p V_p b b^T for
    /// b = dtheta_p/dx, times 1 + s. In a convex tangent no patch is left out of the damping.
    void
    add_tangent(const CellField &cells, Tangent tangent, std::vector<double> &values) const;

    /// Add its part of the columns G, as ElasticPotential::assemble_tangent() has them.
    void
    add_coupling(const CellField &cells, std::vector<double> &columns) const;

    /// After update(): add what a displacement changes, as ElasticPotential::add_response().
    void
    add_response(const CellField   &cells,
                 Tangent            tangent,
                 const Vector      &displacement,
                 ElasticEvaluation &result) const;

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    void
    find_means(const CellField &cells, const Vector &positions);

    /// b = dtheta_p/dx of Eq. (25), three numbers for each node of a patch [1/m].
    void
    find_gradient(unsigned int patch, const CellField &cells, std::vector<double> &b) const;

    /// Whether a patch has a tangent beside that of Eq. (25), with thin or strongly stretched cells.
    bool
    is_special(unsigned int patch) const;

    /// Add it to `matrix` over the nodes of the patch.
    void
    add_special_tangent(unsigned int                patch,
                        const CellField            &cells,
                        Tangent                     tangent,
                        const std::vector<double>  &b,
                        dealii::FullMatrix<double> &matrix) const;

    void
    find_pressures(const std::vector<double> &weights);

    /// lambda_p V_p (1 + s), the factor of b b^T in A.
    double
    tangent_factor(unsigned int patch, Tangent tangent) const;

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

    const Patches      &patches;
    const ExamplePoses *examples;
    const FESpace      &fe_space;
    const FreeDofs     &free_dofs;
    const PatchScatter  scatter;
    ThinCells           thin;
    PatchGuard          guard;
    std::vector<double> fractions;          ///< of each point in the volume of its patch
    std::vector<double> means;              ///< theta_p
    std::vector<double> mean_squares;       ///< m_p of Eq. (26)
    std::vector<double> past_means;         ///< that damping remembers; empty without it
    std::vector<double> damping_factors;    ///< s, or 0
    double              whole_damping = 0.; ///< s where no patch is left out

    /// Of points, in batches.
    dealii::AlignedVector<double> traces, squares, pressures, scales;
  };
} // namespace Exemplar

#endif
