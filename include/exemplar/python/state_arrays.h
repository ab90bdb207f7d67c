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

    /// Positions (n,3) [m]. The array keeps its values when steps replace the state, as the problem
    /// then leaves it the memory. Within a step, which will free the memory, it is a copy.
    pybind11::array
    positions(bool in_step);

    /// Velocities (n,3) [m/s], likewise; None in scenes without.
    pybind11::object
    velocities(bool in_step);

    /// Rest positions (n,3) [m].
    pybind11::array
    rest_positions() const;

    /// Nodes of the cells (m,4), from 0.
    pybind11::array
    cells() const;

    /// Leave the memory of the state, which is about to be replaced, to the arrays.
    void
    let_go();

  private:
    /// A field of the state that arrays show.
    struct Shown
    {
      Vector memory; ///< field of a former state; empty: problem has it
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
