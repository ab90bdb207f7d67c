// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_saved_state_h
#define exemplar_saved_state_h

#include <exemplar/run/output/diagnostics.h>
#include <exemplar/run/problem/problem.h>

#include <cstdint>
#include <string>

namespace Exemplar::Python
{
  /// A state of a problem, and what makes its next steps the same once more.
  struct SavedState
  {
    State         state;
    Work          work;         ///< done up to it
    std::string   memory;       ///< of the solver; empty: none
    std::uint64_t settings = 0; ///< of the problem, with others its memory is of no use

    /// For boost's archives.
    template <typename Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &state &work.handles &work.gravity &work.loads &memory &settings;
    }
  };

  SavedState
  save_state(const Problem &problem, const Work &work);

  /// Throws UserError for a state of another body, with what differs, and for one that no step can start
  /// from.
  void
  check_fits(const SavedState &saved, const Problem &problem);

  /// To be called for what fits.
  void
  restore_state(const SavedState &saved, Problem &problem);
} // namespace Exemplar::Python

#endif
