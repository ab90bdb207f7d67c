// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/run/problem/problem.h>

#include <sstream>

// Steps whose energy is compared with the work, and static increments that are repeated in parts, whose work is known better.

namespace Exemplar
{
  namespace
  {
    /// What terms remember, of this process.
    std::string
    memory_of(const PotentialTerms &terms)
    {
      std::ostringstream              bytes;
      boost::archive::binary_oarchive archive(bytes);
      for (const auto &term : terms)
        term->save(archive);
      return bytes.str();
    }

    /// Let terms remember what memory_of() has returned in this process.
    void
    restore(const PotentialTerms &terms, const std::string &memory)
    {
      std::istringstream              bytes(memory);
      boost::archive::binary_iarchive archive(bytes);
      for (const auto &term : terms)
        term->load(archive);
    }
  } // namespace

  bool
  Problem::has_parts(const StepInterval &interval) const
  {
    return parameters.scene == SceneKind::statics
           && (potential.is_driven(state, interval.end)
               || constraints.handles.are_elsewhere(interval.end, state.positions));
  }

  SolveReport
  Problem::make_step_in_parts(const StepInterval &interval, const SolveReport &refused)
  {
    const State       begin    = state;
    const std::string of_terms = memory_of(potential.get_terms());
    const EnergyAudit of_audit = *audit;
    const auto        go_back  = [&]
    {
      state = begin;
      solver->forget();
      restore(potential.get_terms(), of_terms);
      potential.get_tangent().follow_couplings();
      audit = std::make_unique<EnergyAudit>(of_audit);
      start(state);
    };
    for (const unsigned int n : { 4U, 16U, 64U })
    {
      bool        gains_energy = false;
      SolveReport sum;
      try
      {
        for (unsigned int k = 1; k <= n && (k == 1 || is_success(sum.status)); ++k)
        {
          state.step = begin.step;
          const double end
              = k == n ? interval.end : begin.time + k * (interval.end - begin.time) / n;
          SolveReport part = solve_step({ end, interval.size / n }, gains_energy);
          part.iterations += sum.iterations;
          part.factorizations += sum.factorizations;
          part.load_stages += sum.load_stages;
          sum = std::move(part);
        }
      }
      catch (...)
      {
        go_back();
        throw;
      }
      if (is_success(sum.status))
      {
        audit->count_parts(state.step);
        spare = begin;
        return sum;
      }
      go_back();
    }
    return refused;
  }

  bool
  Problem::audit_step(const State &next, const StepInterval &interval, SolveReport &report)
  {
    if (audit == nullptr)
      return false;
    if (parameters.solver.starts == Starts::examples && interval.end == end_of_scene(*this))
    {
      audit->restart("Solver/Starts = examples");
      return false;
    }
    const std::string failure = audit->add_step(state, next);
    if (failure.empty())
      return false;
    report.status  = SolveStatus::failed;
    report.failure = failure;
    elastic->set_history(state.history);
    return true;
  }

  void
  Problem::restart_audit(const std::string &what)
  {
    if (audit != nullptr)
      audit->restart(what);
  }
} // namespace Exemplar
