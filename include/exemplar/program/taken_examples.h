// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_taken_examples_h
#define exemplar_taken_examples_h

#include <exemplar/run/problem/problem.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// Records how much of each example the steps of a run take, for weights that are found.
  class TakenExamples
  {
  public:
    /// `problem` must outlive this.
    explicit TakenExamples(const Problem &problem);

    /// Record the weights after an accepted step.
    void
    add_step();

    /// A line per example, but for the rest pose, with its greatest and its last weight, and where to read on if all are
    /// small; empty without weights to find or without steps.
    std::string
    text() const;

  private:
    const Problem      &problem;
    const unsigned int  first_step; ///< after which the record begins
    std::vector<double> greatest;   ///< weight of each example in any region
    unsigned int        n_steps = 0;
  };
} // namespace Exemplar

#endif
