// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_energy_balance_h
#define exemplar_energy_balance_h

#include <optional>

namespace Exemplar
{
  /// The energies at the end of a step, and the work that was done on the body in it [J].
  struct EnergyStep
  {
    unsigned int step    = 0;  ///< its number
    double       stored  = 0.; ///< with plastic work, which includes hardening
    double       kinetic = 0.; ///< 0 in statics
    double       plastic = 0.; ///< of what is stored: plastic work since the first step
    double       size    = 0.; ///< sum of the magnitudes of which both consist

    double work     = 0.; ///< of loads and of everything that moves or changes
    double doubt    = 0.; ///< of the work: half of the difference between two rules
    double unsolved = 0.; ///< work of the forces that the solver has left over
    double rounding = 0.;

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      archive &step &stored &kinetic &plastic &size &work &doubt &unsolved &rounding;
    }
  };

  /// Energy that no work explains, since the end of a step `since`.
  struct EnergyExcess
  {
    unsigned int since = 0;
    double       grown = 0.; ///< in dynamics the stored energy at the end of the step [J]
    double       work  = 0.; ///< in dynamics with the energies at the start of the step [J]
    double       doubt = 0.; ///< of the work [J]
  };

  /// The greatest rise of stored and kinetic energy that no work explains.
  struct EnergyGain
  {
    unsigned int since = 0, until = 0;
    double       energy   = 0.; ///< [J]
    double       greatest = 0.; ///< stored and kinetic energy up to then [J]

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      archive &since &until &energy &greatest;
    }
  };

  /// Compares the energies of steps with the work that was done, doc/output.md (Energy audit).
  class EnergyBalance
  {
  public:
    explicit EnergyBalance(const bool is_dynamic) : is_dynamic(is_dynamic) {}

    /// From now on count from these energies; their work does not matter.
    void
    begin(const EnergyStep &at);

    /// Whether begin() was called since the last forget().
    bool
    has_begun() const
    {
      return begun;
    }

    /// Count nothing until begin().
    void
    forget()
    {
      begun = false;
    }

    const EnergyStep &
    get_last() const
    {
      return last;
    }

    /// Count a step. An excess is a failure: then nothing is changed.
    std::optional<EnergyExcess>
    add(const EnergyStep &step);

    /// The greatest gain in dynamics, if it is worth a warning.
    std::optional<EnergyGain>
    gain() const;

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      archive &begun &last &greatest &excess &doubt &rounding &base &rise &most;
    }

  private:
    /// Energy and work at the step since which an excess is counted, both since begin() [J].
    struct Base
    {
      unsigned int step   = 0;
      double       stored = 0., work = 0.;

      template <typename Archive>
      void
      serialize(Archive &archive, unsigned int /*version*/)
      {
        archive &step &stored &work;
      }
    };

    std::optional<EnergyExcess>
    add_increment(const EnergyStep &step);

    std::optional<EnergyExcess>
    add_time_step(const EnergyStep &step);

    bool       is_dynamic;
    bool       begun = false;
    EnergyStep last;
    double     greatest = 0.; ///< energy so far [J]
    double     excess   = 0.; ///< of the stored energy over the work, since the base [J]
    double     doubt    = 0.; ///< of all steps [J]
    double     rounding = 0.; ///< of all steps [J]
    Base       base;
    EnergyGain rise, most;
  };
} // namespace Exemplar

#endif
