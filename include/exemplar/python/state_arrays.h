// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_state_arrays_h
#define exemplar_state_arrays_h

#include <exemplar/run/problem/problem.h>

#include <pybind11/numpy.h>

#include <memory>

namespace Exemplar::Python
{
  /// Fields of a problem as read-only arrays in its own memory, which lives as long as they do.
  class StateArrays
  {
  public:
    explicit StateArrays(std::shared_ptr<Problem> problem);

    /// (n,3) [m]. They stay what they are when steps replace the state: then the problem leaves them
    /// the memory. Within a step, which will free it, a copy.
    pybind11::array
    positions(bool in_step);

    /// Likewise, [m/s]; None in scenes without.
    pybind11::object
    velocities(bool in_step);

    /// (n,3) [m].
    pybind11::array
    rest_positions() const;

    /// (m,4), nodes from 0.
    pybind11::array
    cells() const;

    /// Leave to arrays the memory of the state, which is about to be replaced.
    void
    let_go();

  private:
    /// A field of the state that arrays show.
    struct Shown
    {
      Vector memory; ///< of a state that is no more; empty: the problem has it
    };

    pybind11::array
    show(const Vector &field, std::shared_ptr<Shown> &shown, bool in_step);

    static void
    let_go(Vector &field, std::shared_ptr<Shown> &shown);

    const std::shared_ptr<Problem> problem;
    std::shared_ptr<Shown>         shown_positions, shown_velocities;
  };
} // namespace Exemplar::Python

#endif
