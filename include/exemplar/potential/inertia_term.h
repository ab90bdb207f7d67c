// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_inertia_term_h
#define exemplar_inertia_term_h

#include <exemplar/body/mass.h>
#include <exemplar/body/time_integrator.h>
#include <exemplar/potential/potential_term.h>

namespace Exemplar
{
  /// gamma (gamma + a_M) / 2 |x - x_hat|^2_M, Eq. (22): inertia and mass damping. Outside of steps it
  /// is zero.
  class InertiaTerm : public PotentialTerm
  {
  public:
    /// Both must outlive the term; the integrator's step is begun before the term's. `is_reported`:
    /// the energy has a column, energy_inertia.
    InertiaTerm(const Mass &mass, const TimeIntegrator &integrator, bool is_reported = false);

    std::string
    name() const override
    {
      return "inertia";
    }

    void
    begin_step(const State &start, double step_size) override;

    void
    leave_step() override
    {
      in_step = false;
    }

    void
    add(const TermPoint &at, ElasticSums &sums) override;

    void
    attach(const SymmetricPattern &pattern, const FreeDofs &free_dofs) override;

    void
    follow_parameters() override;

    void
    add_tangent(const TermPoint     &at,
                Tangent              kind,
                std::vector<double> &values,
                std::vector<double> &columns) override;

    double
    rounding_force(const Vector &positions) const override;

    void
    append_columns(double                                       energy,
                   std::vector<std::pair<std::string, double>> &columns) const override
    {
      if (is_reported)
        columns.emplace_back("energy_inertia", energy);
    }

    std::optional<EnergyFlow>
    energy_flow(const State & /*start*/, const State & /*end*/) const override
    {
      return EnergyFlow{ false, 0., 0., 0. };
    }

    NoGradients
    no_gradients() const override
    {
      return {};
    }

    std::size_t
    memory_consumption() const override;

  private:
    const Mass             &mass;
    const TimeIntegrator   &integrator;
    const bool              is_reported;
    const SymmetricPattern *pattern   = nullptr; ///< since attach()
    const FreeDofs         *free_dofs = nullptr; ///< since attach()
    std::vector<double>     mass_values;         ///< M on the pattern [kg]
    bool                    in_step        = false;
    double                  predicted_size = 0.; ///< greatest coordinate of the prediction [m]
    Mass::Padded            difference, product; ///< memory of add(): x - x_hat, and M times it
  };
} // namespace Exemplar

#endif
