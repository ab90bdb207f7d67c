// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_energy_audit_h
#define exemplar_energy_audit_h

#include <exemplar/algebra/vector.h>
#include <exemplar/body/mass.h>
#include <exemplar/run/problem/energy_balance.h>

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  class Problem;

  /// Compares the change of the energy in each step with the work that was done on the body, doc/output.md (Energy audit). No result of a step depends
  /// on it.
  class EnergyAudit
  {
  public:
    /// Whether the steps of the problem's scene have an energy to audit: statics and implicit Euler, with forces that
    /// are the gradient of the energy.
    static bool
    is_possible(const Problem &problem);

    /// The problem must outlive this.
    explicit EnergyAudit(const Problem &problem);

    /// Begin again at the end of the next step, as `what` has been changed from outside.
    void
    restart(const std::string &what);

    /// Audit the step between these states, of which the evaluation of the problem is, before the terms end it.
    /// Returns why it cannot be accepted; empty if it can. All processes must call this.
    std::string
    add_step(const State &start, const State &end);

    /// The problem's state is another one, and so is its evaluation: count from there.
    void
    begin();

    /// Warnings of energy that was gained.
    std::vector<std::string>
    warnings() const;

    /// Count an increment, by its number, that was made in parts because its work was not known well enough.
    void
    count_parts(unsigned int step);

    /// Lines on the increments that were made in parts, and on how often and why the audit has begun again.
    std::string
    notes() const;

    /// What a resumed run needs.
    void
    save(boost::archive::binary_oarchive &archive) const;

    void
    load(boost::archive::binary_iarchive &archive);

    /// In bytes.
    std::size_t
    memory_consumption() const;

  private:
    /// What is known of a state besides its energies.
    struct Forces
    {
      Vector gradient; ///< of the potential [N]
      std::vector<double>
           weights; ///< derivatives of the energy by prescribed weights, with the sign changed [J]
      bool are_balanced = false; ///< whether the gradient is that of a solved increment
    };

    /// Energies at a state, of which the evaluation of the problem is. Empty where a term does not know them.
    std::optional<EnergyStep>
    energies(const State &start, const State &end);

    /// Add the work of handles and of forces that the solver has left over.
    void
    add_work_of_nodes(const State &start, const State &end, EnergyStep &step) const;

    /// Add the work of prescribed weights, whose own energy is not stored.
    void
    add_work_of_weights(const State &start, const State &end, EnergyStep &step);

    double
    kinetic_energy(const State &at);

    void
    count_from(const EnergyStep &at, bool is_balanced);

    std::string
    failure(const EnergyExcess &excess) const;

    const Problem      &problem;
    EnergyBalance       balance;
    Forces              last;
    const double        least_energy; ///< as great as rounding of positions makes it [J]
    unsigned int        n_restarts = 0, first_restart = 0;
    unsigned int        n_in_parts = 0, first_in_parts = 0;
    std::string         first_cause;
    std::vector<double> weight_forces;       ///< memory of add_work_of_weights()
    Mass::Padded        velocities, momenta; ///< memory of kinetic_energy()
  };
} // namespace Exemplar

#endif
