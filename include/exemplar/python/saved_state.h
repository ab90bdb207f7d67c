// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_saved_state_h
#define exemplar_saved_state_h

#include <exemplar/run/output/diagnostics.h>
#include <exemplar/run/problem/problem.h>

#include <cstdint>
#include <string>

namespace Exemplar::Python
{
  /// A state of a problem, with all that is needed to make the same next steps again.
  struct SavedState
  {
    State         state;
    Work          work;         ///< work of the forces up to it [J]
    std::string   memory;       ///< solver's memory; empty: none
    std::uint64_t settings = 0; ///< digest of the settings for which the memory is valid

    /// Serialization by boost's archives.
    template <typename Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &state &work.handles &work.gravity &work.loads &memory &settings;
    }
  };

  SavedState
  save_state(const Problem &problem, const Work &work);

  /// Throws UserError for a state of another body, with the difference, and for one from which no
  /// step can start.
  void
  check_fits(const SavedState &saved, const Problem &problem);

  /// Sets the state of a problem. Precondition: check_fits() has passed.
  void
  restore_state(const SavedState &saved, Problem &problem);
} // namespace Exemplar::Python

#endif
