// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_friction_lag_h
#define exemplar_friction_lag_h

#include <exemplar/algebra/exchange.h>
#include <exemplar/potential/contact_forces.h>

#include <deque>
#include <map>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// The normal forces of friction in a step are those of the step's end, which depends on them: a fixed point. Each round takes
  /// forces, solves the step and finds other forces there. The next ones are chosen from the last rounds such that the change would
  /// be least if it were linear (D. G. Anderson, J. ACM 12, 1965), because plain iteration may go to and fro where contacts stick.
  class FrictionLag
  {
  public:
    /// Another step begins.
    void
    clear()
    {
      rows.clear();
      rounds.clear();
    }

    /// Given what rubbed in the solution of a step and what rubs at its end, replace the forces of the latter by those for the next
    /// round. All processes must call this.
    void
    accelerate(const std::vector<Rubbing> &before,
               std::vector<Rubbing>       &now,
               const Exchange             &exchange);

  private:
    /// Of this process, by row; rows that are missing are 0.
    struct Round
    {
      std::vector<double> found;  ///< forces at the end [N]
      std::vector<double> change; ///< those less the forces that led there [N]
    };

    std::vector<double>
    forces_by_row(const std::vector<Rubbing> &rubbing);

    /// Factors of the differences to earlier rounds, the newest first, which take the most off the change of the newest round.
    std::vector<double>
    factors(const Exchange &exchange) const;

    std::map<std::pair<unsigned int, PairKey>, std::size_t> rows;   ///< of obstacles and pairs
    std::deque<Round>                                       rounds; ///< the newest one last
  };
} // namespace Exemplar

#endif
