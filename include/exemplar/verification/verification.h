// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_verification_h
#define exemplar_verification_h

#include <exemplar/base/process_group.h>

#include <functional>
#include <string>
#include <vector>

// Reference cases: computed numbers against closed forms, published numbers, finite differences and
// second methods. Tolerances follow from theory or the source of the expected number, never from
// the result.

namespace Exemplar
{
  /// Run the cases of these names, or all, and print a line for each number: PASS or FAIL, case
  /// (what), expected, got, tolerance. Returns the exit status: 1 if a number fails. Throws
  /// UserError for an unknown name before anything is run. Collective: the root computes most cases
  /// while the others wait, but all compute those of shared bodies; the status is the root's.
  int
  verify(const std::vector<std::string> &names, const ProcessGroup &processes);

  /// Print the cases, a line each: name, compared quantity and source.
  void
  list_verification_cases(const ProcessGroup &processes);

  namespace Verification
  {
    /// Comparison of a computed number with the expected one.
    enum class Comparison
    {
      absolute, ///< |got - expected| <= tolerance
      relative, ///< |got - expected| <= tolerance |expected|
      at_most,  ///< got <= expected
      at_least  ///< got >= expected
    };

    /// A computed number, and its expected value.
    struct Measurement
    {
      std::string what;
      double      expected;
      double      got;
      Comparison  comparison;
      double      tolerance = 0.; ///< of absolute and relative comparisons

      bool
      passes() const;
    };

    /// A reference case: its description and its computation.
    struct Case
    {
      std::string                               name;        ///< in kebab-case
      std::string                               description; ///< with the source of the numbers
      std::function<std::vector<Measurement>()> measure;     ///< may throw, which fails the case
      bool is_shared = false; ///< all processes compute it; the root's numbers count
    };

    // The cases by subject, one file each.
    std::vector<Case>
    kernel_cases();
    std::vector<Case>
    derivative_cases();
    std::vector<Case>
    static_cases();
    std::vector<Case>
    beam_cases();
    std::vector<Case>
    space_cases();
    std::vector<Case>
    dynamic_cases();
    std::vector<Case>
    balance_cases();
    std::vector<Case>
    example_cases();
    std::vector<Case>
    contact_cases();

    /// Cases that need several processes.
    std::vector<Case>
    process_cases();
  } // namespace Verification
} // namespace Exemplar

#endif
