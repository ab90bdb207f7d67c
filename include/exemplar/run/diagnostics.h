// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_diagnostics_h
#define exemplar_diagnostics_h

#include <exemplar/base/number_text.h>
#include <exemplar/base/step_clock.h>
#include <exemplar/body/example_weights.h>
#include <exemplar/body/handles.h>
#include <exemplar/body/loads.h>
#include <exemplar/body/mass.h>
#include <exemplar/potential/evaluation.h>
#include <exemplar/solvers/solve_report.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// A row of statistics.csv: column and value.
  using StatisticsRow = std::vector<std::pair<std::string, std::string>>;

  /// Work done on the body since the first step [J]: end-of-step forces times
  /// displacements.
  struct Work
  {
    double handles = 0.;
    double gravity = 0.;
    double loads   = 0.;
  };

  /// Energies, momenta, reactions and work of a run. Columns that a scene does not
  /// need are absent.
  class Diagnostics
  {
  public:
    /// `energy_is_bounded`: steps minimise one energy, the same before and after the step, with
    /// TimeIntegrator::is_undamped_implicit_euler().
    Diagnostics(const Handles        *handles,
                const Loads          *loads,
                const ExampleWeights *weights,
                const Mass           *mass,
                bool                  energy_is_bounded);

    /// Add the work of the step from `old_positions` to `state`.
    void
    add_work(const dealii::Vector<double> &old_positions,
             const State                  &state,
             const dealii::Vector<double> &gradient);

    const Work &
    get_work() const
    {
      return work;
    }

    void
    set_work(const Work &value)
    {
      work = value;
    }

    StatisticsRow
    row(const State &state, const SolveReport &report, const Evaluation &evaluation) const;

    /// The seconds of a step by part; without values in the row of the initial state.
    static void
    append_seconds(StatisticsRow &row, const std::optional<PartSeconds> &seconds);

  private:
    const Handles        *handles;
    const Loads          *loads;
    const ExampleWeights *weights;
    const Mass           *mass;
    const bool            energy_is_bounded;
    Work                  work;
  };
} // namespace Exemplar

#endif
