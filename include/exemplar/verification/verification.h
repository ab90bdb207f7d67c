// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_verification_h
#define exemplar_verification_h

#include <exemplar/base/process_group.h>

#include <functional>
#include <string>
#include <vector>

// Reference cases: what the program computes against closed forms, published numbers,
// finite differences and second methods. Tolerances are those that theory or the source
// of the expected number allows, never what happens to come out.

namespace Exemplar
{
  /// Run the cases of these names, or all, and print a line for each number: PASS or FAIL,
  /// case (what), expected, got, tolerance. Returns the exit status: 1 if a number is off.
  /// Throws UserError for an unknown name, before anything is run. Several processes must all call
  /// it: the root computes the cases while the others wait, but those of bodies that they share
  /// all compute together, and the status is the root's.
  int
  verify(const std::vector<std::string> &names, const ProcessGroup &processes);

  /// Print the cases, a line each: name, and what it compares with which source.
  void
  list_verification_cases(const ProcessGroup &processes);

  namespace Verification
  {
    /// How a number that was found is held against the expected one.
    enum class Comparison
    {
      absolute, ///< |got - expected| <= tolerance
      relative, ///< |got - expected| <= tolerance |expected|
      at_most,  ///< got <= expected
      at_least  ///< got >= expected
    };

    /// A number that a case found, and what it should be.
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

    /// A reference case: what it is, and how its numbers are found.
    struct Case
    {
      std::string                               name;        ///< in kebab-case
      std::string                               description; ///< with the source of the numbers
      std::function<std::vector<Measurement>()> measure;     ///< may throw: the case has failed
      bool is_shared = false; ///< all processes compute it together; the root's numbers count
    };

    // The cases by subject, each from a file of its own.
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

    /// Of several processes alone.
    std::vector<Case>
    process_cases();
  } // namespace Verification
} // namespace Exemplar

#endif
