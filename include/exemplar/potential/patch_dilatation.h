// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_patch_dilatation_h
#define exemplar_patch_dilatation_h

#include <exemplar/body/example_poses.h>
#include <exemplar/body/patches.h>
#include <exemplar/potential/patch_guard.h>
#include <exemplar/potential/patch_scatter.h>
#include <exemplar/potential/patch_volumes.h>
#include <exemplar/potential/potential_term.h>

#include <optional>
#include <vector>

namespace Exemplar
{
  /// Stiffness damping of the mean dilatations of patches, Eq. (22); empty without damping.
  struct PatchDamping
  {
    std::vector<double> past_means; ///< sum_m c_m theta_p(x_m)
    std::vector<double> factors;    ///< s, or 0 of patches that are left out

    double
    factor(const unsigned int patch) const
    {
      return factors.empty() ? 0. : factors[patch];
    }
  };

  /// The volume part of Psi by patches, Eq. (25): sum lambda_p/2 V_p (theta_p - eta
  /// theta_p(E(w)))^2 with the mean theta_p of tr(e) over a patch, and its guard. The points' own energy is then
  /// that of a material without lambda, and the patch adds to their stress the pressure lambda_p
  /// (theta_p - eta theta_p(E(w))) I. A neo-Hookean background has its share in the mean of J, see PatchVolumes,
  /// and theta_p^2 the factor eta alone, Eq. (37).
  class PatchDilatation : public PotentialTerm
  {
  public:
    /// `material` is that of the body, with lambda. All must outlive it.
    PatchDilatation(const Patches      &patches,
                    const ExamplePoses &examples,
                    const FESpace      &fe_space,
                    const Material     &material);

    std::string
    name() const override
    {
      return "patches";
    }

    NodePairs
    couplings() const override
    {
      return PatchScatter::couplings(patches, fe_space);
    }

    /// Where patches couple more nodes than cells do.
    bool
    couples_by_products() const override
    {
      return traits_of(fe_space.element()).locks;
    }

    void
    attach(const SymmetricPattern &pattern, const FreeDofs &free_dofs, CellField &cells) override;

    /// A patch with a point that is left out of the damping has none.
    void
    begin_step(const State &start) override;

    void
    leave_step() override
    {
      damping = {};
    }

    void
    add(const TermPoint &at, ElasticSums &sums) override;

    void
    add_weight_linear_term(const Vector &positions, std::vector<double> &c) override;

    void
    hear_cells(const Vector &positions) override;

    void
    tell_cells(const TermPoint &at) override;

    /// lambda_p V_p b b^T for b = dtheta_p/dx, times 1 + s, and what the guard adds. In a convex
    /// tangent no patch is left out of the damping.
    void
    add_tangent(const TermPoint     &at,
                Tangent              kind,
                std::vector<double> &values,
                std::vector<double> &columns) override;

    void
    add_tangent_in_parts(const TermPoint     &at,
                         Tangent              kind,
                         std::vector<double> &values,
                         std::vector<double> &columns,
                         OuterProducts       &products) override;

    void
    add_response(const TermPoint &at,
                 Tangent          kind,
                 const Vector    &displacement,
                 ElasticSums     &sums) override;

    /// lambda_p theta_p^2 / 2, or that of J_p - 1, and what the guard adds.
    void
    add_densities(std::vector<double> &of_points) const override;

    std::size_t
    memory_consumption() const override;

  private:
    /// b = dtheta_p/dx of Eq. (25) [1/m].
    void
    find_gradients(const Vector &positions, PatchVectors &b) const;

    PatchProducts
    find_products(const Vector &positions, Tangent kind) const;

    void
    add_columns(const PatchVectors &b, std::vector<double> &columns) const;

    /// Of a patch beside held nodes.
    void
    add_response_of(unsigned int         patch,
                    const PatchProducts &products,
                    const Vector        &displacement,
                    ElasticSums         &sums) const;

    /// Of theta_p^2 in the energy: 1, or eta beside a background that knows J.
    double
    share() const
    {
      return volumes ? examples.constants().importance : 1.;
    }

    /// Whether theta_p acts at all beside J_p.
    bool
    has_traces() const
    {
      return share() > 0. || cells->get_damping().factor() > 0.;
    }

    /// What the tangent has by J_p.
    PatchProducts
    find_products_of_volumes(const Tangent kind) const
    {
      return volumes->find_products(1. - share(), kind, *cells, *scatter);
    }

    /// What the energies have by J_p, and less by theta_p.
    void
    add_energies_of_volumes(ElasticSums &sums) const;

    /// lambda_p V_p (1 + s), the factor of b b^T in A.
    double
    tangent_factor(unsigned int patch, Tangent kind) const;

    /// eta theta_p(E(w)); 0 without examples.
    double
    target(unsigned int patch, const std::vector<double> &weights) const;

    const Patches              &patches;
    const ExamplePoses         &examples;
    const FESpace              &fe_space;
    CellField                  *cells     = nullptr; ///< since attach()
    const FreeDofs             *free_dofs = nullptr; ///< since attach()
    std::optional<PatchScatter> scatter;             ///< since attach()
    PatchGuard                  guard;
    std::optional<PatchVolumes> volumes; ///< of a law that knows J, since attach()
    std::vector<double>         means;   ///< theta_p
    PatchDamping                damping;
  };
} // namespace Exemplar

#endif
