// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_patch_dilatation_h
#define exemplar_patch_dilatation_h

#include <exemplar/body/example_poses.h>
#include <exemplar/body/patches.h>
#include <exemplar/potential/patch_guard.h>
#include <exemplar/potential/patch_scatter.h>
#include <exemplar/potential/patch_volumes.h>
#include <exemplar/potential/potential_term.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace Exemplar
{
  /// Stiffness damping of the mean dilatations of patches, Eq. (22).
  struct PatchDamping
  {
    explicit PatchDamping(const std::size_t n_patches)
        : past_means(n_patches, 0.), factors(n_patches, 0.)
    {
    }

    void
    clear()
    {
      std::fill(past_means.begin(), past_means.end(), 0.);
      std::fill(factors.begin(), factors.end(), 0.);
    }

    std::vector<double> past_means; ///< sum_m c_m theta_p(x_m)
    std::vector<double> factors;    ///< s, or 0 of patches that are left out
  };

  /// What a patch tells its points.
  struct PressureOnPoints
  {
    double pressure; ///< [Pa]
    double scale;    ///< of the summands that it is the difference of [Pa]
  };

  /// The volume part of Psi by patches, Eq. (25): sum lambda_p/2 V_p (theta_p - eta
  /// theta_p(E(w)))^2 with the mean theta_p of tr(e) over a patch, and its guard. The points' own energy is then
  /// that of a material without lambda, and the patch adds to their stress the pressure lambda_p
  /// (theta_p - eta theta_p(E(w))) I. A neo-Hookean background has its share in the mean of J, see PatchVolumes,
  /// and theta_p^2 the factor eta alone, Eq. (37).
  class PatchDilatation
  {
  public:
    /// `material` is that of the body, with lambda. All must outlive it.
    PatchDilatation(const Patches      &patches,
                    const ExamplePoses &examples,
                    const FESpace      &fe_space,
                    const Material     &material);

    /// Whether patches couple more nodes than cells do, so that a pattern may be without their couplings and get their
    /// tangent as outer products.
    static bool
    couples_by_products(const FESpace &fe_space)
    {
      return traits_of(fe_space.element()).locks;
    }

    /// The pattern on which add_tangent() writes, the free degrees of freedom and the cells; all must outlive the
    /// patches. To be called again when the pattern or what is held has changed.
    void
    attach(const SymmetricPattern &pattern, const FreeDofs &free_dofs, CellField &cells);

    /// A step begins, with the cells' damping as CellField has it. A patch with a point that is left out of the
    /// damping has none.
    void
    begin_step();

    /// From now on states are evaluated without a step that leads to them.
    void
    leave_step()
    {
      damping.clear();
    }

    /// Find the means of the dilatations that the cells have found at these positions, CellField::get_dilatation().
    /// Called before all that follows.
    void
    read_dilatations(const Vector &positions);

    /// Before the cells are evaluated or make their tangent at this point: write the pressures that act in them to
    /// CellField::get_dilatation(). Called before the four functions that follow, at the same point.
    void
    write_pressures(const TermPoint &at);

    /// Add the energies of patches and their derivatives by the weights. Forces are those of the pressures.
    void
    add(const TermPoint &at, ElasticSums &sums);

    /// lambda_p V_p b b^T for b = dtheta_p/dx, times 1 + s, and what the guard adds: to `products`, by node, if the
    /// pattern is without these couplings, else to the values. In a convex tangent no patch is left out of the damping.
    /// The columns, if there are any, are those of PotentialTerm::add_tangent().
    void
    add_tangent(const TermPoint     &at,
                Tangent              kind,
                std::vector<double> &values,
                std::vector<double> &columns,
                OuterProducts       *products);

    /// As PotentialTerm::add_response().
    void
    add_response(const TermPoint &at, Tangent kind, const Vector &displacement, ElasticSums &sums);

    /// Add lambda_p theta_p^2 / 2, or that of J_p - 1, and what the guard adds [J/m^3].
    void
    add_densities(std::vector<double> &of_points) const;

    /// Add the patches' part of c_i with dPsi/dw = H w - c [J]; H is the weights' quadratic form.
    void
    add_weight_linear_term(std::vector<double> &c) const;

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    /// b = dtheta_p/dx of Eq. (25) [1/m].
    void
    find_gradients(const Vector &positions, PatchVectors &b) const;

    PatchProducts
    find_products(const Vector &positions, Tangent kind) const;

    void
    add_columns(const PatchVectors &b, std::vector<double> &columns) const;

    /// Add what the tangent of one patch, beside held nodes, changes by `displacement`.
    void
    add_response_of(unsigned int         patch,
                    const PatchProducts &products,
                    const Vector        &displacement,
                    ElasticSums         &sums) const;

    /// The factor of theta_p^2 in the energy: 1, or eta beside a background that knows J.
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

    const Patches                &patches;
    const ExamplePoses           &examples;
    const FESpace                &fe_space;
    CellField                    *cells     = nullptr; ///< since attach()
    const FreeDofs               *free_dofs = nullptr; ///< since attach()
    std::optional<PatchScatter>   scatter;             ///< since attach()
    PatchGuard                    guard;
    std::optional<PatchVolumes>   volumes;      ///< of a law that knows J, since attach()
    std::vector<double>           means;        ///< theta_p
    std::vector<double>           mean_squares; ///< |F|^2 of long cells, or 0
    std::vector<PressureOnPoints> pressures;    ///< memory of write_pressures()
    PatchDamping                  damping;
  };
} // namespace Exemplar

#endif
