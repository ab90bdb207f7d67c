// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_diagnostics_h
#define exemplar_diagnostics_h

#include <exemplar/run/problem/problem.h>

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace Exemplar
{
  /// A cell of statistics.csv.
  struct StatisticsCell
  {
    std::string column;

    /// The value; monostate: not known.
    std::variant<std::monostate, double, unsigned int, std::string> value = {};

    bool is_of_report = false; ///< known also for a step that failed

    /// The text in the file; empty for numbers that are not finite.
    std::string
    text() const;
  };

  using StatisticsRow = std::vector<StatisticsCell>;

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
    /// Which columns rows have: those that the problem needs now, or those that it needed at the
    /// beginning. A file's rows have the same columns even if a session later adds handles or
    /// loads.
    enum class Columns
    {
      of_present,
      of_beginning
    };

    /// The problem must outlive this. All processes must call this.
    explicit Diagnostics(const Problem &problem, Columns columns = Columns::of_present);

    /// Add the work of the step that the problem has just made. To be called after each.
    void
    add_step();

    /// Continue from the problem's state with the work done before.
    void
    resume(const Work &earlier);

    const Work &
    get_work() const
    {
      return work;
    }

    /// A row for the problem's present energies and forces; `shown` has the step, the time, the
    /// velocities and the weights.
    StatisticsRow
    row(const State &shown, const SolveReport &report) const;

    /// The seconds of a step by part; without values in the row of the initial state.
    static void
    append_seconds(StatisticsRow &row, const std::optional<PhaseSeconds> &seconds);

  private:
    void
    append_terms(StatisticsRow &row) const;

    void
    append_weights(StatisticsRow &row, const State &shown, const SolveReport &report) const;

    void
    append_work(StatisticsRow &row) const;

    /// Column energy_dissipated: the total of all dissipation since the first step [J].
    void
    append_dissipated(StatisticsRow &row, const State &shown) const;

    /// The row with all columns that the problem needs now.
    StatisticsRow
    present_row(const State &shown, const SolveReport &report) const;

    const Problem            &problem;
    std::vector<std::string>  columns;          ///< of rows; empty: as the problem is now
    Vector                    last_positions;   ///< before the next step [m]
    Vector                    displacement;     ///< memory of add_step()
    std::vector<unsigned int> held;             ///< degrees of freedom of the handles
    unsigned int              held_version = 0; ///< of the FreeDofs when they were asked for them
    Work                      work;
  };
} // namespace Exemplar

#endif
