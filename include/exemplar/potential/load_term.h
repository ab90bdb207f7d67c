// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_load_term_h
#define exemplar_load_term_h

#include <exemplar/body/loads.h>
#include <exemplar/potential/potential_term.h>

namespace Exemplar
{
  /// -f.(x - X): gravity and dead forces, as a potential of the displacements from the rest
  /// positions X. From positions the work would come with rounding of its own.
  class LoadTerm : public PotentialTerm
  {
  public:
    /// Both must outlive the term.
    LoadTerm(const Loads &loads, const FESpace &fe_space) : loads(loads), fe_space(fe_space) {}

    std::string
    name() const override
    {
      return "loads";
    }

    void
    set_time(double time) override;

    bool
    differs(double time, double other_time) const override;

    void
    add(const TermPoint &at, ElasticSums &sums) override;

    std::optional<EnergyFlow>
    energy_flow(const State &start, const State &end) const override;

    NoGradients
    no_gradients() const override
    {
      return {};
    }

    std::size_t
    memory_consumption() const override;

  private:
    /// Set the forces to those of a time [s] at the nodes that this process owns [N].
    void
    find_forces(double time, Vector &forces) const;

    const Loads   &loads;
    const FESpace &fe_space;
    Vector         force;          ///< f of the time that is set, at the nodes of this process [N]
    Vector         force_norms;    ///< of each node [N]
    Vector         displacement;   ///< memory of add()
    mutable Vector force_at_start; ///< memory of energy_flow()
  };
} // namespace Exemplar

#endif
