// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/nearest_word.h>
#include <exemplar/verification/verification.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>

namespace Exemplar
{
  namespace Verification
  {
    bool
    Measurement::passes() const
    {
      const double error = std::abs(got - expected);
      switch (comparison) // NaN passes no comparison
      {
      case Comparison::absolute:
        return error <= tolerance;
      case Comparison::relative:
        return error <= tolerance * std::abs(expected);
      case Comparison::at_most:
        return got <= expected;
      case Comparison::at_least:
        return got >= expected;
      }
      return false;
    }

    namespace
    {
      std::vector<Case>
      all_cases(const unsigned int n_processes)
      {
        std::vector<Case> all;
        for (const auto &subject :
             { kernel_cases, derivative_cases, static_cases, beam_cases, space_cases, dynamic_cases,
               balance_cases, example_cases, contact_cases })
          for (Case &one : subject())
            all.push_back(std::move(one));
        if (n_processes > 1)
          for (Case &one : process_cases())
            all.push_back(std::move(one));
        return all;
      }

      std::vector<Case>
      select(const std::vector<std::string> &names, const unsigned int n_processes)
      {
        const std::vector<Case> all = all_cases(n_processes);
        if (names.empty())
          return all;
        std::vector<Case> selected;
        for (const std::string &name : names)
        {
          const auto found = std::find_if(all.begin(), all.end(),
                                          [&](const Case &one) { return one.name == name; });
          if (found == all.end())
          {
            std::vector<std::string> known;
            for (const Case &one : all)
              known.push_back(one.name);
            const std::string nearest = nearest_word(name, known);
            const bool is_scene = name.size() > 4 && name.compare(name.size() - 4, 4, ".prm") == 0;
            throw UserError("verify: there is no case '" + name + "'."
                            + (nearest.empty() ? "" : " Did you mean '" + nearest + "'?")
                            + (is_scene ? " verify computes reference cases by their names; a "
                                          "scene is run by: exemplar "
                                              + name + "."
                                        : "")
                            + " exemplar verify --list names them all.");
          }
          selected.push_back(*found);
        }
        return selected;
      }

      std::string
      six_digits(const double value)
      {
        return fmt::format("{:.6g}", value);
      }

      std::string
      tolerance_text(const Measurement &measurement)
      {
        switch (measurement.comparison)
        {
        case Comparison::absolute:
          return six_digits(measurement.tolerance) + " absolute";
        case Comparison::relative:
          return six_digits(measurement.tolerance) + " relative";
        case Comparison::at_most:
          return "at most";
        case Comparison::at_least:
          return "at least";
        }
        return "";
      }

      void
      print_row(const std::string &verdict,
                const std::string &name,
                const std::string &expected,
                const std::string &got,
                const std::string &tolerance)
      {
        std::cout << std::left << std::setw(6) << verdict << std::setw(58) << name << std::setw(13)
                  << expected << std::setw(13) << got << tolerance << std::endl;
      }

      /// Print a line for each number. Returns whether all pass.
      bool
      print(const std::string &name, const std::vector<Measurement> &measurements)
      {
        bool passes = true;
        for (const Measurement &m : measurements)
        {
          print_row(m.passes() ? "PASS" : "FAIL", name + " (" + m.what + ")",
                    six_digits(m.expected), six_digits(m.got), tolerance_text(m));
          passes = passes && m.passes();
        }
        return passes;
      }

      /// Compute and print a case that one process computes.
      bool
      run(const Case &one)
      {
        try
        {
          return print(one.name, one.measure());
        }
        catch (const Interrupted &)
        {
          throw;
        }
        catch (const std::exception &error)
        {
          std::cout << "FAIL  " << one.name << ": " << error.what() << std::endl;
          return false;
        }
      }
    } // namespace
  }   // namespace Verification

  namespace
  {
    /// Compute and print a case. Returns whether it passes, on the root alone.
    bool
    run(const Verification::Case &one, const ProcessGroup &processes)
    {
      bool passes = true;
      if (one.is_shared) // a failure in one process ends all
      {
        const auto measurements = one.measure();
        processes.at_root([&] { passes = Verification::print(one.name, measurements); });
      }
      else
        processes.at_root([&] { passes = Verification::run(one); });
      processes.wait_for_all();
      return passes;
    }
  } // namespace

  int
  verify(const std::vector<std::string> &names, const ProcessGroup &processes)
  {
    const std::vector<Verification::Case> cases
        = Verification::select(names, processes.n_processes);
    std::ostream &out = processes.of_root(std::cout);
    processes.at_root(
        [] { Verification::print_row("", "case (what)", "expected", "got", "tolerance"); });
    std::vector<std::string> failed;
    for (const Verification::Case &one : cases)
      if (!run(one, processes))
        failed.push_back(one.name);
    out << cases.size() - failed.size() << " of " << cases.size() << " cases pass";
    for (std::size_t i = 0; i < failed.size(); ++i)
      out << (i == 0 ? "; failed: " : ", ") << failed[i];
    out << std::endl;
    return failed.empty() ? 0 : 1;
  }

  void
  list_verification_cases(const ProcessGroup &processes)
  {
    std::ostream &out = processes.of_root(std::cout);
    for (const Verification::Case &one : Verification::all_cases(processes.n_processes))
      out << std::left << std::setw(31) << one.name << ' ' << one.description << '\n';
  }
} // namespace Exemplar
