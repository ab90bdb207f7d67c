// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/problem/energy_balance.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    constexpr double allowed = 1e-3; ///< of the greatest energy: what no rule has to explain
    constexpr double worth_words
        = 5e-3; ///< of the greatest energy: a gain from which on there is a warning
  }             // namespace

  void
  EnergyBalance::begin(const EnergyStep &at)
  {
    const EnergyGain before = most;
    *this                   = EnergyBalance(is_dynamic);
    begun                   = true;
    last                    = at;
    greatest                = at.size;
    base                    = { at.step, at.stored, 0. };
    rise.since              = at.step;
    most                    = before;
  }

  std::optional<EnergyExcess>
  EnergyBalance::add(const EnergyStep &step)
  {
    const auto found = is_dynamic ? add_time_step(step) : add_increment(step);
    if (!found)
      last = step;
    return found;
  }

  std::optional<EnergyExcess>
  EnergyBalance::add_increment(const EnergyStep &step)
  {
    // what an earlier step has dissipated pays for nothing: the excess is that since its least sum
    const double new_excess   = excess + step.stored - last.stored - step.work;
    const double new_doubt    = doubt + step.doubt + step.unsolved;
    const double new_rounding = rounding + step.rounding;
    const double new_greatest = std::max(greatest, step.size);
    if (new_excess > new_doubt + new_rounding + allowed * new_greatest)
      return EnergyExcess{ base.step, step.stored - base.stored, base.work + step.work, new_doubt };
    excess   = std::max(0., new_excess);
    doubt    = new_doubt;
    rounding = new_rounding;
    greatest = new_greatest;
    base.work += step.work;
    if (excess == 0.)
      base = { step.step, step.stored, 0. };
    return {};
  }

  std::optional<EnergyExcess>
  EnergyBalance::add_time_step(const EnergyStep &step)
  {
    // where a force is greatest within the step, both rules are below its work, by less than the last step's doubt
    const double of_work      = step.doubt + last.doubt;
    const double had          = last.stored + last.kinetic + step.work;
    const double new_doubt    = of_work + step.unsolved;
    const double new_greatest = std::max(greatest, step.size);
    if (step.stored - had > new_doubt + step.rounding + allowed * new_greatest)
      return EnergyExcess{ last.step, step.stored, had, new_doubt };
    greatest = new_greatest;
    rise.energy += step.stored + step.kinetic - had - of_work - step.rounding;
    if (!(rise.energy > 0.))
      rise = { step.step, 0, 0., 0. };
    else if (rise.energy > most.energy)
      most = { rise.since, step.step, rise.energy, greatest };
    return {};
  }

  std::optional<EnergyGain>
  EnergyBalance::gain() const
  {
    if (most.energy > worth_words * most.greatest)
      return most;
    return {};
  }
} // namespace Exemplar
