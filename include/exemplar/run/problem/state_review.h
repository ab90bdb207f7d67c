// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_state_review_h
#define exemplar_state_review_h

#include <exemplar/run/problem/problem.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// Collects flaws of a run's states, for warnings at its end.
  class StateReview
  {
  public:
    /// `problem` must outlive this.
    explicit StateReview(const Problem &problem);

    /// Review the state after an accepted step.
    void
    add_step(const SolveReport &report);

    /// Warnings in order of severity. Elements are named by the numbers of the mesh file.
    std::vector<std::string>
    warnings() const;

  private:
    /// Steps in which cells were inverted.
    struct Inversions
    {
      unsigned int             first_step = 0, worst_step = 0, n_steps = 0;
      unsigned int             n_cells = 0; ///< in the worst step
      std::vector<std::size_t> elements;    ///< in the first step
    };

    /// The greatest displacement of a node along an axis in one step.
    struct Farthest
    {
      unsigned int step     = 0;
      double       distance = 0.; ///< [m]
    };

    /// With contact, keep the greatest displacement of a step.
    void
    add_displacement();

    const Problem &problem;
    Inversions     inversions;
    Farthest       farthest;
    unsigned int   first_raised    = 0; ///< first step with loads raised in parts; 0: none
    unsigned int   first_unsettled = 0, n_unsettled = 0; ///< steps whose friction has not settled
  };

  /// Whether friction of the last step had settled; it has where there is none.
  bool
  friction_has_settled(const Problem &problem);

  /// How to let friction settle, in sentences.
  std::string
  how_to_settle(const Problem &problem);

  /// At the end of a scene, a warning if missed_example() finds one; else none. All processes must
  /// call this.
  std::vector<std::string>
  missed_example_warnings(Problem &problem);
} // namespace Exemplar

#endif
